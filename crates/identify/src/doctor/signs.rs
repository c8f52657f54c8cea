//! Whether the channels of a record agree with each other in sign, scale and time.

use super::Findings;
use super::motion::Track;
use super::series::n;
use crate::rig::Rig;
use std::f64::consts::{PI, TAU};

/// The largest shift of the velocity that is looked for [samples].
const FARTHEST: usize = 20;

/// Finds signs, scales and delays that do not agree.
pub(super) fn examine(rig: &Rig, track: &Track, findings: &mut Findings) {
    if let Some(velocity) = &track.velocity {
        of_velocity(rig, track, velocity, findings);
    }
    of_cells(rig, track, findings);
    of_drive(track, findings);
}

/// How the travel and the integral of the velocity compare, the velocity taken `shift` samples later.
struct Likeness {
    /// Correlation squared [1], negative where one falls as the other rises.
    correlation: f64,
    /// Travel for a unit of the integral. The noise of the velocity is the larger one, so the travel is
    /// taken as exact.
    scale: f64,
}

fn likeness(track: &Track, integral: &[f64], shift: isize) -> Likeness {
    let (length, rows) = (2 * track.reach, integral.len());
    let (mut qq, mut qv, mut vv) = (0.0, 0.0, 0.0);
    let mut i = FARTHEST;
    while i + length + FARTHEST < rows {
        let j = i.saturating_add_signed(shift);
        let travel = track.position[i + length] - track.position[i];
        let other = integral[j + length] - integral[j];
        qq += travel * travel;
        qv += travel * other;
        vv += other * other;
        i += length;
    }
    let correlation = if qq * vv > 0.0 { qv * qv.abs() / (qq * vv) } else { 0.0 };
    Likeness { correlation, scale: if qv == 0.0 { 0.0 } else { qq / qv } }
}

fn of_velocity(rig: &Rig, track: &Track, velocity: &[f64], findings: &mut Findings) {
    let position = track.kind.displacement;
    let mut integral = vec![0.0; velocity.len()];
    for i in 1..velocity.len() {
        let step = track.time[i] - track.time[i - 1];
        integral[i] = integral[i - 1] + 0.5 * step * (velocity[i] + velocity[i - 1]);
    }
    let still = likeness(track, &integral, 0);
    let farthest = FARTHEST.cast_signed();
    let like = |shift| likeness(track, &integral, shift);
    let size = |shift: isize| like(shift).correlation.abs();
    let Some(best) = (-farthest..=farthest).max_by(|a, b| size(*a).total_cmp(&size(*b))) else {
        return;
    };
    let found = like(best);
    if found.correlation.abs() < 0.5 {
        if track.range() > 20.0 * track.grain && track.time.len() > 4 * FARTHEST {
            let text = format!(
                "does not follow the derivative of the {position}: correlation squared {}",
                n(found.correlation.abs())
            );
            findings.problem(
                "unlike",
                "velocity",
                text,
                "see whether the columns are the right ones",
            );
        }
        return;
    }
    let (left, right) = (size(best - 1), size(best + 1));
    let bend = left - 2.0 * size(best) + right;
    let inside = best.abs() < farthest && bend < 0.0;
    let shift = best as f64 + if inside { 0.5 * (left - right) / bend } else { 0.0 };
    let better = 1.0 - size(best) < 0.5 * (1.0 - still.correlation.abs());
    if shift.abs() >= 0.9 && better {
        let text = format!(
            "comes {} samples ({} s) {} the derivative of the {position}",
            n(shift.abs()),
            n(shift.abs() * track.step),
            if shift > 0.0 { "after" } else { "before" }
        );
        findings.problem("delay", "velocity", text, "shift the column, or leave the velocity out");
    }
    if found.correlation < 0.0 {
        let text = format!("falls where the {position} rises faster: its sign is the other way");
        findings.problem(
            "sign",
            "velocity",
            text,
            "give its unit a minus in the rig file, as \"-rad/s\"",
        );
    }
    of_scale(rig, track, found.scale.abs(), findings);
}

