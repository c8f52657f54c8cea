//! The load is not balanced: T_f grows by sine sin q + cosine cos q.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The load is not balanced: T_f grows by sine sin q + cosine cos q.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GravityUnbalance {
    /// Part that goes with sin q [N·m].
    pub sine: f64,
    /// Part that goes with cos q [N·m].
    pub cosine: f64,
}

impl Effect for GravityUnbalance {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(scenario.plant.rotary(), "a plant that turns")
    }
    fn load(&self, now: &Now) -> f64 {
        let (sin, cos) = now.load_q.sin_cos();
        self.sine * sin + self.cosine * cos
    }
}
