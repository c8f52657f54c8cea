//! The contact warms up: F (1 + amount · w) with ẇ = (1 − w)/τ, carried as a state.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The contact warms up: F (1 + amount · w) with ẇ = (1 − w)/τ, carried as a state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrictionDrift {
    /// Growth in the end.
    pub amount: f64,
    /// Time constant τ [s].
    pub tau: f64,
    /// Whether the level alone grows at which bristles slip, and not their stiffness.
    #[serde(default)]
    pub level: bool,
}

impl Effect for FrictionDrift {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let rubs = scenario.friction.level() > 0.0;
        unless(
            rubs && self.tau > 0.0,
            "a friction model with a Coulomb level, and a time constant above 0",
        )
    }

    fn states(&self) -> usize {
        1
    }
    fn rates(&self, _now: &Now, x: &[f64], rates: &mut [f64]) {
        rates[0] = (1.0 - x[0]) / self.tau;
    }
    fn share(&self, _now: &Now, x: &[f64]) -> f64 {
        if self.level { 0.0 } else { self.amount * x[0] }
    }
    fn rise(&self, now: &Now, x: &[f64]) -> f64 {
        if self.level { now.level * self.amount * x[0] } else { 0.0 }
    }
}
