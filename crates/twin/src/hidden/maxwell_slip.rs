//! One spring that slips, beside the declared friction.

use super::{Effect, unless};
use crate::{Friction, Scenario};
use serde::{Deserialize, Serialize};

/// One spring that slips, beside the declared friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaxwellSlip {
    /// Stiffness k [N/m] or [N·m/rad].
    pub k: f64,
    /// Deadband Δ [m] or [rad].
    pub delta: f64,
}

impl Effect for MaxwellSlip {
    fn refuses(&self, _scenario: &Scenario) -> Option<&'static str> {
        unless(
            self.k >= 0.0 && self.delta > 0.0,
            "a stiffness of 0 or above and a deadband above 0",
        )
    }

    fn beside(&self) -> Option<Friction> {
        let (k, delta) = (vec![self.k], vec![self.delta]);
        Some(Friction::MaxwellSlip { k, delta, sigma_2: 0.0 })
    }
}
