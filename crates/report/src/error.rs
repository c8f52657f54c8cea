//! What can go wrong between the tables and the pages.

/// A summary that cannot be rendered.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum ReportError {
    /// A figure of a kind that is not in the list.
    #[error("{experiment}: figure `{figure}` is of kind `{kind}`; known are {known}")]
    UnknownKind {
        /// The experiment.
        experiment: String,
        /// The figure.
        figure: String,
        /// What stands in its row.
        kind: String,
        /// What could stand there.
        known: String,
    },
    /// A figure whose row or table lacks what its kind needs.
    #[error("figure `{figure}` of kind `{kind}`: {found}; expected {expected}")]
    Incomplete {
        /// The figure.
        figure: String,
        /// Its kind.
        kind: String,
        /// What stands there.
        found: String,
        /// What is needed.
        expected: String,
    },
    /// Two outputs with one name, or a name that leaves no file name.
    #[error("`{path}` would be written twice; expected one experiment or figure of that name")]
    SameName {
        /// The file.
        path: String,
    },
    /// The drawing library refused.
    #[error("figure `{figure}` cannot be drawn: {why}")]
    Drawing {
        /// The figure.
        figure: String,
        /// The library's own words.
        why: String,
    },
}
