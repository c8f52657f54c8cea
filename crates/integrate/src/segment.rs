//! The two things a solver is given: the segment, which it asks, and the recorder, which it tells.

use crate::{Dynamics, Failure, Trajectory};
use std::cell::Cell;
use std::panic::resume_unwind;

/// Why the wrapper unwinds out of a solver; caught by `solve`. Unwinding with `resume_unwind` does
/// not call the panic hook.
#[derive(Debug, Clone, Copy)]
pub(crate) enum GiveUp {
    BudgetSpent,
    NeverFinite,
}

/// Right-hand sides in a row that are not finite before a solver is given up. Halving a step at
/// each attempt gets below what a clock resolves long before; some solvers go on for ever.
const HOPELESS: u32 = 1000;

/// Counts what is asked of the right-hand side, over all segments of a run.
#[derive(Debug)]
pub(crate) struct Counter {
    pub(crate) evaluations: Cell<u64>,
    pub(crate) jacobians: Cell<u64>,
    /// Right-hand sides up to the last that were not finite, in a row.
    not_finite: Cell<u32>,
    limit: u64,
}

impl Counter {
    pub(crate) fn new(limit: u64) -> Self {
        Counter {
            evaluations: Cell::new(0),
            jacobians: Cell::new(0),
            not_finite: Cell::new(0),
            limit,
        }
    }

    fn spend(&self, on: &Cell<u64>) {
        if self.evaluations.get() + self.jacobians.get() >= self.limit {
            resume_unwind(Box::new(GiveUp::BudgetSpent));
        }
        on.set(on.get() + 1);
    }

    fn look(&self, dy: &[f64]) {
        if dy.iter().all(|dy| dy.is_finite()) {
            self.not_finite.set(0);
        } else if self.not_finite.replace(self.not_finite.get() + 1) >= HOPELESS {
            resume_unwind(Box::new(GiveUp::NeverFinite));
        }
    }
}

/// A stretch of the problem that is integrated in one go, from a fresh start.
#[derive(Clone)]
pub struct Segment<'a> {
    pub(crate) dynamics: &'a dyn Dynamics,
    pub(crate) counter: &'a Counter,
    /// The piece of the right-hand side it lies on; none if corners are ignored.
    pub piece: Option<usize>,
    /// First time.
    pub start: f64,
    /// Last time.
    pub end: f64,
    /// State at the start.
    pub y0: Vec<f64>,
    /// Natural size of each state.
    pub scale: &'a [f64],
}

impl std::fmt::Debug for Segment<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Segment")
            .field("piece", &self.piece)
            .field("start", &self.start)
            .field("end", &self.end)
            .field("y0", &self.y0)
            .finish_non_exhaustive()
    }
}

impl Segment<'_> {
    /// Number of states.
    pub fn dimension(&self) -> usize {
        self.y0.len()
    }

    /// f(t, y) on this segment's piece, counted. Does not return when the budget is spent, nor
    /// after a thousand values in a row that are not finite.
    pub fn derivative(&self, t: f64, y: &[f64], dy: &mut [f64]) {
        self.counter.spend(&self.counter.evaluations);
        self.dynamics.derivative(t, y, self.piece, dy);
        self.counter.look(dy);
    }

    /// ∂f/∂y on this segment's piece, row by row, counted. Does not return when the budget is
    /// spent.
    pub fn jacobian(&self, t: f64, y: &[f64], jacobian: &mut [f64]) {
        self.counter.spend(&self.counter.jacobians);
        self.dynamics.jacobian(t, y, self.piece, jacobian);
    }

    /// Evaluations of the right-hand side so far, over all segments of the run.
    pub fn evaluations(&self) -> u64 {
        self.counter.evaluations.get()
    }

    /// Whether the last right-hand side was finite.
    pub fn last_derivative_was_finite(&self) -> bool {
        self.counter.not_finite.get() == 0
    }
}

/// Takes down every accepted step of a run, or the states at the times asked for.
#[derive(Debug)]
pub struct Recorder<'g> {
    /// Every step; of a run that delivers on a grid only the last.
    pub(crate) trajectory: Trajectory,
    pub(crate) accepted: u64,
    pub(crate) rejected: Option<u64>,
    largest: Vec<f64>,
    grid: Option<Delivery<'g>>,
}

