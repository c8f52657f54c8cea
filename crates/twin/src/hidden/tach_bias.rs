//! The velocity sensor shows v + bias.

use super::{Effect, Now, unless};
use crate::{Quantity, Scenario};
use serde::{Deserialize, Serialize};

/// The velocity sensor shows v + bias.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TachBias {
    /// Bias, on the side of the load [m/s] or [rad/s].
    pub bias: f64,
}

impl Effect for TachBias {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(scenario.shows(Quantity::Velocity), "a velocity sensor")
    }

    fn sense(&self, quantity: Quantity, _now: &Now, _x: &[f64], value: f64) -> f64 {
        if quantity == Quantity::Velocity { value + self.bias } else { value }
    }
}
