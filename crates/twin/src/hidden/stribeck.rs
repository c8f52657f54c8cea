//! The Coulomb level is higher in slow sliding, by drop · exp(−|v/v_s|^power).

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The Coulomb level is higher in slow sliding, by drop · exp(−|v/v_s|^power).
/// LuGre takes it into the deflection at which its bristles slip; other models grow as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stribeck {
    /// How much higher at rest [N] or [N·m].
    pub drop: f64,
    /// Stribeck velocity v_S [m/s] or [rad/s].
    pub v_s: f64,
    /// Power of v/v_S in the exponential: 2 as in the paper, 1 as in older texts [1].
    #[serde(default = "two")]
    pub power: f64,
}

fn two() -> f64 {
    2.0
}

impl Effect for Stribeck {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let rubs = scenario.friction.level() > 0.0;
        unless(
            rubs && self.v_s > 0.0 && self.power > 0.0,
            "a friction model with a Coulomb level, and a Stribeck velocity and a power above 0",
        )
    }

    fn rise(&self, now: &Now, _x: &[f64]) -> f64 {
        self.drop * (-(now.v / self.v_s).abs().powf(self.power)).exp()
    }
}
