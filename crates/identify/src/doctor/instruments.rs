//! Each channel for itself: what its instrument did.

use super::series::{longest_run, n, noise, quantile, quantum};
use super::{Facts, Findings, Series, examine_values};
use crate::recording::{FEWEST_ROWS, usable};
use crate::rig::KINDS;

/// A run of so many samples at the largest value may be saturation.
const RUN: usize = 5;

/// What the channel shows, and what is wrong with it; nothing if it has no usable sample.
pub(super) fn examine(series: &Series, rig: bool, findings: &mut Findings) -> Option<Facts> {
    examine_values(series, findings);
    let good: Vec<f64> = series.values.iter().copied().filter(|v| usable(*v)).collect();
    let least = good.iter().copied().reduce(f64::min)?;
    let largest = good.iter().copied().reduce(f64::max)?;
    let step = quantum(&series.values);
    let floor = step.or(series.stated).map_or(0.0, |q| q / 12.0_f64.sqrt());
    let facts = Facts {
        name: series.name.clone(),
        unit: series.unit,
        missing: series.values.len() - good.len(),
        least,
        largest,
        quantum: step,
        noise: noise(&series.values).max(floor),
    };
    if good.len() < FEWEST_ROWS {
        return Some(facts);
    }
    if least == largest {
        constant(series, rig, least, findings);
        return Some(facts);
    }
    if let Some(stated) = series.stated {
        steps(series, step, stated, findings);
    }
    if series.measured {
        saturation(series, &facts, findings);
        outliers(series, &facts, good, findings);
    }
    Some(facts)
}

/// A channel that never changes tells nothing; a reference or an added input may rest.
fn constant(series: &Series, rig: bool, value: f64, findings: &mut Findings) {
    let text = format!("is {} {} throughout", n(value), series.unit).replace("  ", " ");
    if rig && series.measured {
        let remedy = "see whether the sensor was connected and the column is the right one";
        findings.problem("constant", &series.name, text, remedy);
    } else {
        findings.note("constant", &series.name, text, "leave it out if it should not be");
    }
}

/// The step in the samples against the one that the rig file states.
fn steps(series: &Series, found: Option<f64>, stated: f64, findings: &mut Findings) {
    let unit = series.unit;
    let noise = noise(&series.values);
    if let Some(found) = found.filter(|found| *found > 1.05 * stated) {
        let text = format!(
            "moves in steps of {} {unit} where the rig file states {} {unit}",
            n(found),
            n(stated)
        );
        let remedy = "see the unit, the gear and the encoder's count";
        findings.problem("quantum", &series.name, text, remedy);
    } else if found.is_none_or(|found| found < 0.5 * stated) && noise < 0.1 * stated {
        // Rounding to the stated step would leave stated/√12 = 0.29 of it.
        let text = format!(
            "is smoother than steps of {} {unit}, which the rig file states, would leave it (noise {} {unit})",
            n(stated),
            n(noise)
        );
        let remedy = "it was filtered or interpolated before it was written; its delay is then not the encoder's";
        findings.note("quantum", &series.name, text, remedy);
    }
}

/// A run of samples at the extreme that is entered at speed: a smooth signal comes to its turn slowly, in
/// the last samples before a run of length L by some eight quanta over L samples, for near the turn it is
/// a parabola.
fn saturation(series: &Series, facts: &Facts, findings: &mut Findings) {
    // Encoders do not saturate, and a drive that rests is no fault.
    if ["angle", "position", "displacement"].contains(&series.name.as_str()) {
        return;
    }
    let values = &series.values;
    let still = values.windows(2).filter(|w| w[0] == w[1]).count();
    for extreme in [facts.largest, facts.least] {
        let (first, length) = longest_run(values, extreme);
        let count = values.iter().filter(|v| **v == extreme).count();
        // A signal that stays at most of its levels is made of steps.
        let stepwise = 2 * still.saturating_sub(count) > values.len().saturating_sub(2 * count);
        if length < RUN || stepwise {
            continue;
        }
        let before = first.checked_sub(length).map(|i| values[i]);
        let after = values.get(first + 2 * length - 1).copied();
        let away = |v: Option<f64>| v.filter(|v| usable(*v)).map(|v| (v - extreme).abs());
        let Some(change) = away(before).into_iter().chain(away(after)).reduce(f64::min) else {
            continue;
        };
        let step = facts.quantum.unwrap_or(0.0).max(f64::EPSILON * extreme.abs());
        if change > 20.0 * step && change > 6.0 * facts.noise {
            let text = format!(
                "{count} samples are {} {}, up to {length} in a row: it looks saturated there",
                n(extreme),
                series.unit
            );
            let remedy = if KINDS.iter().any(|kind| kind.drives.contains(&series.name.as_str())) {
                "if it is a command that its controller limits there, nothing is wrong; else widen the range, or \
                 drive less, so that the extreme is measured"
            } else {
                "widen the range, or drive less, so that the extreme is measured"
            };
            findings.problem("saturated", &series.name, text, remedy);
            findings.rows(first, first + length - 1);
        }
    }
}

/// Single samples that leave their neighbours, which agree with each other, by half of all the signal spans.
fn outliers(series: &Series, facts: &Facts, mut good: Vec<f64>, findings: &mut Findings) {
    let span = quantile(&mut good, 0.99) - quantile(&mut good, 0.01);
    let least = (0.5 * span).max(10.0 * facts.noise);
    let far = |w: &[f64]| {
        let alone = (w[2] - 0.5 * (w[1] + w[3])).abs();
        let around = (w[3] - w[1]).abs().max((w[1] - w[0]).abs()).max((w[4] - w[3]).abs());
        w.iter().all(|v| usable(*v)) && alone > least && alone > 5.0 * around
    };
    let windows = series.values.windows(5).enumerate();
    let rows: Vec<usize> = windows.filter(|(_, w)| far(w)).map(|(i, _)| i + 2).collect();
    if let (Some(first), Some(last)) = (rows.first(), rows.last()) {
        let text = format!(
            "{} single samples leave their neighbours by more than {} {}, the first with {}",
            rows.len(),
            n(least),
            series.unit,
            n(series.values[*first])
        );
        let remedy = "see whether they are glitches of the transfer, and replace them if so";
        findings.problem("outlier", &series.name, text, remedy);
        findings.rows(*first, *last);
    }
}
