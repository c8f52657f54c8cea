//! Our own stiff method: Radau IIA of order 5 on arrays, with events that end a step to the last digit.
//!
//! It is for the few states of a plant with friction: stiff while the contact sticks, kinked where the
//! velocity changes sign. A solver that steps over the kink loses its order there; this one is told by
//! an event function where the kink is, ends a step on it and goes on from there.

mod event;
mod linear;
mod march;
mod step;
mod tableau;

pub use march::radau;

use crate::{Limits, Outcome, Work};

/// A system y' = f(t, y) of N equations with its Jacobian and one event function.
pub trait System<const N: usize> {
    /// f(t, y).
    fn derivative(&mut self, t: f64, y: &[f64; N]) -> [f64; N];

    /// ∂fᵢ/∂yⱼ in row i and column j.
    fn jacobian(&mut self, t: f64, y: &[f64; N]) -> [[f64; N]; N];

    /// g(t, y): where it changes sign f has a kink, and a step must end. Without events it is 1.
    fn event(&self, _t: f64, _y: &[f64; N]) -> f64 {
        1.0
    }

    /// Puts a state that is on an event but for rounding exactly there.
    fn land(&self, _y: &mut [f64; N]) {}
}

/// How closely to solve. The error of a step is estimated to third order and the step is of fifth, so
/// the error achieved is well below the tolerance, and the more so the tighter it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings<const N: usize> {
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance of each state, in its unit.
    pub atol: [f64; N],
    /// An event function below this on both sides of a change of sign is no event: a velocity that
    /// rings down to rest would otherwise turn for ever.
    pub dead_band: f64,
    /// Where to stop.
    pub limits: Limits,
}

/// A point of the solution: the start, the end of a step, or an event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node<const N: usize> {
    /// Time.
    pub t: f64,
    /// State.
    pub y: [f64; N],
    /// Its derivative.
    pub y_dot: [f64; N],
    /// Whether it lies on an event.
    pub event: bool,
}

/// What a run of [`radau`] took and how it ended; its nodes went to the observer.
#[derive(Debug, Clone, PartialEq)]
pub struct Integration {
    /// What it took.
    pub work: Work,
    /// Events it ended a step on.
    pub events: u64,
    /// How it ended.
    pub outcome: Outcome,
}
