//! Where the LuGre model dissipates, and where it can give energy back.
//!
//! The bristles store ½σ₀x². What is left of the power F u̇ is D = F u̇ − d/dt(½σ₀x²), and with equations
//! 18 and 19 and a = |u̇|/r(u̇) it is D = σ₀ a x² + σ₁ẋ² + σ₁ a x ẋ + σ₂u̇². Because r falls with the speed, a
//! deflection left over from slow motion can be larger than r(u̇): the bristles then relax, ẋ < 0, and
//! σ₁ẋ pushes along the motion.

use crate::{FrictionModel, LuGre};

/// The power D lost [W] at the deflection `x` [m] and the velocity `u_dot` [m/s]; negative where the
/// model gives back more than the bristles had stored.
pub fn dissipation(lugre: &LuGre, x: f64, u_dot: f64) -> f64 {
    let mut x_dot = [0.0];
    lugre.x_dot(&[x], 0.0, u_dot, &mut x_dot);
    lugre.force(&[x], &x_dot, 0.0, u_dot) * u_dot - lugre.sigma_0 * x * x_dot[0]
}

/// The |u̇|/r(u̇) [1/s] up to which D ≥ 0 at every deflection: 4σ₀(σ₁ + σ₂)/σ₁², where the quadratic
/// form D of x and u̇ loses its definiteness; ∞ without σ₁.
pub fn dissipative_rate(lugre: &LuGre) -> f64 {
    4.0 * lugre.sigma_0 * (lugre.sigma_1 + lugre.sigma_2) / (lugre.sigma_1 * lugre.sigma_1)
}

/// The speed [m/s] up to which D ≥ 0 at every deflection.
pub fn dissipative_speed(lugre: &LuGre) -> f64 {
    let rate = dissipative_rate(lugre);
    lowest(lugre, |v| v / lugre.r(v) > rate).unwrap_or(f64::INFINITY)
}

/// The speed [m/s] up to which D ≥ 0 at every deflection that motion from rest can reach, |x| ≤ F_S/σ₀;
/// nothing if there is no such speed, so that the model gives energy back at none.
///
/// With ξ = x/r along u̇, D/|u̇| = σ₀ r ξ² + (σ₁(1 − ξ) + σ₂)|u̇|: it needs ξ > 1, and ξ ≤ F_S/(σ₀ r). If
/// F_S ≤ F_C (1 + σ₂/σ₁) the bracket is positive at every speed.
pub fn returning_speed(lugre: &LuGre) -> Option<f64> {
    let most = lugre.scale()[0];
    let reach = |v: f64| {
        let (r, best) = (lugre.r(v), 2.0 * (1.0 + lugre.sigma_2 / lugre.sigma_1));
        let xi = (most / r).min(best);
        let push = lugre.sigma_1 * (xi - 1.0) - lugre.sigma_2;
        push > 0.0 && v * push > lugre.sigma_0 * r * xi * xi
    };
    lowest(lugre, reach)
}

/// The lowest speed at which `happens`, which then goes on happening, by bisection to the last digit.
fn lowest(lugre: &LuGre, happens: impl Fn(f64) -> bool) -> Option<f64> {
    /// No speed is larger than this many Stribeck velocities.
    const FASTEST: f64 = 1e15;
    let (mut low, mut high) = (0.0, lugre.v_s);
    while !happens(high) {
        (low, high) = (high, 2.0 * high);
        if high > FASTEST * lugre.v_s {
            return None;
        }
    }
    loop {
        let v = low + 0.5 * (high - low);
        if v <= low || v >= high {
            return Some(v);
        }
        if happens(v) { high = v } else { low = v }
    }
}
