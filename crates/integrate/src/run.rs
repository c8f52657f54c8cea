//! What comes back.

use std::fmt;

/// The work of a run, counted by our wrapper around the right-hand side for all solvers alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// Evaluations of the Jacobian matrix. diffsol asks for it column by column; n products of the
    /// Jacobian with unit vectors count as one.
    pub jacobians: u64,
    /// Accepted steps.
    pub accepted: u64,
    /// Attempted steps that were thrown away, for error or because Newton's method failed; none
    /// for a method with fixed steps, which knows no attempt. In a failed run of ode_solvers, those
    /// after the last accepted step are not in it.
    pub rejected: Option<u64>,
}

impl std::ops::AddAssign<&Work> for Work {
    /// The work of two runs; rejections are known of both or not at all.
    fn add_assign(&mut self, other: &Work) {
        self.evaluations += other.evaluations;
        self.jacobians += other.jacobians;
        self.accepted += other.accepted;
        self.rejected = self.rejected.zip(other.rejected).map(|(a, b)| a + b);
    }
}

/// The start and every accepted step, in order; a restart point stands once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trajectory {
    /// Times.
    pub t: Vec<f64>,
    /// States, n per time, row by row.
    pub y: Vec<f64>,
    /// Number of states.
    pub n: usize,
}

impl Trajectory {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// True if not even the start is there.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// State at point i.
    pub fn state(&self, i: usize) -> &[f64] {
        &self.y[i * self.n..(i + 1) * self.n]
    }

    /// Last time and state.
    pub fn last(&self) -> Option<(f64, &[f64])> {
        self.t.last().map(|&t| (t, self.state(self.len() - 1)))
    }
}

/// Why a solver did not get to the end.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// A state grew above a million times its natural size.
    #[error("diverged")]
    Diverged,
    /// A state or a right-hand side became infinite or not a number.
    #[error("not finite")]
    NotFinite,
    /// The solver wants a step below what it, or the clock, can resolve.
    #[error("step too small")]
    StepTooSmall,
    /// The budget of [`crate::Limits`] is spent.
    #[error("too many evaluations")]
    TooManyEvaluations,
    /// Newton's iteration of an implicit step did not converge.
    #[error("no convergence")]
    NoConvergence,
    /// The solver or the right-hand side panicked, with these words.
    #[error("panicked: {0}")]
    Panicked(String),
    /// The solver stopped for a reason that fits none of these, in its own words.
    #[error("stopped: {0}")]
    Stopped(String),
}

impl Failure {
    /// A stable name for tables.
    pub fn name(&self) -> &'static str {
        match self {
            Failure::Diverged => "diverged",
            Failure::NotFinite => "not finite",
            Failure::StepTooSmall => "step too small",
            Failure::TooManyEvaluations => "too many evaluations",
            Failure::NoConvergence => "no convergence",
            Failure::Panicked(_) => "panicked",
            Failure::Stopped(_) => "stopped",
        }
    }
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// At the end of the span.
    Solved,
    /// Before it.
    Failed {
        /// Time of the last good point.
        at: f64,
        /// The reason.
        why: Failure,
    },
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Outcome::Solved => write!(f, "solved"),
            Outcome::Failed { at, why } => write!(f, "{why} at t = {at}"),
        }
    }
}

/// One solver on one problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// All that was computed, up to the failure if there was one.
    pub trajectory: Trajectory,
    /// What it took.
    pub work: Work,
    /// How it ended.
    pub outcome: Outcome,
}
