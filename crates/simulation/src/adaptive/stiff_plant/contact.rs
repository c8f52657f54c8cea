//! Friction with one state as the stiff method takes it: many stages at once, on one side of its kink.

#![expect(
    clippy::inline_always,
    reason = "called for every stage: a call costs more than what it does"
)]

use duhem::{Dahl, LuGre};
use integrate::collocation::{exp, fma};

/// The slopes of ẋ and of F at one state, F with ẋ put in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slopes {
    /// ∂ẋ/∂u̇.
    pub(super) x_dot_by_v: f64,
    /// ∂ẋ/∂x [1/s].
    pub(super) x_dot_by_x: f64,
    /// ∂F/∂u̇ [N·s/m].
    pub(super) force_by_v: f64,
    /// ∂F/∂x.
    pub(super) force_by_x: f64,
}

/// A friction model with one state whose right-hand side is smooth in u̇ on each side of zero. All of it is
/// for the side s = sgn u̇ and continued smoothly beyond it, where |u̇| reads s u̇.
pub(super) trait Contact: Send + Sync + std::fmt::Debug {
    /// ẋ and F [N] for velocities `v` [m/s] and states `x`.
    fn flow<const W: usize>(&self, s: f64, v: &[f64; W], x: &[f64; W]) -> ([f64; W], [f64; W]);

    /// Their slopes.
    fn slopes(&self, s: f64, v: f64, x: f64) -> Slopes;

    /// The speed [m/s] below which the friction changes most; 0 if it has no such speed.
    fn zone(&self) -> f64;

    /// The largest |x| that a motion can lead to from a smaller one.
    fn limit(&self) -> f64;

    /// The displacement [m] over which the contact is deflected to its limit.
    fn deflection(&self) -> f64;
}

/// At so many times v_S the Stribeck term is e⁻¹⁶ of what it is at rest.
const STRIBECK_ZONE: f64 = 4.0;

impl Contact for LuGre {
    #[inline(always)]
    fn flow<const W: usize>(&self, s: f64, v: &[f64; W], x: &[f64; W]) -> ([f64; W], [f64; W]) {
        let slower = 1.0 / self.v_s;
        let stribeck = exp(&v.map(|v| -(v * slower) * (v * slower)));
        let (mut x_dot, mut force) = ([0.0; W], [0.0; W]);
        for i in 0..W {
            let limit = fma(self.f_s - self.f_c, stribeck[i], self.f_c);
            x_dot[i] = fma(-s * self.sigma_0 * x[i] / limit, v[i], v[i]);
            let viscous = fma(self.sigma_1, x_dot[i], self.sigma_2 * v[i]);
            force[i] = fma(self.sigma_0, x[i], viscous);
        }
        (x_dot, force)
    }

    #[inline(always)]
    fn slopes(&self, s: f64, v: f64, x: f64) -> Slopes {
        let z = v / self.v_s;
        let [stribeck] = exp(&[-z * z]).map(|share| (self.f_s - self.f_c) * share);
        let limit = self.f_c + stribeck;
        let share = s * self.sigma_0 * x / limit;
        // The limit falls with the speed, at the rate −2v/v_S² of its Stribeck term.
        let fall = 2.0 * z * z * stribeck / limit;
        let (x_dot_by_v, x_dot_by_x) = (1.0 - share * (1.0 + fall), -s * v * self.sigma_0 / limit);
        Slopes {
            x_dot_by_v,
            x_dot_by_x,
            force_by_v: self.sigma_1 * x_dot_by_v + self.sigma_2,
            force_by_x: self.sigma_0 + self.sigma_1 * x_dot_by_x,
        }
    }

    fn zone(&self) -> f64 {
        STRIBECK_ZONE * self.v_s
    }

    /// With F_S below F_C the contact holds more in motion than at rest.
    fn limit(&self) -> f64 {
        self.f_s.max(self.f_c) / self.sigma_0
    }

    fn deflection(&self) -> f64 {
        self.limit()
    }
}

/// For γ ≥ 1; below, the right-hand side is not Lipschitz where the force arrives at F_C.
impl Contact for Dahl {
    #[inline(always)]
    fn flow<const W: usize>(&self, s: f64, v: &[f64; W], x: &[f64; W]) -> ([f64; W], [f64; W]) {
        let mut x_dot = [0.0; W];
        for i in 0..W {
            let left = 1.0 - s * x[i] / self.f_c;
            let share = match self.gamma {
                1.0 => left,
                2.0 => left * left.abs(),
                gamma => left.abs().powf(gamma).copysign(left),
            };
            x_dot[i] = self.sigma * share * v[i];
        }
        (x_dot, *x)
    }

    fn slopes(&self, s: f64, v: f64, x: f64) -> Slopes {
        let left = 1.0 - s * x / self.f_c;
        let slope = self.gamma * left.abs().powf(self.gamma - 1.0);
        Slopes {
            x_dot_by_v: self.sigma * left.abs().powf(self.gamma).copysign(left),
            x_dot_by_x: -self.sigma * slope * s / self.f_c * v,
            force_by_v: 0.0,
            force_by_x: 1.0,
        }
    }

    fn zone(&self) -> f64 {
        0.0
    }

    fn limit(&self) -> f64 {
        self.f_c
    }

    fn deflection(&self) -> f64 {
        self.f_c / self.sigma
    }
}
