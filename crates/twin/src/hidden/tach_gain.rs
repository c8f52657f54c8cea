//! The velocity sensor shows (1 + error) v.

use super::{Effect, Now, unless};
use crate::{Quantity, Scenario};
use serde::{Deserialize, Serialize};

/// The velocity sensor shows (1 + error) v.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TachGain {
    /// Error of its gain.
    pub error: f64,
}

impl Effect for TachGain {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(scenario.shows(Quantity::Velocity), "a velocity sensor")
    }

    fn sense(&self, quantity: Quantity, _now: &Now, _x: &[f64], value: f64) -> f64 {
        if quantity == Quantity::Velocity { (1.0 + self.error) * value } else { value }
    }
}
