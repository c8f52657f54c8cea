//! The Coulomb level is higher in slow sliding, by drop · exp(−(v/v_s)²).

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The Coulomb level is higher in slow sliding, by drop · exp(−(v/v_s)²).
/// LuGre takes it into the deflection at which its bristles slip; other models grow as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stribeck {
    /// How much higher at rest [N] or [N·m].
    pub drop: f64,
    /// Stribeck velocity v_S [m/s] or [rad/s].
    pub v_s: f64,
}

impl Effect for Stribeck {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let rubs = scenario.friction.level() > 0.0;
        unless(
            rubs && self.v_s > 0.0,
            "a friction model with a Coulomb level, and a Stribeck velocity above 0",
        )
    }

    fn rise(&self, now: &Now, _x: &[f64]) -> f64 {
        self.drop * (-(now.v / self.v_s).powi(2)).exp()
    }
}
