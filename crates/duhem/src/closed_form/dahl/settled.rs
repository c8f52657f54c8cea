//! The settled loop.

use super::{advance, travel, work::loop_area};
use crate::Dahl;
use std::f64::consts::LN_2;

/// The settled loop of the Dahl model between two turning points, at every frequency the same.
#[derive(Debug, Clone, PartialEq)]
pub struct Loop {
    dahl: Dahl,
    /// Left turning point [m].
    pub u_min: f64,
    /// Right turning point [m].
    pub u_max: f64,
    /// Force at the right turning point [N]; at the left one it is the opposite.
    pub force_at_u_max: f64,
}

impl Loop {
    /// The loop an input with these extremes settles on, from every initial force within ±F_C.
    ///
    /// With a = F(u_max)/F_C and β = u_max − u_min it closes if the way from −a to a is β long:
    /// ((1+a)^(1−γ) − (1−a)^(1−γ))/(1−γ) = βσ/F_C, for γ = 1: a = tanh(βσ/2F_C); for γ < 1: a = 1 once
    /// β reaches the saturation travel.
    pub fn new(dahl: &Dahl, (u_min, u_max): (f64, f64)) -> Self {
        let way = dahl.sigma / dahl.f_c * (u_max - u_min);
        let force_at_u_max = dahl.f_c * half_height(1.0 - dahl.gamma, way);
        Self { dahl: dahl.clone(), u_min, u_max, force_at_u_max }
    }

    /// The force [N] at `u` [m] within the loop's range, going up or down.
    pub fn force(&self, u: f64, rising: bool) -> f64 {
        if rising {
            advance(&self.dahl, -self.force_at_u_max, (u - self.u_min).max(0.0))
        } else {
            advance(&self.dahl, self.force_at_u_max, (u - self.u_max).min(0.0))
        }
    }

    /// ∮F du [J]: the energy lost in one cycle.
    ///
    /// It is positive and the loop clockwise with u horizontal, F being larger on the way up than on
    /// the way down. The paper (p. 96) has it counterclockwise, which needs the axes exchanged.
    pub fn area(&self) -> f64 {
        loop_area(&self.dahl, self.force_at_u_max, self.u_max - self.u_min)
    }

    /// The displacement [m] from a turning point to F = 0, a magnitude.
    pub fn lag(&self) -> f64 {
        travel(&self.dahl, self.force_at_u_max, 0.0).map_or(0.0, f64::abs)
    }
}

/// a of the closed loop for p = 1 − γ and the way βσ/F_C, sought as y with a = tanh(y/2): there the
/// equation is well-conditioned from small loops to a = 1.
fn half_height(p: f64, way: f64) -> f64 {
    if p > 0.0 && way >= 2.0_f64.powf(p) / p {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    // At y = 1024 the height is 1 to the last digit.
    while way_to(p, high) < way && high < 1024.0 {
        (low, high) = (high, 2.0 * high);
    }
    loop {
        let y = low + 0.5 * (high - low);
        if y <= low || y >= high {
            return (0.5 * y).tanh();
        }
        if way_to(p, y) < way {
            low = y;
        } else {
            high = y;
        }
    }
}

/// ((1+a)^p − (1−a)^p)/p at a = tanh(y/2), where ln((1+a)/(1−a)) = y.
fn way_to(p: f64, y: f64) -> f64 {
    let log_above = LN_2 - (-y).exp().ln_1p();
    if p == 0.0 { y } else { (p * log_above).exp() * -(-p * y).exp_m1() / p }
}
