//! Residuals that hang together, made independent.
//!
//! What a recorded input says wrong goes through the plant and is seen in many samples at once. With the residuals r
//! in units of the sensors' noise and the columns of B what one standard deviation of each part of the input's noise
//! moves them by, their covariance is I + B Bᵀ, and (I + B Bᵀ)^(-1/2) r is white. The symmetric root leaves what
//! happens at a sample as near to it as may be.

use nalgebra::{DMatrix, DVectorViewMut};

/// The symmetric inverse root of a covariance I + B Bᵀ.
#[derive(Debug, Clone, PartialEq)]
pub struct Whitening {
    /// B V, where BᵀB = V diag(s²) Vᵀ: one column for each s² that counts.
    along: DMatrix<f64>,
    /// ((1 + s²)^(-1/2) − 1)/s² of each.
    by: Vec<f64>,
}

/// Less than this share of the sensors' variance does not show.
const LITTLE: f64 = 1e-4;

impl Whitening {
    /// Of the columns B [1]; none if they do not show.
    pub fn of(columns: &DMatrix<f64>) -> Option<Self> {
        let squares = columns.transpose() * columns;
        if squares.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let eigen = squares.symmetric_eigen();
        let counts: Vec<usize> =
            (0..columns.ncols()).filter(|i| eigen.eigenvalues[*i] > LITTLE).collect();
        if counts.is_empty() {
            return None;
        }
        let by = |i: &usize| {
            let s = eigen.eigenvalues[*i];
            ((1.0 + s).sqrt().recip() - 1.0) / s
        };
        Some(Self {
            along: columns * eigen.eigenvectors.select_columns(&counts),
            by: counts.iter().map(by).collect(),
        })
    }

    /// How many residuals it is for.
    pub(super) fn rows(&self) -> usize {
        self.along.nrows()
    }

    /// Makes the first residuals of `rows` white, as many as it is for.
    pub fn apply(&self, rows: &mut [f64]) {
        let mut rows = DVectorViewMut::from_slice(&mut rows[..self.rows()], self.rows());
        let mut parts = self.along.tr_mul(&rows);
        for (part, by) in parts.iter_mut().zip(&self.by) {
            *part *= by;
        }
        rows.gemv(1.0, &self.along, &parts, 1.0);
    }

    /// The same of every column of `all`.
    pub fn apply_all(&self, all: &mut DMatrix<f64>) {
        let mut rows = all.rows_mut(0, self.rows());
        let mut parts = self.along.transpose() * &rows;
        for (mut part, by) in parts.row_iter_mut().zip(&self.by) {
            part *= *by;
        }
        rows.gemm(1.0, &self.along, &parts, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::Whitening;
    use nalgebra::DMatrix;

    #[test]
    fn the_covariance_of_what_is_white_is_one() {
        let b = DMatrix::from_fn(6, 2, |i, j| ((i + 2 * j) as f64).sin() * 3.0);
        let whitening = Whitening::of(&b).unwrap();
        // W (I + B Bᵀ) Wᵀ, W column by column.
        let mut w = DMatrix::identity(6, 6);
        for mut column in w.column_iter_mut() {
            whitening.apply(column.as_mut_slice());
        }
        let mut all = DMatrix::identity(6, 6);
        whitening.apply_all(&mut all);
        assert!((all - &w).amax() < 1e-15);
        let covariance = DMatrix::identity(6, 6) + &b * b.transpose();
        let white = &w * covariance * w.transpose();
        assert!((white - DMatrix::identity(6, 6)).amax() < 1e-12);
        assert!((&w - w.transpose()).amax() < 1e-12, "it is symmetric");
        assert_eq!(Whitening::of(&DMatrix::zeros(6, 2)), None);
    }
}
