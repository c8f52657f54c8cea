//! Play between motor and load: two masses that touch at the ends of a gap.

use super::{Effect, Joint, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// Play between motor and load: two masses that touch at the ends of a gap.
/// The position sensor, the springs and the weight are the load’s, with a small friction of its own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Backlash {
    /// The whole play [m] or [rad].
    pub gap: f64,
}

impl Effect for Backlash {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(driven && self.gap >= 0.0, "a driven plant, and a gap of 0 or above")
    }

    fn joint(&self, joint: &mut Joint) {
        joint.gap = self.gap;
    }
}
