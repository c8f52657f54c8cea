//! Initial-value problems, the solvers that are compared on them, and the work they do.
//!
//! One function, [`solve`], takes an [`InitialValueProblem`], an entry of [`SOLVERS`] and a
//! [`Control`], and hands back a [`Run`]: every accepted step, the work counted by one wrapper for
//! all libraries alike, and the outcome. A solver that diverges, gives up, panics or asks without
//! end is a result and never an error of the program; what it computed before is kept. [`deliver`] does the
//! same for states at given times, by the dense output of each library.
//!
//! **Invariant.** This crate knows no friction, no files and no plots, has no clock, and no type of
//! a solver library leaves its file in `libraries/`.
//!
//! Read first: [`Dynamics`], the right-hand side and what a *piece* of it is; [`Solver`], one entry
//! of the list; [`Run`], what comes back.

pub mod collocation;
mod ensemble;
mod faulty;
mod libraries;
mod newton;
mod problem;
mod radau;
mod run;
mod segment;
mod solve;
mod solvers;

pub use ensemble::ensemble;
pub use faulty::FAULTY;
pub use problem::{Control, Corners, Dynamics, Grid, InitialValueProblem, Limits};
pub use radau::{Integration, Node, Settings, System, radau};
pub use run::{Failure, Outcome, Run, Trajectory, Work};
pub use segment::{Recorder, Segment};
pub use solve::{Sampling, deliver, solve, solving};
pub use solvers::{Order, SETS, SOLVERS, Solver, set, solver};

/// The solver libraries with the exact versions they are pinned to.
pub fn versions() -> Vec<(&'static str, &'static str)> {
    vec![("diffsol", "0.18.0"), ("ode_solvers", "0.6.2")]
}
