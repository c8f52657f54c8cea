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

/// The changes between two natures with the same sensors, both without noise; channels without noise left out.
pub(super) fn visible(a: &Scenario, b: &Scenario, seed: u64) -> Result<Vec<Visible>, TwinError> {
    let all = changes(a, b, seed)?.into_iter();
    let of = |(channel, noise, change): (&str, f64, Vec<f64>)| Visible {
        channel: channel.to_owned(),
        noise,
        plain: rms(&change) / noise,
        local: rms(&straightened(&change, super::RATE)) / noise,
    };
    Ok(all.map(of).collect())
}

/// The name of each channel that has noise, its noise, and its change at every sample.
pub(super) fn changes(
    a: &Scenario,
    b: &Scenario,
    seed: u64,
) -> Result<Vec<(&'static str, f64, Vec<f64>)>, TwinError> {
    // Local errors ten times as large are still far below any noise.
    let made = |scenario: &Scenario| make_hidden(&quiet(scenario), seed, &Nothing, 10.0);
    let (with, without) = (made(a)?, made(b)?);
    let pairs = with.clean[1..].iter().zip(&without.clean[1..]);
    Ok(a.sensors
        .iter()
        .zip(pairs)
        .filter(|(sensor, _)| sensor.noise.max(sensor.quantum) > 0.0)
        .map(|(sensor, ((_, with), (_, without)))| {
            let change = with.iter().zip(without).map(|(a, b)| a - b).collect();
            (sensor.quantity.name(), sensor.noise.hypot(sensor.quantum / 12f64.sqrt()), change)
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
