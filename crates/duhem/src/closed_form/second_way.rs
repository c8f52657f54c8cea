//! The Dahl loop a second time, with no formula of [`super::dahl`].
//!
//! du = dF/D±(F), equations 12 and 13, integrated by double-exponential quadrature; what is sought on
//! the way is found by bisection. The only change of variable is F = ±F_C (1 − e^v), which keeps the
//! distance e^v to ±F_C apart, so that it can be as small as the integrals need it.

use crate::Dahl;
use std::f64::consts::{FRAC_PI_2, LN_2};

/// |du|/dv [m]: F_C e^v divided by D± = σ e^(γv).
fn density(dahl: &Dahl, v: f64) -> f64 {
    dahl.f_c / dahl.sigma * ((1.0 - dahl.gamma) * v).exp()
}

/// The distance [m] while v falls from `v0` by `drop`, which may be ∞ for γ < 1.
fn distance(dahl: &Dahl, v0: f64, drop: f64) -> f64 {
    integral(|x| density(dahl, v0 - x), drop)
}

/// The work [J] on the same way: ∫ F du, with F = F_C (1 − e^v) in the direction of motion.
fn work_between(dahl: &Dahl, v0: f64, drop: f64) -> f64 {
    integral(|x| -(v0 - x).exp_m1() * dahl.f_c * density(dahl, v0 - x), drop)
}

/// By how much v falls from `v0` on the way |Δu| = `way` [m]; ∞ if it saturates.
fn drop_after(dahl: &Dahl, v0: f64, way: f64) -> f64 {
    if v0 == f64::NEG_INFINITY {
        return 0.0;
    }
    if dahl.gamma < 1.0 && way >= distance(dahl, v0, f64::INFINITY) {
        return f64::INFINITY;
    }
    let mut reach = 1.0;
    while distance(dahl, v0, reach) < way {
        reach *= 2.0;
    }
    bisect(0.0, reach, |drop| distance(dahl, v0, drop) < way)
}

/// The force [N] after a monotone displacement `delta_u` [m], signed, from `force` within ±F_C [N].
pub fn advance(dahl: &Dahl, force: f64, delta_u: f64) -> f64 {
    if delta_u == 0.0 {
        return force;
    }
    let s = delta_u.signum();
    let v0 = (-s * force / dahl.f_c).ln_1p();
    -s * dahl.f_c * (v0 - drop_after(dahl, v0, delta_u.abs())).exp_m1()
}

/// ∫F du [J] over a monotone displacement `delta_u` [m], signed, from `force` within ±F_C [N].
pub fn work(dahl: &Dahl, force: f64, delta_u: f64) -> f64 {
    if delta_u == 0.0 {
        return 0.0;
    }
    let v0 = (-delta_u.signum() * force / dahl.f_c).ln_1p();
    work_from(dahl, v0, delta_u.abs())
}

fn work_from(dahl: &Dahl, v0: f64, way: f64) -> f64 {
    if v0 == f64::NEG_INFINITY {
        return dahl.f_c * way;
    }
    let drop = drop_after(dahl, v0, way);
    let flat = if drop == f64::INFINITY { way - distance(dahl, v0, drop) } else { 0.0 };
    work_between(dahl, v0, drop) + dahl.f_c * flat
}

/// The displacement [m] that takes F from −F_C to F_C; nothing if the integral diverges.
pub fn saturation_travel(dahl: &Dahl) -> Option<f64> {
    (dahl.gamma < 1.0).then(|| distance(dahl, LN_2, f64::INFINITY))
}

/// The settled loop, found by bisection on "the way from −a to a is u_max − u_min long".
#[derive(Debug, Clone, PartialEq)]
pub struct Loop {
    dahl: Dahl,
    /// Left turning point [m].
    pub u_min: f64,
    /// Right turning point [m].
    pub u_max: f64,
    /// ln(1 − a), with a = F(u_max)/F_C.
    log_gap: f64,
}

impl Loop {
    /// The loop between these extremes [m].
    pub fn new(dahl: &Dahl, (u_min, u_max): (f64, f64)) -> Self {
        let beta = u_max - u_min;
        let way = |gap: f64| distance(dahl, above(-gap), above(-gap) + gap);
        let log_gap = if saturation_travel(dahl).is_some_and(|travel| beta >= travel) {
            f64::NEG_INFINITY
        } else {
            let mut reach = 1.0;
            while way(reach) < beta {
                reach *= 2.0;
            }
            -bisect(0.0, reach, |gap| way(gap) < beta)
        };
        Self { dahl: dahl.clone(), u_min, u_max, log_gap }
    }

    /// Force at the right turning point [N].
    pub fn force_at_u_max(&self) -> f64 {
        -self.dahl.f_c * self.log_gap.exp_m1()
    }

    /// The force [N] at `u` [m] within the range, going up or down.
    pub fn force(&self, u: f64, rising: bool) -> f64 {
        let (s, way) = if rising { (1.0, u - self.u_min) } else { (-1.0, self.u_max - u) };
        let v0 = above(self.log_gap);
        -s * self.dahl.f_c * (v0 - drop_after(&self.dahl, v0, way)).exp_m1()
    }

    /// ∮F du [J].
    pub fn area(&self) -> f64 {
        2.0 * work_from(&self.dahl, above(self.log_gap), self.u_max - self.u_min)
    }

    /// The displacement [m] from a turning point to F = 0.
    pub fn lag(&self) -> f64 {
        let v0 = above(self.log_gap);
        distance(&self.dahl, v0, v0)
    }
}

/// ln(1 + a) from ln(1 − a).
fn above(log_gap: f64) -> f64 {
    (-log_gap.exp_m1()).ln_1p()
}

/// The point of [low, high] where `below` turns false, to the last digit.
fn bisect(mut low: f64, mut high: f64, below: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return middle;
        }
        if below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// ∫ f dx from 0 to `end`, which may be ∞.
fn integral(f: impl Fn(f64) -> f64, end: f64) -> f64 {
    if end == f64::INFINITY {
        // x = exp(π/2 sinh t)
        refine(|t| {
            let x = (FRAC_PI_2 * t.sinh()).exp();
            f(x) * x * FRAC_PI_2 * t.cosh()
        })
    } else {
        // x = end (1 + tanh(π/2 sinh t))/2
        refine(|t| {
            let y = FRAC_PI_2 * t.sinh();
            let x = end / (1.0 + (-2.0 * y).exp());
            f(x) * 0.5 * end * FRAC_PI_2 * t.cosh() / (y.cosh() * y.cosh())
        })
    }
}

/// The trapezoidal sum over the whole line, refined until it no longer changes.
fn refine(f: impl Fn(f64) -> f64) -> f64 {
    const REACH: f64 = 5.0;
    let (mut h, mut old) = (0.5, f64::NAN);
    let mut n = 20;
    let mut sum: f64 = (0..=n).map(|i| f(h * f64::from(i) - REACH)).sum();
    for _ in 0..9 {
        let new = h * sum;
        if (new - old).abs() <= 4.0 * f64::EPSILON * new.abs() {
            return new;
        }
        (old, h) = (new, 0.5 * h);
        sum += (0..n).map(|i| f(h * f64::from(2 * i + 1) - REACH)).sum::<f64>();
        n *= 2;
    }
    h * sum
}
