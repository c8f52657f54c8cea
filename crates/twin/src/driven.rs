//! A driven plant, followed from event to event.
//!
//! The momentum p = M v + σ₁ z stands for the speed: ṗ = pull − (c + σ₂) v − σ₀ z − F(q), in which ż does not
//! appear. A step ends at every sample, at every corner of the drive and at every reversal of a contact that
//! remembers; stuck, nothing moves until the pull exceeds what holds.

use crate::{
    Hidden, TwinError,
    contact::Contact,
    plant::Balance,
    rosenbrock::{Flow, Pace, step},
    signal::Leg,
};
use nalgebra::{Matrix3, Vector3};

/// A plant on its way; its state is displacement, momentum, bristle.
pub(crate) struct Driven<'a> {
    t: f64,
    y: Vector3<f64>,
    motion: Motion<'a>,
    pace: Pace,
}

/// The law of motion while the drive is smooth and the contact goes one way.
struct Motion<'a> {
    balance: Balance,
    contact: Contact,
    hidden: &'a dyn Hidden,
    leg: Leg<'a>,
}

impl Motion<'_> {
    fn speed(&self, y: &Vector3<f64>) -> f64 {
        (y[1] - self.contact.bristle.sigma_1 * y[2]) / self.balance.inertia
    }

    fn drag(&self) -> f64 {
        self.balance.drag + self.contact.sigma_2
    }

    /// What pulls at it, friction and drag apart [N] or [N·m].
    fn pull(&self, t: f64, q: f64, v: f64) -> f64 {
        self.balance.pull(self.leg.at(t).0, q) + self.hidden.drive(t, q, v)
    }

    /// By how much the pull exceeds what holds a stuck plant at q [N] or [N·m].
    fn excess(&self, t: f64, q: f64) -> f64 {
        self.pull(t, q, 0.0).abs() - self.contact.hold()
    }
}

/// The slope of a function by central differences.
fn slope_of(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let d = 1e-6 * x.abs().max(1e-3);
    (f(x + d) - f(x - d)) / (2.0 * d)
}

impl Flow for Motion<'_> {
    fn slope(&self, t: f64, y: &Vector3<f64>) -> Vector3<f64> {
        let (q, v, z) = (y[0], self.speed(y), y[2]);
        let held = self.contact.force(q).0 + self.contact.bristle.sigma_0 * z;
        let pushed = self.pull(t, q, v) - self.drag() * v - held;
        Vector3::new(v, pushed, self.contact.bristle.rate(v, z).0)
    }

    fn jacobian(&self, t: f64, y: &Vector3<f64>) -> Matrix3<f64> {
        let (q, v, z) = (y[0], self.speed(y), y[2]);
        let bristle = &self.contact.bristle;
        let (by_p, by_z) = (1.0 / self.balance.inertia, -bristle.sigma_1 / self.balance.inertia);
        let hidden_q = slope_of(|q| self.hidden.drive(t, q, v), q);
        let hidden_v = slope_of(|v| self.hidden.drive(t, q, v), v);
        let p_q = self.balance.pull_slope(q) - self.contact.force(q).1 + hidden_q;
        let p_v = hidden_v - self.drag();
        let (_, z_v, z_z) = bristle.rate(v, z);
        Matrix3::from_rows(&[
            [0.0, by_p, by_z].into(),
            [p_q, p_v * by_p, p_v * by_z - bristle.sigma_0].into(),
            [0.0, z_v * by_p, z_v * by_z + z_z].into(),
        ])
    }

    fn slope_in_time(&self, t: f64, y: &Vector3<f64>) -> Vector3<f64> {
        let hidden = slope_of(|t| self.hidden.drive(t, y[0], self.speed(y)), t);
        Vector3::new(0.0, self.balance.gain * self.leg.at(t).1 + hidden, 0.0)
    }
}

impl<'a> Driven<'a> {
    /// A plant that starts at displacement q with speed v, its bristles relaxed.
    pub(crate) fn new(
        balance: Balance,
        mut contact: Contact,
        hidden: &'a dyn Hidden,
        (q, v): (f64, f64),
        tolerance: f64,
    ) -> Self {
        if contact.remembers() {
            contact.turn(q, if v == 0.0 && contact.sticks() { 0.0 } else { 1f64.copysign(v) });
        }
        // Below a nanometre and a nanometre per second, or such angles, nothing is measured.
        let least = Vector3::new(1e-9, 1e-9 * balance.inertia, 1e-9);
        let y = Vector3::new(q, balance.inertia * v, 0.0);
        let mut pace = Pace::new(1e-6, tolerance, least);
        pace.saw(y);
        let motion = Motion { balance, contact, hidden, leg: Leg::Held(0.0) };
        Self { t: 0.0, y, motion, pace }
    }

    /// Displacement.
    pub(crate) fn q(&self) -> f64 {
        self.y[0]
    }

    /// Speed.
    pub(crate) fn v(&self) -> f64 {
        self.motion.speed(&self.y)
    }

