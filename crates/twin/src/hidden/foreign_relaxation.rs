//! A rubber seal: a spring and a damper in series beside the friction, ḟ = k v − f/τ.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// A rubber seal: a spring and a damper in series beside the friction, ḟ = k v − f/τ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignRelaxation {
    /// Stiffness k [N/m] or [N·m/rad].
    pub k: f64,
    /// Time constant τ [s].
    pub tau: f64,
}

impl Effect for ForeignRelaxation {
    fn refuses(&self, _scenario: &Scenario) -> Option<&'static str> {
        unless(self.tau > 0.0, "a time constant above 0")
    }

    fn states(&self) -> usize {
        1
    }
    fn rates(&self, now: &Now, x: &[f64], rates: &mut [f64]) {
        rates[0] = self.k * now.v - x[0] / self.tau;
    }
    fn friction(&self, _now: &Now, x: &[f64]) -> f64 {
        x[0]
    }
}
