//! What can be wrong with a record of a drive.

use std::fmt::Write;

/// A record that cannot be read, or a column that is not there.
///
/// No variant knows the file's name: who asked for the file adds it.
#[derive(Debug, thiserror::Error)]
pub enum SheetError {
    /// The operating system refused.
    #[error("{what}: {reason}")]
    Disk {
        /// What was tried, as in "cannot open".
        what: &'static str,
        /// The system's own words; part of the message, and so not told as its source once more.
        reason: std::io::Error,
    },
    /// Content that is not what its format asks for.
    #[error("{place}: found {found}; expected {expected}")]
    Content {
        /// Where: a line, a variable, the file.
        place: String,
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// More than a record may hold.
    #[error("{place}: {found}; there may be at most {cap}")]
    Cap {
        /// Where it was noticed.
        place: String,
        /// How much there is.
        found: String,
        /// How much there may be.
        cap: String,
    },
    /// A column that is not there.
    #[error("no column `{}`; there are {}", shown(name), list(known))]
    Unknown {
        /// The name asked for.
        name: String,
        /// Every column's name.
        known: Vec<String>,
    },
    /// A name that several columns have.
    #[error("{} columns are named `{}`: columns {at:?} counted from 1; expected one, rename the others",
        at.len(), shown(name))]
    Ambiguous {
        /// The name asked for.
        name: String,
        /// The places of the columns that have it, counted from 1.
        at: Vec<usize>,
    },
    /// A column that holds something that is no number.
    #[error(
        "line {line}, column `{}`: found `{}`; expected a number, as 1.5e-3, or nothing{}",
        shown(name),
        shown(found),
        comma(found)
    )]
    Text {
        /// The column.
        name: String,
        /// The line of the first such cell, counted from 1.
        line: u64,
        /// What stands there, at most [`crate::SheetError::SHOWN`] characters of it.
        found: String,
    },
    /// A column that was left out because it is no column of real numbers.
    #[error("`{}` was not read: it is {what}; expected a column of real numbers", shown(name))]
    Skipped {
        /// The name asked for.
        name: String,
        /// What it is.
        what: String,
    },
}

impl SheetError {
    /// How much of a text taken from the file a message shows [characters].
    pub const SHOWN: usize = 80;

    /// Content that does not fit.
    pub(crate) fn content(
        place: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self::Content { place: place.into(), found: found.into(), expected: expected.into() }
    }

    /// Too much of something.
    pub(crate) fn cap(
        place: impl Into<String>,
        found: impl Into<String>,
        cap: impl Into<String>,
    ) -> Self {
        Self::Cap { place: place.into(), found: found.into(), cap: cap.into() }
    }
}

/// A text from a file as a message may show it: no control characters, and cut.
pub(crate) fn shown(text: &str) -> String {
    let mut shown = String::new();
    for (i, c) in text.chars().enumerate() {
        if i == SheetError::SHOWN {
            shown.push('…');
            break;
        }
        // Quotes stay as they are; controls, marks of direction and the like do not.
        if matches!(c, '"' | '\'' | '\\') {
            shown.push(c);
        } else {
            let _ = write!(shown, "{}", c.escape_debug());
        }
    }
    shown
}

/// The first names of a list, as a message may show them.
fn list(known: &[String]) -> String {
    const FIRST: usize = 24;
    let mut text = known
        .iter()
        .take(FIRST)
        .map(|name| format!("`{}`", shown(name)))
        .collect::<Vec<_>>()
        .join(", ");
    if known.len() > FIRST {
        let _ = write!(text, " and {} more", known.len() - FIRST);
    }
    if known.is_empty() { "none".to_owned() } else { text }
}

/// What one must know about decimal commas, if the cell may be a number with one.
fn comma(found: &str) -> &'static str {
    if found.contains(',') && found.contains(|c: char| c.is_ascii_digit()) {
        " (a decimal comma is read where tabs or semicolons part the cells and no number before has a point)"
    } else {
        ""
    }
}
