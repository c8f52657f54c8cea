//! The motor gives more for each unit of a large input: g u (1 + ratio (u/u₀)²).

use super::{Effect, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The motor gives more for each unit of a large input: g u (1 + ratio (u/u₀)²).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignMotorConstant {
    /// What it gives more at u₀.
    pub ratio: f64,
    /// Input u₀ [A], [V] or [N].
    pub u_0: f64,
}

impl Effect for ForeignMotorConstant {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(driven && self.u_0 > 0.0, "a driven plant, and an input above 0")
    }

    fn amplifier(&self, u: f64, drive: f64) -> f64 {
        drive * (1.0 + self.ratio * (u / self.u_0).powi(2))
    }
}
