//! What is told of one method on one problem.

use serde::{Deserialize, Serialize};

/// The relative tolerances that are compared: 1e-3 to 1e-12.
pub const RTOLS: [f64; 10] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];

/// The status of a run that says it got to the end; any other is the name of its failure.
pub const SOLVED: &str = "solved";

/// A row of the benchmark.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The problem: P1 to P6.
    pub problem: String,
    /// Its parameter: γ of P1, ω [rad/s] of P2.
    pub parameter: Option<f64>,
    /// The method's name in the list.
    pub solver: String,
    /// Whether the method is ours and knows what friction it solves.
    pub ours: bool,
    /// What it was asked for; none for an exact method, which is asked for nothing.
    pub control: Option<RowControl>,
    /// Whether it was started afresh at the reversals of the input, which are known beforehand; of a plant
    /// nothing is.
    pub restart: bool,
    /// max abs(delivered − reference)/max abs(reference) on the grid; none if it did not get to the end.
    pub error: Option<f64>,
    /// Thread CPU time of a delivery [s], the median of the repeats; none if the answer is wrong.
    pub cpu_s: Option<f64>,
    /// Evaluations of the right-hand side; of an exact method the updates of its closed form.
    pub evaluations: u64,
    /// "solved", or why it failed.
    pub status: String,
    /// Evaluations of the Jacobian.
    pub jacobians: u64,
    /// Accepted steps.
    pub accepted: u64,
    /// Rejected steps, of a method that knows any.
    pub rejected: Option<u64>,
    /// Thread CPU time of each repeat [s].
    pub repeats_s: Vec<f64>,
}

/// What a method was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RowControl {
    /// The relative tolerance.
    pub rtol: f64,
}

/// The largest error an answer may have and be timed.
const WRONG: f64 = 0.1;

impl Row {
    /// Whether the run got to the end with an answer that is worth a time.
    pub fn right(&self) -> bool {
        self.status == SOLVED && self.error.is_some_and(|error| error <= WRONG)
    }

    /// Whether the run said it was solved while the answer is off by a thousand times what was asked, and by
    /// more than 1e-3.
    pub fn silent_failure(&self) -> bool {
        let allowed = self.control.map_or(0.0, |control| 1000.0 * control.rtol);
        let wrong = |error: f64| error.is_nan() || error > allowed.max(1e-3);
        self.status == SOLVED && self.error.is_none_or(wrong)
    }

    /// What sets the row apart from all others of a run.
    pub fn key(&self) -> String {
        let parameter = self.parameter.map_or(String::new(), |value| format!(" {value}"));
        let control = self.control.map_or("exact".to_owned(), |c| format!("{:e}", c.rtol));
        let restart = if self.restart { " restart" } else { "" };
        format!("{}{parameter} {} {control}{restart}", self.problem, self.solver)
    }
}
