//! Newton's matrices λ/h − J, for all blocks of a step.

#![expect(
    clippy::inline_always,
    reason = "called for every stage: a call costs more than what it does"
)]

use super::lanes::Complex;

/// λ/h − J for all blocks, ready to solve with.
pub trait Newton<const N: usize, const B: usize>: Sized {
    /// From the shift λ/h.
    fn new(shift: &Complex<B>, jacobian: &[[f64; N]; N]) -> Self;

    /// The solution for the right-hand side `b`.
    fn solve(&self, b: &[Complex<B>; N]) -> [Complex<B>; N];
}

/// Any system: as L U without exchange of rows. As h becomes small the diagonal rules, so that a step that
/// fails for want of an exchange is only made shorter.
///
/// The loops run over all rows and columns and ask which are meant, because the compiler unrolls loops of
/// constant length only.
#[derive(Debug, Clone)]
pub struct General<const N: usize, const B: usize> {
    /// Below the diagonal the factors, on it the inverse pivots, above it what is left.
    lu: [[Complex<B>; N]; N],
}

impl<const N: usize, const B: usize> Newton<N, B> for General<N, B> {
    #[inline(always)]
    fn new(shift: &Complex<B>, jacobian: &[[f64; N]; N]) -> Self {
        let mut lu = [[Complex::ZERO; N]; N];
        for i in 0..N {
            for j in 0..N {
                let start = if i == j { *shift } else { Complex::ZERO };
                lu[i][j] = start.plus_real(-jacobian[i][j]);
            }
        }
        for k in 0..N {
            lu[k][k] = lu[k][k].inverse();
            for i in 0..N {
                if i > k {
                    lu[i][k] = lu[i][k].times(&lu[k][k]);
                    for j in 0..N {
                        if j > k {
                            lu[i][j] = lu[i][j].less(&lu[i][k], &lu[k][j]);
                        }
                    }
                }
            }
        }
        Self { lu }
    }

    #[inline(always)]
    fn solve(&self, b: &[Complex<B>; N]) -> [Complex<B>; N] {
        let mut b = *b;
        for i in 0..N {
            for j in 0..N {
                if j < i {
                    b[i] = b[i].less(&self.lu[i][j], &b[j]);
                }
            }
        }
        for below in 0..N {
            let i = N - 1 - below;
            for j in 0..N {
                if j > i {
                    b[i] = b[i].less(&self.lu[i][j], &b[j]);
                }
            }
            b[i] = b[i].times(&self.lu[i][i]);
        }
        b
    }
}

/// A displacement, its velocity and one more state, of which the displacement does not know: J has the first
/// row 0, 1, 0. The displacement is eliminated and the other two are solved for by Cramer's rule.
#[derive(Debug, Clone)]
pub struct Moving<const B: usize> {
    /// h/λ.
    period: Complex<B>,
    /// What the displacement hands on to the velocity: J₁₀ h/λ.
    hands_on: Complex<B>,
    /// The diagonal of what is left, and the other two entries.
    diagonal: [Complex<B>; 2],
    beside: [f64; 2],
    /// One over its determinant.
    inverse: Complex<B>,
}

impl<const B: usize> Newton<3, B> for Moving<B> {
    #[inline(always)]
    fn new(shift: &Complex<B>, jacobian: &[[f64; 3]; 3]) -> Self {
        let [_, [j10, j11, j12], [_, j21, j22]] = *jacobian;
        let period = shift.inverse();
        let hands_on = period.scaled(j10);
        let first = shift.plus_real(-j11).plus(&hands_on.scaled(-1.0));
        let second = shift.plus_real(-j22);
        let determinant = first.times(&second).plus_real(-j12 * j21);
        let (diagonal, beside) = ([first, second], [j12, j21]);
        Self { period, hands_on, diagonal, beside, inverse: determinant.inverse() }
    }

    #[inline(always)]
    fn solve(&self, b: &[Complex<B>; 3]) -> [Complex<B>; 3] {
        let [q, v, x] = b;
        let v = v.plus(&self.hands_on.times(q));
        let first = self.diagonal[1].times(&v).plus(&x.scaled(self.beside[0]));
        let second = self.diagonal[0].times(x).plus(&v.scaled(self.beside[1]));
        let (v, x) = (first.times(&self.inverse), second.times(&self.inverse));
        [q.plus(&v).times(&self.period), v, x]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_matrices_solve_their_equations() {
        let jacobian = [[0.0, 1.0, 0.0], [-7.0, -300.0, 2e4], [0.0, 0.3, -50.0]];
        let shift = Complex { re: [3.0, 40.0], im: [0.0, 25.0] };
        let b = [1.0, -2.0, 0.5].map(|b| Complex { re: [b, 3.0 - b], im: [0.0, b * b] });
        let ways =
            [General::new(&shift, &jacobian).solve(&b), Moving::new(&shift, &jacobian).solve(&b)];
        for x in ways {
            for i in 0..3 {
                let mut left = shift.times(&x[i]).plus(&b[i].scaled(-1.0));
                for j in 0..3 {
                    left = left.plus(&x[j].scaled(-jacobian[i][j]));
                }
                let off = left.re.iter().chain(&left.im).fold(0.0_f64, |m, l| m.max(l.abs()));
                assert!(off < 1e-12, "row {i}: {off:e} is left");
            }
        }
    }
}
