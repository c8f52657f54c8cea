//! Something rubs for a while: more friction from one time to another, within 50 ms in and out.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// Something rubs for a while: more friction from one time to another, within 50 ms in and out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignFault {
    /// How much more.
    pub ratio: f64,
    /// When it begins [s].
    pub from: f64,
    /// When it ends [s].
    pub to: f64,
}

impl Effect for ForeignFault {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(scenario.friction.level() > 0.0, "a friction model with a Coulomb level")
    }

    fn share(&self, now: &Now, _x: &[f64]) -> f64 {
        let edge = |t: f64| f64::midpoint(1.0, ((now.t - t) / 0.025).tanh());
        self.ratio * (edge(self.from) - edge(self.to))
    }
}
