//! The friction model is stronger one way: F (1 + ratio) where F > 0, F (1 − ratio) where F < 0.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The friction model is stronger one way: F (1 + ratio) where F > 0, F (1 − ratio) where F < 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoulombAsymmetry {
    /// Asymmetry.
    pub ratio: f64,
}

impl Effect for CoulombAsymmetry {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(scenario.friction.level() > 0.0, "a friction model with a Coulomb level")
    }

    fn share(&self, now: &Now, _x: &[f64]) -> f64 {
        if now.friction == 0.0 { 0.0 } else { self.ratio * now.friction.signum() }
    }
}
