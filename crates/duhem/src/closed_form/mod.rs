//! Exact answers, so that error is measured against truth and not against a tight run of the same code.

pub mod dahl;
pub mod lugre;
pub mod masing;
pub mod maxwell_slip;
pub mod second_way;
pub mod semilinear;

use crate::{Input, ParameterError, Parameters};

/// The closed form a run is judged by.
pub trait Reference: std::fmt::Debug + Send + Sync {
    /// Writes the exact internal state at time `t` [s]; for Dahl the state is F [N].
    fn state(&self, t: f64, x: &mut [f64]);

    /// A bound on the rounding in [`Self::state`], in units of the state.
    fn error_bound(&self) -> f64;

    /// Times [s] at which the state has a kink that is not a corner of the input, in order: where a
    /// force arrives at its limit. None if the model has no such point.
    fn kinks(&self) -> Vec<f64> {
        Vec::new()
    }
}

/// One closed form of the list.
#[derive(Debug, Clone, Copy)]
pub struct ReferenceEntry {
    /// Its name in the experiments: the model's.
    pub name: &'static str,
    /// The answer for these parameters and this input from the state x0, over the span [s].
    pub build:
        fn(&Parameters, &Input, &[f64], (f64, f64)) -> Result<Box<dyn Reference>, ReferenceError>,
}

/// Why there is no exact answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReferenceError {
    /// The parameters do not make the model.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// The initial state does not have the model's number of states, or is not finite.
    #[error("x0 = {found:?}: expected {expected} finite numbers, one for each state")]
    InitialState {
        /// The state found.
        found: Vec<f64>,
        /// The model's number of states.
        expected: usize,
    },
    /// A settled state is asked of an input that does not repeat itself.
    #[error("the input has no period: expected a periodic one")]
    NoPeriod,
    /// The quadrature would take too long.
    #[error("{needed:e} panels of quadrature: expected at most {most:e}, take a shorter span")]
    TooLong {
        /// How many it needs.
        needed: f64,
        /// How many it may have.
        most: f64,
    },
    /// One of the ways to the answer does not get to the end.
    #[error("{way} stops at t = {at} s: {why}")]
    Unanswered {
        /// Which way.
        way: String,
        /// How far it gets [s].
        at: f64,
        /// What stops it.
        why: String,
    },
    /// The time span is empty or not finite.
    #[error("span = [{start}, {end}] s: expected a finite start before a finite end")]
    Span {
        /// Its start [s].
        start: f64,
        /// Its end [s].
        end: f64,
    },
}

/// The closed forms.
pub const REFERENCES: &[ReferenceEntry] = &[
    ReferenceEntry { name: "dahl", build: dahl::Trajectory::build },
    ReferenceEntry { name: "lugre", build: lugre::Trajectory::build },
    ReferenceEntry { name: "maxwell-slip", build: maxwell_slip::Trajectory::build },
];

/// Refuses an initial state or a span no answer can start from.
pub fn check(x0: &[f64], states: usize, (start, end): (f64, f64)) -> Result<(), ReferenceError> {
    if x0.len() != states || x0.iter().any(|x| !x.is_finite()) {
        return Err(ReferenceError::InitialState { found: x0.to_vec(), expected: states });
    }
    if start.is_finite() && end.is_finite() && start < end {
        Ok(())
    } else {
        Err(ReferenceError::Span { start, end })
    }
}

/// The monotone arcs of an input over a span, and the displacement at their starts.
#[derive(Debug, Clone)]
pub(crate) struct Arcs {
    input: Input,
    /// Start of each arc and end of the last [s].
    times: Vec<f64>,
    /// Displacement there [m].
    u: Vec<f64>,
}

impl Arcs {
    pub(crate) fn new(input: &Input, (start, end): (f64, f64)) -> Self {
        let mut times = vec![start];
        times.extend(input.corners(start, end));
        times.push(end);
        let u = times.iter().map(|t| input.u(*t)).collect();
        Self { input: input.clone(), times, u }
    }

    pub(crate) fn len(&self) -> usize {
        self.times.len() - 1
    }

    /// Displacement over the whole of arc `k` [m].
    pub(crate) fn travel(&self, k: usize) -> f64 {
        self.u[k + 1] - self.u[k]
    }

    /// The arc that holds at `t` and the displacement on it so far [m], never against its direction.
    pub(crate) fn locate(&self, t: f64) -> (usize, f64) {
        let inner = &self.times[1..self.len()];
        let k = inner.partition_point(|corner| *corner <= t);
        let (so_far, whole) = (self.input.u(t) - self.u[k], self.travel(k));
        (k, if so_far * whole < 0.0 { 0.0 } else { so_far })
    }

    /// The time [s] at which the displacement on arc `k` reaches `so_far` [m], to the last digit.
    pub(crate) fn time_at(&self, k: usize, so_far: f64) -> f64 {
        let (mut low, mut high) = (self.times[k], self.times[k + 1]);
        loop {
            let middle = low + 0.5 * (high - low);
            if middle <= low || middle >= high {
                return middle;
            }
            if (self.input.u(middle) - self.u[k]).abs() < so_far.abs() {
                low = middle;
            } else {
                high = middle;
            }
        }
    }

    /// Displacement at the start of arc `k` [m].
    pub(crate) fn u(&self, k: usize) -> f64 {
        self.u[k]
    }

    /// Displacement at time `t` [m].
    pub(crate) fn u_at(&self, t: f64) -> f64 {
        self.input.u(t)
    }

    /// Start and end of arc `k` [s].
    pub(crate) fn ends(&self, k: usize) -> (f64, f64) {
        (self.times[k], self.times[k + 1])
    }

    /// Velocity at time `t` [s] on arc `k` [m/s].
    pub(crate) fn velocity(&self, k: usize, t: f64) -> f64 {
        self.input.u_dot_on(self.times[k], self.times[k + 1], t)
    }

    /// The constant velocity of arc `k` [m/s], if it is constant.
    pub(crate) fn constant_velocity(&self, k: usize) -> Option<f64> {
        let (from, to) = self.ends(k);
        let at = |part: f64| self.velocity(k, from + part * (to - from));
        let (start, middle, end) = (at(0.0), at(0.5), at(1.0));
        (start == middle && middle == end).then_some(middle)
    }

    /// A bound on the rounding of u(t) over the span [m]: of u itself, of its phase, and of the joints
    /// of a sequence.
    pub(crate) fn rounding(&self) -> f64 {
        let size = self.u.iter().fold(0.0_f64, |size, u| size.max(u.abs()));
        let end = self.times[self.len()].abs().max(self.times[0].abs());
        let phase = self.input.period().map_or(0.0, |period| std::f64::consts::TAU * end / period);
        let inner = &self.times[1..self.len()];
        let joint = |t: &f64| (self.input.u(*t) - self.input.u(t.next_down())).abs();
        let joints = inner.iter().map(joint).fold(0.0, f64::max);
        joints + 2.0 * f64::EPSILON * size * (1.0 + phase)
    }
}
