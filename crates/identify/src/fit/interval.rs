//! What a fit can say of a parameter: standard errors, and the interval in which the misfit stays small.

use super::{
    newton::Local,
    problem::Problem,
    search::{Found, Patience, search},
};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// The 95 % quantile of χ² with one degree of freedom.
const CHI_SQUARED: f64 = 3.841_458_820_694_124;

/// The 97.5 % quantile of the normal distribution.
pub(super) const NORMAL: f64 = 1.959_963_984_540_054;

/// The spread of the fit's variables.
#[derive(Debug, Clone)]
pub struct Spread {
    /// The residual variance s², 1 where model and noise are right [1].
    pub variance: f64,
    /// Covariance of the fit's variables with white residuals, s² (JᵀJ)⁻¹.
    pub covariance: DMatrix<f64>,
    /// By what the standard error of each variable grows because neighbouring residuals are alike; 1 if they
    /// are not [1].
    pub inflation: Vec<f64>,
    /// The correlation of neighbouring residuals of each channel, the mean over them [1].
    pub neighbours: f64,
}

/// The spread of the variables at a minimum.
pub(super) fn spread(problem: &Problem<'_>, found: &Found, local: &Local) -> Spread {
    let n = found.x.len();
    let samples: usize = found.pieces.iter().map(|p| p.residuals.len()).sum::<usize>()
        + problem.loads(&found.x).0.len();
    let unknown = n + if problem.data.force.is_some() { 0 } else { 2 * problem.windows.len() };
    let variance = found.misfit / (samples.saturating_sub(unknown)).max(1) as f64;
    let inverse = inverse(&local.gauss);
    let neighbours = neighbours(problem, found);
    let mut inflation = vec![1.0; n];
    // Below this the correlation is what white residuals show by chance.
    if neighbours > 3.0 / (samples as f64).sqrt() {
        let robust = &inverse * scores(problem, found, local) * &inverse;
        for (i, grows) in inflation.iter_mut().enumerate() {
            let plain = variance * inverse[(i, i)];
            *grows = (robust[(i, i)] / plain).sqrt().max(1.0);
        }
    }
    Spread { variance, covariance: inverse * variance, inflation, neighbours }
}

/// The inverse of JᵀJ, whose diagonal may differ by many orders; directions of no curvature get a variance
/// that is as good as infinite.
fn inverse(gauss: &DMatrix<f64>) -> DMatrix<f64> {
    let n = gauss.nrows();
    let size: Vec<f64> = (0..n).map(|i| gauss[(i, i)].max(1e-300).sqrt()).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| gauss[(i, j)] / (size[i] * size[j]));
    let eigen = scaled.symmetric_eigen();
    let values = eigen.eigenvalues.map(|v| v.max(1e-13).recip());
    let back =
        &eigen.eigenvectors * DMatrix::from_diagonal(&values) * eigen.eigenvectors.transpose();
    DMatrix::from_fn(n, n, |i, j| back[(i, j)] / (size[i] * size[j]))
}

/// The correlation of residuals one sample apart, over all windows and channels.
fn neighbours(problem: &Problem<'_>, found: &Found) -> f64 {
    let channels = problem.channels();
    let (mut product, mut square) = (0.0, 0.0);
    for (window, piece) in problem.windows.iter().zip(&found.pieces) {
        let rows = &piece.residuals[..window.len() * channels];
        for (i, r) in rows.iter().enumerate() {
            square += r * r;
            if let Some(next) = rows.get(i + channels) {
                product += r * next;
            }
        }
    }
    if square > 0.0 { product / square } else { 0.0 }
}

/// Σ g gᵀ over stretches of samples, g the part of the half gradient of one stretch: what stands for JᵀJ where
/// residuals of one stretch are alike. Stretches grow with the cube root of the number of samples.
fn scores(problem: &Problem<'_>, found: &Found, local: &Local) -> DMatrix<f64> {
    let n = found.x.len();
    let channels = problem.channels();
    let samples: usize = problem.windows.iter().map(super::window::Window::len).sum();
    let stretch = 4 * channels * (samples as f64).cbrt().ceil().max(1.0).min(1e6) as usize;
    let mut sum = DMatrix::zeros(n, n);
    for (piece, jacobian) in found.pieces.iter().zip(&local.jacobians) {
        let rows = piece.residuals.len();
        let mut first = 0;
        while first < rows {
            let end = (first + stretch).min(rows);
            let part = jacobian.rows(first, end - first);
            let g = part.transpose()
                * nalgebra::DVector::from_column_slice(&piece.residuals[first..end]);
            sum += &g * g.transpose();
            first = end;
        }
    }
    sum
}

/// The interval of one variable in which the misfit, with all others refitted, stays within the 95 % quantile;
/// none where no bound was found.
pub type Interval = [Option<f64>; 2];

/// The steps a bound may take, and how far it may go [in the fit's variable].
const TRIES: usize = 7;
const FURTHEST: f64 = 9.0;

/// The profile intervals of all variables around the minimum.
pub(super) fn profiles(problem: &Problem<'_>, found: &Found, spread: &Spread) -> Vec<Interval> {
    (0..found.x.len())
        .into_par_iter()
        .map(|i| {
            let limit = CHI_SQUARED * spread.variance * spread.inflation[i].powi(2);
            let side = |sign: f64| bound(problem, found, spread, (i, sign, limit));
            [side(-1.0), side(1.0)]
        })
        .collect()
}

/// How far variable `i` goes in the direction `sign` before the misfit has grown by `limit`.
fn bound(
    problem: &Problem<'_>,
    found: &Found,
    spread: &Spread,
    (i, sign, limit): (usize, f64, f64),
) -> Option<f64> {
    let c = &spread.covariance;
    let error = c[(i, i)].sqrt() * spread.inflation[i];
    let (mut x, mut pieces) = (found.x.clone(), found.pieces.clone());
    let (mut inside, mut inside_root) = (0.0, 0.0);
    let mut outside: Option<(f64, f64)> = None;
    let mut away = (NORMAL * error).clamp(1e-9, 2.0);
    for _ in 0..TRIES {
        let mut there = x.clone();
        let moved = found.x[i] + sign * away - x[i];
        for (j, x) in there.iter_mut().enumerate() {
            *x += (moved * c[(j, i)] / c[(i, i)]).clamp(-1.0, 1.0);
        }
        there[i] = found.x[i] + sign * away;
        let patience = Patience { misfit: 0.01 * limit, simulations: 8 };
        let mut near = search(problem, (&there, Some(&pieces)), Some(i), &patience);
        if near.misfit - found.misfit > 1.1 * limit {
            // The windows' starts may have gone astray; from where they were seen they may not.
            let other = search(problem, (&there, None), Some(i), &patience);
            near = if other.misfit < near.misfit { other } else { near };
        }
        let root = ((near.misfit - found.misfit) / limit).max(0.0).sqrt();
        if (root - 1.0).abs() < 0.05 {
            return Some(found.x[i] + sign * away / root);
        }
        if root < 1.0 {
            (inside, inside_root) = (away, root);
            (x, pieces) = (near.x, near.pieces);
        } else {
            outside = Some((away, root));
        }
        // The root of the misfit grows about linearly.
        away = match outside {
            Some((far, far_root)) => {
                let share = (1.0 - inside_root) / (far_root - inside_root);
                inside + (far - inside) * share.clamp(0.05, 0.95)
            }
            None if inside >= FURTHEST => return None,
            None => (away / root.max(0.3)).min(3.0 * away).min(FURTHEST),
        };
    }
    outside.map(|_| found.x[i] + sign * away)
}
