//! A friction model under an input, as an initial-value problem a solver can take.
//!
//! **Invariant**: knows no files and no plots; the models are `duhem`'s, the solvers `integrate`'s, and
//! here they meet for the first time.
//!
//! Read first: [`PrescribedMotion`] (the model under an imposed motion), then `duhem::FrictionModel` and
//! `integrate::InitialValueProblem`, which it joins.

use duhem::{FrictionModel, Input};
use integrate::{Dynamics, InitialValueProblem};

/// A friction model whose relative displacement u(t) is imposed: ẋ = f(x, u) g(u̇), equation 1.
#[derive(Debug)]
pub struct PrescribedMotion {
    model: Box<dyn FrictionModel>,
    input: Input,
    /// Start, corners and end [s]; piece k lies between `bounds[k]` and `bounds[k + 1]`.
    bounds: Vec<f64>,
}

impl PrescribedMotion {
    /// The model under `input` from `start` to `end` [s].
    pub fn new(model: Box<dyn FrictionModel>, input: Input, (start, end): (f64, f64)) -> Self {
        let mut bounds = vec![start];
        bounds.extend(input.corners(start, end));
        bounds.push(end);
        Self { model, input, bounds }
    }

    /// The problem with its breakpoints, from the internal state `x0`.
    pub fn problem(&self, x0: Vec<f64>) -> InitialValueProblem<'_> {
        let last = self.bounds.len() - 1;
        InitialValueProblem {
            dynamics: self,
            start: self.bounds[0],
            end: self.bounds[last],
            y0: x0,
            breakpoints: self.bounds[1..last].to_vec(),
        }
    }

    /// The corners of the input inside the span [s].
    pub fn corners(&self) -> &[f64] {
        &self.bounds[1..self.bounds.len() - 1]
    }

    /// The friction force [N] in state `x` at time `t` [s]; at a corner, just after it.
    pub fn force(&self, t: f64, x: &[f64]) -> f64 {
        let (u, u_dot) = (self.input.u(t), self.input.u_dot(t));
        let mut x_dot = vec![0.0; x.len()];
        self.model.x_dot(x, u, u_dot, &mut x_dot);
        self.model.force(x, &x_dot, u, u_dot)
    }

    fn u_dot(&self, t: f64, piece: Option<usize>) -> f64 {
        match piece {
            Some(k) => self.input.u_dot_on(self.bounds[k], self.bounds[k + 1], t),
            None => self.input.u_dot(t),
        }
    }
}

impl Dynamics for PrescribedMotion {
    fn dimension(&self) -> usize {
        self.model.states()
    }

    fn derivative(&self, t: f64, y: &[f64], piece: Option<usize>, dy: &mut [f64]) {
        self.model.x_dot(y, self.input.u(t), self.u_dot(t, piece), dy);
    }

    fn jacobian(&self, t: f64, y: &[f64], piece: Option<usize>, jacobian: &mut [f64]) {
        self.model.jacobian(y, self.input.u(t), self.u_dot(t, piece), jacobian);
    }

    fn scale(&self) -> Vec<f64> {
        self.model.scale()
    }
}
