//! The estimates and how sure they are.

use super::{
    binding::{self, Free},
    interval::{self, Interval, Spread},
    problem::Problem,
    search::{End, Found},
};

/// A fitted parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Its name.
    pub name: String,
    /// Its nominal value [its unit].
    pub given: f64,
    /// Its fitted value.
    pub found: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Whether it lies further from its nominal value than two standard errors and one per cent.
    pub moved: bool,
    /// Whether the record identifies it: the 95 % interval is closed on both sides, or was not asked for and
    /// the standard error is finite.
    pub identified: bool,
    /// The 95 % interval by profile likelihood; a side that is not there was not found.
    pub interval: [Option<f64>; 2],
    /// The 95 % interval from the standard error.
    pub asymptotic: [f64; 2],
    /// The 95 % interval of the bootstrap over blocks.
    pub bootstrap: Option<[f64; 2]>,
    /// Whether it ended as far from its nominal size as it may go.
    pub at_bound: bool,
}

pub(super) fn correlation(spread: &Spread) -> Vec<Vec<f64>> {
    let c = &spread.covariance;
    (0..c.nrows())
        .map(|i| (0..c.nrows()).map(|j| c[(i, j)] / (c[(i, i)] * c[(j, j)]).sqrt()).collect())
        .collect()
}

pub(super) fn estimates(
    problem: &Problem<'_>,
    found: &Found,
    spread: &Spread,
    (profiles, drawn, asked): (&[Interval], &[Option<[f64; 2]>], bool),
) -> Vec<Estimate> {
    let one = |(i, free): (usize, &Free)| {
        let at = |x: f64| {
            let mut there = found.x.clone();
            there[i] = x;
            problem.value(i, &there)
        };
        let value = at(found.x[i]);
        let error = spread.covariance[(i, i)].sqrt() * spread.inflation[i];
        let slope = free.slope(free.value(found.x[i])).abs();
        let standard_error = slope * error;
        let mut interval = profiles[i].map(|x| x.map(at));
        if matches!(free.scale, binding::Scale::InverseSquare(_)) {
            interval.reverse();
        }
        Estimate {
            name: free.name.clone(),
            given: free.given,
            found: value,
            standard_error,
            moved: (value - free.given).abs() > (2.0 * standard_error).max(0.01 * free.given.abs()),
            identified: found.end == End::Converged
                && standard_error.is_finite()
                && (!asked || interval.iter().all(Option::is_some)),
            interval,
            asymptotic: [-1.0, 1.0].map(|s| value + s * interval::NORMAL * standard_error),
            bootstrap: drawn[i],
            at_bound: free.at_bound(free.value(found.x[i])),
        }
    };
    problem.free.iter().enumerate().map(one).collect()
}
