//! Drives under which a plant reverses and slides.

use super::{DURATION, between, sign};
use crate::Part;
use rand::RngExt;
use rand_chacha::ChaCha20Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The shape of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Excitation {
    /// One sine.
    Sine,
    /// Five sines at a time.
    Multisine,
    /// A sine that becomes faster.
    Chirp,
    /// Steps, or ramps where nothing may jump, to random values with rests between them.
    Steps,
    /// A slow triangle with fast bursts.
    Bursts,
}

impl Excitation {
    /// All of them.
    pub const ALL: &[Self] = &[Self::Sine, Self::Multisine, Self::Chirp, Self::Steps, Self::Bursts];

    /// Its parts, of about twice this size; without jumps where the drive is a `motion`.
    pub(super) fn parts(self, size: f64, motion: bool, stream: &mut ChaCha20Rng) -> Vec<Part> {
        match self {
            Self::Sine => {
                let omega = between(0.8, 2.0, stream);
                vec![Part::Sine { amplitude: 2.2 * size, omega, phase: 0.0 }]
            }
            Self::Multisine => [0.5, 1.1, 2.3, 4.9, 9.7]
                .iter()
                .map(|omega| Part::Sine {
                    amplitude: 0.8 * size,
                    omega: omega * between(0.9, 1.1, stream),
                    phase: if motion { 0.0 } else { between(0.0, TAU, stream) },
                })
                .collect(),
            Self::Chirp => vec![Part::Chirp {
                amplitude: 2.2 * size,
                omega_start: 0.6,
                omega_end: if motion { 6.0 } else { 15.0 },
                over: DURATION,
            }],
            Self::Steps => vec![joined(steps(size, stream), motion)],
            Self::Bursts => {
                let period = between(11.0, 16.0, stream);
                let slow = Part::Triangle { amplitude: 1.7 * size, period };
                vec![slow, joined(bursts(size, stream), motion)]
            }
        }
    }
}

/// Times, multiples of 5 ms, with values from each on.
type Points = (Vec<f64>, Vec<f64>);

fn on_grid(t: f64) -> f64 {
    (t * super::RATE).round() / super::RATE
}

/// Pushes back and forth, three in four against the one before, and rests.
fn steps(size: f64, stream: &mut ChaCha20Rng) -> Points {
    let (mut times, mut values) = (Vec::new(), Vec::new());
    let (mut t, mut way) = (0.2, 1.0);
    while t < DURATION {
        times.push(on_grid(t));
        values.push(way * size * between(1.3, 2.8, stream));
        t += between(0.3, 1.2, stream);
        times.push(on_grid(t));
        values.push(0.0);
        t += between(0.3, 1.0, stream);
        way *= if stream.random::<f64>() < 0.75 { -1.0 } else { 1.0 };
    }
    (times, values)
}

/// Eight fast swings about every seven seconds.
fn bursts(size: f64, stream: &mut ChaCha20Rng) -> Points {
    let (mut times, mut values) = (Vec::new(), Vec::new());
    let mut t = 2.0;
    while t < DURATION - 3.0 {
        let (half, mut way) = (between(0.1, 0.25, stream), sign(stream));
        for _ in 0..8 {
            times.push(on_grid(t));
            values.push(way * 1.5 * size);
            way = -way;
            t += half;
        }
        times.push(on_grid(t));
        values.push(0.0);
        t += between(3.0, 8.0, stream);
    }
    (times, values)
}

/// Steps; for a motion, ramps that take a tenth of a second at least.
fn joined((times, values): Points, motion: bool) -> Part {
    if !motion {
        return Part::Steps { times, values };
    }
    let (mut ramp_times, mut ramp_values, mut last) = (Vec::new(), Vec::new(), 0.0);
    for (k, (t, value)) in times.iter().zip(&values).enumerate() {
        let next = times.get(k + 1).unwrap_or(&(t + 1.0)) - t;
        ramp_times.extend([*t, t + 0.6 * next]);
        ramp_values.extend([last, *value]);
        last = *value;
    }
    Part::Ramps { times: ramp_times, values: ramp_values }
}
