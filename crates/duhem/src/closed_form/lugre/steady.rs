//! Where the steady sliding force, equation 21, stops falling and starts rising.

use crate::LuGre;

/// The two positive speeds where Fₛₛ has a horizontal tangent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyExtrema {
    /// Speed of the local maximum, from which Fₛₛ decreases [m/s].
    pub maximum: f64,
    /// Speed of the local minimum, from which Fₛₛ increases [m/s].
    pub minimum: f64,
}

/// The extrema of equation 21, where 2s e^(−s²) = σ₂v_S/(F_S − F_C) with s = u̇/v_S; nothing if Fₛₛ is
/// monotone. Without σ₂ the maximum is at 0 and the minimum at ∞.
pub fn steady_extrema(lugre: &LuGre) -> Option<SteadyExtrema> {
    let level = lugre.sigma_2 * lugre.v_s / (lugre.f_s - lugre.f_c);
    // The left side is largest, √(2/e), at s = 1/√2.
    let top = std::f64::consts::FRAC_1_SQRT_2;
    if lugre.f_s <= lugre.f_c || level >= drop(top) {
        return None;
    }
    if level == 0.0 {
        return Some(SteadyExtrema { maximum: 0.0, minimum: f64::INFINITY });
    }
    let mut far = 2.0;
    while drop(far) > level {
        far *= 2.0;
    }
    Some(SteadyExtrema {
        maximum: lugre.v_s * root(level, 0.0, top),
        minimum: lugre.v_s * root(level, far, top),
    })
}

/// 2s e^(−s²): how fast the Stribeck term falls, in units of (F_S − F_C)/v_S.
fn drop(s: f64) -> f64 {
    2.0 * s * (-s * s).exp()
}

/// The s between `below` and `above` where `drop` is `level`, by bisection to the last digit.
fn root(level: f64, mut below: f64, mut above: f64) -> f64 {
    loop {
        let s = below + 0.5 * (above - below);
        if s == below || s == above {
            return s;
        }
        if drop(s) < level {
            below = s;
        } else {
            above = s;
        }
    }
}
