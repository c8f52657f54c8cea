//! How the program ends.

use experiment::ExperimentError;
use record::RecordError;
use report::ReportError;
use twin::TwinError;

/// The documented exit codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Exit {
    /// All done.
    Done = 0,
    /// A committed number, verdict or page moved, or a house rule is broken.
    CheckFailed = 1,
    /// A name that is not in the list.
    Usage = 2,
    /// More work than before, or a right answer lost; times only on request.
    Regression = 3,
    /// A file that says what cannot be meant.
    Input = 4,
    /// Stopped from outside; everything resumable.
    Interrupted = 5,
    /// Disk or environment.
    Environment = 6,
    /// Our own mistake.
    Bug = 70,
}

/// An error with the code to end with.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) exit: Exit,
    pub(crate) error: anyhow::Error,
}

impl Failure {
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self { exit: Exit::Usage, error: anyhow::anyhow!(message.into()) }
    }

    pub(crate) fn environment(error: impl Into<anyhow::Error>) -> Self {
        Self { exit: Exit::Environment, error: error.into() }
    }
}

impl From<RecordError> for Failure {
    fn from(error: RecordError) -> Self {
        let exit = match error {
            RecordError::Disk { .. } => Exit::Environment,
            RecordError::Table { .. } => Exit::Input,
        };
        Self { exit, error: error.into() }
    }
}

impl From<ExperimentError> for Failure {
    fn from(error: ExperimentError) -> Self {
        let exit = match error {
            ExperimentError::Record(inner) => return inner.into(),
            ExperimentError::Spec { .. } | ExperimentError::Unanswered { .. } => Exit::Input,
            ExperimentError::Interrupted { .. } => Exit::Interrupted,
            ExperimentError::Environment(_) => Exit::Environment,
            ExperimentError::Bug(_) => Exit::Bug,
        };
        Self { exit, error: error.into() }
    }
}

impl From<ReportError> for Failure {
    fn from(error: ReportError) -> Self {
        Self { exit: Exit::Input, error: error.into() }
    }
}

impl From<TwinError> for Failure {
    fn from(error: TwinError) -> Self {
        let exit = match error {
            TwinError::Name { .. } => Exit::Usage,
            TwinError::Syntax(_) | TwinError::Value { .. } | TwinError::Motion { .. } => {
                Exit::Input
            }
        };
        Self { exit, error: error.into() }
    }
}
