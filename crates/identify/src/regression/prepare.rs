//! From the record to the rows of the regression.

use super::{
    Options, RegressionError, Samples, Term,
    filter::{LowPass, decimate, decimator, differences, first_kept, gain_at_rest},
};

/// The rows.
pub(super) struct Prepared {
    /// The terms, one for each column.
    pub terms: Vec<Term>,
    /// The columns, decimated.
    pub columns: Vec<Vec<f64>>,
    /// The force, decimated [N] or [N·m].
    pub force: Vec<f64>,
    /// Their times [s].
    pub time: Vec<f64>,
    /// Samples with q̇ = 0.
    pub at_rest: usize,
    /// What decimation multiplies a constant by [1].
    pub gain: f64,
    /// Cut-off of the position's filter [Hz].
    pub cutoff: f64,
    /// Sampling rate [Hz].
    pub sampling: f64,
}

/// Beyond this size squares and products of samples would leave the range of f64.
const LARGEST: f64 = 1e100;

/// Divided twice by a shorter step [s] the largest samples would leave it, too.
const LEAST_STEP: f64 = 1e-12;

/// How far a step may be from the mean one, as a share of it: stamps may be rounded, but no sample may be
/// missing or stand twice.
const EVEN: f64 = 0.5;

/// Half the order of the position's filter.
const PAIRS: usize = 2;

/// Filters, differentiates, trims and decimates.
pub(super) fn prepare(
    samples: &Samples<'_>,
    options: &Options,
) -> Result<Prepared, RegressionError> {
    let terms = options.plant.terms(options.by_direction);
    check(samples)?;
    enough(samples.time.len(), options, terms.len())?;
    let step = step(samples.time)?;
    let (sampling, half) = (1.0 / step, 0.5 / step);
    let cutoff = options.cutoff.unwrap_or(0.1 * sampling);
    if !(cutoff > 0.0 && cutoff < half) {
        return Err(RegressionError::Cutoff { found: cutoff, below: half });
    }
    let q = LowPass::butterworth(PAIRS, cutoff / half).both_ways(samples.position);
    let v = differences(&q, step);
    let a = differences(&v, step);
    let kept = options.trim.0..q.len() - options.trim.1;
    let factor = options.decimation;
    let column = |term: &Term| {
        let at = |i: usize| term.column.at(q[i], v[i], a[i]);
        decimate(&kept.clone().map(at).collect::<Vec<_>>(), factor)
    };
    let net = |i: usize| samples.force[i] - options.known_damping * v[i];
    let time = &samples.time[kept.clone()];
    let first = if factor > 1 { first_kept(time.len(), factor) } else { 0 };
    Ok(Prepared {
        columns: terms.iter().map(column).collect(),
        terms,
        force: decimate(&kept.clone().map(net).collect::<Vec<_>>(), factor),
        time: time.iter().copied().skip(first).step_by(factor.max(1)).collect(),
        at_rest: v[kept].iter().filter(|v| **v == 0.0).count(),
        gain: gain_at_rest(factor),
        cutoff,
        sampling,
    })
}

/// The columns are of one length and hold numbers.
fn check(samples: &Samples<'_>) -> Result<(), RegressionError> {
    let expected = samples.time.len();
    let channels =
        [("time", samples.time), ("position", samples.position), ("force", samples.force)];
    for (channel, values) in channels {
        if values.len() != expected {
            return Err(RegressionError::Length { channel, found: values.len(), expected });
        }
        let usable = |v: &f64| v.abs() <= LARGEST;
        if let Some(i) = values.iter().position(|v| !usable(v)) {
            return Err(RegressionError::NotFinite { channel, row: i + 1, found: values[i] });
        }
    }
    Ok(())
}

/// There is something left behind both filters, ten rows for each coefficient.
fn enough(found: usize, options: &Options, terms: usize) -> Result<(), RegressionError> {
    let factor = options.decimation.max(1);
    let of_filters = 3 * decimator(2).order() + 1;
    let rows = factor.saturating_mul(10 * terms).max(of_filters);
    let expected = rows.saturating_add(options.trim.0).saturating_add(options.trim.1);
    if found < expected { Err(RegressionError::Short { found, expected }) } else { Ok(()) }
}

/// The sampling step [s], the same everywhere.
fn step(time: &[f64]) -> Result<f64, RegressionError> {
    let (first, last) = (time[0], time[time.len() - 1]);
    let mean = (last - first) / (time.len() - 1) as f64;
    let uneven = |w: &[f64]| (w[1] - w[0] - mean).abs() > EVEN * mean;
    match time.windows(2).position(uneven) {
        None if mean >= LEAST_STEP => Ok(mean),
        None => Err(RegressionError::Step { found: mean, least: LEAST_STEP }),
        Some(i) => {
            let found = time[i + 1] - time[i];
            Err(RegressionError::Uneven { row: i + 1, found, expected: mean })
        }
    }
}
