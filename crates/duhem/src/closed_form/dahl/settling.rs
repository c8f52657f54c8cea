//! Where a mass on a spring with Dahl friction settles at a constant force.
//!
//! Between two turning points the kinetic energy is the work of the net force F_e − k_s q − F(q), with
//! F(q) the closed form of the friction. The next turning point is where that work is spent: a root of
//! one function of q, whatever the mass. So the whole sequence of turning points is a closed form
//! iterated.
//!
//! **What comes out.** Every state with v = 0 and F = F_e − k_s q is a rest. A state that is not at
//! rest swings on, and for γ = 1 the swings shrink as 1/n only. The contact is stiffer on the way back
//! to F = 0 than on the way out, so each cycle takes F a little towards 0: with f = F/F_C and a swing δ,
//! per cycle Δδ = −2σ²δ²/(3F_C K) and Δf = −2k_sσfδ/(F_C K), K = k_s + σ, to leading order, hence
//! δ → 3F_C K/(2σ²n) and f ~ n^(−3k_s/σ) (while 3k_s < σ; what is of higher order in δ gives 1/n). For
//! any other γ > 0 δ is the γ-th part of that, and the exponent the same. The paper has F settle at ±F_C and the mass at (F_e ∓ F_C)/k_s, where no trajectory goes.

use super::{advance, work};
use crate::{Dahl, sgn};

/// A mass on a spring with Dahl friction under a constant force.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldMass {
    /// The friction.
    pub dahl: Dahl,
    /// Stiffness k_s of the spring [N/m], positive.
    pub stiffness: f64,
    /// Force F_e [N].
    pub drive: f64,
}

/// A point on the way where the friction is known: a turning point, or a crossing of balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Displacement q [m].
    pub q: f64,
    /// Friction force F [N], within ±F_C.
    pub force: f64,
}

/// Where the mass is after a number of swings, and where it can still go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settling {
    /// How many swings were taken.
    pub swings: usize,
    /// Length of the last swing [m]; 0 at rest.
    pub swing: f64,
    /// The mean of the last two crossings of balance, one on each way: the rest that the mass is nearest to.
    pub rest: Contact,
    /// How much the displacement of the two crossings differs [m].
    pub spread: f64,
}

impl HeldMass {
    /// The net force F_e − k_s q − F [N]; the mass is at rest if it is 0 with v = 0.
    pub fn net_force(&self, at: Contact) -> f64 {
        self.drive - self.stiffness * at.q - at.force
    }

    /// The next turning point of the mass that stands at `from`; nothing if it rests there.
    pub fn next_turn(&self, from: Contact) -> Option<Contact> {
        let s = sgn(self.net_force(from));
        (s != 0.0).then(|| self.turn(from, s, 0.0))
    }

    /// The first turning point of a mass that passes `from` in the direction `s` = ±1 with the kinetic
    /// energy `kinetic` [J]: the only place where the mass matters.
    pub fn first_turn(&self, from: Contact, s: f64, kinetic: f64) -> Contact {
        self.turn(from, s, kinetic)
    }

    /// Up to `count` turning points after `from`, which is one itself; fewer if the mass comes to rest.
    pub fn turns(&self, from: Contact, count: usize) -> Vec<Contact> {
        let next = |at: &Contact| self.next_turn(*at);
        std::iter::successors(Some(from), next).skip(1).take(count).collect()
    }

    /// Lets the mass swing `swings` times from the turning point `from`.
    pub fn settle(&self, from: Contact, swings: usize) -> Settling {
        let (mut at, mut before, mut swing) = (from, from, 0.0);
        for n in 0..swings {
            let Some(next) = self.next_turn(at) else {
                return Settling { swings: n, swing: 0.0, rest: at, spread: 0.0 };
            };
            swing = (next.q - at.q).abs();
            (before, at) = (at, next);
        }
        let (one, other) = (self.balance(before), self.balance(at));
        let rest = Contact { q: 0.5 * (one.q + other.q), force: 0.5 * (one.force + other.force) };
        Settling { swings, swing, rest, spread: (one.q - other.q).abs() }
    }

    /// Where the mass that leaves the turning point `from` crosses F_e = k_s q + F.
    pub fn balance(&self, from: Contact) -> Contact {
        let net = self.net_force(from);
        let s = sgn(net);
        let left = |way: f64| s * self.net_force(self.after(from, s * way));
        let way = bisect(0.0, net.abs() / self.stiffness, |way| left(way) > 0.0);
        self.after(from, s * way)
    }

    /// The displacements [m] between which every later crossing of balance lies: from where the mass is
    /// now to F = 0, where q = F_e/k_s, and the spread of the two ways beyond.
    pub fn range_of_rest(&self, now: &Settling) -> (f64, f64) {
        let end = self.drive / self.stiffness;
        (now.rest.q.min(end) - now.spread, now.rest.q.max(end) + now.spread)
    }

    fn after(&self, from: Contact, delta_q: f64) -> Contact {
        Contact { q: from.q + delta_q, force: advance(&self.dahl, from.force, delta_q) }
    }

    /// The root of T₀ + ∫(F_e − k_s q − F) dq: the integral is concave in the way, because F grows with
    /// it, so beyond its maximum there is one root, and none before.
    fn turn(&self, from: Contact, s: f64, kinetic: f64) -> Contact {
        let net = s * self.net_force(from);
        let w0 = 1.0 - s * from.force / self.dahl.f_c;
        // Twice the kinetic energy over the way; without friction's growth it is spent at `most`.
        let left = |way: f64| {
            2.0 * kinetic / way + 2.0 * net
                - self.stiffness * way
                - 2.0 * self.mean_growth(s, w0, way)
        };
        let most = (net + (net * net + 2.0 * self.stiffness * kinetic).sqrt()) / self.stiffness;
        let way = bisect(0.0, 1.000_001 * most, |way| left(way) > 0.0);
        self.after(from, s * way)
    }

    /// The mean of s(F − F₀) [N] over the way, without the cancellation of short ways for γ = 1.
    fn mean_growth(&self, s: f64, w0: f64, way: f64) -> f64 {
        let kappa = self.dahl.sigma / self.dahl.f_c * way;
        if self.dahl.gamma == 1.0 {
            return self.dahl.f_c * w0 * growth(kappa);
        }
        let f0 = s * self.dahl.f_c * (1.0 - w0);
        work(&self.dahl, f0, s * way) / way - s * f0
    }
}

/// 1 − (1 − e^(−κ))/κ.
fn growth(kappa: f64) -> f64 {
    if kappa > 0.05 {
        return 1.0 + (-kappa).exp_m1() / kappa;
    }
    // κ/2 − κ²/6 + κ³/24 − …; the ninth term is below 1e-17 of the first.
    let mut sum = 0.0;
    for n in (2..=10).rev() {
        sum = kappa / f64::from(n) * (1.0 - sum);
    }
    sum
}

/// The point of [low, high] where `holds` turns false, to the last digit.
pub(super) fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return middle;
        }
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}
