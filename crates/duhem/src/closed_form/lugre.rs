//! The LuGre model solved exactly where the speed is constant between the turns: triangle waves,
//! staircases, samples. There equation 18 is linear with constant coefficients.

use super::{Arcs, Reference, ReferenceError, check};
use crate::{Input, LuGre, Parameters, sgn};

/// The bristle deflection [m] after the displacement `delta_u` [m] at the constant velocity `u_dot`
/// [m/s]: x = s r + (x₀ − s r) e^(−|Δu|/r), s = sgn u̇.
pub fn advance(lugre: &LuGre, x: f64, delta_u: f64, u_dot: f64) -> f64 {
    if u_dot == 0.0 {
        return x;
    }
    let r = lugre.r(u_dot);
    let part = -(-delta_u.abs() / r).exp_m1();
    x + (sgn(u_dot) * r - x) * part
}

/// The deflection at the right turning point [m] of the settled loop of a triangle wave of the speed
/// `speed` [m/s] and the width `beta` = u_max − u_min [m]: r tanh(β/2r).
pub fn settled_deflection(lugre: &LuGre, speed: f64, beta: f64) -> f64 {
    let r = lugre.r(speed);
    r * (0.5 * beta / r).tanh()
}

/// The exact deflection of the bristles under an input of piecewise constant velocity.
#[derive(Debug, Clone)]
pub struct Trajectory {
    lugre: LuGre,
    arcs: Arcs,
    /// Velocity on each arc [m/s].
    u_dot: Vec<f64>,
    /// Deflection at the start of each arc [m].
    x: Vec<f64>,
}

impl Trajectory {
    /// The trajectory from `x0` [m] over the span [s].
    pub fn new(
        lugre: &LuGre,
        input: &Input,
        x0: f64,
        span: (f64, f64),
    ) -> Result<Self, ReferenceError> {
        check(&[x0], 1, span)?;
        let arcs = Arcs::new(input, span);
        let (mut u_dot, mut x) = (Vec::with_capacity(arcs.len()), vec![x0]);
        for k in 0..arcs.len() {
            let (start, end) = arcs.ends(k);
            let constant = arcs.constant_velocity(k);
            let velocity = constant.ok_or(ReferenceError::Velocity { start, end })?;
            u_dot.push(velocity);
            x.push(advance(lugre, x[k], arcs.travel(k), velocity));
        }
        Ok(Self { lugre: lugre.clone(), arcs, u_dot, x })
    }

    /// The exact deflection [m] at time `t` [s] of the span.
    pub fn deflection(&self, t: f64) -> f64 {
        let (k, so_far) = self.arcs.locate(t);
        advance(&self.lugre, self.x[k], so_far, self.u_dot[k])
    }

    pub(crate) fn build(
        parameters: &Parameters,
        input: &Input,
        x0: &[f64],
        span: (f64, f64),
    ) -> Result<Box<dyn Reference>, ReferenceError> {
        let lugre = LuGre::new(parameters)?;
        check(x0, 1, span)?;
        Ok(Box::new(Self::new(&lugre, input, x0[0], span)?))
    }
}

impl Reference for Trajectory {
    fn state(&self, t: f64, x: &mut [f64]) {
        x[0] = self.deflection(t);
    }

    /// The flow contracts, so the roundings of the arcs add at most: that of u, with |dx/du| ≤ 1 + |x|/r,
    /// and a few units of the largest deflection.
    fn error_bound(&self) -> f64 {
        let slowest = self.lugre.f_s.min(self.lugre.f_c) / self.lugre.sigma_0;
        let fastest = self.lugre.f_s.max(self.lugre.f_c) / self.lugre.sigma_0;
        let largest = self.x.iter().fold(fastest, |largest, x| largest.max(x.abs()));
        let slope = 1.0 + largest / slowest;
        let arcs = self.x.len() as f64;
        arcs * (8.0 * f64::EPSILON * largest + 2.0 * slope * self.arcs.rounding())
    }
}
