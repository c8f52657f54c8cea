//! Ordinary least squares with standard errors for residuals that hang together in time.

use nalgebra::{DMatrix, DVector};

/// A solved regression y = X β + e.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Solution {
    /// Coefficients β.
    pub beta: Vec<f64>,
    /// Covariance of β after Newey and West, row-major.
    pub covariance: Vec<f64>,
    /// Standard errors of β as if the residuals were independent.
    pub classical: Vec<f64>,
    /// Residuals e = y − X β.
    pub residual: Vec<f64>,
    /// Condition number of X with its columns scaled to length one [1].
    pub condition: f64,
    /// Lags of the residuals that the covariance accounts for [rows].
    pub lag: usize,
}

/// A column that the others make up, or one of zeros, by its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dependent(pub usize);

/// Below this share of its length a column has nothing of its own, only rounding.
const OWN_SHARE: f64 = 1e-9;

/// Solves y = X β for the columns of X, of equal length and with more rows than columns; `lag` in rows,
/// chosen by [`plug_in_lag`] if none is given.
pub(super) fn solve(
    columns: &[Vec<f64>],
    y: &[f64],
    lag: Option<usize>,
) -> Result<Solution, Dependent> {
    let (n, p) = (y.len(), columns.len());
    let lengths: Vec<f64> = columns.iter().map(|column| norm(column)).collect();
    if let Some(zero) = lengths.iter().position(|length| *length == 0.0) {
        return Err(Dependent(zero));
    }
    let x = DMatrix::from_fn(n, p, |i, j| columns[j][i] / lengths[j]);
    let y = DVector::from_column_slice(y);
    let (q, r) = x.clone().qr().unpack();
    if let Some(j) = (0..p).find(|j| r[(*j, *j)].abs() < OWN_SHARE) {
        return Err(Dependent(j));
    }
    let scaled = r.solve_upper_triangular(&(q.transpose() * &y)).ok_or(Dependent(0))?;
    let inverse = r.solve_upper_triangular(&DMatrix::identity(p, p)).ok_or(Dependent(0))?;
    let residual = y - &x * &scaled;
    let singular = r.singular_values();
    let free = (n - p) as f64;
    let variance = residual.norm_squared() / free;
    // The scores q_ij e_i: their long-run covariance is what the independence of the residuals would make σ²I.
    let scores = DMatrix::from_fn(n, p, |i, j| q[(i, j)] * residual[i]);
    let lag = lag.unwrap_or_else(|| plug_in_lag(&scores)).min(n - 1);
    let middle = long_run(&scores, lag) * (n as f64 / free);
    let covariance = &inverse * middle * inverse.transpose();
    let unscale = |i: usize, j: usize| covariance[(i, j)] / (lengths[i] * lengths[j]);
    Ok(Solution {
        beta: (0..p).map(|j| scaled[j] / lengths[j]).collect(),
        covariance: (0..p * p).map(|k| unscale(k / p, k % p)).collect(),
        classical: (0..p).map(|j| variance.sqrt() * inverse.row(j).norm() / lengths[j]).collect(),
        residual: residual.as_slice().to_vec(),
        condition: singular.max() / singular.min(),
        lag,
    })
}

pub(super) fn norm(values: &[f64]) -> f64 {
    let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    largest * values.iter().map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}

/// Σᵢ sᵢsᵢᵀ + Σₗ (1 − l/(L + 1)) Σᵢ (sᵢsᵢ₋ₗᵀ + sᵢ₋ₗsᵢᵀ), l from 1 to the lag L: Newey and West, Econometrica 55 (1987).
fn long_run(scores: &DMatrix<f64>, lag: usize) -> DMatrix<f64> {
    let n = scores.nrows();
    let mut sum = scores.transpose() * scores;
    for l in 1..=lag {
        let weight = 1.0 - l as f64 / (lag + 1) as f64;
        let shifted = scores.rows(l, n - l).transpose() * scores.rows(0, n - l);
        sum += (&shifted + shifted.transpose()) * weight;
    }
    sum
}

/// The lag that suits scores of the first order: 1.1447 (α n)^(1/3) with α = 4ρ²/((1 − ρ)²(1 + ρ)²), after
/// Andrews, Econometrica 59 (1991), for the column whose ρ asks for most. At most a tenth of the rows.
fn plug_in_lag(scores: &DMatrix<f64>) -> usize {
    let n = scores.nrows();
    let lag = |column: nalgebra::DVectorView<'_, f64>| {
        let s = column.as_slice();
        let (before, after) = (&s[..n - 1], &s[1..]);
        let product: f64 = before.iter().zip(after).map(|(a, b)| a * b).sum();
        let square: f64 = before.iter().map(|a| a * a).sum();
        let rho = if square > 0.0 { (product / square).clamp(-0.97, 0.97) } else { 0.0 };
        let alpha = 4.0 * rho * rho / ((1.0 - rho).powi(2) * (1.0 + rho).powi(2));
        1.1447 * (alpha * n as f64).cbrt()
    };
    let most = (0..scores.ncols()).map(|j| lag(scores.column(j))).fold(0.0, f64::max);
    let cap = n / 10;
    // Counted up rather than cast: the cap ends it.
    (0..cap).find(|l| *l as f64 >= most).unwrap_or(cap)
}
