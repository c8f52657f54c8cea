//! A friction model whose displacement is imposed.

use crate::{Motion, motion::Pieces};
use duhem::{FrictionModel, Input};
use integrate::{Dynamics, InitialValueProblem};

/// A friction model whose relative displacement u(t) is imposed: ẋ = f(x, u) g(u̇), equation 1.
#[derive(Debug)]
pub struct PrescribedMotion {
    model: Box<dyn FrictionModel>,
    input: Input,
    pieces: Pieces,
}

impl PrescribedMotion {
    /// The model under `input` from `start` to `end` [s].
    pub fn new(model: Box<dyn FrictionModel>, input: Input, (start, end): (f64, f64)) -> Self {
        let corners = input.corners(start, end);
        Self { model, input, pieces: Pieces::new((start, end), corners) }
    }

    fn u_dot(&self, t: f64, piece: Option<usize>) -> f64 {
        let times = &self.pieces.times;
        match piece {
            Some(k) => self.input.u_dot_on(times[k], times[k + 1], t),
            None => self.input.u_dot(t),
        }
    }
}

impl Motion for PrescribedMotion {
    fn problem(&self, y0: Vec<f64>) -> InitialValueProblem<'_> {
        self.pieces.problem(self, y0)
    }

    fn corners(&self) -> &[f64] {
        self.pieces.corners()
    }

    fn force(&self, t: f64, y: &[f64]) -> f64 {
        let (u, u_dot) = (self.input.u(t), self.input.u_dot(t));
        let mut x_dot = vec![0.0; y.len()];
        self.model.x_dot(y, u, u_dot, &mut x_dot);
        self.model.force(y, &x_dot, u, u_dot)
    }

    fn response(&self, t: f64, y: &[f64]) -> f64 {
        self.force(t, y)
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
