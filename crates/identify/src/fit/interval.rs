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
pub(super) struct Spread {
    /// The residual variance s², 1 where model and noise are right [1].
    pub variance: f64,
    /// Covariance of the fit's variables with white residuals, s² (JᵀJ)⁻¹.
    pub covariance: DMatrix<f64>,
    /// By what the standard error of each variable grows because neighbouring residuals are alike, or those larger
    /// on which it depends most; 1 if they are not [1].
    pub inflation: Vec<f64>,
    /// The correlation of neighbouring residuals of each channel, the mean over them [1].
    pub neighbours: f64,
}

/// The spread of the variables at a minimum.
pub(super) fn spread(problem: &Problem<'_>, found: &Found, local: &Local) -> Spread {
    let n = found.x.len();
    let samples: usize = found.pieces.iter().map(|p| p.residuals.len()).sum::<usize>()
        + problem.loads(&found.x).0.len();
    let unknown = n + problem.starts() * problem.windows.len();
    let variance = found.misfit / (samples.saturating_sub(unknown)).max(1) as f64;
    let inverse = inverse(&local.gauss);
    let neighbours = neighbours(problem, found);
    let (scores, few, stretches) = scores(found, local);
    let robust = &inverse * scores * &inverse;
    // Below these what is found is what white residuals of one variance show by chance.
    let alike = neighbours > 3.0 / (samples as f64).sqrt();
    let chance = 1.0 + (2.0 / stretches).sqrt();
    let inflation = (0..n)
        .map(|i| {
            let grows = robust[(i, i)] / (variance * inverse[(i, i)]);
            if alike || grows > chance { (few * grows.sqrt()).max(1.0) } else { 1.0 }
        })
        .collect();
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

/// Σ g gᵀ over stretches of the record, g the part of the half gradient of one stretch: what stands for JᵀJ where
/// residuals of one stretch are alike; what a standard error from so few stretches is to be multiplied by, and how
/// many are free.
///
/// A window is a stretch; of few windows there are [`STRETCHES`] stretches in all.
fn scores(found: &Found, local: &Local) -> (DMatrix<f64>, f64, f64) {
    let n = found.x.len();
    let rows: usize = found.pieces.iter().map(|p| p.residuals.len()).sum();
    let long = if found.pieces.len() >= STRETCHES / 2 { rows } else { rows.div_ceil(STRETCHES) };
    let (mut sum, mut count) = (DMatrix::zeros(n, n), 0);
    for (piece, jacobian) in found.pieces.iter().zip(&local.jacobians) {
        let mut first = 0;
        while first < piece.residuals.len() {
            let end = (first + long).min(piece.residuals.len());
            let residuals = nalgebra::DVector::from_column_slice(&piece.residuals[first..end]);
            let g = jacobian.rows(first, end - first).transpose() * residuals;
            sum += &g * g.transpose();
            (first, count) = (end, count + 1);
        }
    }
    // The quantile of Student's distribution against the normal one, to first order in 1/ν.
    let free = f64::from((count - 1).max(1));
    let student = 1.0 + (NORMAL * NORMAL + 1.0) / (4.0 * free);
    (sum, student * ((free + 1.0) / free).sqrt(), free)
}

/// Into how many stretches a record of few windows is cut.
const STRETCHES: usize = 24;

/// The interval of one variable in which the misfit, with all others refitted, stays within the 95 % quantile;
/// none where no bound was found.
pub(super) type Interval = [Option<f64>; 2];

/// The steps a bound may take, and how far it may go [in the fit's variable].
const TRIES: usize = 6;
const FURTHEST: f64 = 9.0;

/// A misfit so much lower [residual variances] is another minimum.
const LOWER: f64 = 0.5;

/// The profile intervals of all variables around the minimum, and a lower minimum if a profile came upon one: then
/// the intervals are worth nothing.
pub(super) fn profiles(
    problem: &Problem<'_>,
    found: &Found,
    spread: &Spread,
) -> (Vec<Interval>, Option<Found>) {
    let sides: Vec<[Side; 2]> = (0..found.x.len())
        .into_par_iter()
        .map(|i| {
            let limit = CHI_SQUARED * spread.variance * spread.inflation[i].powi(2);
            [-1.0, 1.0].map(|sign| bound(problem, found, spread, (i, sign, limit)))
        })
        .collect();
    let intervals = sides.iter().map(|sides| {
        [0, 1].map(|side| match &sides[side] {
            Side::At(x) => Some(*x),
            Side::Nowhere | Side::Lower(_) => None,
        })
    });
    let intervals = intervals.collect();
    let lower = sides.into_iter().flatten().filter_map(|side| match side {
        Side::Lower(found) => Some(*found),
        Side::At(_) | Side::Nowhere => None,
    });
    (intervals, lower.min_by(|a, b| a.misfit.total_cmp(&b.misfit)))
}

/// What was found in one direction.
enum Side {
    /// A bound, in the fit's variable.
    At(f64),
    /// No bound.
    Nowhere,
    /// A lower misfit.
    Lower(Box<Found>),
}

/// How far variable `i` goes in the direction `sign` before the misfit has grown by `limit`.
fn bound(
    problem: &Problem<'_>,
    found: &Found,
    spread: &Spread,
    (i, sign, limit): (usize, f64, f64),
) -> Side {
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
        let patience = Patience { misfit: 0.005 * limit, share: 0.0, simulations: 24 };
        let mut near = search(problem, (&there, Some(&pieces)), Some(i), &patience);
        if near.misfit - found.misfit > 1.1 * limit {
            // The windows' starts may have gone astray; from where they were seen they may not.
            let other = search(problem, (&there, None), Some(i), &patience);
            near = if other.misfit < near.misfit { other } else { near };
        }
        if near.misfit < found.misfit - LOWER * spread.variance {
            return Side::Lower(Box::new(near));
        }
        let root = ((near.misfit - found.misfit) / limit).max(0.0).sqrt();
        if (root - 1.0).abs() < 0.05 {
            return Side::At(found.x[i] + sign * away / root);
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
            None if inside >= FURTHEST => return Side::Nowhere,
            None => (away / root.max(0.3)).min(3.0 * away).min(FURTHEST),
        };
    }
    outside.map_or(Side::Nowhere, |_| Side::At(found.x[i] + sign * away))
}

#[cfg(test)]
mod tests {
    use super::{CHI_SQUARED, NORMAL};

    #[test]
    fn the_two_quantiles_are_one() {
        // χ² with one degree of freedom is the square of a normal variable.
        assert!((CHI_SQUARED - NORMAL * NORMAL).abs() < 1e-14);
        // The normal one by Simpson's rule.
        let density = |x: f64| (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let n = 2000;
        let h = NORMAL / f64::from(n);
        let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
        let within: f64 = (0..=n).map(|i| weight(i) * density(f64::from(i) * h)).sum();
        assert!((2.0 * within * h / 3.0 - 0.95).abs() < 1e-12);
    }
}
