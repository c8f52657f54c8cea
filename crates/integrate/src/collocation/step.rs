//! One step: the stages by simplified Newton iteration, and the estimate of their error.

#![expect(clippy::inline_always, reason = "called for every stage: a call costs more than it does")]
#![expect(clippy::needless_range_loop, reason = "stages and blocks count alike in several arrays")]

use super::{
    Kinked,
    lanes::{Complex, fma},
    newton::Newton,
    tableau::Tableau,
};

/// Newton iterations before a step is given up.
const ITERATIONS: i32 = 12;

/// The increments of the stages, a row for each state.
pub(super) type Increments<const N: usize, const W: usize> = [[f64; W]; N];

/// Newton's matrix of a step with its shift.
#[derive(Debug, Clone)]
pub(super) struct Blocks<M, const B: usize> {
    /// λ/h.
    shift: Complex<B>,
    matrix: M,
}

impl<M, const B: usize> Blocks<M, B> {
    #[inline(always)]
    pub(super) fn new<const N: usize, const W: usize>(
        tableau: &Tableau<W, B>,
        h: f64,
        jacobian: &[[f64; N]; N],
    ) -> Self
    where
        M: Newton<N, B>,
    {
        let (re, im) = tableau.lambda;
        let shift = Complex { re, im }.scaled(1.0 / h);
        Self { shift, matrix: M::new(&shift, jacobian) }
    }

    /// The estimated error of a step of length `h` from a state of derivative `y_dot`, in units of the
    /// tolerances, whose inverses are `weights`: the larger of that at its end and that of its polynomial
    /// between the stages. The latter is what is seen of a slow motion along a fast decay, which the
    /// former, as it is damped, hardly feels however long the step.
    #[inline(always)]
    pub(super) fn error<const N: usize, const S: usize, const W: usize>(
        &self,
        tableau: &Tableau<W, B>,
        (h, y_dot, weights): (f64, &[f64; N], &[f64; N]),
        solved: &Solved<N, W>,
    ) -> f64
    where
        M: Newton<N, B>,
    {
        let mut right = [Complex::ZERO; N];
        let mut defect = [Complex::ZERO; N];
        let per = 1.0 / h;
        for i in 0..N {
            let z = &solved.z[i];
            let sum = (0..S).fold(0.0, |sum, s| fma(tableau.error[s], z[s], sum));
            right[i].re[0] = fma(sum, per, y_dot[i]);
            let slope = (0..S).fold(0.0, |sum, s| fma(tableau.slope[s], z[s], sum));
            defect[i].re[0] = fma(slope, per, -solved.between[i]);
        }
        let size = |x: &[Complex<B>; N]| {
            (0..N).map(|i| (x[i].re[0] * weights[i]).powi(2)).sum::<f64>() / N as f64
        };
        let (end, between) = (self.matrix.solve(&right), self.matrix.solve(&defect));
        let (end, between) = (size(&end), size(&between));
        // Not by max, which drops what is not a number.
        if between > end { between.sqrt() } else { end.sqrt() }
    }
}

/// What the stages of a step are solved for.
#[derive(Debug)]
pub(super) struct Equations<'a, M, const N: usize, const W: usize, const B: usize> {
    pub(super) tableau: &'a Tableau<W, B>,
    pub(super) y: &'a [f64; N],
    /// The forcing at the stages.
    pub(super) u: [f64; W],
    pub(super) blocks: &'a Blocks<M, B>,
    /// One over the tolerance of each state.
    pub(super) weights: &'a [f64; N],
    /// The share of the tolerances that the iteration may leave.
    pub(super) enough: f64,
}

/// The stages of a step as the iteration left them.
#[derive(Debug, Clone)]
pub(super) struct Solved<const N: usize, const W: usize> {
    pub(super) z: Increments<N, W>,
    /// f at the look between the stages.
    pub(super) between: [f64; N],
    pub(super) iterations: i32,
    /// The worst factor by which an update shrank less than the one before; 0 if there was but one.
    pub(super) theta: f64,
    pub(super) converged: bool,
}

