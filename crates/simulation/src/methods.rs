//! The one list of methods: the solvers, which are given a right-hand side, and our own, which are given
//! the task.

use crate::{Task, adaptive::ADAPTIVE, exact::EXACT};
use integrate::{Limits, Outcome, SOLVERS, Solver, Work};

/// A method of our own that knows what friction it solves: a member of [`EXACT`] or [`ADAPTIVE`].
#[derive(Debug, Clone, Copy)]
pub struct Own {
    /// Its name, as an experiment writes it.
    pub name: &'static str,
    /// Where it holds, in words.
    pub holds: &'static str,
    /// The method made ready for a task; an error in words where it does not hold. It only reads the task:
    /// what takes longer the longer the span is, is done in [`Solves::deliver`], where it is timed.
    pub build: fn(&Task) -> Result<Box<dyn Solves>, NotHere>,
}

/// Why a method does not solve a task.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{method} does not hold here: {found}; expected {expected}")]
pub struct NotHere {
    /// The method.
    pub method: &'static str,
    /// What the task has.
    pub found: String,
    /// What it may have.
    pub expected: &'static str,
}

/// A method ready for a task.
pub trait Solves: Send + Sync + std::fmt::Debug {
    /// Solves the task and writes the states at the times of `grid`, which rise within the span, into
    /// `states`, n for each time. `rtol` is the relative tolerance, which an exact method does not look at;
    /// absolute ones are `rtol` times the natural size of each state. What a failed run did not reach is NaN.
    fn deliver(&self, rtol: f64, limits: &Limits, grid: &[f64], states: &mut [f64]) -> Delivered;
}

/// How a delivery went.
#[derive(Debug, Clone, PartialEq)]
pub struct Delivered {
    /// What it took. For an exact method the evaluations are the updates of its closed form, one for
    /// each time delivered and each event on the way.
    pub work: Work,
    /// How it ended.
    pub outcome: Outcome,
}

/// An entry of the one list.
#[derive(Debug, Clone, Copy)]
pub enum Method {
    /// A solver of a right-hand side.
    Solver(&'static Solver),
    /// An exact method.
    Exact(&'static Own),
    /// An adaptive method of our own.
    Adaptive(&'static Own),
}

impl Method {
    /// Its name, as an experiment writes it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Solver(solver) => solver.name,
            Self::Exact(own) | Self::Adaptive(own) => own.name,
        }
    }

    /// Where it comes from: "own", "ode_solvers" or "diffsol".
    pub fn library(&self) -> &'static str {
        match self {
            Self::Solver(solver) => solver.library,
            Self::Exact(_) | Self::Adaptive(_) => "own",
        }
    }
}

/// All methods: solvers, exact methods, our own adaptive ones.
pub fn methods() -> impl Iterator<Item = Method> {
    let solvers = SOLVERS.iter().map(Method::Solver);
    let exact = EXACT.iter().map(Method::Exact);
    solvers.chain(exact).chain(ADAPTIVE.iter().map(Method::Adaptive))
}

/// The method of this name.
pub fn method(name: &str) -> Option<Method> {
    methods().find(|method| method.name() == name)
}
