//! What can be wrong with a rig.

/// Why a text is no rig, or why a rig does not take a value.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RigError {
    /// The text is not TOML, or too long.
    #[error("{}{found}: expected a rig file in TOML", place(*line))]
    Syntax {
        /// The line, from 1, where there is one.
        line: Option<usize>,
        /// What was found.
        found: String,
    },
    /// A name that is not in its list.
    #[error("{}unknown {what} {name}: {known}", place(*line))]
    Unknown {
        /// The line, from 1, where it comes from a file.
        line: Option<usize>,
        /// What it names: `key in [plant]`, `friction model`.
        what: String,
        /// The name found, quoted.
        name: String,
        /// What is known, with the near miss if there is one.
        known: String,
    },
    /// What has to be said is not.
    #[error("{}{key} is missing: expected {expected}", place(*line))]
    Missing {
        /// The line, from 1, of the table it belongs to.
        line: Option<usize>,
        /// The key.
        key: String,
        /// What belongs there, with its unit.
        expected: String,
    },
    /// A value that cannot be meant.
    #[error("{}{key} = {found}: expected {expected}", place(*line))]
    Invalid {
        /// The line, from 1, where it comes from a file.
        line: Option<usize>,
        /// The key.
        key: String,
        /// What was found.
        found: String,
        /// What belongs there, with its unit.
        expected: String,
    },
}

impl RigError {
    /// An unknown name, with what is known and the near miss.
    pub(super) fn unknown(line: Option<usize>, what: &str, name: &str, known: &[&str]) -> Self {
        let known = if known.is_empty() {
            "none are known to this version".to_owned()
        } else {
            format!("expected one of {}{}", known.join(", "), near(name, known))
        };
        Self::Unknown { line, what: what.to_owned(), name: quoted(name), known }
    }

    /// The same error at a line and under a key, where it did not know of any.
    pub(super) fn at(self, line: usize, key: &str) -> Self {
        match self {
            Self::Invalid { found, expected, .. } => {
                Self::Invalid { line: Some(line), key: key.to_owned(), found, expected }
            }
            other => other,
        }
    }
}

fn place(line: Option<usize>) -> String {
    line.map_or(String::new(), |line| format!("line {line}: "))
}

/// The one of `known` that was probably meant, as an ending of the sentence that lists them.
fn near(name: &str, known: &[&str]) -> String {
    let name: String = name.chars().take(64).collect();
    let distance = |k: &&&str| strsim::damerau_levenshtein(&name, k);
    match known.iter().min_by_key(distance) {
        Some(k) if distance(&k) <= 1 + k.len() / 4 => format!(" (did you mean `{k}`?)"),
        _ => String::new(),
    }
}

/// Text of a file, safe to show: quoted, control characters escaped, at most 80 letters.
pub(crate) fn quoted(text: &str) -> String {
    let mut shown: String = text.chars().take(80).flat_map(char::escape_debug).collect();
    if text.chars().nth(80).is_some() {
        shown.push('…');
    }
    format!("\"{shown}\"")
}
