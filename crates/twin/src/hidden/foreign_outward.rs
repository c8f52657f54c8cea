//! Friction is stronger on the way out than on the way home: F (1 ± ratio) by the sign of v (q − home).

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// Friction is stronger on the way out than on the way home: F (1 ± ratio) by the sign of v (q − home).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignOutward {
    /// How much.
    pub ratio: f64,
    /// Where home is [m] or [rad].
    #[serde(default)]
    pub home: f64,
    /// Distance over which home is home [m] or [rad].
    pub near: f64,
    /// Speed over which the way is told [m/s] or [rad/s].
    pub slow: f64,
}

impl Effect for ForeignOutward {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let rubs = scenario.friction.level() > 0.0;
        unless(
            rubs && self.near > 0.0 && self.slow > 0.0,
            "a friction model with a Coulomb level, and a distance and a speed above 0",
        )
    }

    fn share(&self, now: &Now, _x: &[f64]) -> f64 {
        self.ratio * ((now.q - self.home) / self.near).tanh() * (now.v / self.slow).tanh()
    }
}
