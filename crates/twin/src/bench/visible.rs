//! How well a change of nature can be seen.

use crate::{Scenario, TwinError, hidden::Nothing, make_hidden};
use serde::{Deserialize, Serialize};

/// How much a channel changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Visible {
    /// The channel, as a rig file calls it.
    pub channel: String,
    /// Noise of its sensor, white and of its step, in its unit.
    pub noise: f64,
    /// Root mean square of the change over the record, in units of the noise.
    pub plain: f64,
    /// The same after a straight line is taken off every second of it: what is no slow drift.
    pub local: f64,
}

/// What a sensor would show of a motion without its noise.
pub(super) struct Shown {
    /// The channel, as a rig file calls it.
    pub(super) channel: &'static str,
    /// Noise of the sensor, white and of its step, in its unit.
    pub(super) noise: f64,
    /// Every sample, in its unit.
    pub(super) values: Vec<f64>,
}

/// The changes between what two natures with the same sensors show, `of` one `and` the other.
pub(super) fn visible(of: &[Shown], and: &[Shown]) -> Vec<Visible> {
    let one = |(of, and): (&Shown, &Shown)| {
        let change = of.change(and);
        Visible {
            channel: of.channel.to_owned(),
            noise: of.noise,
            plain: rms(&change) / of.noise,
            local: rms(&straightened(&change, super::RATE)) / of.noise,
        }
    };
    of.iter().zip(and).map(one).collect()
}

impl Shown {
    /// What is shown less what another nature shows, sample by sample.
    pub(super) fn change(&self, other: &Self) -> Vec<f64> {
        self.values.iter().zip(&other.values).map(|(a, b)| a - b).collect()
    }
}

/// What the sensors show of a motion, those without noise left out.
pub(super) fn shown(scenario: &Scenario, seed: u64) -> Result<Vec<Shown>, TwinError> {
    // Local errors ten times as large are still far below any noise.
    let made = make_hidden(&quiet(scenario), seed, &Nothing, 10.0)?;
    let all = scenario.sensors.iter().zip(made.clean.into_iter().skip(1));
    Ok(all
        .filter(|(sensor, _)| sensor.noise.max(sensor.quantum) > 0.0)
        .map(|(sensor, (_, values))| Shown {
            channel: sensor.quantity.name(),
            noise: sensor.noise.hypot(sensor.quantum / 12f64.sqrt()),
            values,
        })
        .collect())
}

/// The largest local change; the largest of all where what is `steady` counts too.
pub(super) fn most(visible: &[Visible], steady: bool) -> f64 {
    let of = |channel: &Visible| if steady { channel.plain } else { channel.local };
    visible.iter().map(of).fold(0.0, f64::max)
}

fn quiet(scenario: &Scenario) -> Scenario {
    let mut quiet = scenario.clone();
    for sensor in &mut quiet.sensors {
        (sensor.noise, sensor.quantum) = (0.0, 0.0);
    }
    quiet
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// Values less the straight line through each second of them.
pub(super) fn straightened(values: &[f64], rate: f64) -> Vec<f64> {
    let block = crate::signal::count(rate).max(3);
    values.chunks(block).flat_map(less_line).collect()
}

fn less_line(values: &[f64]) -> Vec<f64> {
    let n = values.len() as f64;
    let middle = (n - 1.0) / 2.0;
    let mean = values.iter().sum::<f64>() / n;
    let at = |k: usize| k as f64 - middle;
    let moment: f64 = values.iter().enumerate().map(|(k, v)| at(k) * v).sum();
    let spread: f64 = (0..values.len()).map(|k| at(k) * at(k)).sum();
    let slope = if spread > 0.0 { moment / spread } else { 0.0 };
    values.iter().enumerate().map(|(k, v)| v - mean - slope * at(k)).collect()
}
