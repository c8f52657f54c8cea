//! A spring with Dahl friction driven so slowly that the mass does not matter: k_s q + F(q) = F_e.
//!
//! Both terms grow with q on the way up and fall on the way down, so q follows from F_e by bisection;
//! for γ = 1 it is a Lambert function, which is the same root by another name.

use super::{Loop, advance, settling::bisect};
use crate::{Dahl, sgn};

/// The displacement [m] at the force `drive` [N] on the first way from q = 0, F = 0.
pub fn first_way(dahl: &Dahl, stiffness: f64, drive: f64) -> f64 {
    let s = sgn(drive);
    let below = |way: f64| stiffness * way + advance(dahl, 0.0, way) < s * drive;
    s * bisect(0.0, s * drive / stiffness, below)
}

/// The loop q(F_e) that a slow drive ±`amplitude` [N] settles on.
#[derive(Debug, Clone, PartialEq)]
pub struct QuasiStaticLoop {
    /// Stiffness k_s of the spring [N/m].
    pub stiffness: f64,
    /// The friction on the way between −q_max and q_max.
    pub friction: Loop,
}

impl QuasiStaticLoop {
    /// The loop between the drives ±`amplitude` [N].
    pub fn new(dahl: &Dahl, stiffness: f64, amplitude: f64) -> Self {
        let friction = |q: f64| Loop::new(dahl, (-q, q));
        let below = |q: f64| stiffness * q + friction(q).force_at_u_max < amplitude;
        let q_max = bisect(0.0, amplitude / stiffness, below);
        Self { stiffness, friction: friction(q_max) }
    }

    /// The largest displacement [m].
    pub fn q_max(&self) -> f64 {
        self.friction.u_max
    }

    /// ∮F_e dq [J]: the spring gives back what it takes, so it is friction's ∮F dq.
    pub fn area(&self) -> f64 {
        self.friction.area()
    }

    /// The displacement [m] at the force `drive` [N], on the way up or down.
    pub fn q(&self, drive: f64, rising: bool) -> f64 {
        let below = |q: f64| self.stiffness * q + self.friction.force(q, rising) < drive;
        bisect(self.friction.u_min, self.friction.u_max, below)
    }

    /// The width [m] of the loop at F_e = 0.
    pub fn width(&self) -> f64 {
        self.q(0.0, false) - self.q(0.0, true)
    }
}
