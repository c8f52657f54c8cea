//! The amplifier gives no more than its limit, and bends before: T/(1 + |T/limit|⁸)^⅛.

use super::{Effect, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The amplifier gives no more than its limit, and bends before: T/(1 + |T/limit|⁸)^⅛.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorqueSaturation {
    /// Limit of the drive [N] or [N·m]; infinite for none.
    pub limit: f64,
}

impl Effect for TorqueSaturation {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(driven && self.limit > 0.0, "a driven plant, and a limit above 0")
    }

    fn amplifier(&self, _u: f64, drive: f64) -> f64 {
        drive / (1.0 + (drive / self.limit).powi(8)).powf(0.125)
    }
}
