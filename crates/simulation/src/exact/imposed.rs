//! A motion that is imposed, followed piece by piece along the grid.

use crate::{Delivered, NotHere, Own, Task};
use duhem::{Input, ParameterError, Parameters, sgn};
use integrate::{Failure, Limits, Outcome, Work};
use std::ops::Range;

/// What is imposed, on what, and from where.
#[derive(Debug, Clone)]
pub(super) struct Imposed<M> {
    /// The friction.
    pub model: M,
    /// The displacement.
    pub input: Input,
    /// First and last time [s].
    pub span: (f64, f64),
    /// The state at the start.
    pub x0: Vec<f64>,
}

/// The time between two corners, and the points of the grid in it; one at a corner begins the next.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// Its start [s].
    pub start: f64,
    /// Its end [s].
    pub end: f64,
    /// Which points of the grid.
    pub points: Range<usize>,
}

/// Refuses a task for what is `found` in it.
pub(super) fn refuse(own: &Own, found: impl Into<String>) -> NotHere {
    NotHere { method: own.name, found: found.into(), expected: own.holds }
}

/// The model of the task, if it is the one of this `name`.
pub(super) fn model<M>(
    own: &Own,
    task: &Task,
    name: &str,
    new: fn(&Parameters) -> Result<M, ParameterError>,
) -> Result<M, NotHere> {
    if task.model.name != name {
        return Err(refuse(own, format!("the model {}", task.model.name)));
    }
    new(&task.parameters).map_err(|error| refuse(own, error.to_string()))
}

/// Refuses an initial state that is not of `n` finite numbers, or an empty span.
pub(super) fn check_start(own: &Own, task: &Task, n: usize) -> Result<(), NotHere> {
    if task.y0.len() != n || !task.y0.iter().all(|y| y.is_finite()) {
        return Err(refuse(own, format!("y0 = {:?} for {n} states", task.y0)));
    }
    crate::error::check_span(task.span).map_err(|error| refuse(own, error.to_string()))
}

/// The outcome of what would take more updates than the limit: nothing is delivered.
pub(super) fn too_many(start: f64, states: &mut [f64]) -> Delivered {
    states.fill(f64::NAN);
    let outcome = Outcome::Failed { at: start, why: Failure::TooManyEvaluations };
    Delivered { work: Work::default(), outcome }
}

/// The outcome of a delivery of so many updates.
pub(super) fn solved(updates: u64) -> Delivered {
    let work = Work { evaluations: updates, ..Work::default() };
    Delivered { work, outcome: Outcome::Solved }
}

impl<M> Imposed<M> {
    /// The imposed motion of a task from a state of `n` numbers; an error in words if it is none.
    pub(super) fn new(own: &Own, task: &Task, model: M, n: usize) -> Result<Self, NotHere> {
        if task.plant.is_some() {
            return Err(refuse(own, "a plant"));
        }
        check_start(own, task, n)?;
        Ok(Self { model, input: task.input.clone(), span: task.span, x0: task.y0.clone() })
    }

    /// Start, corners and end [s].
    pub(super) fn times(&self) -> Vec<f64> {
        let (start, end) = self.span;
        let mut times = self.input.corners(start, end);
        times.insert(0, start);
        times.push(end);
        times
    }

    /// Follows the pieces between the `times`: `follow` is given each with the displacements at its start
    /// and end and its direction.
    pub(super) fn follow(
        &self,
        (limits, grid): (&Limits, &[f64]),
        states: &mut [f64],
        mut follow: impl FnMut(&Piece, Travel, &mut [f64]),
    ) -> Delivered {
        let times = self.times();
        let updates = (grid.len() + times.len() - 2) as u64;
        if updates > limits.evaluations {
            return too_many(self.span.0, states);
        }
        let mut u = times.clone();
        self.input.displace(&mut u);
        for (piece, u) in pieces(&times, grid).zip(u.windows(2)) {
            follow(&piece, Travel { from: u[0], to: u[1], s: sgn(u[1] - u[0]) }, states);
        }
        solved(updates)
    }
}

/// The displacement over a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Travel {
    /// At its start [m].
    pub from: f64,
    /// At its end [m].
    pub to: f64,
    /// Its direction, 0 at rest.
    pub s: f64,
}

/// The pieces between the `times`, with the points of the `grid` in each.
pub(super) fn pieces(times: &[f64], grid: &[f64]) -> impl Iterator<Item = Piece> {
    let (last, mut first) = (times.len() - 2, 0);
    times.windows(2).enumerate().map(move |(k, ends)| {
        let later = if k == last {
            grid.len()
        } else {
            first + grid[first..].partition_point(|t| *t < ends[1])
        };
        let points = first..later;
        first = later;
        Piece { start: ends[0], end: ends[1], points }
    })
}
