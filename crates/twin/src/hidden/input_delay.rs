//! The converter gives out what it was told a delay ago.

use super::{Effect, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The converter gives out what it was told a delay ago.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputDelay {
    /// Delay [s].
    pub delay: f64,
}

impl Effect for InputDelay {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(driven && self.delay >= 0.0, "a driven plant, and a delay of 0 or above")
    }

    fn delay(&self) -> f64 {
        self.delay
    }
}
