//! The LuGre model solved exactly: under an imposed motion equation 18 is linear in x.
//!
//! Where the speed is constant (triangle waves, staircases, samples) the solution is an exponential;
//! elsewhere it is variation of constants, by quadrature to the last digits.

mod leg;
mod panel;
mod passivity;
pub mod second_way;
mod steady;
mod trajectory;

pub use leg::Leg;
pub use passivity::{dissipation, dissipative_rate, dissipative_speed, returning_speed};
pub use steady::{SteadyExtrema, steady_extrema};
pub use trajectory::{Trajectory, settled, settled_start};

use crate::{LuGre, sgn};

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

/// ∫F du [J] over the displacement `delta_u` [m] at the constant velocity `u_dot` [m/s] from `x` [m]:
/// dx/du = 1 − sx/r gives ∫x du = s r(Δu − Δx), and ∫ẋ du = u̇ Δx.
pub fn work(lugre: &LuGre, x: f64, delta_u: f64, u_dot: f64) -> f64 {
    let delta_x = advance(lugre, x, delta_u, u_dot) - x;
    let elastic = lugre.sigma_0 * sgn(u_dot) * lugre.r(u_dot) * (delta_u - delta_x);
    elastic + lugre.sigma_1 * u_dot * delta_x + lugre.sigma_2 * u_dot * delta_u
}

/// The largest value of `f` between `low` and `high`, by golden sections.
pub(crate) fn largest((mut low, mut high): (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut best = f(low).max(f(high));
    for _ in 0..90 {
        let (a, b) = (high - share * (high - low), low + share * (high - low));
        let (fa, fb) = (f(a), f(b));
        best = best.max(fa).max(fb);
        if fa > fb { high = b } else { low = a }
    }
    best
}
