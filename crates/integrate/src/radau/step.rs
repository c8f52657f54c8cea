//! One step of the method: the stages by simplified Newton iteration, and the estimate of their error.

use super::{Settings, System, linear::Lu, tableau::Tableau};
use crate::{Failure, Work};
use nalgebra::{Complex, Matrix3};

/// Newton iterations in a step before it is given up.
const ITERATIONS: i32 = 12;

/// The stage increments, first to last; the last is that of the step.
pub(super) type Increments<const N: usize> = [[f64; N]; 3];

/// Where a step starts.
#[derive(Debug, Clone)]
pub(super) struct Base<const N: usize> {
    pub(super) t: f64,
    pub(super) y: [f64; N],
    pub(super) y_dot: [f64; N],
    pub(super) jacobian: [[f64; N]; N],
}

/// A step whose stages are solved.
#[derive(Debug, Clone)]
pub(super) struct Step<const N: usize> {
    pub(super) h: f64,
    pub(super) z: Increments<N>,
    pub(super) iterations: i32,
    real: Lu<f64, N>,
}

/// Why a step has no stages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoStages {
    /// The iteration does not converge or meets numbers that are not finite: a shorter step may.
    Diverges,
    /// The budget is spent.
    Spent,
}

/// The method on a system, counting.
#[derive(Debug)]
pub(super) struct Method<'a, S, const N: usize> {
    pub(super) system: &'a mut S,
    pub(super) tableau: Tableau,
    pub(super) rtol: f64,
    pub(super) atol: [f64; N],
    pub(super) work: Work,
    pub(super) last_was_finite: bool,
    evaluations_left: u64,
}

impl<'a, S: System<N>, const N: usize> Method<'a, S, N> {
    pub(super) fn new(system: &'a mut S, settings: &Settings<N>) -> Self {
        Self {
            system,
            tableau: Tableau::new(),
            rtol: settings.rtol,
            atol: settings.atol,
            work: Work { rejected: Some(0), ..Work::default() },
            last_was_finite: true,
            evaluations_left: settings.limits.evaluations,
        }
    }

    pub(super) fn derivative(&mut self, t: f64, y: &[f64; N]) -> Result<[f64; N], Failure> {
        self.spend()?;
        self.work.evaluations += 1;
        let y_dot = self.system.derivative(t, y);
        self.last_was_finite = y_dot.iter().all(|y_dot| y_dot.is_finite());
        Ok(y_dot)
    }

    pub(super) fn base(&mut self, t: f64, y: [f64; N]) -> Result<Base<N>, Failure> {
        let y_dot = self.derivative(t, &y)?;
        self.spend()?;
        self.work.jacobians += 1;
        let jacobian = self.system.jacobian(t, &y);
        let finite = self.last_was_finite && jacobian.iter().flatten().all(|j| j.is_finite());
        if finite { Ok(Base { t, y, y_dot, jacobian }) } else { Err(Failure::NotFinite) }
    }

    fn spend(&mut self) -> Result<(), Failure> {
        self.evaluations_left =
            self.evaluations_left.checked_sub(1).ok_or(Failure::TooManyEvaluations)?;
        Ok(())
    }

    /// The size of `delta` in units of the tolerances around the state `y`, as a root mean square.
    pub(super) fn norm(&self, y: &[f64; N], delta: &[f64; N]) -> f64 {
        let scaled = |i: usize| delta[i] / (self.atol[i] + self.rtol * y[i].abs());
        let sum: f64 = (0..N).map(|i| scaled(i) * scaled(i)).sum();
        (sum / N as f64).sqrt()
    }

