//! The drive over time: values, slopes, and the times at which it has a corner.

use crate::{Input, Part};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha20Rng;

/// Beside a corner by so much [s], to say which side of it is meant.
const BESIDE: f64 = 1e-7;
/// Times closer than this are one [s].
const SAME: f64 = 1e-9;

/// A drive, ready to be evaluated.
#[derive(Debug, Clone)]
pub(crate) struct Signal {
    hold: Option<f64>,
    parts: Vec<Part>,
}

/// The drive between two corners, where it is smooth.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Leg<'a> {
    /// Held by a converter.
    Held(f64),
    /// The sum of the parts, each on the side of its corners where this time lies.
    Smooth(&'a [Part], f64),
}

impl Signal {
    /// The drive of a record of this length; random parts are drawn from stream 0 of the seed.
    pub(crate) fn new(input: &Input, duration: f64, seed: u64) -> Self {
        let mut stream = ChaCha20Rng::seed_from_u64(seed);
        let parts = input.parts.iter().map(|part| match part {
            Part::RandomSteps { amplitude, every } => {
                let count = count(duration / every) + 1;
                Part::Steps {
                    times: (0..count).map(|k| k as f64 * every).collect(),
                    values: (0..count)
                        .map(|_| amplitude * (2.0 * stream.random::<f64>() - 1.0))
                        .collect(),
                }
            }
            other => other.clone(),
        });
        Self { hold: input.hold, parts: parts.collect() }
    }

    /// The leg on which `inside` lies.
    pub(crate) fn leg(&self, inside: f64) -> Leg<'_> {
        match self.hold {
            None => Leg::Smooth(&self.parts, inside),
            Some(hold) => {
                let since = (inside / hold).floor() * hold;
                Leg::Held(Leg::Smooth(&self.parts, since + BESIDE).at(since).0)
            }
        }
    }

    /// The leg that begins at `t`.
    pub(crate) fn leg_from(&self, t: f64) -> Leg<'_> {
        self.leg(t + BESIDE)
    }

    /// The times in `(0, duration)` at which a leg ends, sorted; none within 1e-9 s of a multiple of `sample`.
    pub(crate) fn corners(&self, duration: f64, sample: f64) -> Vec<f64> {
        let mut times: Vec<f64> = match self.hold {
            Some(hold) => (1..=count(duration / hold)).map(|k| k as f64 * hold).collect(),
            None => self.parts.iter().flat_map(|part| corners(part, duration)).collect(),
        };
        times.retain(|t| {
            let off = (t / sample - (t / sample).round()).abs() * sample;
            *t > SAME && *t < duration - SAME && off > SAME
        });
        times.sort_by(f64::total_cmp);
        times.dedup_by(|b, a| *b - *a < SAME);
        times
    }
}

impl Leg<'_> {
    /// Value and slope at `t`.
    pub(crate) fn at(&self, t: f64) -> (f64, f64) {
        match self {
            Self::Held(value) => (*value, 0.0),
            Self::Smooth(parts, inside) => parts.iter().fold((0.0, 0.0), |sum, part| {
                let (value, slope) = at(part, t, *inside);
                (sum.0 + value, sum.1 + slope)
            }),
        }
    }
}

/// How many whole ones there are.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a scenario's counts are checked to lie below 1e9"
)]
pub(crate) fn count(ratio: f64) -> usize {
    ratio as usize
}

/// Value and slope of a part at `t`, on the side of its corners where `inside` lies.
fn at(part: &Part, t: f64, inside: f64) -> (f64, f64) {
    match part {
        Part::Constant { value } => (*value, 0.0),
        Part::Sine { amplitude, omega, phase } => {
            let (sin, cos) = (omega * t + phase).sin_cos();
            (amplitude * sin, amplitude * omega * cos)
        }
        Part::Chirp { amplitude, omega_start, omega_end, over } => {
            let (omega, phase) = if inside < *over {
                let grown = (omega_end - omega_start) / over * t;
                (omega_start + grown, (omega_start + grown / 2.0) * t)
            } else {
                (*omega_end, (omega_start + omega_end) / 2.0 * over + omega_end * (t - over))
            };
            let (sin, cos) = phase.sin_cos();
            (amplitude * sin, amplitude * omega * cos)
        }
        Part::Triangle { amplitude, period } => {
            let half = period / 2.0;
            let leg = (inside / half + 0.5).floor();
            let slope = if leg.rem_euclid(2.0) == 0.0 { 2.0 } else { -2.0 } * amplitude / half;
            (slope * (t - leg * half), slope)
        }
        Part::Steps { times, values } => match times.partition_point(|time| *time <= inside) {
            0 => (0.0, 0.0),
            n => (values[n - 1], 0.0),
        },
        Part::Ramps { times, values } => match times.partition_point(|time| *time <= inside) {
            0 => (values[0], 0.0),
            n if n == times.len() => (values[n - 1], 0.0),
            n => {
                let slope = (values[n] - values[n - 1]) / (times[n] - times[n - 1]);
                // From the nearer end, so that it ends where the next begins: dry friction would turn around for the
                // last digit that a rest lies behind.
                let nearer = if t - times[n - 1] < times[n] - t { n - 1 } else { n };
                (values[nearer] + slope * (t - times[nearer]), slope)
            }
        },
        Part::RandomSteps { .. } => (0.0, 0.0), // drawn in `new`, and steps since
    }
}

