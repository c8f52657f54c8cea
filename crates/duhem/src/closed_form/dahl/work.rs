//! The work of the force.

use super::{decay, power_integral};
use crate::{Dahl, Input, closed_form::Arcs};

/// ∫F du [J] over a monotone displacement `delta_u` [m], signed, from `force` [N].
///
/// With w = 1 − sF/F_C it is F_C|Δu| − (F_C²/σ) ∫w^(1−γ) dw, which for γ = 1 and γ = 2 becomes an
/// exponential and a logarithm.
pub fn work(dahl: &Dahl, force: f64, delta_u: f64) -> f64 {
    if delta_u == 0.0 {
        return 0.0;
    }
    let f0 = delta_u.signum() * force / dahl.f_c;
    let w0 = 1.0 - f0;
    let kappa = dahl.sigma / dahl.f_c * delta_u.abs();
    let log_ratio = decay(dahl, w0.abs(), delta_u.abs());
    let unit = dahl.f_c * dahl.f_c / dahl.sigma;
    let f1 = f0 - w0 * log_ratio.exp_m1();
    small(dahl.gamma, f0, f1).map_or_else(
        || unit * (kappa - w0.signum() * power_integral(2.0 - dahl.gamma, w0.abs(), log_ratio)),
        |work| unit * work,
    )
}

/// ∮F du [J] of the loop with ±`force` at its turns and `beta` [m] between them: both ways lose the
/// same. A small loop is of third order in its height, and is summed from there.
pub(super) fn loop_area(dahl: &Dahl, force: f64, beta: f64) -> f64 {
    let (a, unit) = (force / dahl.f_c, dahl.f_c * dahl.f_c / dahl.sigma);
    let one_way = small(dahl.gamma, -a, a).map(|work| unit * work);
    // Rounding could give an elastic loop, of γ = 0, an area below zero.
    2.0 * one_way.unwrap_or_else(|| work(dahl, -force, beta)).max(0.0)
}

/// ∫F du [J] of the exact trajectory from `f0` [N] over a span of time [s].
pub fn work_over(dahl: &Dahl, input: &Input, f0: f64, span: (f64, f64)) -> f64 {
    let arcs = Arcs::new(input, span);
    let (mut force, mut sum) = (f0, 0.0);
    for k in 0..arcs.len() {
        sum += work(dahl, force, arcs.travel(k));
        force = super::advance(dahl, force, arcs.travel(k));
    }
    sum
}

/// ∫ f (1 − f)^(−γ) df from f₀ to f₁ by the binomial series, for forces far below F_C, where the closed
/// form would cancel; nothing for larger ones.
fn small(gamma: f64, f0: f64, f1: f64) -> Option<f64> {
    if f0.abs().max(f1.abs()) * gamma.max(1.0) >= 0.125 {
        return None;
    }
    let (mut coefficient, mut n, mut sum) = (1.0, 0.0, 0.0);
    let (mut low, mut high) = (f0 * f0, f1 * f1);
    let size = low.max(high);
    while coefficient * size * (f0.abs().max(f1.abs())).powf(n) > 1e-20 * size {
        sum += coefficient * (high - low) / (n + 2.0);
        coefficient *= (gamma + n) / (n + 1.0);
        (low, high) = (low * f0, high * f1);
        n += 1.0;
    }
    Some(sum)
}
