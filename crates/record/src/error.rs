//! What can go wrong with files and tables.

use std::path::PathBuf;

/// A file or a table that could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The operating system refused.
    #[error("{}: {what}", path.display())]
    Disk {
        /// The file or folder.
        path: PathBuf,
        /// What was tried, as in "cannot write".
        what: &'static str,
        /// The system's own words.
        source: std::io::Error,
    },
    /// A table that is not what its type says: a missing column, a wrong type, no CSV at all.
    #[error("{}: {found}; expected {expected}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
}
