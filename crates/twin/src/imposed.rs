//! An imposed motion: the displacement is the drive, and the force answers.

use crate::{
    TwinError,
    contact::Contact,
    rosenbrock::{Flow, Pace},
    signal::Leg,
};
use nalgebra::{Matrix3, Vector3};

/// A contact under an imposed motion.
pub(crate) struct Imposed {
    t: f64,
    contact: Contact,
    /// Where it is, and how the bristle stands there.
    q: f64,
    z: f64,
    pace: Pace,
}

/// The bristle alone; the other two components rest.
struct Bristles<'a> {
    contact: &'a Contact,
    leg: Leg<'a>,
}

impl Flow for Bristles<'_> {
    fn slope(&self, t: f64, y: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(0.0, 0.0, self.contact.bristle.rate(self.leg.at(t).1, y[2]).0)
    }

    fn jacobian(&self, t: f64, y: &Vector3<f64>) -> Matrix3<f64> {
        let mut matrix = Matrix3::zeros();
        matrix[(2, 2)] = self.contact.bristle.rate(self.leg.at(t).1, y[2]).2;
        matrix
    }

    fn slope_in_time(&self, t: f64, y: &Vector3<f64>) -> Vector3<f64> {
        let d = 1e-7 * t.abs().max(1.0);
        let speed = (self.leg.at(t + d).1 - self.leg.at(t - d).1) / (2.0 * d);
        let slope = self.contact.bristle.rate(self.leg.at(t).1, y[2]).1;
        Vector3::new(0.0, 0.0, slope * speed)
    }
}

impl Imposed {
    /// A relaxed contact at the displacement with which the leg begins.
    pub(crate) fn new(contact: Contact, q: f64, tolerance: f64) -> Self {
        let pace = Pace::new(1e-6, tolerance, Vector3::new(1.0, 1.0, 1e-9));
        Self { t: 0.0, contact, q, z: 0.0, pace }
    }

    /// Displacement.
    pub(crate) fn q(&self) -> f64 {
        self.q
    }

    /// Friction force at a speed [N].
    pub(crate) fn force(&self, v: f64) -> f64 {
        let bristle = &self.contact.bristle;
        let rate = bristle.rate(v, self.z).0;
        self.contact.force(self.q).0
            + bristle.sigma_0 * self.z
            + bristle.sigma_1 * rate
            + self.contact.sigma_2 * v
    }

    /// Follows the motion to `end`, along a leg on which the displacement is smooth.
    /// Its speed may change sign once on the way: a leg is no longer than a sample.
    pub(crate) fn follow(&mut self, leg: Leg<'_>, end: f64) -> Result<(), TwinError> {
        let speed = |t: f64| leg.at(t).1;
        let turn = if speed(self.t) * speed(end) < 0.0 { turn(speed, self.t, end) } else { end };
        for stop in [turn, end] {
            self.bend(leg, stop)?;
            self.move_to(leg.at(stop).0);
        }
        Ok(())
    }

    /// A monotone motion to q; the contact reverses first if it went the other way.
    fn move_to(&mut self, q: f64) {
        let moved = q - self.q;
        if moved != 0.0 && self.contact.way * moved <= 0.0 {
            self.contact.turn(self.q, 1f64.copysign(moved));
        }
        self.q = q;
    }

    /// The bristle from here to `end`.
    fn bend(&mut self, leg: Leg<'_>, end: f64) -> Result<(), TwinError> {
        let flow = Bristles { contact: &self.contact, leg };
        while self.t < end && self.contact.bristle.sigma_0 > 0.0 {
            let y = Vector3::new(0.0, 0.0, self.z);
            let Some((h, next)) = self.pace.step(&flow, self.t, &y, end) else {
                let reason = "the bristle's steps become too short";
                return Err(TwinError::Motion { time: self.t, reason });
            };
            self.z = next[2];
            self.pace.saw(next);
            self.t = if h >= end - self.t { end } else { self.t + h };
        }
        self.t = end;
        Ok(())
    }
}

/// Where the speed changes its sign, by bisection.
fn turn(speed: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let before = speed(a);
    for _ in 0..60 {
        let middle = f64::midpoint(a, b);
        if speed(middle) * before > 0.0 {
            a = middle;
        } else {
            b = middle;
        }
    }
    b
}
