//! The clock of a record.

use super::series::{median_step, n};
use super::{Findings, Sampling, Series, examine_values};
use crate::recording::{FEWEST_ROWS, GAP, usable};

/// A jitter [steps] from which on the stamps have to be used one by one.
const JITTER: f64 = 0.01;

/// Which column is the time, where no rig says it: one with a telling name, or the first that increases.
pub(super) fn guess(all: &[Series], findings: &mut Findings) -> Option<usize> {
    let telling = |name: &str| {
        let name = name.trim().to_lowercase();
        name == "t" || ["time", "t_", "t [", "t(", "t/"].iter().any(|start| name.starts_with(start))
    };
    let rises = |s: &Series| {
        s.values.len() >= FEWEST_ROWS && s.values.windows(2).all(|w| w[1] > w[0] && usable(w[1]))
    };
    let guess = all.iter().position(|s| telling(&s.name)).or_else(|| all.iter().position(rises));
    if let Some(i) = guess {
        let text =
            "is taken for the time in seconds, as no rig file says which column is".to_owned();
        findings.note("clock", &all[i].name, text, "name the columns with --rig RIG");
    } else {
        let text = "no column has the name of a time or increases from row to row".to_owned();
        findings.problem("clock", "", text, "name the columns with --rig RIG");
    }
    guess
}

/// Finds what is wrong with the stamps.
pub(super) fn examine(time: &Series, findings: &mut Findings) -> Option<Sampling> {
    examine_values(time, findings);
    let name = time.name.as_str();
    let step = median_step(&time.values);
    if step <= 0.0 {
        let text = "no stamp is later than the one before".to_owned();
        findings.problem("clock", name, text, "name the column of the time in the rig file");
        return None;
    }
    let found = |of: &dyn Fn(f64) -> bool| {
        let rows: Vec<usize> =
            (1..time.values.len()).filter(|i| of(time.values[*i] - time.values[i - 1])).collect();
        Some((rows.len(), *rows.first()?, *rows.last()?))
    };
    if let Some((count, first, last)) = found(&|d| d == 0.0) {
        let text = format!("{count} stamps repeat the one before");
        findings.problem("duplicate", name, text, "drop the repeated rows");
        findings.rows(first, last);
    }
    if let Some((count, first, last)) = found(&|d| d < 0.0) {
        let text = format!("{count} stamps go back");
        findings.problem("backward", name, text, "sort the rows, or cut the record there");
        findings.rows(first, last);
    }
    let gaps = found(&|d| d > GAP * step && usable(d));
    if let Some((count, first, last)) = gaps {
        let steps = time.values.windows(2).map(|w| w[1] - w[0]).filter(|d| usable(*d));
        let longest = steps.fold(0.0, f64::max);
        let text = format!(
            "{count} gaps above {GAP} steps of {} s, the longest {} s",
            n(step),
            n(longest)
        );
        findings.problem(
            "gap",
            name,
            text,
            "cut the record there, or fit its stretches as windows",
        );
        findings.rows(first, last);
    }
    let jitter = jitter(time, step, findings);
    let mut good = time.values.iter().filter(|v| usable(**v));
    let first = good.next().copied().unwrap_or(0.0);
    let last = good.next_back().copied().unwrap_or(first);
    Some(Sampling {
        column: name.to_owned(),
        rows: time.values.len(),
        duration: last - first,
        step,
        jitter,
        gaps: gaps.map_or(0, |(count, _, _)| count),
    })
}

/// The variation of the steps that are no gaps, in usual steps.
fn jitter(time: &Series, step: f64, findings: &mut Findings) -> f64 {
    let steps = time.values.windows(2).map(|w| (w[1] - w[0]) / step - 1.0);
    let regular: Vec<f64> = steps.filter(|d| *d > -1.0 && *d <= GAP - 1.0).collect();
    let squares: f64 = regular.iter().map(|d| d * d).sum();
    let jitter = (squares / regular.len().max(1) as f64).sqrt();
    if jitter > JITTER {
        let text = format!("the steps vary by {} % (standard deviation)", n(100.0 * jitter));
        let remedy = "use the stamps as they are only if the clock that wrote them is the sensors'";
        findings.note("jitter", &time.name, text, remedy);
    }
    jitter
}
