//! The true input is u + bias: what the monitor of the amplifier reads too little.

use super::{Effect, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The true input is u + bias: what the monitor of the amplifier reads too little.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurrentBias {
    /// Bias [A], [V] or [N].
    pub bias: f64,
}

impl Effect for CurrentBias {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(scenario.plant.balance().is_some(), "a driven plant")
    }

    fn input(&self, u: f64) -> f64 {
        u + self.bias
    }
}