fn corners(part: &Part, duration: f64) -> Vec<f64> {
    match part {
        Part::Constant { .. } | Part::Sine { .. } | Part::RandomSteps { .. } => Vec::new(),
        Part::Chirp { over, .. } => vec![*over],
        Part::Triangle { period, .. } => {
            (0..=count(2.0 * duration / period)).map(|k| (k as f64 + 0.5) * period / 2.0).collect()
        }
        Part::Steps { times, .. } | Part::Ramps { times, .. } => times.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(parts: Vec<Part>, hold: Option<f64>) -> Signal {
        Signal::new(&Input { hold, parts }, 10.0, 1)
    }

    #[test]
    fn the_slope_of_every_smooth_part_is_the_derivative_of_its_value() {
        let parts = [
            Part::Sine { amplitude: 2.0, omega: 3.0, phase: 0.4 },
            Part::Chirp { amplitude: 1.5, omega_start: 1.0, omega_end: 20.0, over: 6.0 },
            Part::Triangle { amplitude: 0.7, period: 1.3 },
            Part::Ramps { times: vec![1.0, 2.5, 4.0], values: vec![0.5, -1.0, 3.0] },
        ];
        for part in parts {
            let signal = signal(vec![part.clone()], None);
            for k in 0..970 {
                let t = 0.0031 + 0.01 * f64::from(k);
                let leg = signal.leg(t);
                let difference = (leg.at(t + 1e-6).0 - leg.at(t - 1e-6).0) / 2e-6;
                let slope = leg.at(t).1;
                assert!(
                    (difference - slope).abs() < 1e-6,
                    "{part:?} at {t} s: {slope}, {difference}"
                );
            }
        }
    }

    #[test]
    fn a_chirp_a_triangle_and_ramps_have_no_jump_at_their_corners() {
        let signal = signal(
            vec![
                Part::Chirp { amplitude: 1.5, omega_start: 1.0, omega_end: 20.0, over: 6.0 },
                Part::Triangle { amplitude: 0.7, period: 1.3 },
                Part::Ramps { times: vec![1.0, 2.5, 4.0], values: vec![0.5, -1.0, 3.0] },
            ],
            None,
        );
        let corners = signal.corners(10.0, 100.0);
        assert!(corners.len() > 15, "{corners:?} s");
        for t in corners {
            let (before, after) = (signal.leg(t - 1e-6).at(t).0, signal.leg_from(t).at(t).0);
            assert!((before - after).abs() < 1e-12, "at {t} s: {before} and {after}");
        }
    }

    #[test]
    fn a_ramp_ends_where_the_rest_after_it_lies_to_the_last_digit() {
        let times: Vec<f64> = (0..200).map(|k| 0.37 * f64::from(k) + 0.11).collect();
        let values: Vec<f64> = (0..200_u32).map(|k| 0.022 * f64::from(k / 2).sin()).collect();
        let part = Part::Ramps { times: times.clone(), values: values.clone() };
        for (end, value) in times.iter().zip(&values).skip(1) {
            assert_eq!(super::at(&part, *end, end - 1e-3).0, *value, "at {end} s");
        }
    }

    #[test]
    fn a_held_drive_keeps_the_value_of_its_last_sample() {
        let sine = Part::Sine { amplitude: 2.0, omega: 3.0, phase: 0.0 };
        let held = signal(vec![sine], Some(0.01));
        for (t, since) in [(0.005, 0.0), (0.0299, 0.02), (0.57 + 1e-4, 0.57)] {
            let (value, slope) = held.leg(t).at(t);
            assert!((value - 2.0 * f64::sin(3.0 * since)).abs() < 1e-12, "at {t} s: {value}");
            assert_eq!(slope, 0.0);
        }
        assert_eq!(held.corners(0.1, 0.02).len(), 5, "{:?}", held.corners(0.1, 0.02));
    }
}
