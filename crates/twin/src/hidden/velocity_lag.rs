//! The velocity sensor is a lag of first order, ẇ = (v − w)/τ, and shows w.

use super::{Effect, Now, unless};
use crate::{Quantity, Scenario};
use serde::{Deserialize, Serialize};

/// The velocity sensor is a lag of first order, ẇ = (v − w)/τ, and shows w.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VelocityLag {
    /// Time constant τ [s].
    pub tau: f64,
}

impl Effect for VelocityLag {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let shown = scenario.shows(Quantity::Velocity);
        unless(shown && self.tau >= 0.0, "a velocity sensor, and a time constant of 0 or above")
    }
    fn states(&self) -> usize {
        usize::from(self.tau > 0.0)
    }
    fn start(&self, now: &Now, x: &mut [f64]) {
        x.fill(now.v);
    }
    fn rates(&self, now: &Now, x: &[f64], rates: &mut [f64]) {
        if self.tau > 0.0 {
            rates[0] = (now.v - x[0]) / self.tau;
        }
    }
    fn sense(&self, quantity: Quantity, _now: &Now, x: &[f64], value: f64) -> f64 {
        if quantity == Quantity::Velocity { *x.first().unwrap_or(&value) } else { value }
    }
}
