//! A spring between motor and load: the velocity sensor is the motor’s, the position sensor the load’s.

use super::{Effect, Joint, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// A spring between motor and load: the velocity sensor is the motor’s, the position sensor the load’s.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Compliance {
    /// Stiffness [N/m] or [N·m/rad]; infinite for none.
    pub stiffness: f64,
}

impl Effect for Compliance {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(driven && self.stiffness > 0.0, "a driven plant, and a stiffness above 0")
    }

    fn joint(&self, joint: &mut Joint) {
        joint.stiffness = self.stiffness;
    }
}
