//! The amplifier gives no more than its limit, and bends before: T/(1 + |T/limit|ᵖ)^(1/p).

use super::{Effect, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The amplifier gives no more than its limit, and bends before: T/(1 + |T/limit|ᵖ)^(1/p).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorqueSaturation {
    /// Limit of the drive [N] or [N·m]; infinite for none.
    pub limit: f64,
    /// Power p: the larger it is, the shorter the bend [1].
    #[serde(default = "eight")]
    pub power: f64,
}

fn eight() -> f64 {
    8.0
}

impl Effect for TorqueSaturation {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(
            driven && self.limit > 0.0 && self.power > 0.0,
            "a driven plant, and a limit and a power above 0",
        )
    }

    fn amplifier(&self, _u: f64, drive: f64) -> f64 {
        drive / (1.0 + (drive / self.limit).abs().powf(self.power)).powf(1.0 / self.power)
    }
}
