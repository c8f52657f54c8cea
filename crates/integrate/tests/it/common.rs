//! Problems the tests share.

use integrate::{Control, Corners, Dynamics, InitialValueProblem, Limits, Order, Run, Solver};

/// y' = f(t, y) for one state, with its Jacobian and pieces, from closures.
pub(crate) struct Scalar<F, G> {
    pub(crate) f: F,
    pub(crate) slope: G,
}

impl<F, G> Dynamics for Scalar<F, G>
where
    F: Fn(f64, f64, Option<usize>) -> f64 + Sync + Send,
    G: Fn(f64, f64, Option<usize>) -> f64 + Sync + Send,
{
    fn dimension(&self) -> usize {
        1
    }
    fn derivative(&self, t: f64, y: &[f64], piece: Option<usize>, dy: &mut [f64]) {
        dy[0] = (self.f)(t, y[0], piece);
    }
    fn jacobian(&self, t: f64, y: &[f64], piece: Option<usize>, jacobian: &mut [f64]) {
        jacobian[0] = (self.slope)(t, y[0], piece);
    }
    fn scale(&self) -> Vec<f64> {
        vec![1.0]
    }
}

/// A forced, nonlinear problem in two states of different size, with v = y₂/s:
/// y₁' = v − (y₁² + y₁ − cos²t − cos t), v' = −y₁ − cos t sin t (v + sin t);
/// solved by y₁ = cos t, v = −sin t.
pub(crate) struct Forced {
    pub(crate) s: f64,
}

impl Forced {
    pub(crate) fn exact(&self, t: f64) -> [f64; 2] {
        [t.cos(), -self.s * t.sin()]
    }
}

impl Dynamics for Forced {
    fn dimension(&self) -> usize {
        2
    }
    fn derivative(&self, t: f64, y: &[f64], _: Option<usize>, dy: &mut [f64]) {
        let (c, s) = (t.cos(), t.sin());
        let v = y[1] / self.s;
        dy[0] = v - (y[0] * y[0] + y[0] - c * c - c);
        dy[1] = self.s * (-y[0] - c * s * (v + s));
    }
    fn jacobian(&self, t: f64, y: &[f64], _: Option<usize>, jacobian: &mut [f64]) {
        jacobian[0] = -2.0 * y[0] - 1.0;
        jacobian[1] = 1.0 / self.s;
        jacobian[2] = -self.s;
        jacobian[3] = -t.cos() * t.sin();
    }
    fn scale(&self) -> Vec<f64> {
        vec![1.0, self.s]
    }
}

pub(crate) fn run(
    solver: &Solver,
    problem: &InitialValueProblem<'_>,
    control: f64,
    corners: Corners,
) -> Run {
    let control = match solver.order {
        Order::Fixed(_) => Control::Step(control),
        Order::Adaptive(_) | Order::Variable => Control::Tolerance { rtol: control },
    };
    integrate::solve(solver, problem, &control, corners, &Limits::default())
}

/// Least-squares slope of log y over log x.
pub(crate) fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (num, den) = logs
        .iter()
        .fold((0.0, 0.0), |(a, b), (x, y)| (a + (x - mx) * (y - my), b + (x - mx) * (x - mx)));
    num / den
}
