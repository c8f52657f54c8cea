//! Quantities of a fit: its parameters, and what its record and its simulations show without it.

use super::{Measured, NORMAL, OF_A_FIT, PARAMETER, Quantity, SPRING};
use crate::{
    fits::{Motions, Runs, Which, ends, middle},
    plan::{Fit, Plan, Subject},
};
use record::{ModelRow, ParameterRow};
use std::{f64::consts::TAU, ops::Range};

macro_rules! quantity {
    ($const:ident, $name:literal, $unit:expr, $what:literal, ($method:literal, $second:literal), $takes:expr, $measure:expr) => {
        pub(super) const $const: Quantity = Quantity {
            name: $name,
            model: OF_A_FIT,
            unit: $unit,
            what: $what,
            method: $method,
            second: $second,
            code: concat!("crates/experiment/src/quantities/fit.rs, ", stringify!($const)),
            takes: $takes,
            measure: $measure,
        };
    };
}

quantity!(
    FITTED,
    "fitted",
    PARAMETER,
    "fitted parameter",
    ("the fit by simulated motions", "the truth the record was made with, and its 95 % interval"),
    &[],
    |plan, subject| {
        let row = parameter(at(plan, subject), &subject.expect)?;
        let truth = row.truth.ok_or_else(|| format!("no truth of {}", subject.expect))?;
        let mut found = Measured::of(row.found, truth);
        found.error = found.error.max(NORMAL * row.standard_error);
        Ok(found)
    }
);

quantity!(
    SPRING_SLOPE,
    "spring_slope",
    SPRING,
    "stiffness of a spring from its load cell alone",
    ("straight line through force against radius times angle", "the fit's estimate"),
    &[],
    |plan, subject| {
        let fit = at(plan, subject);
        let (key, cell, side) = match subject.expect.as_str() {
            "force_1" => ("k_1", "force_1", 1.0),
            "force_2" => ("k_2", "force_2", -1.0),
            other => return Err(format!("found `{other}`: expected force_1 or force_2")),
        };
        let force = fit.recording.channels.get(cell).ok_or_else(|| format!("no {cell}"))?;
        let angle = fit.data.displacement.as_ref().ok_or("no angle")?;
        let radius = fit.rig.value("radius").ok_or("no radius")?;
        Ok(Measured::of(side * slope(&angle.values, force) / radius, parameter(fit, key)?.found))
    }
);

quantity!(
    DRIVE_BIAS,
    "drive_bias",
    "N",
    "bias of the drive that the record shows",
    ("mean of the drive over whole periods", "the fit's `offset`"),
    &["period"],
    |plan, subject| {
        let fit = at(plan, subject);
        let drive = Motions::of(&Runs::of_fit(fit)?, Which::Record, 1.0)?.drive;
        let settled = &drive[settled(fit, subject)?];
        let mean = settled.iter().sum::<f64>() / settled.len() as f64;
        Ok(Measured::of(mean, parameter(fit, "offset")?.found))
    }
);

quantity!(
    DRIVE_HALF_SPAN,
    "drive_half_span",
    "N",
    "half the span of the recorded drive",
    ("largest and smallest sample of whole periods", "amplitude of the drive's first harmonic"),
    &["period"],
    |plan, subject| {
        let fit = at(plan, subject);
        let drive = Motions::of(&Runs::of_fit(fit)?, Which::Record, 1.0)?.drive;
        let range = settled(fit, subject)?;
        let [low, high] = ends(&drive[range.clone()]);
        let [period] = subject.argument("period")?;
        let (mut cosine, mut sine) = (0.0, 0.0);
        for i in range.clone() {
            let phase = TAU * fit.recording.time[i] / period;
            cosine += drive[i] * phase.cos();
            sine += drive[i] * phase.sin();
        }
        let harmonic = 2.0 * f64::hypot(cosine, sine) / range.len() as f64;
        Ok(Measured::of(0.5 * (high - low), harmonic))
    }
);

quantity!(
    LOOP_HEIGHT,
    "loop_height",
    "m",
    "span of the displacement over the last whole periods",
    ("largest and smallest sample", "the same of the last period; simulated, with finer steps"),
    &["period"],
    |plan, subject| {
        let fit = at(plan, subject);
        let which = Which::of(&subject.expect)?;
        let all = settled(fit, subject)?;
        let height = |q: &[f64]| {
            let [low, high] = ends(q);
            high - low
        };
        let motion = Motions::of(&Runs::of_fit(fit)?, which, 1.0)?;
        let found = height(&motion.q[all.clone()]);
        if which == Which::Record {
            let [period] = subject.argument("period")?;
            let end = fit.recording.time[all.end - 1];
            let last = Motions::within(&fit.recording.time, [end - period, end]);
            let mut measured = Measured::of(found, height(&motion.q[last]));
            // No span is known better than the encoder's step.
            measured.error = measured.error.max(quantum(fit));
            return Ok(measured);
        }
        Ok(Measured::of(found, height(&Motions::of(&Runs::of_fit(fit)?, which, 100.0)?.q[all])))
    }
);

