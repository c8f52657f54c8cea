//! What is to be solved, and how closely.

use crate::{Failure, Segment};

/// A system of ordinary differential equations, y' = f(t, y), smooth between its breakpoints.
pub trait Dynamics: Sync + Send {
    /// Number of states n.
    fn dimension(&self) -> usize;

    /// Writes f(t, y) into `dy`.
    ///
    /// `piece` says which smooth piece is meant. `Some(k)` is piece k, between breakpoints k - 1
    /// and k, *continued smoothly* beyond its ends: a solver that was restarted at a breakpoint
    /// evaluates at the breakpoint itself, and may look a little past the end of its segment, for
    /// a first guess of the step or by rounding. `None` is whatever holds at t.
    fn derivative(&self, t: f64, y: &[f64], piece: Option<usize>, dy: &mut [f64]);

    /// Writes ∂f_i/∂y_j into `jacobian`, row by row.
    fn jacobian(&self, t: f64, y: &[f64], piece: Option<usize>, jacobian: &mut [f64]);

    /// Natural size of each state, positive: absolute tolerances are `rtol * scale`, and a state
    /// above `1e6 * scale` has diverged.
    fn scale(&self) -> Vec<f64>;
}

/// Right-hand side, time span, initial state and the times where the right-hand side has a corner.
#[derive(Clone)]
pub struct InitialValueProblem<'a> {
    /// The right-hand side.
    pub dynamics: &'a dyn Dynamics,
    /// Initial time.
    pub start: f64,
    /// Final time, after `start`.
    pub end: f64,
    /// Initial state.
    pub y0: Vec<f64>,
    /// Corners in time, strictly inside the span and rising: breakpoint k ends piece k. Two that
    /// are closer than some 1e-12 of the time are too close for the libraries to step between.
    pub breakpoints: Vec<f64>,
}

impl std::fmt::Debug for InitialValueProblem<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("InitialValueProblem")
            .field("start", &self.start)
            .field("end", &self.end)
            .field("y0", &self.y0)
            .field("breakpoints", &self.breakpoints)
            .finish_non_exhaustive()
    }
}

impl InitialValueProblem<'_> {
    /// The ends of the segments to be integrated one after the other, with their pieces.
    pub(crate) fn segments(&self, corners: Corners) -> Vec<(f64, f64, Option<usize>)> {
        match corners {
            Corners::Ignore => vec![(self.start, self.end, None)],
            Corners::Restart => {
                let starts = std::iter::once(self.start).chain(self.breakpoints.iter().copied());
                let ends = self.breakpoints.iter().copied().chain(std::iter::once(self.end));
                starts.zip(ends).enumerate().map(|(k, (a, b))| (a, b, Some(k))).collect()
            }
        }
    }

    /// A problem that cannot be posed is refused in words.
    pub(crate) fn check(&self, scale: &[f64]) -> Result<(), Failure> {
        let n = self.dynamics.dimension();
        let refuse = |words: String| Err(Failure::Stopped(words));
        if n == 0 || self.y0.len() != n || scale.len() != n {
            return refuse(format!(
                "ill-posed: {n} states, but {} initial values and {} scales",
                self.y0.len(),
                scale.len()
            ));
        }
        if !scale.iter().all(|s| s.is_finite() && *s > 0.0) {
            return refuse(format!("ill-posed: scales must be positive, found {scale:?}"));
        }
        let mut times = vec![self.start];
        times.extend(&self.breakpoints);
        times.push(self.end);
        if !times.iter().all(|t| t.is_finite()) || !times.windows(2).all(|w| w[0] < w[1]) {
            return refuse(format!(
                "ill-posed: start, breakpoints and end must rise, found {} … {} with {} between",
                self.start,
                self.end,
                self.breakpoints.len()
            ));
        }
        Ok(())
    }
}

/// How closely a solver is asked to solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// Fixed step h: every segment is cut into the least number of equal steps not longer than h.
    Step(f64),
    /// Adaptive steps: relative tolerance, and with it the absolute ones, `rtol * scale`.
    Tolerance {
        /// Relative tolerance.
        rtol: f64,
    },
}

impl Control {
    /// The equal steps a fixed-step method takes over a segment.
    pub fn grid(&self, segment: &Segment<'_>) -> Result<Grid, Failure> {
        match *self {
            Control::Step(h) if h.is_finite() && h > 0.0 => {
                Ok(Grid::new(segment.start, segment.end, h))
            }
            Control::Step(h) => {
                Err(Failure::Stopped(format!("a step must be positive, found {h}")))
            }
            Control::Tolerance { rtol } => Err(Failure::Stopped(format!(
                "a fixed-step method needs a step, found the tolerance {rtol:e}"
            ))),
        }
    }

    /// The relative tolerance of an adaptive method.
    pub fn rtol(&self) -> Result<f64, Failure> {
        match *self {
            Control::Tolerance { rtol } if rtol.is_finite() && rtol > 0.0 => Ok(rtol),
            Control::Tolerance { rtol } => {
                Err(Failure::Stopped(format!("a tolerance must be positive, found {rtol}")))
            }
            Control::Step(h) => Err(Failure::Stopped(format!(
                "an adaptive method needs a tolerance, found the step {h:e}"
            ))),
        }
    }
}

/// Equal steps that land exactly on both ends of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    start: f64,
    end: f64,
    /// Number of steps.
    pub steps: u64,
    /// Length of each.
    pub h: f64,
}

impl Grid {
    /// Cuts a span into ⌈length/h⌉ equal steps; a quotient that rounding has pushed just above a
    /// whole number counts as that number.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the quotient is positive, and one beyond u64 saturates and meets the budget"
    )]
    fn new(start: f64, end: f64, h: f64) -> Self {
        let quotient = (end - start) / h;
        let steps = ((quotient * (1.0 - 1e-12) - 1e-9).ceil().max(1.0)) as u64;
        Grid { start, end, steps, h: (end - start) / steps as f64 }
    }

    /// Time of grid point k, from 0 to `steps`: no rounding accumulates, and the last is the end.
    pub fn time(&self, k: u64) -> f64 {
        if k == self.steps { self.end } else { self.start + k as f64 * self.h }
    }
}

/// What a solver does at the breakpoints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Corners {
    /// Starts afresh at each, on the smooth piece that follows.
    Restart,
    /// Is not told, and steps over them.
    Ignore,
}

/// Where a solver is stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Most evaluations of right-hand side and Jacobian together. A count and no time, so that the
    /// outcome does not depend on the load of the machine.
    pub evaluations: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { evaluations: 5_000_000 }
    }
}
