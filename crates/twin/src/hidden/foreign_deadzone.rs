//! The bridge of the amplifier loses what is near zero: u less ±zone, 0 within.

use super::{Effect, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The bridge of the amplifier loses what is near zero: u less ±zone, 0 within.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignDeadzone {
    /// Half of the zone [A], [V] or [N].
    pub zone: f64,
}

impl Effect for ForeignDeadzone {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(driven && self.zone >= 0.0, "a driven plant, and a zone of 0 or above")
    }

    fn input(&self, u: f64) -> f64 {
        u - u.clamp(-self.zone, self.zone)
    }
}