quantity!(
    LOOP_MISFIT,
    "loop_misfit",
    "m",
    "root mean square distance of the simulated displacement from the recorded one, each about its middle",
    ("simulated from the record's first sample", "the same with finer steps"),
    &["period"],
    |plan, subject| {
        let fit = at(plan, subject);
        let which = Which::of(&subject.expect)?;
        let range = settled(fit, subject)?;
        let record = Motions::of(&Runs::of_fit(fit)?, Which::Record, 1.0)?;
        let distance = |finer: f64| -> Result<f64, String> {
            let q = Motions::of(&Runs::of_fit(fit)?, which, finer)?.q;
            let shift = middle(&q[range.clone()]) - middle(&record.q[range.clone()]);
            let square = |i: usize| (q[i] - record.q[i] - shift).powi(2);
            Ok((range.clone().map(square).sum::<f64>() / range.len() as f64).sqrt())
        };
        Ok(Measured::of(distance(1.0)?, distance(100.0)?))
    }
);

quantity!(
    HELD_OUT_ERROR,
    "held_out_error",
    "1",
    "residual of a friction model on blocks it was not fitted to, in units of the noise",
    ("root mean square over the blocks held out", "the same over the blocks it was fitted to"),
    &[],
    |plan, subject| {
        let row = model(at(plan, subject), &subject.expect)?;
        Ok(Measured::of(row.held_out, row.trained))
    }
);

quantity!(
    INTERVALS_WITH_TRUTH,
    "intervals_with_truth",
    "1",
    "how many 95 % intervals contain the truth",
    ("intervals by profile likelihood", "intervals from standard errors"),
    &[],
    |plan, subject| {
        let rows = &at(plan, subject).found()?.parameters;
        let inside = |low: f64, high: f64, truth: f64| (low..=high).contains(&truth);
        let count = |holds: &dyn Fn(&ParameterRow, f64) -> bool| {
            let of = |row: &&ParameterRow| row.truth.is_some_and(|truth| holds(row, truth));
            rows.iter().filter(of).count() as f64
        };
        let profile = count(&|row, truth| {
            inside(row.low.unwrap_or(f64::NEG_INFINITY), row.high.unwrap_or(f64::INFINITY), truth)
        });
        let asymptotic = count(&|row, truth| {
            let half = NORMAL * row.standard_error;
            inside(row.found - half, row.found + half, truth)
        });
        Ok(Measured::of(profile, asymptotic))
    }
);

/// The fit that is meant.
pub(crate) fn at<'a>(plan: &'a Plan, subject: &Subject) -> &'a Fit {
    &plan.fits[subject.study]
}

fn parameter<'a>(fit: &'a Fit, name: &str) -> Result<&'a ParameterRow, String> {
    let rows = &fit.found()?.parameters;
    rows.iter().find(|row| row.parameter == name).ok_or_else(|| {
        let known: Vec<&str> = rows.iter().map(|row| row.parameter.as_str()).collect();
        format!("found `{name}`: expected one of {}", known.join(", "))
    })
}

/// The row of a model by the beginning of its name: Maxwell-slip has its number of elements behind it.
pub(crate) fn model<'a>(fit: &'a Fit, name: &str) -> Result<&'a ModelRow, String> {
    let rows = &fit.found()?.models;
    let called = |row: &&ModelRow| row.model == name || row.model.starts_with(&format!("{name},"));
    rows.iter().find(called).ok_or_else(|| {
        let known: Vec<&str> = rows.iter().map(|row| row.model.as_str()).collect();
        format!("found `{name}`: expected one of {}", known.join("; "))
    })
}

/// The samples of as many whole periods as the second half of the record holds.
fn settled(fit: &Fit, subject: &Subject) -> Result<Range<usize>, String> {
    let [period] = subject.argument("period")?;
    let time = &fit.recording.time;
    let (start, end) = (time[0], time[time.len() - 1]);
    let count = (0.5 * (end - start) / period).floor();
    if !(period > 0.0 && count >= 1.0) {
        return Err(format!("period = {period} s: expected at most half the record's {end} s"));
    }
    // A period's end is the next one's start: one of the two counts.
    let range = Motions::within(time, [end - count * period + 1e-9 * end, end]);
    Ok(range)
}

/// The step of the encoder of the displacement; 0 where the rig file does not say it.
fn quantum(fit: &Fit) -> f64 {
    let channel = identify::rig::Kind::of(fit.rig.kind).map(|kind| kind.displacement);
    channel.and_then(|name| fit.recording.quantum.get(name)).copied().unwrap_or(0.0)
}

/// The slope of the straight line through y against x, by least squares.
fn slope(x: &[f64], y: &[f64]) -> f64 {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (x_mean, y_mean) = (mean(x), mean(y));
    let xy: f64 = x.iter().zip(y).map(|(x, y)| (x - x_mean) * (y - y_mean)).sum();
    let xx: f64 = x.iter().map(|x| (x - x_mean).powi(2)).sum();
    xy / xx
}

#[cfg(test)]
mod tests {
    use super::slope;

    #[test]
    fn a_straight_line_has_the_slope_it_was_made_with() {
        let x: Vec<f64> = (0..20).map(|i| f64::from(i) * 0.1).collect();
        let y: Vec<f64> = x.iter().map(|x| 3.0 - 0.7 * x).collect();
        assert!((slope(&x, &y) + 0.7).abs() < 1e-14, "{}", slope(&x, &y));
    }
}
