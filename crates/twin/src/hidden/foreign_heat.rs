//! The contact swells with the heat it makes: ḣ = P/E − h/τ, F (1 + ratio h), P the friction’s power.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The contact swells with the heat it makes: ḣ = P/E − h/τ, F (1 + ratio h), P the friction’s power.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignHeat {
    /// Growth at h = 1.
    pub ratio: f64,
    /// Heat that makes h = 1, E [J].
    pub energy: f64,
    /// Time constant of cooling τ [s].
    pub tau: f64,
}

impl Effect for ForeignHeat {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let rubs = scenario.friction.level() > 0.0;
        unless(
            rubs && self.energy > 0.0 && self.tau > 0.0,
            "a friction model with a Coulomb level, and an energy and a time constant above 0",
        )
    }

    fn states(&self) -> usize {
        1
    }
    fn rates(&self, now: &Now, x: &[f64], rates: &mut [f64]) {
        rates[0] = (now.level * now.v).abs() / self.energy - x[0] / self.tau;
    }
    fn share(&self, _now: &Now, x: &[f64]) -> f64 {
        self.ratio * x[0]
    }
}
