//! The Dahl model solved exactly, for every γ ≥ 0 and every input.
//!
//! On a monotone piece with direction s = sgn u̇ let w = 1 − sF/F_C. Equation 11 then reads
//! dw/d|u| = −(σ/F_C) |w|^γ sgn w, which separates: |w|^(1−γ) falls linearly with the distance, and
//! exponentially |w| itself if γ = 1. Everything here is written with 1 − γ inside `exp_m1` and
//! `ln_1p`, so that it passes through γ = 1 (and the work through γ = 2) without losing a digit.

mod corollary;
mod piece;
pub mod quasi_static;
mod settled;
pub mod settling;
mod trajectory;
mod work;

pub use corollary::{alpha_plus, contraction, falling, falling_as_printed, rising};
pub use piece::Piece;
pub use settled::Loop;
pub use trajectory::Trajectory;
pub use work::{work, work_over};

use crate::Dahl;

/// The exact force [N] after a monotone displacement `delta_u` [m], signed, from `force` [N].
///
/// For abs(F) ≤ F_C the result is within ±F_C exactly, and reaches it in finite travel if γ < 1.
pub fn advance(dahl: &Dahl, force: f64, delta_u: f64) -> f64 {
    if delta_u == 0.0 {
        return force;
    }
    let s = delta_u.signum();
    let w0 = 1.0 - s * force / dahl.f_c;
    let w = w0 * decay(dahl, w0.abs(), delta_u.abs()).exp();
    s * dahl.f_c * (1.0 - w)
}

/// The signed displacement [m] that takes the force from `from` to `to` [N], both within ±F_C;
/// nothing if no displacement does: ±F_C itself is out of reach for γ ≥ 1.
pub fn travel(dahl: &Dahl, from: f64, to: f64) -> Option<f64> {
    let (f_c, p) = (dahl.f_c, 1.0 - dahl.gamma);
    if from.abs() > f_c || to.abs() > f_c {
        return None;
    }
    if from == to {
        return Some(0.0);
    }
    let s = (to - from).signum();
    let (w0, w1) = (1.0 - s * from / f_c, 1.0 - s * to / f_c);
    if w1 <= 0.0 && p <= 0.0 {
        return None;
    }
    let log_ratio = -((s * (to - from) / f_c) / w1).ln_1p();
    Some(s * f_c / dahl.sigma * power_integral(p, w0, log_ratio))
}

/// The displacement [m] that takes F from −F_C to F_C: finite for γ < 1 only, where the model is not
/// Lipschitz at F_C.
pub fn saturation_travel(dahl: &Dahl) -> Option<f64> {
    travel(dahl, -dahl.f_c, dahl.f_c)
}

/// ln(w/w₀) after the distance |Δu| [m] from w₀ ≥ 0; −∞ once saturated.
fn decay(dahl: &Dahl, w0: f64, distance: f64) -> f64 {
    let (p, kappa) = (1.0 - dahl.gamma, dahl.sigma / dahl.f_c * distance);
    if p == 0.0 {
        return -kappa;
    }
    if w0 == 0.0 {
        return f64::NEG_INFINITY;
    }
    let left = -p * kappa * w0.powf(-p);
    if left <= -1.0 { f64::NEG_INFINITY } else { left.ln_1p() / p }
}

/// ∫ w^(q−1) dw from w₁ to w₀, where `log_ratio` = ln(w₁/w₀) ≤ 0: stable also at q = 0.
fn power_integral(q: f64, w0: f64, log_ratio: f64) -> f64 {
    if w0 == 0.0 {
        return 0.0;
    }
    if q == 0.0 { -log_ratio } else { w0.powf(q) * -(q * log_ratio).exp_m1() / q }
}
