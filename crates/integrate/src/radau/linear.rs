//! Systems of a few linear equations, real or complex, in arrays.

use nalgebra::ComplexField;

/// A matrix as P⁻¹ L U, by Gauss's elimination with partial pivoting.
#[derive(Debug, Clone)]
pub(super) struct Lu<C, const N: usize> {
    lu: [[C; N]; N],
    pivots: [usize; N],
}

impl<C: ComplexField<RealField = f64> + Copy, const N: usize> Lu<C, N> {
    /// λ − J; none if it is singular or not finite.
    pub(super) fn shifted(lambda: C, jacobian: &[[f64; N]; N]) -> Option<Self> {
        let mut lu = [[C::zero(); N]; N];
        for i in 0..N {
            for j in 0..N {
                lu[i][j] = C::from_real(-jacobian[i][j]);
            }
            lu[i][i] += lambda;
        }
        let mut pivots = [0; N];
        for k in 0..N {
            let mut pivot = k;
            for i in k + 1..N {
                if lu[i][k].norm1() > lu[pivot][k].norm1() {
                    pivot = i;
                }
            }
            lu.swap(k, pivot);
            pivots[k] = pivot;
            let size = lu[k][k].norm1();
            if size == 0.0 || !size.is_finite() {
                return None;
            }
            let above = lu[k];
            for row in &mut lu[k + 1..] {
                row[k] /= above[k];
                let factor = row[k];
                for (below, above) in row[k + 1..].iter_mut().zip(&above[k + 1..]) {
                    *below -= factor * *above;
                }
            }
        }
        Some(Self { lu, pivots })
    }

    /// The solution for the right-hand side `b`.
    pub(super) fn solve(&self, mut b: [C; N]) -> [C; N] {
        for k in 0..N {
            b.swap(k, self.pivots[k]);
        }
        for i in 0..N {
            for j in 0..i {
                let known = b[j];
                b[i] -= self.lu[i][j] * known;
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                let known = b[j];
                b[i] -= self.lu[i][j] * known;
            }
            b[i] /= self.lu[i][i];
        }
        b
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;

    #[test]
    fn a_solution_solves_its_equations() {
        // Its first pivot is not the first row.
        let jacobian = [
            [-1e-9, 2.0, -3.0, 0.5],
            [4.0, 1.0, 0.0, -2.0],
            [1.0, 7.0, 2.0, 1.0],
            [0.0, 0.3, -5.0, 6.0],
        ];
        for lambda in [Complex::new(0.0, 0.0), Complex::new(2.0, -3.0)] {
            let b = [1.0, -2.0, 0.5, 3.0].map(|b| Complex::new(b, 1.0 - b));
            let x = Lu::shifted(lambda, &jacobian).unwrap().solve(b);
            for i in 0..4 {
                let sum: Complex<f64> = (0..4).map(|j| x[j] * -jacobian[i][j]).sum();
                let left = (sum + lambda * x[i] - b[i]).norm();
                assert!(left < 1e-14, "row {i}: {left:e} is left");
            }
        }
        assert!(Lu::shifted(0.0, &[[1.0, 2.0], [2.0, 4.0]]).is_none(), "singular");
        assert!(Lu::shifted(f64::NAN, &[[1.0]]).is_none(), "not a number");
    }
}
