//! Periodic inputs: sine, offset cosine, triangle.

use super::{
    Harmonic,
    error::{InputError, positive},
};
use crate::elementary::{in_place, sines};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Sine,
    CosineOffset,
    Triangle,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Wave {
    kind: Kind,
    /// Amplitude a [m].
    amplitude: f64,
    /// Angular frequency ω [rad/s].
    omega: f64,
}

impl Wave {
    pub(super) fn new(kind: Kind, amplitude: f64, omega: f64) -> Result<Self, InputError> {
        Ok(Self {
            kind,
            amplitude: positive("amplitude", amplitude, "a positive, finite amplitude [m]")?,
            omega: positive("omega", omega, "a positive, finite angular frequency [rad/s]")?,
        })
    }

    /// The wave as one sine; a triangle is none.
    pub(super) fn harmonic(&self) -> Option<Harmonic> {
        let (amplitude, omega) = (self.amplitude, self.omega);
        match self.kind {
            Kind::Sine => Some(Harmonic { amplitude, omega, phase: 0.0, constant: 0.0 }),
            Kind::CosineOffset => {
                Some(Harmonic { amplitude, omega, phase: FRAC_PI_2, constant: -amplitude })
            }
            Kind::Triangle => None,
        }
    }

    pub(super) fn u(&self, t: f64) -> f64 {
        match self.kind {
            Kind::Sine => self.amplitude * (self.omega * t).sin(),
            // a (cos ωt − 1) without its cancellation near ωt = 0.
            Kind::CosineOffset => {
                let half = (0.5 * self.omega * t).sin();
                -2.0 * self.amplitude * half * half
            }
            Kind::Triangle => {
                let s = self.phase(t);
                self.amplitude * if s < 0.5 { 4.0 * s - 1.0 } else { 3.0 - 4.0 * s }
            }
        }
    }

    /// u in the place of each time.
    pub(super) fn displace(&self, times: &mut [f64]) {
        let (a, omega) = (self.amplitude, self.omega);
        match self.kind {
            Kind::Sine => {
                in_place(times, |t| omega * t);
                sines(times);
                in_place(times, |sine| a * sine);
            }
            Kind::CosineOffset => {
                in_place(times, |t| 0.5 * omega * t);
                sines(times);
                in_place(times, |half| -2.0 * a * half * half);
            }
            Kind::Triangle => in_place(times, |t| self.u(t)),
        }
    }

    pub(super) fn piecewise_linear(&self) -> bool {
        self.kind == Kind::Triangle
    }

    pub(super) fn u_dot(&self, t: f64) -> f64 {
        let top = self.amplitude * self.omega;
        match self.kind {
            Kind::Sine => top * (self.omega * t).cos(),
            Kind::CosineOffset => -top * (self.omega * t).sin(),
            Kind::Triangle => self.ramp(if self.phase(t) < 0.5 { 1.0 } else { -1.0 }),
        }
    }

    /// The velocity at `t` on the arc around `middle`.
    pub(super) fn u_dot_on(&self, middle: f64, t: f64) -> f64 {
        match self.kind {
            Kind::Sine | Kind::CosineOffset => self.u_dot(t),
            Kind::Triangle => self.u_dot(middle),
        }
    }

    pub(super) fn period(&self) -> f64 {
        TAU / self.omega
    }

    pub(super) fn range(&self) -> (f64, f64) {
        match self.kind {
            Kind::Sine | Kind::Triangle => (-self.amplitude, self.amplitude),
            Kind::CosineOffset => (-2.0 * self.amplitude, 0.0),
        }
    }

    /// The corners around the span and a few more: the k-th is at (k + offset) π/ω.
    pub(super) fn corners(&self, start: f64, end: f64) -> Vec<f64> {
        let offset = if self.kind == Kind::CosineOffset { 0.0 } else { 0.5 };
        let mut k = (start * self.omega / PI - offset).floor();
        let mut corners = Vec::new();
        loop {
            let t = (k + offset) * PI / self.omega;
            // Beyond 2^53 half periods a corner can no longer be told from the next.
            if t.is_nan() || t >= end || k + 1.0 == k {
                return corners;
            }
            corners.push(t);
            k += 1.0;
        }
    }

    /// The triangle's phase in [0, 1): 0 at the left turn, 1/2 at the right one.
    fn phase(&self, t: f64) -> f64 {
        (self.omega * t / TAU + 0.25).rem_euclid(1.0)
    }

    fn ramp(&self, direction: f64) -> f64 {
        direction * 2.0 / PI * self.amplitude * self.omega
    }
}