    /// Solves for the stages of a step of length `h` from the guess `z`, until the error left is below
    /// `close` times what a step of this tolerance may have. How fast the iteration converges is seen in
    /// this step only: the rate of the last one says nothing about a step that meets a kink.
    pub(super) fn stages(
        &mut self,
        base: &Base<N>,
        h: f64,
        z: Increments<N>,
        close: f64,
    ) -> Result<Step<N>, NoStages> {
        let real = Lu::shifted(self.tableau.gamma / h, &base.jacobian);
        let pair = Lu::shifted(self.tableau.alpha_beta / h, &base.jacobian);
        let (real, pair) = real.zip(pair).ok_or(NoStages::Diverges)?;
        let enough = close * (10.0 * f64::EPSILON / self.rtol).max(self.rtol.sqrt().min(0.03));
        let mut w = mix(&self.tableau.t_inverse, &z);
        let (mut z, mut before, mut eta) = (z, 0.0, 1.0);
        for k in 1..=ITERATIONS {
            let update = self.update(base, (h, &z, &w), (&real, &pair))?;
            let size =
                (update.iter().map(|u| self.norm(&base.y, u).powi(2)).sum::<f64>() / 3.0).sqrt();
            if !size.is_finite() {
                return Err(NoStages::Diverges);
            }
            if k > 1 {
                let theta = size / before;
                // At round-off the updates stop shrinking, small as they are.
                if theta >= 0.99 && size > 1e3 * f64::EPSILON / self.rtol {
                    return Err(NoStages::Diverges);
                }
                eta = if theta < 0.99 { theta / (1.0 - theta) } else { 0.0 };
            }
            for (w, update) in w.iter_mut().flatten().zip(update.iter().flatten()) {
                *w += update;
            }
            z = mix(&self.tableau.t, &w);
            if eta * size <= enough {
                return Ok(Step { h, z, iterations: k, real });
            }
            before = size;
        }
        Err(NoStages::Diverges)
    }

    /// One Newton update of the decoupled coordinates `w` of the stages `z`.
    fn update(
        &mut self,
        base: &Base<N>,
        (h, z, w): (f64, &Increments<N>, &Increments<N>),
        (real, pair): (&Lu<f64, N>, &Lu<Complex<f64>, N>),
    ) -> Result<Increments<N>, NoStages> {
        let mut f = [[0.0; N]; 3];
        for (stage, f) in f.iter_mut().enumerate() {
            let t = base.t + self.tableau.c[stage] * h;
            *f = self.derivative(t, &plus(&base.y, &z[stage])).map_err(|_| NoStages::Spent)?;
        }
        let g = mix(&self.tableau.t_inverse, &f);
        let (gamma, alpha_beta) = (self.tableau.gamma / h, self.tableau.alpha_beta / h);
        let first = real.solve(std::array::from_fn(|i| g[0][i] - gamma * w[0][i]));
        let others = pair.solve(std::array::from_fn(|i| {
            Complex::new(g[1][i], g[2][i]) - alpha_beta * Complex::new(w[1][i], w[2][i])
        }));
        Ok([first, others.map(|w| w.re), others.map(|w| w.im)])
    }

    /// The estimated error of a step in units of the tolerances. The second, damped estimate that the
    /// book takes after a rejection is not taken: on a slow motion with a fast decay it is too small by
    /// as much as the decay is faster than the step.
    pub(super) fn error(&self, base: &Base<N>, step: &Step<N>) -> f64 {
        let weights = self.tableau.error.map(|e| e / step.h);
        let stages: [f64; N] = std::array::from_fn(|j| {
            weights[0] * step.z[0][j] + weights[1] * step.z[1][j] + weights[2] * step.z[2][j]
        });
        self.norm(&base.y, &step.real.solve(plus(&stages, &base.y_dot)))
    }

    /// A guess of the stages of the next step, of length `h`, on the polynomial through the last ones.
    pub(super) fn extrapolate(&self, last: &Step<N>, h: f64) -> Increments<N> {
        self.tableau.c.map(|c| {
            let there = self.along(last, 1.0 + c * h / last.h);
            std::array::from_fn(|j| there[j] - last.z[2][j])
        })
    }

    /// The polynomial through the start and the stages of a step, at the part `s` of it.
    pub(super) fn along(&self, step: &Step<N>, s: f64) -> [f64; N] {
        let c = self.tableau.c;
        let weight = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            s * (s - c[j]) * (s - c[k]) / (c[i] * (c[i] - c[j]) * (c[i] - c[k]))
        };
        let w = [weight(0), weight(1), weight(2)];
        std::array::from_fn(|j| w[0] * step.z[0][j] + w[1] * step.z[1][j] + w[2] * step.z[2][j])
    }
}

pub(super) fn plus<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// The matrix `m` on the three stages of every state.
fn mix<const N: usize>(m: &Matrix3<f64>, stages: &Increments<N>) -> Increments<N> {
    [0, 1, 2].map(|i| {
        std::array::from_fn(|j| {
            m[(i, 0)] * stages[0][j] + m[(i, 1)] * stages[1][j] + m[(i, 2)] * stages[2][j]
        })
    })
}