    /// Follows the motion to `end`, along a leg on which the drive is smooth.
    pub(crate) fn follow(&mut self, leg: Leg<'a>, end: f64) -> Result<(), TwinError> {
        self.motion.leg = leg;
        let mut idle = 0;
        while self.t < end {
            if self.motion.contact.sticks() && self.motion.contact.way == 0.0 {
                self.wait(end);
                continue;
            }
            let Some((h, next)) = self.pace.step(&self.motion, self.t, &self.y, end) else {
                let reason = "its steps become too short";
                return Err(TwinError::Motion { time: self.t, reason });
            };
            let contact = &self.motion.contact;
            if contact.remembers() && contact.way * self.motion.speed(&next) < 0.0 && idle < 2 {
                let reached = self.reversal(h);
                idle = if reached > 0.0 { 0 } else { idle + 1 };
                self.reverse(reached, end);
            } else {
                idle = 0;
                self.y = next;
                self.t = if h >= end - self.t { end } else { self.t + h };
            }
            let momentum = self.motion.balance.inertia * self.v();
            self.pace.saw(Vector3::new(self.y[0], momentum, self.y[2]));
        }
        Ok(())
    }

    /// The state after a step of h, and its speed along the present way.
    fn after(&self, h: f64) -> Option<(Vector3<f64>, f64)> {
        let (next, _) = step(&self.motion, self.t, &self.y, h)?;
        Some((next, self.motion.contact.way * self.motion.speed(&next)))
    }

    /// How long a step, shorter than h, ends where the speed is 0; 0 if there was no motion this way at all.
    fn reversal(&self, h: f64) -> f64 {
        let speed =
            |h: f64| if h > 0.0 { self.after(h).map_or(0.0, |(_, speed)| speed) } else { 0.0 };
        let mut forth = (0.0, self.motion.contact.way * self.v());
        // It may start from rest: then some shorter step still goes forth, or none does.
        for halved in 1..40 {
            if forth.1 > 0.0 {
                break;
            }
            let shorter = h * 0.5f64.powi(halved);
            forth = (shorter, speed(shorter));
        }
        if forth.1 > 0.0 { root(speed, forth.0, h) } else { 0.0 }
    }

    /// Goes on to where the speed is 0, and lets the contact reverse there, or stick.
    fn reverse(&mut self, h: f64, end: f64) {
        if let Some((next, _)) = (h > 0.0).then(|| self.after(h)).flatten() {
            self.y = next;
        }
        self.t = (self.t + h).min(end);
        let q = self.y[0];
        // Only contacts without bristle remember, so that the momentum is that of the mass alone.
        self.y[1] = 0.0;
        let contact = &self.motion.contact;
        let way = if contact.sticks() { 0.0 } else { -contact.way };
        self.motion.contact.turn(q, way);
        if h == 0.0 && self.motion.contact.sticks() {
            // It did not move at all: the pull is at the limit, and cannot be told from it before the next leg.
            self.t = end;
        }
    }

    /// Stuck: waits until the pull exceeds what holds, and starts that way.
    fn wait(&mut self, end: f64) {
        let q = self.y[0];
        let excess = |t: f64| self.motion.excess(t, q);
        let Some(by) = self.first_beyond(end) else {
            self.t = end;
            return;
        };
        let start = if excess(self.t) > 0.0 { self.t } else { root_up(excess, self.t, by) };
        let way = 1f64.copysign(self.motion.pull(start, q, 0.0));
        self.t = start;
        self.motion.contact.turn(q, way);
    }

    /// A time at which the pull on the stuck plant exceeds what holds, up to `end`: there, or at a peak before.
    fn first_beyond(&self, end: f64) -> Option<f64> {
        let q = self.y[0];
        if self.motion.excess(self.t, q) > 0.0 {
            return Some(self.t);
        }
        if self.motion.excess(end, q) > 0.0 {
            return Some(end);
        }
        let rising = |t: f64| {
            self.motion.pull(t, q, 0.0) * self.motion.balance.gain * self.motion.leg.at(t).1
        };
        if rising(self.t) > 0.0 && rising(end) < 0.0 {
            let peak = root(rising, self.t, end);
            return (self.motion.excess(peak, q) > 0.0).then_some(peak);
        }
        None
    }
}

/// Where f, positive at a and not at b, has its root, by regula falsi with the Illinois rule; on the side of b.
pub(crate) fn root(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (mut a, mut b) = ((a, f(a)), (b, f(b)));
    for _ in 0..80 {
        let mut middle = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        if !(middle > a.0 && middle < b.0) {
            middle = f64::midpoint(a.0, b.0);
        }
        if middle <= a.0 || middle >= b.0 {
            break;
        }
        let value = f(middle);
        if value == 0.0 {
            return middle;
        }
        if value > 0.0 {
            a = (middle, value);
            b.1 /= 2.0;
        } else {
            b = (middle, value);
            a.1 /= 2.0;
        }
        if b.0 - a.0 <= 4.0 * f64::EPSILON * b.0.abs() {
            break;
        }
    }
    b.0
}

/// Where f, not positive at a and positive at b, has its root; on the side of b.
pub(crate) fn root_up(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    root(|t| -f(t), a, b)
}
