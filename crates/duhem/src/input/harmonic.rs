//! One sine and a constant: the inputs under which a piecewise linear plant has a closed form.

use super::{Input, Shape};

/// u(t) = a sin(ωt + φ) + c.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Amplitude a [m], or [N] of a force.
    pub amplitude: f64,
    /// Angular frequency ω [rad/s].
    pub omega: f64,
    /// Phase φ [rad].
    pub phase: f64,
    /// Constant part c, in the unit of a.
    pub constant: f64,
}

impl Harmonic {
    /// u at the time `t` [s].
    pub fn u(&self, t: f64) -> f64 {
        self.amplitude * (self.omega * t + self.phase).sin() + self.constant
    }
}

impl Input {
    /// The input as one sine and a constant, if it is that: a sine, an offset cosine, or an input that
    /// never changes.
    pub fn harmonic(&self) -> Option<Harmonic> {
        if let Shape::Wave(wave) = &self.0 {
            return wave.harmonic();
        }
        let (low, high) = self.range();
        let constant = Harmonic { amplitude: 0.0, omega: 0.0, phase: 0.0, constant: low };
        (low == high).then_some(constant)
    }
}
