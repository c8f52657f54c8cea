//! The nonlinear equation of an implicit stage.

use crate::{Failure, Segment};
use nalgebra::{DMatrix, DVector};

/// Most iterations for one stage.
const ITERATIONS: usize = 50;
/// An update below this, relative to state and scale, is the last.
const ROUND_OFF: f64 = 1e-15;
/// An update below this that no longer shrinks has stagnated at round-off and is the last too.
const NEARLY: f64 = 1e-10;

/// Newton's method for `y = base + γ f(t, y)`, with a fresh analytic Jacobian in each iteration
/// and iterated to round-off: the fixed-step methods are there to show their order, and an error
/// left by the iteration would hide it.
#[derive(Debug)]
pub(crate) struct Newton {
    jacobian: Vec<f64>,
    f: Vec<f64>,
    residual: Vec<f64>,
}

impl Newton {
    pub(crate) fn new(n: usize) -> Self {
        Newton { jacobian: vec![0.0; n * n], f: vec![0.0; n], residual: vec![0.0; n] }
    }

    /// Solves for y, from the guess it holds. `gamma` has the dimension of time.
    pub(crate) fn solve(
        &mut self,
        segment: &Segment<'_>,
        (t, gamma): (f64, f64),
        base: &[f64],
        y: &mut [f64],
    ) -> Result<(), Failure> {
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            segment.derivative(t, y, &mut self.f);
            for i in 0..y.len() {
                self.residual[i] = base[i] + gamma * self.f[i] - y[i];
            }
            segment.jacobian(t, y, &mut self.jacobian);
            let update = self.update(gamma).ok_or(Failure::NoConvergence)?;
            let mut size = 0.0_f64;
            for i in 0..y.len() {
                y[i] += update[i];
                size = size.max(update[i].abs() / (y[i].abs() + segment.scale[i]));
            }
            if !y.iter().all(|y| y.is_finite()) {
                return Err(Failure::NotFinite);
            }
            if size <= ROUND_OFF || (size <= NEARLY && size >= 0.5 * before) {
                return Ok(());
            }
            before = size;
        }
        Err(Failure::NoConvergence)
    }

    /// δ from (1 − γ ∂f/∂y) δ = residual; none if the matrix is singular.
    fn update(&self, gamma: f64) -> Option<DVector<f64>> {
        let n = self.residual.len();
        if n == 1 {
            let slope = 1.0 - gamma * self.jacobian[0];
            return (slope != 0.0).then(|| DVector::from_element(1, self.residual[0] / slope));
        }
        let matrix =
            DMatrix::identity(n, n) - gamma * DMatrix::from_row_slice(n, n, &self.jacobian);
        matrix.lu().solve(&DVector::from_column_slice(&self.residual))
    }
}
