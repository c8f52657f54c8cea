//! From what is to what is read.

use crate::Sensor;
use rand::SeedableRng;
use rand_chacha::ChaCha20Rng;
use rand_distr::{Distribution, StandardNormal};

/// A sensor at work, with the noise it draws.
/// Its noise is a stream of its own of the record's seed, so that no sensor changes another's.
pub(crate) struct Reader<'a> {
    sensor: &'a Sensor,
    stream: ChaCha20Rng,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(sensor: &'a Sensor, seed: u64) -> Self {
        let mut stream = ChaCha20Rng::seed_from_u64(seed);
        stream.set_stream(1 + sensor.quantity as u64);
        Self { sensor, stream }
    }

    /// What the sensor makes of the next true value, which is in its own unit.
    pub(crate) fn read(&mut self, value: f64) -> f64 {
        let sensor = self.sensor;
        let drawn: f64 = StandardNormal.sample(&mut self.stream);
        let shown = sensor.gain * value + sensor.bias + sensor.noise * drawn;
        if sensor.quantum > 0.0 {
            // Adding 0 makes -0 plain.
            (shown / sensor.quantum).round() * sensor.quantum + 0.0
        } else {
            shown
        }
    }
}

/// What a sensor makes of true values, which are in its own unit.
pub(crate) fn read(sensor: &Sensor, truth: &[f64], seed: u64) -> Vec<f64> {
    let mut reader = Reader::new(sensor, seed);
    truth.iter().map(|value| reader.read(*value)).collect()
}
