//! The bootstrap over blocks: what the estimates would have been with other stretches of the same drive.

use super::{Options, newton::Local, problem::Problem, search::Found};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The fewest blocks from which it makes sense to draw.
const LEAST: usize = 8;

/// How many blocks the record is cut into.
const BLOCKS: usize = 24;

/// The 95 % interval of every parameter; none if there are too few blocks or nothing is to be drawn.
///
/// Every draw weighs each block by how often it was drawn and takes one Gauss–Newton step from the minimum,
/// which is what the estimate changes by to first order.
pub(super) fn draw(
    problem: &Problem<'_>,
    found: &Found,
    local: &Local,
    options: &Options,
) -> Vec<Option<[f64; 2]>> {
    let n = found.x.len();
    let blocks = blocks(found, local);
    if blocks.len() < LEAST || options.bootstrap == 0 {
        return vec![None; n];
    }
    let mut random = ChaCha8Rng::seed_from_u64(options.seed ^ 0xb10c);
    let mut values = vec![Vec::with_capacity(options.bootstrap); n];
    for _ in 0..options.bootstrap {
        let (mut gradient, mut gauss) = (DVector::zeros(n), DMatrix::zeros(n, n));
        for _ in 0..blocks.len() {
            let (g, h) = &blocks[random.random_range(0..blocks.len())];
            gradient += g;
            gauss += h;
        }
        let Some(step) = gauss.cholesky().map(|c| c.solve(&gradient)) else { continue };
        let x: Vec<f64> = found.x.iter().zip(step.iter()).map(|(x, s)| x - s).collect();
        for (i, values) in values.iter_mut().enumerate() {
            values.push(problem.value(i, &x));
        }
    }
    values.into_iter().map(|v| quantiles(v, options.bootstrap)).collect()
}

fn quantiles(mut values: Vec<f64>, asked: usize) -> Option<[f64; 2]> {
    if values.len() < asked / 2 || values.is_empty() {
        return None;
    }
    values.sort_by(f64::total_cmp);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the list")]
    let at = |share: f64| values[(share * (values.len() - 1) as f64).round() as usize];
    Some([at(0.025), at(0.975)])
}

/// The part of half gradient and JᵀJ of each of some stretches of the record.
fn blocks(found: &Found, local: &Local) -> Vec<(DVector<f64>, DMatrix<f64>)> {
    let rows: usize = found.pieces.iter().map(|p| p.residuals.len()).sum();
    let long = rows.div_ceil(BLOCKS).max(1);
    let mut all = Vec::new();
    for (piece, jacobian) in found.pieces.iter().zip(&local.jacobians) {
        let count = piece.residuals.len().div_ceil(long).max(1);
        for k in 0..count {
            let cut = |k: usize| k * piece.residuals.len() / count;
            let part = jacobian.rows(cut(k), cut(k + 1) - cut(k));
            let residuals = DVector::from_column_slice(&piece.residuals[cut(k)..cut(k + 1)]);
            all.push((part.transpose() * residuals, part.transpose() * part));
        }
    }
    all
}
