//! The last steps to the minimum, with the second derivatives that Gauss and Newton leave out.
//!
//! Where a few samples lie in a break-away the residuals bend so much with the parameters that JᵀJ is far from
//! the misfit's Hessian, and Levenberg and Marquardt's steps zigzag for ever. The Hessian itself, from
//! differences of the exact gradient over a tenth of a standard error, ends that.

use super::{
    problem::{Lead, Piece, Problem},
    search::{End, Found},
};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// The misfit's half gradient, JᵀJ, the windows' Jacobians, and how their starts follow.
pub(super) struct Local {
    pub(super) misfit: f64,
    pub(super) gradient: DVector<f64>,
    pub(super) gauss: DMatrix<f64>,
    pub(super) jacobians: Vec<DMatrix<f64>>,
    leads: Vec<Lead>,
}

/// A reduction of the misfit [1] that is not worth another step.
const ENOUGH: f64 = 0.02;

/// The share of a standard error over which the gradient is differenced.
const SHARE: f64 = 0.1;

/// Goes from where a search ended to the minimum, moving all variables but the `fixed` one.
pub fn settle(problem: &Problem<'_>, found: Found, fixed: Option<usize>) -> Found {
    let n = found.x.len();
    let moving: Vec<usize> = (0..n).filter(|i| Some(*i) != fixed).collect();
    let mut found = found;
    let mut local = look(problem, &found.x, &found.pieces);
    let mut information = local.gauss.clone();
    if found.end == End::Converged && newton(&information, &local.gradient, &moving).1 < ENOUGH {
        return found;
    }
    for round in 0..6 {
        if round < 3 {
            information = curvature(problem, &found.x, &local, &moving);
        }
        let (step, gain) = newton(&information, &local.gradient, &moving);
        if gain < ENOUGH {
            let whole = found.pieces.iter().all(|p| !p.motion.q.is_empty());
            found.end = if whole { End::Converged } else { found.end };
            break;
        }
        let Some((x, pieces, misfit)) = shorten(problem, &found.x, &step, &local) else {
            break;
        };
        found.simulations[0] += 1;
        found.x = x;
        found.misfit = misfit;
        found.pieces = pieces;
        local = look(problem, &found.x, &found.pieces);
    }
    found
}

pub(super) fn look(problem: &Problem<'_>, x: &[f64], pieces: &[Piece]) -> Local {
    let n = x.len();
    let slopes = problem.all_slopes(x, pieces);
    let (loads, loads_by) = problem.loads(x);
    let mut gradient = loads_by.transpose() * DVector::from_column_slice(&loads);
    let mut gauss = loads_by.transpose() * &loads_by;
    if gradient.is_empty() {
        (gradient, gauss) = (DVector::zeros(n), DMatrix::zeros(n, n));
    }
    let mut misfit: f64 = loads.iter().map(|r| r * r).sum();
    for (piece, slopes) in pieces.iter().zip(&slopes) {
        let residuals = DVector::from_column_slice(&piece.residuals);
        misfit += residuals.norm_squared();
        gradient += slopes.jacobian.transpose() * residuals;
        gauss += slopes.jacobian.transpose() * &slopes.jacobian;
    }
    let (jacobians, leads) = slopes.into_iter().map(|s| (s.jacobian, s.lead)).unzip();
    Local { misfit, gradient, gauss, jacobians, leads }
}

/// Half the Hessian, from differences of half the gradient to both sides.
fn curvature(problem: &Problem<'_>, x: &[f64], local: &Local, moving: &[usize]) -> DMatrix<f64> {
    let n = x.len();
    let columns: Vec<(usize, DVector<f64>)> = moving
        .par_iter()
        .map(|&j| {
            let step = SHARE / local.gauss[(j, j)].max(1e-12).sqrt();
            let step = step.min(0.05);
            let at = |sign: f64| {
                let mut x_there = x.to_vec();
                x_there[j] += sign * step;
                let pieces = problem.pieces(&x_there, Some((x, &local.leads)));
                look(problem, &x_there, &pieces).gradient
            };
            (j, (at(1.0) - at(-1.0)) / (2.0 * step))
        })
        .collect();
    let mut hessian = DMatrix::zeros(n, n);
    for (j, column) in columns {
        hessian.set_column(j, &column);
    }
    0.5 * (&hessian + hessian.transpose())
}

/// Newton's step and the reduction of the misfit it promises; where the misfit does not curve upwards the
/// step goes down all the same.
fn newton(
    information: &DMatrix<f64>,
    gradient: &DVector<f64>,
    moving: &[usize],
) -> (DVector<f64>, f64) {
    let m = moving.len();
    // In units of the diagonal, as the variables' sensitivities differ by orders of magnitude.
    let size = |i: usize| information[(i, i)].abs().max(1e-300).sqrt();
    let scaled = DMatrix::from_fn(m, m, |a, b| {
        let (i, j) = (moving[a], moving[b]);
        information[(i, j)] / (size(i) * size(j))
    });
    let eigen = scaled.symmetric_eigen();
    let right = DVector::from_fn(m, |a, _| gradient[moving[a]] / size(moving[a]));
    let along = eigen.eigenvectors.transpose() * right;
    let least = 1e-9;
    let moved = DVector::from_fn(m, |a, _| -along[a] / eigen.eigenvalues[a].abs().max(least));
    let gain = -along.dot(&moved);
    let back = &eigen.eigenvectors * moved;
    let mut step = DVector::zeros(gradient.len());
    for (a, i) in moving.iter().enumerate() {
        step[*i] = back[a] / size(*i);
    }
    let long = step.amax();
    if long > 1.0 { (step / long, gain) } else { (step, gain) }
}

/// The longest of a few shares of `step` with which the misfit falls.
fn shorten(
    problem: &Problem<'_>,
    x: &[f64],
    step: &DVector<f64>,
    local: &Local,
) -> Option<(Vec<f64>, Vec<Piece>, f64)> {
    let mut share = 1.0;
    for _ in 0..6 {
        let there: Vec<f64> = x.iter().zip(step.iter()).map(|(x, s)| x + share * s).collect();
        let pieces = problem.pieces(&there, Some((x, &local.leads)));
        let loads: f64 = problem.loads(&there).0.iter().map(|r| r * r).sum();
        let misfit = loads + pieces.iter().flat_map(|p| &p.residuals).map(|r| r * r).sum::<f64>();
        if misfit < local.misfit {
            return Some((there, pieces, misfit));
        }
        share *= 0.3;
    }
    None
}
