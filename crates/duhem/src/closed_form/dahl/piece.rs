//! The force on one monotone piece, at many displacements at once.

use crate::{
    Dahl,
    elementary::{exp_m1, in_place, ln_1p},
};

/// A monotone piece of the displacement, and the force at its start.
///
/// It is [`super::advance`] with all that is constant on the piece done once, written as the share of
/// the way from F to ±F_C: 1 − w/w₀, which keeps the digits of a small change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Displacement at the start [m].
    u: f64,
    /// Direction s.
    s: f64,
    /// Force at the start [N].
    force: f64,
    /// Where it tends, sF_C [N].
    target: f64,
    /// γ.
    gamma: f64,
    /// By the distance: (σ/F_C)|w₀|^(γ−1), the initial slope of the share [1/m].
    rate: f64,
}

impl Piece {
    /// The piece from the displacement `u` [m] in the direction of `s`, where the force is `force` [N].
    pub fn new(dahl: &Dahl, force: f64, u: f64, s: f64) -> Self {
        let target = s.signum() * dahl.f_c;
        let w0 = ((target - force) / dahl.f_c).abs();
        let power = match dahl.gamma {
            0.0 => 1.0 / w0,
            1.0 => 1.0,
            2.0 => w0,
            gamma => w0.powf(gamma - 1.0),
        };
        let rate = dahl.sigma / dahl.f_c * power;
        Self { u, s: s.signum(), force, target, gamma: dahl.gamma, rate }
    }

    /// Puts the force [N] in the place of each displacement [m].
    pub fn forces(&self, u: &mut [f64]) {
        if self.force == self.target {
            u.fill(self.force);
            return;
        }
        let p = 1.0 - self.gamma;
        match self.gamma {
            // Cut at 1 by what uses it.
            0.0 => self.fill(u, |x| x),
            1.0 => self.fill(u, |x| -exp_m1(-x)),
            2.0 => self.fill(u, |x| x / (1.0 + x)),
            _ if p > 0.0 => self.fill(u, |x| {
                let left = if p * x < 1.0 { -p * x } else { 0.0 };
                let share = -exp_m1(ln_1p(left) / p);
                if p * x < 1.0 { share } else { 1.0 }
            }),
            _ => self.fill(u, |x| -exp_m1(ln_1p(-p * x) / p)),
        }
    }

    /// The force [N] at the displacement `u` [m].
    pub fn force(&self, u: f64) -> f64 {
        let mut here = [u];
        self.forces(&mut here);
        here[0]
    }

    /// F after the distance |Δu|, from the `share` of the way to ±F_C; never beyond, and there for 1.
    #[inline]
    fn fill(&self, u: &mut [f64], share: impl Fn(f64) -> f64) {
        let Self { u: u0, s, force, target, rate, .. } = *self;
        let gap = target - force;
        let (low, high) = (force.min(target), force.max(target));
        in_place(u, |u| {
            let distance = s * (u - u0);
            // Next to a turn rounding can go back.
            let share = share(rate * if distance > 0.0 { distance } else { 0.0 });
            let f = force + gap * share;
            let f = if f > low { f } else { low };
            let f = if f < high { f } else { high };
            if share < 1.0 { f } else { target }
        });
    }
}
