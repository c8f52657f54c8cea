//! A run against the exact answer, in several norms.
//!
//! Errors are taken at the solver's own accepted steps, with no interpolation of ours in between, or at the
//! times that a method of our own delivers, which are many and none of its choosing; and are relative to the largest response of the exact answer: the force under an imposed motion, the
//! displacement of a plant.

use crate::plan::{Case, Plan, control_name, corners_name};
use duhem::closed_form::Reference;
use integrate::{Outcome, Run, Trajectory};
use record::{CaseRecord, CaseRow, History};
use simulation::Motion;

/// How near to a kink counts as near, as a share of the period.
pub const NEAR_A_KINK: f64 = 1.0 / 20.0;
/// The smallest error that is told apart from none: digits do not exceed 16.
const SMALLEST: f64 = 1e-16;
/// The stretches of time a history is thinned to; each keeps its smallest and its largest step.
const HISTORY: f64 = 300.0;
/// Points at which the exact answer's largest response is looked for, besides its kinks.
const PROBES: u32 = 1000;

/// The exact response at `t`.
fn exact_response(motion: &dyn Motion, reference: &dyn Reference, t: f64, x: &mut [f64]) -> f64 {
    reference.state(t, x);
    motion.response(t, x)
}

/// The largest absolute response of the exact answer over the span.
pub(crate) fn largest_response(
    motion: &dyn Motion,
    reference: &dyn Reference,
    (span, n): (f64, usize),
) -> f64 {
    let mut x = vec![0.0; n];
    let grid = (0..=PROBES).map(|i| span * f64::from(i) / f64::from(PROBES));
    grid.chain(kinks(motion, reference))
        .map(|t| exact_response(motion, reference, t, &mut x).abs())
        .fold(0.0, f64::max)
}

/// The record of one finished case.
pub(crate) fn record(
    plan: &Plan,
    case: &Case,
    run: &Run,
    motion: &dyn Motion,
    reference: &dyn Reference,
) -> CaseRecord {
    let study = &plan.studies[case.study];
    let errors = errors(&run.trajectory, motion, reference, study.span);
    let norms = Norms::of(&run.trajectory.t, &errors, &kinks(motion, reference), study.period);
    let (status, detail, at) = match &run.outcome {
        Outcome::Solved => ("solved".to_owned(), String::new(), study.span),
        Outcome::Failed { at, why } => (why.name().to_owned(), detail(why), *at),
    };
    let row = CaseRow {
        status,
        detail,
        reached: at / study.span,
        error_final: norms.last,
        error_max: norms.max,
        error_l2: norms.l2,
        error_away: norms.away,
        digits: norms.max.map(|e| -e.max(SMALLEST).log10()),
        evaluations: run.work.evaluations,
        jacobians: run.work.jacobians,
        accepted: run.work.accepted,
        rejected: run.work.rejected,
        ..named(case)
    };
    CaseRecord { row, history: case.history.then(|| history(&run.trajectory, &errors)) }
}

/// A case's row with its names and nothing measured.
pub(crate) fn named(case: &Case) -> CaseRow {
    CaseRow {
        solver: case.solver.name().to_owned(),
        library: case.solver.library().to_owned(),
        control: control_name(case.solver).to_owned(),
        value: case.value,
        corners: corners_name(case.corners).to_owned(),
        ..CaseRow::default()
    }
}

/// The words of a failure beyond its name.
fn detail(why: &integrate::Failure) -> String {
    match why {
        integrate::Failure::Panicked(words) | integrate::Failure::Stopped(words) => words.clone(),
        _ => String::new(),
    }
}

/// The relative error at every accepted step.
fn errors(
    trajectory: &Trajectory,
    motion: &dyn Motion,
    reference: &dyn Reference,
    span: f64,
) -> Vec<f64> {
    let n = trajectory.n;
    let scale = largest_response(motion, reference, (span, n));
    let mut x = vec![0.0; n];
    let mut error = |(i, t): (usize, &f64)| {
        let ours = motion.response(*t, &trajectory.y[i * n..(i + 1) * n]);
        (ours - exact_response(motion, reference, *t, &mut x)).abs() / scale
    };
    trajectory.t.iter().enumerate().map(&mut error).collect()
}