impl<M: Newton<N, B>, const N: usize, const W: usize, const B: usize> Equations<'_, M, N, W, B> {
    /// Solves for the stages from the guess `z`.
    #[inline(always)]
    pub(super) fn solve<T: Kinked<N>, const S: usize>(
        &self,
        system: &T,
        z: Increments<N, W>,
    ) -> Solved<N, W> {
        let mut w = self.decoupled::<S>(&z);
        let between = [0.0; N];
        let mut solved = Solved { z, between, iterations: 0, theta: 0.0, converged: false };
        let mut before = f64::INFINITY;
        while solved.iterations < ITERATIONS {
            solved.iterations += 1;
            let size = self.update::<T, S>(system, &mut solved, &mut w);
            if !size.is_finite() {
                break;
            }
            let mut left = size;
            if solved.iterations > 1 {
                let theta = size / before;
                // At round-off the updates stop shrinking, small as they are.
                let rounding = size <= 1e-9;
                if !rounding {
                    solved.theta = solved.theta.max(theta);
                }
                if theta >= 0.99 {
                    if !rounding {
                        break;
                    }
                    left = 0.0;
                } else {
                    left = size * theta / (1.0 - theta);
                    if left * theta.powi(ITERATIONS - solved.iterations) > self.enough {
                        break;
                    }
                }
            }
            if left <= self.enough {
                solved.converged = true;
                break;
            }
            before = size;
        }
        solved
    }

    /// One update of the increments `z` and of the same in the blocks' coordinates, `w`; its size in units of
    /// the tolerances.
    #[inline(always)]
    fn update<T: Kinked<N>, const S: usize>(
        &self,
        system: &T,
        solved: &mut Solved<N, W>,
        w: &mut [Complex<B>; N],
    ) -> f64 {
        let z = &mut solved.z;
        let mut stages = *z;
        for (row, y) in stages.iter_mut().zip(self.y) {
            for stage in row {
                *stage += y;
            }
        }
        let f = system.derivatives(&self.u, &stages);
        for (between, f) in solved.between.iter_mut().zip(&f) {
            *between = f[S];
        }
        let mut residual = self.decoupled::<S>(&f);
        for (residual, w) in residual.iter_mut().zip(w.iter()) {
            *residual = residual.less(&self.blocks.shift, w);
        }
        let update = self.blocks.matrix.solve(&residual);
        let mut squares = [0.0; W];
        for i in 0..N {
            let mut change = [0.0; W];
            for b in 0..S.div_ceil(2) {
                let (re, im) = (&self.tableau.back[b].0, &self.tableau.back[b].1);
                let (by_re, by_im) = (update[i].re[b], update[i].im[b]);
                for s in 0..W {
                    change[s] = fma(re[s], by_re, fma(im[s], by_im, change[s]));
                }
            }
            for b in 0..B {
                w[i].re[b] += update[i].re[b];
                w[i].im[b] += update[i].im[b];
            }
            for s in 0..W {
                z[i][s] += change[s];
                let scaled = change[s] * self.weights[i];
                squares[s] = fma(scaled, scaled, squares[s]);
            }
        }
        let mut halves = [0.0; 2];
        for s in 0..W {
            halves[s % 2] += squares[s];
        }
        let sum = halves[0] + halves[1];
        (sum / (N * S) as f64).sqrt()
    }

    #[inline(always)]
    fn decoupled<const S: usize>(&self, rows: &Increments<N, W>) -> [Complex<B>; N] {
        let mut result = [Complex::ZERO; N];
        for (result, row) in result.iter_mut().zip(rows) {
            for s in 0..S {
                let (re, im) = (&self.tableau.into[s].0, &self.tableau.into[s].1);
                for b in 0..B {
                    result.re[b] = fma(re[b], row[s], result.re[b]);
                    result.im[b] = fma(im[b], row[s], result.im[b]);
                }
            }
        }
        result
    }
}

/// The coefficients of θ, θ² … of the increments.
#[inline(always)]
pub(super) fn powers<const N: usize, const S: usize, const W: usize, const B: usize>(
    tableau: &Tableau<W, B>,
    z: &Increments<N, W>,
) -> Increments<N, W> {
    let mut powers = [[0.0; W]; N];
    for (powers, z) in powers.iter_mut().zip(z) {
        for s in 0..S {
            for (power, by) in powers.iter_mut().zip(&tableau.power[s]) {
                *power = fma(*by, z[s], *power);
            }
        }
    }
    powers
}

/// The polynomial of these powers, without a constant, at θ.
#[inline(always)]
pub(super) fn horner<const S: usize, const W: usize>(powers: &[f64; W], theta: f64) -> f64 {
    (0..S).rev().fold(0.0, |sum, k| fma(sum, theta, powers[k])) * theta
}

/// The slope by θ of that polynomial at its end, θ = 1.
#[inline(always)]
pub(super) fn slope_at_end<const S: usize, const W: usize>(powers: &[f64; W]) -> f64 {
    (0..S).map(|k| (k + 1) as f64 * powers[k]).sum()
}
