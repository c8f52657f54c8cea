//! The LuGre model solved exactly: under an imposed motion equation 18 is linear in x.
//!
//! Where the speed is constant (triangle waves, staircases, samples) the solution is an exponential;
//! elsewhere it is variation of constants, by quadrature to the last digits.

mod panel;
mod steady;
mod trajectory;

pub use steady::{SteadyExtrema, steady_extrema};
pub use trajectory::{Trajectory, settled_start};

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
