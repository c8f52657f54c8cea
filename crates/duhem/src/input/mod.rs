//! The inputs: the displacement u(t) that is imposed on a model, and where it turns.

mod error;
mod harmonic;
mod polyline;
mod repeated;
mod sequence;
mod wave;

pub use error::InputError;
pub use harmonic::Harmonic;

use crate::elementary::in_place;
use polyline::Polyline;
use repeated::Repeated;
use sequence::Sequence;
use wave::{Kind, Wave};

/// How near to a corner is next to it, as a share of the arc.
const NEXT_TO: f64 = 1e-6;

/// A displacement u(t) [m]: continuous, with a smooth velocity u̇ [m/s] between its corners.
#[derive(Debug, Clone, PartialEq)]
pub struct Input(Shape);

#[derive(Debug, Clone, PartialEq)]
enum Shape {
    Wave(Wave),
    Polyline(Polyline),
    Repeated(Repeated),
    Sequence(Sequence),
}

impl Input {
    /// u = a sin ωt, with the amplitude a [m] and the angular frequency ω [rad/s].
    pub fn sine(amplitude: f64, omega: f64) -> Result<Self, InputError> {
        Wave::new(Kind::Sine, amplitude, omega).map(|wave| Self(Shape::Wave(wave)))
    }

    /// u = a (cos ωt − 1), the input of Figures 8 to 10.
    pub fn cosine_offset(amplitude: f64, omega: f64) -> Result<Self, InputError> {
        Wave::new(Kind::CosineOffset, amplitude, omega).map(|wave| Self(Shape::Wave(wave)))
    }

    /// A triangle wave of the sine's amplitude, period and phase: of constant speed between the turns.
    pub fn triangle(amplitude: f64, omega: f64) -> Result<Self, InputError> {
        Wave::new(Kind::Triangle, amplitude, omega).map(|wave| Self(Shape::Wave(wave)))
    }

    /// Holds each of the `levels` [m] for `hold_time` [s], with ramps of `rise_time` [s] between them,
    /// and the last one for ever.
    pub fn staircase(levels: Vec<f64>, rise_time: f64, hold_time: f64) -> Result<Self, InputError> {
        Polyline::staircase(levels, rise_time, hold_time).map(|line| Self(Shape::Polyline(line)))
    }

    /// Inputs one after the other, each for its duration [s] in its own local time. The last one goes
    /// on for ever. u has to be continuous where they join.
    pub fn sequence(parts: Vec<(Self, f64)>) -> Result<Self, InputError> {
        Sequence::new(parts).map(|sequence| Self(Shape::Sequence(sequence)))
    }

    /// Linear interpolation between the samples u [m] at the times t [s]; at rest before and after.
    pub fn sampled(t: Vec<f64>, u: Vec<f64>) -> Result<Self, InputError> {
        Polyline::new(t, u).map(|line| Self(Shape::Polyline(line)))
    }

    /// Straight pieces between the samples u [m] at the times t [s], repeated for ever: the last u has
    /// to be the first.
    pub fn polyline(t: Vec<f64>, u: Vec<f64>) -> Result<Self, InputError> {
        Repeated::new(t, u).map(|line| Self(Shape::Repeated(line)))
    }

    /// Displacement u at time `t` [m].
    pub fn u(&self, t: f64) -> f64 {
        match &self.0 {
            Shape::Wave(wave) => wave.u(t),
            Shape::Polyline(line) => line.u(t),
            Shape::Repeated(line) => line.u(t),
            Shape::Sequence(sequence) => sequence.u(t),
        }
    }

    /// Puts the displacement [m] in the place of each of the `times` [s], which rise: [`Self::u`] of many
    /// times at once, the same but for the last digits.
    pub fn displace(&self, times: &mut [f64]) {
        match &self.0 {
            Shape::Wave(wave) => wave.displace(times),
            Shape::Polyline(line) => in_place(times, |t| line.u(t)),
            Shape::Repeated(line) => in_place(times, |t| line.u(t)),
            Shape::Sequence(sequence) => sequence.displace(times),
        }
    }

    /// Whether the velocity is constant between any two corners.
    pub fn piecewise_linear(&self) -> bool {
        match &self.0 {
            Shape::Wave(wave) => wave.piecewise_linear(),
            Shape::Polyline(_) | Shape::Repeated(_) => true,
            Shape::Sequence(sequence) => sequence.piecewise_linear(),
        }
    }

    /// Velocity u̇ at time `t` [m/s]; at a corner the value on its right.
    pub fn u_dot(&self, t: f64) -> f64 {
        match &self.0 {
            Shape::Wave(wave) => wave.u_dot(t),
            Shape::Polyline(line) => line.u_dot(t),
            Shape::Repeated(line) => line.u_dot(t),
            Shape::Sequence(sequence) => sequence.u_dot(t),
        }
    }

    /// The period [s], if there is one; of a sequence that of its last part, which goes on for ever.
    pub fn period(&self) -> Option<f64> {
        match &self.0 {
            Shape::Wave(wave) => Some(wave.period()),
            Shape::Polyline(_) => None,
            Shape::Repeated(line) => Some(line.period()),
            Shape::Sequence(sequence) => sequence.period(),
        }
    }

    /// The smallest and the largest u over all times t ≥ 0 [m].
    pub fn range(&self) -> (f64, f64) {
        match &self.0 {
            Shape::Wave(wave) => wave.range(),
            Shape::Polyline(line) => line.range(),
            Shape::Repeated(line) => line.range(),
            Shape::Sequence(sequence) => sequence.range(),
        }
    }

    /// The smallest and the largest u on [start, end] [m]: u is monotone between its corners.
    pub fn range_on(&self, start: f64, end: f64) -> (f64, f64) {
        let inner = self.corners(start, end);
        let turns = inner.iter().chain([&start, &end]).map(|t| self.u(*t));
        turns.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (low.min(u), high.max(u)))
    }

    /// The times strictly inside (start, end) where the velocity changes sign or jumps, sorted [s].
    ///
    /// A corner that rounding alone keeps off an end of the span counts as that end.
    pub fn corners(&self, start: f64, end: f64) -> Vec<f64> {
        let corners = match &self.0 {
            Shape::Wave(wave) => wave.corners(start, end),
            Shape::Polyline(line) => line.corners(),
            Shape::Repeated(line) => line.corners(start, end),
            Shape::Sequence(sequence) => sequence.corners(start, end),
        };
        let margin = 8.0 * f64::EPSILON * start.abs().max(end.abs());
        corners.into_iter().filter(|t| *t > start + margin && *t < end - margin).collect()
    }

    /// Velocity at `t` [m/s] on the smooth arc that holds between the consecutive corners `from` and
    /// `to`: at the ends one-sided, from inside, and never of the other sign than inside.
    pub fn u_dot_on(&self, from: f64, to: f64, t: f64) -> f64 {
        let middle = from + 0.5 * (to - from);
        let (inside, here) = match &self.0 {
            Shape::Wave(wave) => {
                let here = wave.u_dot_on(middle, t);
                // Rounding can turn the sign next to a corner only.
                let margin = NEXT_TO * (to - from);
                if t - from > margin && to - t > margin {
                    return here;
                }
                (wave.u_dot(middle), here)
            }
            Shape::Polyline(line) => return line.u_dot(middle),
            Shape::Repeated(line) => return line.u_dot(middle),
            Shape::Sequence(sequence) => return sequence.u_dot_on(from, to, t),
        };
        if inside * here < 0.0 { 0.0 } else { here }
    }
}
