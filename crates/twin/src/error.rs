//! What can go wrong.

use std::fmt::Display;

/// Why no record was made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TwinError {
    /// The scenario's text is no scenario.
    #[error("the scenario cannot be read: {0}")]
    Syntax(String),
    /// A value of the scenario makes no sense.
    #[error("{key}: found {found}, expected {expected}")]
    Value {
        /// The key in the scenario.
        key: String,
        /// What stands there.
        found: String,
        /// What was expected, with its unit.
        expected: String,
    },
    /// A name that is not in the catalogue.
    #[error("no scenario is called `{found}`; there are {known}")]
    Name {
        /// The name asked for.
        found: String,
        /// The known ones.
        known: String,
    },
    /// The motion cannot be followed.
    #[error(
        "the motion cannot be followed beyond t = {time} s: {reason}; check the plant's and the friction's values"
    )]
    Motion {
        /// Time reached [s].
        time: f64,
        /// What happened.
        reason: &'static str,
    },
}

impl TwinError {
    /// A value that makes no sense.
    pub(crate) fn value(key: impl Into<String>, found: impl Display, expected: &str) -> Self {
        Self::Value { key: key.into(), found: found.to_string(), expected: expected.to_owned() }
    }
}
