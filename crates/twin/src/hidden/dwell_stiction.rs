//! The contact ages at rest: the level it breaks at rises by drop · a, ȧ = (1 − a)/τ − a |s|/d.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The contact ages at rest: the level it breaks at rises by drop · a, ȧ = (1 − a)/τ − a |s|/d.
/// The slip s is what the bristles do not follow; d, some deflections of theirs, wears the age off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DwellStiction {
    /// Rise after a long rest [N] or [N·m].
    pub drop: f64,
    /// Time constant of ageing τ [s].
    pub tau: f64,
    /// How many deflections of the bristles wear the age off [1].
    #[serde(default = "one")]
    pub wear: f64,
}

fn one() -> f64 {
    1.0
}

impl Effect for DwellStiction {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let rubs = scenario.friction.level() > 0.0;
        unless(
            rubs && self.tau > 0.0 && self.wear > 0.0,
            "a friction model with a Coulomb level, and a time constant and a wear above 0",
        )
    }

    fn states(&self) -> usize {
        1
    }
    fn rates(&self, now: &Now, x: &[f64], rates: &mut [f64]) {
        rates[0] = (1.0 - x[0]) / self.tau - x[0] * now.slip.abs() / (self.wear * now.grain);
    }
    fn rise(&self, _now: &Now, x: &[f64]) -> f64 {
        self.drop * x[0]
    }
}
