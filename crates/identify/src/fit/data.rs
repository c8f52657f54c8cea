//! A record as the fit needs it: what drives the plant, what was seen, and how noisy that is.

use crate::{Hold, Recording, Rig, doctor::noise, rig::Kind};

/// What was seen of one quantity, and its noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Its name.
    pub name: String,
    /// One value a sample, in SI units.
    pub values: Vec<f64>,
    /// Standard deviation of its noise, in the same unit.
    pub noise: f64,
    /// Its largest less its smallest value.
    pub span: f64,
    /// The step of its values, in the same unit; 0 if unknown.
    pub quantum: f64,
}

impl Seen {
    /// With the noise that the values themselves show, at least that of the `quantum` (0 if unknown).
    pub fn new(name: &str, values: Vec<f64>, quantum: f64) -> Self {
        let (low, high) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        let span = if values.is_empty() { 0.0 } else { high - low };
        let noise = noise(&values).max(quantum / 12.0_f64.sqrt()).max(1e-9 * span);
        Self { name: name.to_owned(), values, noise, span, quantum }
    }
}

/// A record of a driven plant, or of an imposed motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Data {
    /// Times of the samples since the first of them [s]: a clock may count from anywhere.
    pub time: Vec<f64>,
    /// What drives the plant, in the unit of its input; the displacement if the motion is imposed.
    pub input: Vec<f64>,
    /// What the input does between the samples.
    pub hold: Hold,
    /// The displacement [m] or [rad]; none if the motion is imposed.
    pub displacement: Option<Seen>,
    /// The velocity [m/s] or [rad/s], if it was measured.
    pub velocity: Option<Seen>,
    /// The friction force [N] or [N·m], if the motion is imposed.
    pub force: Option<Seen>,
    /// The two load cells of a drum [N].
    pub loads: Option<[Seen; 2]>,
    /// The controller's reference [m], and what was added to its command; empty if not recorded.
    pub reference: Vec<f64>,
    /// What was added to the controller's command.
    pub added: Vec<f64>,
    /// Standard deviation of the noise of the input as it was recorded [its unit], where it was averaged since; else what it
    /// shows.
    pub averaged: Option<f64>,
    /// The band outside of which that noise was taken away; none where it was not.
    pub band: Option<Band>,
}

/// The band of the noise that is left on an input.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Where it ends [rad a sample].
    pub edge: f64,
    /// At which samples; at the others there is more.
    pub inside: Vec<bool>,
}

impl Data {
    /// A driven plant of which the displacement alone was seen. What else was is set in it afterwards.
    pub fn driven(time: Vec<f64>, input: Vec<f64>, hold: Hold, displacement: Seen) -> Self {
        Self {
            time,
            input,
            hold,
            displacement: Some(displacement),
            velocity: None,
            force: None,
            loads: None,
            reference: Vec::new(),
            added: Vec::new(),
            averaged: None,
            band: None,
        }
    }

    /// Standard deviation of the noise of the recorded input [its unit].
    pub fn noise_of_input(&self) -> f64 {
        self.averaged.unwrap_or_else(|| crate::doctor::noise(&self.input))
    }

    /// The channels of `recording` as the plant of `rig` needs them. A record holds what its rig file names,
    /// so that a channel is missing only where it may be.
    pub fn of(rig: &Rig, recording: &Recording) -> Self {
        let values = |name: &str| recording.channels.get(name).cloned();
        let seen = |name: &str| {
            let quantum = recording.quantum.get(name).copied().unwrap_or(0.0);
            values(name).map(|values| Seen::new(name, values, quantum))
        };
        let imposed = rig.kind == "prescribed";
        let displacement =
            if Kind::of(rig.kind).is_some_and(Kind::turns) { "angle" } else { "position" };
        let input = ["current", "force", "voltage", "displacement"].into_iter().find(|name| {
            recording.channels.contains_key(*name) && (imposed == (*name == "displacement"))
        });
        let said = input.and_then(|name| rig.channels.get(name)).and_then(|c| c.hold);
        let hold = said.unwrap_or_default();
        let loads = match (seen("force_1"), seen("force_2")) {
            (Some(first), Some(second)) => Some([first, second]),
            _ => None,
        };
        let began = recording.time.first().copied().unwrap_or(0.0);
        Self {
            time: recording.time.iter().map(|t| t - began).collect(),
            input: input.and_then(values).unwrap_or_default(),
            hold: rig.controller.as_ref().map_or(hold, |c| c.hold),
            displacement: if imposed { None } else { seen(displacement) },
            velocity: if imposed { None } else { seen("velocity") },
            force: if imposed { seen("force") } else { None },
            loads,
            reference: values("reference").unwrap_or_default(),
            added: values("added_input").unwrap_or_default(),
            averaged: None,
            band: None,
        }
    }

    /// The largest speed [m/s], as measured or from the displacement over a few samples.
    pub fn speed(&self) -> f64 {
        let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        if let Some(velocity) = &self.velocity {
            return largest(&velocity.values);
        }
        let Some(seen) = &self.displacement else { return 0.0 };
        let far = 10.min(seen.values.len().saturating_sub(1));
        let speeds = (far..seen.values.len())
            .map(|i| (seen.values[i] - seen.values[i - far]) / (self.time[i] - self.time[i - far]));
        largest(&speeds.collect::<Vec<f64>>())
    }

    /// The size of what drives the plant [N], in which forces that are nominally zero are measured.
    pub fn force(&self, rig: &Rig) -> f64 {
        let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        if let Some(force) = &self.force {
            return largest(&force.values).max(f64::MIN_POSITIVE);
        }
        let gain = super::binding::model::<f64>(rig, &|_| None).balance.gain;
        (gain * largest(&self.input)).abs().max(f64::MIN_POSITIVE)
    }

    /// The usual time from sample to sample [s].
    pub fn sample_time(&self) -> f64 {
        let mut steps: Vec<f64> = self.time.windows(2).map(|w| w[1] - w[0]).collect();
        if steps.is_empty() {
            return f64::NAN;
        }
        let middle = steps.len() / 2;
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}