/// The kinks of the exact solution: corners of the input, and where a force arrives at its limit.
pub(crate) fn kinks(motion: &dyn Motion, reference: &dyn Reference) -> Vec<f64> {
    let mut kinks = [motion.corners().to_vec(), reference.kinks()].concat();
    kinks.sort_by(f64::total_cmp);
    kinks
}

/// The larger of two errors; not a number if either is, which `f64::max` would drop.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

#[derive(Debug, Default)]
struct Norms {
    last: Option<f64>,
    max: Option<f64>,
    l2: Option<f64>,
    away: Option<f64>,
}

impl Norms {
    /// The norms of the errors at times `t`; none where there is nothing finite to take one of.
    fn of(t: &[f64], errors: &[f64], kinks: &[f64], period: f64) -> Self {
        let finite = |e: f64| e.is_finite().then_some(e);
        let largest = |e: &mut dyn Iterator<Item = f64>| e.reduce(larger).and_then(finite);
        let near = |t: f64| {
            let next = kinks.partition_point(|kink| *kink < t);
            let mut around = kinks[next.saturating_sub(1)..].iter().take(2);
            around.any(|kink| (kink - t).abs() < NEAR_A_KINK * period)
        };
        let squares: f64 = (1..t.len())
            .map(|i| (t[i] - t[i - 1]) * 0.5 * (errors[i].powi(2) + errors[i - 1].powi(2)))
            .sum();
        let length = t.last().unwrap_or(&0.0) - t.first().unwrap_or(&0.0);
        Self {
            last: errors.last().copied().and_then(finite),
            max: largest(&mut errors.iter().copied()),
            l2: finite((squares / length).sqrt()),
            away: largest(&mut t.iter().zip(errors).filter(|(t, _)| !near(**t)).map(|(_, e)| *e)),
        }
    }
}

/// The steps thinned: from each of some stretches of time the smallest and the largest.
fn history(trajectory: &Trajectory, errors: &[f64]) -> History {
    let t = &trajectory.t;
    let stretch = (t.last().unwrap_or(&0.0) - t.first().unwrap_or(&0.0)) / HISTORY;
    let steps: Vec<usize> = (1..t.len()).filter(|i| errors[*i].is_finite()).collect();
    let step = |i: usize| t[i] - t[i - 1];
    let mut kept = Vec::new();
    for place in steps.chunk_by(|a, b| (t[*a] / stretch).floor() == (t[*b] / stretch).floor()) {
        let by_step = |a: &&usize, b: &&usize| step(**a).total_cmp(&step(**b));
        let ends = [place.iter().min_by(by_step), place.iter().max_by(by_step)];
        kept.extend(ends.into_iter().flatten().copied());
    }
    kept.sort_unstable();
    kept.dedup();
    History {
        t: kept.iter().map(|i| t[*i]).collect(),
        step: kept.iter().map(|i| step(*i)).collect(),
        value: kept.iter().map(|i| trajectory.y[i * trajectory.n]).collect(),
        error: kept.iter().map(|i| errors[*i]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::{NEAR_A_KINK, Norms};

    #[test]
    fn the_norms_of_a_known_error() {
        // A period of 100 s with a kink at 50 s: 5 s about it are near.
        let t = [0.0, 10.0, 48.0, 50.0, 60.0, 100.0];
        let errors = [0.0, 1e-3, 5e-3, 9e-3, 2e-3, 1e-3];
        let norms = Norms::of(&t, &errors, &[50.0], 100.0);
        assert_eq!((norms.last, norms.max, norms.away), (Some(1e-3), Some(9e-3), Some(2e-3)));
        assert!((NEAR_A_KINK - 0.05).abs() < 1e-15);
        let squares = 10.0 * 0.5 + 38.0 * 13.0 + 2.0 * 53.0 + 10.0 * 42.5 + 40.0 * 2.5;
        let expected = (squares * 1e-6 / 100.0_f64).sqrt();
        assert!((norms.l2.unwrap() - expected).abs() < 1e-12, "{:?} and {expected}", norms.l2);
    }

    #[test]
    fn an_error_that_is_no_number_is_no_small_error() {
        for errors in [[f64::NAN, 1e-3], [1e-3, f64::NAN]] {
            let norms = Norms::of(&[0.0, 1.0], &errors, &[], 10.0);
            assert_eq!((norms.max, norms.l2, norms.away), (None, None, None));
        }
    }
}