/// Names the mistake whose factor the scale is.
fn of_scale(rig: &Rig, track: &Track, scale: f64, findings: &mut Findings) {
    let near = |factor: f64| (scale / factor).ln().abs() < 0.05;
    if near(1.0) {
        return;
    }
    let units: &[(f64, &str)] = if track.kind.turns() {
        &[
            (1.0, ""),
            (TAU / 60.0, "velocity looks like rpm read as rad/s"),
            (TAU, "velocity looks like rev/s read as rad/s"),
            (PI / 180.0, "velocity looks like deg/s read as rad/s"),
            (180.0 / PI, "angle looks like deg read as rad"),
            (1.0 / TAU, "angle looks like rev read as rad"),
            (1e-3, "time looks like ms read as s"),
        ]
    } else {
        &[
            (1e-3, "velocity looks like mm/s read as m/s, or time like ms read as s"),
            (1e3, "position looks like mm read as m"),
            (1e-2, "velocity looks like cm/s read as m/s"),
        ]
    };
    let ratio = if track.kind.geared() { rig.value("gear_ratio") } else { None };
    let gears: Vec<(f64, &str)> = [(1.0, "")]
        .into_iter()
        .chain(
            ratio.map(|g| (g, "angle and velocity look like taken on different sides of the gear")),
        )
        .chain(ratio.map(|g| (1.0 / g, "velocity looks like the motor's, not the drum's")))
        .collect();
    let both = gears.iter().flat_map(|g| units.iter().map(move |u| (g, u)));
    let named = both.filter(|(g, u)| near(g.0 * u.0)).find(|(g, u)| g.0 * u.0 != 1.0);
    let text = match named {
        Some(((_, gear), (_, unit))) => {
            let words: Vec<&str> = [*unit, *gear].into_iter().filter(|w| !w.is_empty()).collect();
            words.join("; ")
        }
        None => format!("does not fit the derivative of the {}", track.kind.displacement),
    };
    let text = format!("{text}: the travel is {} times the integral of the velocity", n(scale));
    let remedy = "say the unit and the side (at = \"motor\") in the rig file";
    findings.problem("scale", "velocity", text, remedy);
}

/// The load cells rise and fall with the angle as F₁ = F₁₀ + k₁rθ and F₂ = F₂₀ − k₂rθ say.
fn of_cells(rig: &Rig, track: &Track, findings: &mut Findings) {
    let mut turned = Vec::new();
    for (name, force) in &track.cells {
        let (slope, correlation) = line(&track.position, force);
        let first = *name == "force_1";
        let key = if first { "k_1" } else { "k_2" };
        let stiffness = rig.value(key).zip(rig.value("radius")).map_or(0.0, |(k, r)| k * r);
        if correlation < 0.25 {
            continue;
        }
        if (slope > 0.0) != first {
            turned.push((*name, slope));
        } else if !(0.5..2.0).contains(&(slope.abs() / stiffness)) {
            let text = format!(
                "changes by {} N/rad where {key}·radius is {} N/rad in the rig file",
                n(slope.abs()),
                n(stiffness)
            );
            let remedy = "see its unit, and whether its string goes slack; or free the spring";
            findings.note("slope", name, text, remedy);
        }
    }
    let swapped = turned.len() == 2;
    for (name, slope) in turned {
        let text = format!("changes by {} N/rad with the angle, the wrong way", n(slope));
        let remedy = if swapped {
            "exchange the two load cells in the rig file, or turn the sign of the angle"
        } else {
            "give its unit a minus in the rig file: \"-N\""
        };
        findings.problem("sign", name, text, remedy);
    }
}

/// Slope of the line through the points, and the correlation squared.
fn line(x: &[f64], y: &[f64]) -> (f64, f64) {
    let count = x.len() as f64;
    let (mx, my) = (x.iter().sum::<f64>() / count, y.iter().sum::<f64>() / count);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        xx += (x - mx) * (x - mx);
        xy += (x - mx) * (y - my);
        yy += (y - my) * (y - my);
    }
    if xx * yy > 0.0 { (xy / xx, xy * xy / (xx * yy)) } else { (0.0, 0.0) }
}

/// Friction takes energy out, so that over some swings the drive puts energy in.
fn of_drive(track: &Track, findings: &mut Findings) {
    let (Some(first), Some(last)) = (track.turns.first(), track.turns.last()) else { return };
    let (mut work, mut size) = (0.0, 0.0);
    for i in *first..*last {
        let travel = track.position[i + 1] - track.position[i];
        let part = 0.5 * (track.drive[i] + track.drive[i + 1]) * travel;
        work += part;
        size += part.abs();
    }
    let name = track.kind.drives.first().copied().unwrap_or_default();
    if track.turns.len() >= 3 && work < -0.2 * size {
        let text = format!(
            "takes energy out of the motion over {} swings ({} % of what goes to and fro), where friction \
             has to be fed: its sign is the other way",
            track.turns.len() - 1,
            n(-100.0 * work / size)
        );
        let remedy =
            "give the unit of the drive or of the position a minus in the rig file, as \"-A\"";
        findings.problem("sign", name, text, remedy);
    }
}