/// The times asked for, and the states there as far as they are known.
#[derive(Debug)]
struct Delivery<'g> {
    times: &'g [f64],
    states: &'g mut [f64],
    next: usize,
    /// A time asked for that is after another by no more than this is the same: rounding.
    rounding: f64,
}

impl<'g> Recorder<'g> {
    pub(crate) fn new(t: f64, y: &[f64]) -> Self {
        Recorder {
            trajectory: Trajectory { t: vec![t], y: y.to_vec(), n: y.len() },
            accepted: 0,
            rejected: None,
            largest: Vec::new(),
            grid: None,
        }
    }

    /// The same for a run that delivers its states at `times`, which rise, into `states`.
    pub(crate) fn on(t: f64, y: &[f64], times: &'g [f64], states: &'g mut [f64]) -> Self {
        let mut recorder = Recorder::new(t, y);
        let largest = times.iter().fold(0.0, |largest: f64, t| largest.max(t.abs()));
        let rounding = 4.0 * f64::EPSILON * largest;
        recorder.grid = Some(Delivery { times, states, next: 0, rounding });
        recorder
    }

    /// A state above a million times its natural size has diverged.
    pub(crate) fn diverged_above(&mut self, scale: &[f64]) {
        self.largest = scale.iter().map(|s| 1e6 * s).collect();
    }

    /// The next time asked for, if it is not after `t`.
    pub fn due(&self, t: f64) -> Option<f64> {
        let grid = self.grid.as_ref()?;
        grid.times.get(grid.next).copied().filter(|due| *due <= t + grid.rounding)
    }

    /// The times asked for that are not yet delivered and not after `t`.
    pub fn all_due(&self, t: f64) -> &'g [f64] {
        self.grid.as_ref().map_or(&[], |grid| {
            let left = &grid.times[grid.next..];
            &left[..left.partition_point(|due| *due <= t + grid.rounding)]
        })
    }

    /// Takes down the state at the next time asked for, unless it is no good.
    pub fn deliver(&mut self, y: &[f64]) -> Result<(), Failure> {
        self.judge(y)?;
        if let Some(grid) = &mut self.grid {
            let at = grid.next * y.len();
            grid.states[at..at + y.len()].copy_from_slice(y);
            grid.next += 1;
        }
        Ok(())
    }

    /// Takes down an accepted step, unless it is no good; the solver then has to stop and to hand
    /// on the failure. A run that delivers has delivered what was due before it.
    pub fn accept(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.arrive(t, y)?;
        self.accepted += 1;
        Ok(())
    }

    /// The same without a step, where the library has told of its steps without their states.
    pub(crate) fn arrive(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        if !t.is_finite() {
            return Err(Failure::NotFinite);
        }
        self.judge(y)?;
        if self.grid.is_some() {
            self.trajectory.t[0] = t;
            self.trajectory.y.copy_from_slice(y);
        } else {
            self.trajectory.t.push(t);
            self.trajectory.y.extend_from_slice(y);
        }
        Ok(())
    }

    /// Counts an accepted step whose state the library does not tell.
    pub(crate) fn count(&mut self) {
        self.accepted += 1;
    }

    fn judge(&self, y: &[f64]) -> Result<(), Failure> {
        if !y.iter().all(|y| y.is_finite()) {
            return Err(Failure::NotFinite);
        }
        if y.iter().zip(&self.largest).any(|(y, largest)| y.abs() > *largest) {
            return Err(Failure::Diverged);
        }
        Ok(())
    }

    /// The state at the last accepted step, or at the start.
    pub fn last_state(&self) -> &[f64] {
        self.trajectory.last().map_or(&[], |(_, y)| y)
    }

    /// Takes down how many attempted steps were thrown away since this was last called. An
    /// adaptive method calls it even with 0.
    pub fn reject(&mut self, attempts: u64) {
        self.rejected = Some(self.rejected.unwrap_or(0) + attempts);
    }
}
