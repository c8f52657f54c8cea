//! What can go wrong before and around the cases; what goes wrong inside one is a result and no error.

use record::RecordError;
use std::path::PathBuf;

/// An experiment that could not be read, planned or run.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// The TOML says something that cannot be meant.
    #[error("{}:{line}: {key}: found {found}; expected {expected}", path.display())]
    Spec {
        /// The TOML.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The key, as `study[0].model.gamma`.
        key: String,
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// A file could not be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The TOML can be read, but what it asks for has no answer: found where it was solved for.
    #[error(
        "experiments/{experiment}.toml: {what}: found {found}; expected something that has an answer"
    )]
    Unanswered {
        /// The experiment.
        experiment: String,
        /// The study and its point, or the measure or claim.
        what: String,
        /// Why there is none.
        found: String,
    },
    /// Asked to stop: what was finished is stored, the rest can be run again.
    #[error("interrupted after {done} of {total} cases; run the same command again to go on")]
    Interrupted {
        /// Cases finished.
        done: usize,
        /// Cases planned.
        total: usize,
    },
    /// The machine would not give what the run needs, as threads.
    #[error("this machine refuses: {0}")]
    Environment(String),
    /// Our own mistake.
    #[error("a bug in this project: {0}")]
    Bug(String),
}

/// A complaint about one key, before its line is known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Complaint {
    pub(crate) key: String,
    pub(crate) found: String,
    pub(crate) expected: String,
}

impl Complaint {
    pub(crate) fn new(
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self { key: key.into(), found: found.into(), expected: expected.into() }
    }

    /// The same complaint, seen from a table further out.
    pub(crate) fn under(mut self, outer: &str) -> Self {
        self.key =
            if self.key.is_empty() { outer.to_owned() } else { format!("{outer}.{}", self.key) };
        self
    }
}

/// The known names, and the nearest one where it is near enough to be meant.
pub(crate) fn one_of<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let nearest = known
        .iter()
        .map(|name| (strsim::damerau_levenshtein(found, name), *name))
        .min()
        .filter(|(distance, name)| *distance <= 1 + name.len() / 4);
    let list = format!("one of {}", known.join(", "));
    nearest.map_or(list.clone(), |(_, name)| format!("{list} (did you mean `{name}`?)"))
}
