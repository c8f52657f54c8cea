//! The contact presses harder under load: F (1 + ratio |T|/F_C), T the true drive.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The contact presses harder under load: F (1 + ratio |T|/F_C), T the true drive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadFriction {
    /// Growth of F_C for each unit of the drive.
    pub ratio: f64,
    /// Whether the level alone grows at which bristles slip, and not their stiffness.
    #[serde(default)]
    pub level: bool,
}

impl Effect for LoadFriction {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(
            driven && scenario.friction.level() > 0.0,
            "a driven plant, and a friction model with a Coulomb level",
        )
    }

    fn share(&self, now: &Now, _x: &[f64]) -> f64 {
        if self.level { 0.0 } else { self.ratio * now.drive.abs() / now.level }
    }
    fn rise(&self, now: &Now, _x: &[f64]) -> f64 {
        if self.level { self.ratio * now.drive.abs() } else { 0.0 }
    }
}
