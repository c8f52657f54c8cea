//! The force that drives a plant, at the stages of a step.

#![expect(
    clippy::inline_always,
    reason = "called for every stage: a call costs more than what it does"
)]

use duhem::{Harmonic, Input, Plant};
use integrate::collocation::fma;

/// Steps after which the phase is taken from the time again and not from the step before.
const FRESH: u32 = 64;
/// The largest turn of phase in a step [rad] for which the series below hold.
const TURN: f64 = 0.5;

/// The driving force w(t) [N], from a time on.
#[derive(Debug, Clone)]
pub(super) enum Drive {
    /// a sin(ωt + φ) + c.
    Harmonic {
        /// The force itself [N].
        wave: Harmonic,
        /// The time [s].
        t: f64,
        /// Sine and cosine of the phase at that time.
        phase: (f64, f64),
        /// Steps since the phase was taken from the time.
        steps: u32,
    },
    /// Anything else.
    Any {
        /// Its input.
        input: Box<Input>,
        /// What turns it into a force.
        plant: Plant,
        /// The time [s].
        t: f64,
    },
}

impl Drive {
    pub(super) fn new(plant: &Plant, input: &Input) -> Self {
        let (plant, t) = (*plant, 0.0);
        match input.harmonic() {
            None => Self::Any { input: Box::new(input.clone()), plant, t },
            Some(Harmonic { amplitude, omega, phase, constant }) => {
                let (amplitude, constant) =
                    (plant.gain * amplitude, plant.gain * constant + plant.offset);
                let wave = Harmonic { amplitude, omega, phase, constant };
                Self::Harmonic { wave, t, phase: phase.sin_cos(), steps: 0 }
            }
        }
    }

    /// Goes on to the time `to` [s].
    pub(super) fn start_at(&mut self, to: f64) {
        match self {
            Self::Any { t, .. } => *t = to,
            Self::Harmonic { wave, t, phase, steps } => {
                let turn = wave.omega * (to - *t);
                *steps += 1;
                *phase = if *steps < FRESH && turn.abs() < TURN {
                    let (sin, cos) = sin_cos(turn);
                    (phase.0 * cos + phase.1 * sin, phase.1 * cos - phase.0 * sin)
                } else {
                    *steps = 0;
                    (wave.omega * to + wave.phase).sin_cos()
                };
                *t = to;
            }
        }
    }

    /// The force [N] at the parts `c` of the time `h` [s] from there.
    #[inline(always)]
    pub(super) fn force<const W: usize>(&self, h: f64, c: &[f64; W]) -> [f64; W] {
        match self {
            Self::Any { input, plant, t } => c.map(|c| plant.drive(input.u(t + c * h))),
            Self::Harmonic { wave, phase, .. } => {
                let turn = wave.omega * h;
                let near = turn.abs() < TURN;
                let mut force = [0.0; W];
                for (force, c) in force.iter_mut().zip(c) {
                    let (sin, cos) = if near { sin_cos(turn * c) } else { (turn * c).sin_cos() };
                    *force = fma(wave.amplitude, fma(phase.0, cos, phase.1 * sin), wave.constant);
                }
                force
            }
        }
    }
}

/// Of the sine, by the square of the turn.
const SIN: [f64; 7] = inverse_factorials(1);
/// Of the cosine, after its 1.
const COS: [f64; 7] = inverse_factorials(2);

/// Sine and cosine of a turn of less than [`TURN`], to the last digit: the next terms are 4e-17 of it.
#[inline(always)]
fn sin_cos(x: f64) -> (f64, f64) {
    let square = x * x;
    let series = |terms: &[f64]| terms.iter().rev().fold(0.0, |sum, term| fma(sum, square, *term));
    (x * series(&SIN), fma(square, series(&COS), 1.0))
}

/// 1/n!, −1/(n + 2)!, … for n = 1, and −1/n!, 1/(n + 2)!, … for n = 2.
const fn inverse_factorials(n: u32) -> [f64; 7] {
    let (mut terms, mut term, mut next) = ([0.0; 7], 1.0, 2.0);
    if n == 2 {
        (term, next) = (-0.5, 3.0);
    }
    let mut k = 0;
    while k < terms.len() {
        terms[k] = term;
        term /= -next * (next + 1.0);
        next += 2.0;
        k += 1;
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_force_is_that_of_the_input_wherever_it_starts() {
        let plant = Plant { mass: 1.0, stiffness: 0.0, gain: 16.5, offset: 0.25 };
        let sine = Input::sine(0.05, 0.6).unwrap();
        let mut drives = [
            Drive::new(&plant, &sine),
            Drive::Any { input: Box::new(sine.clone()), plant, t: 0.0 },
        ];
        let mut worst = 0.0_f64;
        let (mut t, c) = (0.0, [0.0, 0.3, 0.7, 1.0]);
        for step in 0..3000 {
            let h = if step % 7 == 0 { 1.7 } else { 0.01 };
            for drive in &mut drives {
                drive.start_at(t);
                for (force, c) in drive.force(h, &c).iter().zip(c) {
                    worst = worst.max((force - plant.drive(sine.u(t + c * h))).abs());
                }
            }
            t += h;
        }
        assert!(worst < 1e-13, "off by {worst:e} N");
    }

    #[test]
    fn the_short_series_are_the_librarys_functions() {
        for i in -500..=500 {
            let x = f64::from(i) / 1000.0;
            let ((sin, cos), (right_sin, right_cos)) = (sin_cos(x), x.sin_cos());
            assert!((sin - right_sin).abs() < 2e-16, "sin {x}: {sin}, not {right_sin}");
            assert!((cos - right_cos).abs() < 3e-16, "cos {x}: {cos}, not {right_cos}");
        }
    }
}
