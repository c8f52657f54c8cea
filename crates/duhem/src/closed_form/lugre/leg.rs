//! The deflection on a leg of constant speed, at many times at once.

use crate::{
    LuGre,
    elementary::{exp_m1, in_place},
    sgn,
};

/// A leg of constant velocity, and the deflection at its start.
///
/// It is [`super::advance`] with all that is constant on the leg done once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// When it starts [s].
    start: f64,
    /// Deflection there [m].
    x: f64,
    /// Where it tends, s r [m]; where it is if nothing moves.
    target: f64,
    /// How fast, |u̇|/r [1/s].
    rate: f64,
}

impl Leg {
    /// The leg from the time `start` [s] at the velocity `u_dot` [m/s], where the deflection is `x` [m].
    pub fn new(lugre: &LuGre, x: f64, start: f64, u_dot: f64) -> Self {
        let r = lugre.r(u_dot);
        let target = if u_dot == 0.0 { x } else { sgn(u_dot) * r };
        Self { start, x, target, rate: u_dot.abs() / r }
    }

    /// Puts the deflection [m] in the place of each time [s].
    pub fn deflections(&self, times: &mut [f64]) {
        let Self { start, x, target, rate } = *self;
        in_place(times, |t| x - (target - x) * exp_m1(-rate * (t - start)));
    }

    /// The deflection [m] at the time `t` [s].
    pub fn deflection(&self, t: f64) -> f64 {
        let mut here = [t];
        self.deflections(&mut here);
        here[0]
    }
}
