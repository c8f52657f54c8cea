//! Everything that is printed goes through here.

use std::io::Write;

/// A line of results, on standard output. A reader that went away (`| head`) is no error.
pub(crate) fn line(text: &str) {
    let _ = writeln!(std::io::stdout().lock(), "{text}");
}

/// A line about the run, on standard error.
pub(crate) fn note(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// An error, on standard error.
pub(crate) fn error(text: &str) {
    note(&format!("error: {text}"));
}
