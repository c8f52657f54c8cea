//! The last word: two models run on a record, without any help from it.

use crate::Gap;
use identify::{
    Rig,
    fit::{Data, FitError, Simulated, Trace, simulate},
    rig,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

/// How many times the recorded input is perturbed by its own noise.
const TIMES: u64 = 3;

/// The first sample by which a command is judged: the samples before it are the drive's own coming to rest.
const FROM: usize = 49;

/// Two models run on a record, without any help from it.
#[derive(Debug, Clone)]
pub struct Confirmed {
    /// The misfit of every channel.
    pub gap: Vec<Gap>,
    /// The error of the simulated command, before and after [%]: 100 ‖u − û‖/‖u‖ over the samples from the 50th on, where
    /// û is the command that the rig's controller makes with the model in its loop. None where the rig declares no
    /// controller.
    pub command: Option<[f64; 2]>,
}

/// Runs `nominal` and `model` on `data`: in closed loop where the rig declares its controller, else in one run from the
/// first sample to the last.
///
/// Before is the misfit of `nominal`, not a number where it has no motion; after that of `model`; the floor is what
/// the noise of the sensors and of the recorded input leaves. Nothing is refitted: refit is not a number.
///
/// # Errors
/// A record too short or still, and a `model` that has no motion on it.
pub fn confirm(nominal: &Rig, model: &Rig, data: &Data) -> Result<Confirmed, FitError> {
    let data = &identify::known::still(data);
    let (before, after) =
        rayon::join(|| simulate(nominal, data, None), || simulate(model, data, None));
    let before = match before {
        Err(FitError::NoMotion) => None,
        other => Some(other?),
    };
    let after = after?;
    let spread = spread(model, data, &after);
    let all = after.gap.iter().zip(&spread).map(|(gap, spread)| {
        let there = before.as_ref().and_then(|b| b.gap.iter().find(|g| g.channel == gap.channel));
        Gap {
            channel: gap.channel.clone(),
            unit: unit(model, &gap.channel),
            before: there.map_or(f64::NAN, |g| g.after),
            refit: f64::NAN,
            after: gap.after,
            floor: gap.noise.hypot(*spread),
        }
    });
    let command = command_error(&after).map(|after| {
        let before = before.as_ref().and_then(command_error);
        [before.unwrap_or(f64::NAN), after]
    });
    Ok(Confirmed { gap: all.collect(), command })
}

/// How far the noise of the recorded input moves each channel [its unit], root mean square. A controller's command is
/// simulated, and an imposed motion is what it is: there it moves none.
fn spread(model: &Rig, data: &Data, plain: &Simulated) -> Vec<f64> {
    let mut squares = vec![(0.0, 0.0); plain.traces.len()];
    let noise = data.noise_of_input();
    let alone = data.force.is_some() || plain.traces.iter().any(|t| t.channel == "input");
    let times = 0..if alone || noise <= 0.0 { 0 } else { TIMES };
    let perturbed = |time: u64| {
        let mut random = ChaCha8Rng::seed_from_u64(time);
        let mut other = data.clone();
        for u in &mut other.input {
            let drawn: f64 = StandardNormal.sample(&mut random);
            *u += noise * drawn;
        }
        let finite = |trace: &Trace| trace.after.iter().all(|value| value.is_finite());
        plain.once_more(model, &other).ok().filter(|all| all.iter().all(finite))
    };
    let others: Vec<Vec<Trace>> = times.into_par_iter().filter_map(perturbed).collect();
    for other in others {
        for ((sum, count), (a, b)) in squares.iter_mut().zip(plain.traces.iter().zip(&other)) {
            *sum += a.after.iter().zip(&b.after).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            *count += a.after.len() as f64;
        }
    }
    squares.into_iter().map(|(sum, count)| (sum / f64::max(count, 1.0)).sqrt()).collect()
}

/// The error of the command that a run made [%]; none where it made none.
fn command_error(run: &Simulated) -> Option<f64> {
    let command = run.traces.iter().find(|t| t.channel == "input")?;
    let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let pairs = command.measured.iter().zip(&command.after).skip(FROM);
    let off = norm(&mut pairs.map(|(u, made)| u - made));
    Some(100.0 * off / norm(&mut command.measured.iter().skip(FROM).copied()))
}

/// The unit of a channel.
fn unit(rig: &Rig, channel: &str) -> &'static str {
    let driven = ["voltage", "current"].iter().find(|name| rig.channels.contains_key(**name));
    match (channel, rig::Kind::of(rig.kind), driven) {
        ("velocity", Some(kind), _) => kind.velocity_unit,
        ("angle" | "position" | "displacement", Some(kind), _) => kind.displacement_unit,
        ("input", _, Some(&"voltage")) => "V",
        ("input", _, Some(_)) => "A",
        ("input", Some(kind), None) if kind.turns() => "N·m",
        _ => "N",
    }
}

#[cfg(test)]
mod tests {
    use super::confirm;
    use crate::walk::made::{slide, slides};

    #[test]
    fn what_trembles_at_rest_is_not_simulated() {
        // Shaken by its sensor, dry friction of 1.5 N would turn at every other sample; so it turns forty times by 3 N, and
        // when it does is known to a sample of eight thousand.
        let confirmed = confirm(&slides(1.6), &slides(1.5), &slide(1e-6)).unwrap();
        let (left, turns) = (confirmed.gap[0].after, (40.0 * 9.0 / 8000.0_f64).sqrt());
        assert!(left < 1.01 * turns, "{left} N of {turns} N");
    }
}
