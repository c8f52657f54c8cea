//! The coefficients of the method, computed from √6 and the roots of one cubic.

use nalgebra::{Complex, Matrix3, Vector3};

/// Radau IIA with three stages, in the coordinates in which its stages decouple.
///
/// With the matrix A of the method, A⁻¹ T = T Λ, where Λ holds one real eigenvalue γ and the block of a
/// complex pair α ± iβ. The equation Z = h (A ⊗ 1) F for the 3n stage increments becomes one real
/// system of n and one complex system of n (Hairer and Wanner, *Solving Ordinary Differential Equations
/// II*, section IV.8).
#[derive(Debug, Clone)]
pub(super) struct Tableau {
    /// The times of the stages, as parts of the step; the last is its end.
    pub(super) c: [f64; 3],
    /// The real eigenvalue of A⁻¹.
    pub(super) gamma: f64,
    /// The complex one with the positive imaginary part.
    pub(super) alpha_beta: Complex<f64>,
    /// From decoupled coordinates to stages.
    pub(super) t: Matrix3<f64>,
    /// From stages to decoupled coordinates.
    pub(super) t_inverse: Matrix3<f64>,
    /// The weights of the stage increments in the error estimate.
    pub(super) error: [f64; 3],
}

impl Tableau {
    pub(super) fn new() -> Self {
        let root = 6.0_f64.sqrt();
        let inverse = inverse_of_a();
        let (gamma, alpha_beta) = eigenvalues();
        // The eigenvector of α + iβ is p = t₂ − i t₃.
        let p = eigenvector(&inverse, alpha_beta);
        let real = eigenvector(&inverse, Complex::new(gamma, 0.0));
        let t = Matrix3::from_columns(&[real.map(|v| v.re), p.map(|v| v.re), p.map(|v| -v.im)]);
        Self {
            c: [(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0],
            gamma,
            alpha_beta,
            t,
            t_inverse: inverse_of(&t),
            error: [-(13.0 + 7.0 * root) / 3.0, (-13.0 + 7.0 * root) / 3.0, -1.0 / 3.0],
        }
    }
}

/// The matrix A of the method.
fn a() -> Matrix3<f64> {
    let s = 6.0_f64.sqrt();
    Matrix3::new(
        (88.0 - 7.0 * s) / 360.0,
        (296.0 - 169.0 * s) / 1800.0,
        (-2.0 + 3.0 * s) / 225.0,
        (296.0 + 169.0 * s) / 1800.0,
        (88.0 + 7.0 * s) / 360.0,
        (-2.0 - 3.0 * s) / 225.0,
        (16.0 - s) / 36.0,
        (16.0 + s) / 36.0,
        1.0 / 9.0,
    )
}

fn inverse_of_a() -> Matrix3<f64> {
    inverse_of(&a())
}

/// By cofactors; both matrices it is used for are well conditioned.
fn inverse_of(m: &Matrix3<f64>) -> Matrix3<f64> {
    let [x, y, z] = [m.column(0), m.column(1), m.column(2)];
    let rows = [y.cross(&z), z.cross(&x), x.cross(&y)];
    Matrix3::from_rows(&rows.map(|row| row.transpose())) / x.dot(&rows[0])
}

/// The eigenvalues of A⁻¹, whose characteristic polynomial is λ³ − 9λ² + 36λ − 60.
fn eigenvalues() -> (f64, Complex<f64>) {
    let (three, nine) = (9.0_f64.cbrt(), 81.0_f64.cbrt());
    let gamma = 30.0 / (6.0 + nine - three);
    let of_a = Complex::new((12.0 - nine + three) / 60.0, (nine + three) * 3.0_f64.sqrt() / 60.0);
    (gamma, of_a.conj().inv())
}

/// The vector across two rows of M − λ, with the last component 1.
fn eigenvector(m: &Matrix3<f64>, lambda: Complex<f64>) -> Vector3<Complex<f64>> {
    let shifted = m.map(|v| Complex::new(v, 0.0)) - Matrix3::from_diagonal_element(lambda);
    let vector = shifted.row(0).transpose().cross(&shifted.row(1).transpose());
    vector / vector[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coordinates_decouple_the_stages() {
        let tableau = Tableau::new();
        let Complex { re: alpha, im: beta } = tableau.alpha_beta;
        let blocks = Matrix3::new(tableau.gamma, 0.0, 0.0, 0.0, alpha, -beta, 0.0, beta, alpha);
        let error = (a() * tableau.t * blocks - tableau.t).abs().max();
        assert!(error < 1e-14, "A T Λ differs from T by {error:e}");
        let error = (tableau.t * tableau.t_inverse - Matrix3::identity()).abs().max();
        assert!(error < 1e-14, "T T⁻¹ differs from 1 by {error:e}");
        assert!(beta > 0.0);
    }

    #[test]
    fn the_stages_integrate_powers_exactly() {
        // A is the collocation matrix of c: the integral of s^k to c_i, for k = 0, 1, 2.
        let (tableau, a) = (Tableau::new(), a());
        for k in 0..3 {
            for i in 0..3 {
                let sum: f64 = (0..3).map(|j| a[(i, j)] * tableau.c[j].powi(k)).sum();
                let exact = tableau.c[i].powi(k + 1) / f64::from(k + 1);
                assert!((sum - exact).abs() < 1e-15, "stage {i}, power {k}: {sum}, not {exact}");
            }
        }
    }

    #[test]
    fn the_error_estimate_vanishes_up_to_third_order() {
        // y = s^k: f(0) + Σ e_i z_i must be zero for k = 1, 2 and 3, and not for 4.
        let Tableau { c, error, .. } = Tableau::new();
        for k in 1..=4 {
            let start = if k == 1 { 1.0 } else { 0.0 };
            let sum: f64 = start + (0..3).map(|i| error[i] * c[i].powi(k)).sum::<f64>();
            assert_eq!(sum.abs() < 1e-14, k < 4, "power {k}: {sum:e}");
        }
    }
}
