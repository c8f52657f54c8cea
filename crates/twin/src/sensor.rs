//! From what is to what is read.

use crate::Sensor;
use rand::SeedableRng;
use rand_chacha::ChaCha20Rng;
use rand_distr::{Distribution, StandardNormal};

/// What a sensor makes of true values, which are in its own unit.
/// Its noise is a stream of its own of the record's seed, so that no sensor changes another's.
pub(crate) fn read(sensor: &Sensor, truth: &[f64], seed: u64) -> Vec<f64> {
    let mut stream = ChaCha20Rng::seed_from_u64(seed);
    stream.set_stream(1 + sensor.quantity as u64);
    truth
        .iter()
        .map(|value| {
            let drawn: f64 = StandardNormal.sample(&mut stream);
            let shown = sensor.gain * value + sensor.bias + sensor.noise * drawn;
            if sensor.quantum > 0.0 {
                // Adding 0 makes -0 plain.
                (shown / sensor.quantum).round() * sensor.quantum + 0.0
            } else {
                shown
            }
        })
        .collect()
}
