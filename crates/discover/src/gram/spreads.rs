//! How well a record tells each of many values.

use nalgebra::{DMatrix, SymmetricEigen};

/// A scaled curvature that is less than this is the rounding of larger ones.
const UNSEEN: f64 = 1e-12;

/// The standard deviation of each variable where the misfit has this `curvature`, if noise has that of 1; not a number where there
/// is none.
pub(crate) fn spreads(curvature: &DMatrix<f64>) -> Vec<f64> {
    let n = curvature.nrows();
    let size: Vec<f64> = (0..n).map(|i| curvature[(i, i)].max(1e-300).sqrt()).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| curvature[(i, j)] / (size[i] * size[j]));
    let inverse = surely(scaled);
    let one = |i: usize| inverse.as_ref().map_or(f64::NAN, |own| own[(i, i)].sqrt() / size[i]);
    (0..n).map(one).collect()
}

/// The inverse of a symmetric matrix with ones on its diagonal, if it has one. Of a direction that the record does not
/// see, as of the difference of two springs that always stretch alike, the curvature is rounding, which one inverts to
/// anything: it counts as [`UNSEEN`], and the others keep what is theirs.
fn surely(scaled: DMatrix<f64>) -> Option<DMatrix<f64>> {
    if scaled.is_empty() {
        return None;
    }
    let parts = SymmetricEigen::try_new(scaled, f64::EPSILON, 1000)?;
    let weights = parts.eigenvalues.map(|curvature| 1.0 / curvature.max(UNSEEN));
    let axes = parts.eigenvectors;
    Some(&axes * DMatrix::from_diagonal(&weights) * axes.transpose())
}

#[cfg(test)]
mod tests {
    use super::{DMatrix, spreads, surely};

    #[test]
    fn a_direction_that_is_not_seen_leaves_the_errors_of_the_others_alone() {
        // Of the first two only the sum is seen, to the last bit.
        let (a, bit) = (0.25, 1.0 - f64::EPSILON);
        let inverse = surely(DMatrix::from_row_slice(3, 3, &[1., bit, a, bit, 1., a, a, a, 1.]));
        let inverse = inverse.expect("it is symmetric");
        // With s = (x + y)/√2: the block [2, a√2; a√2, 1] has the inverse's last entry 1/(1 - a²).
        let expected = 1.0 / (1.0 - a * a);
        assert!((inverse[(2, 2)] / expected - 1.0).abs() < 1e-9, "{inverse}");
        assert!((inverse[(0, 0)] / 5e11 - 1.0).abs() < 1e-3, "{inverse}");
        assert!(surely(DMatrix::zeros(0, 0)).is_none());
    }

    #[test]
    fn a_value_is_told_as_well_as_the_others_let_it_be() {
        // Of two that are alike but for a part in a hundred, one of them in units a thousand times as large.
        let curvature = DMatrix::from_row_slice(2, 2, &[4.0, 2e3 * 0.99, 2e3 * 0.99, 1e6]);
        let alone = 1.0 / (1.0 - 0.99 * 0.99_f64);
        let expected = [(alone / 4.0).sqrt(), (alone / 1e6).sqrt()];
        for (spread, expected) in spreads(&curvature).iter().zip(expected) {
            assert!((spread / expected - 1.0).abs() < 1e-9, "{spread} for {expected}");
        }
    }
}
