//! The contact presses harder at some places: F (1 + sine sin nq + cosine cos nq + slope (q − q₀)).

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// The contact presses harder at some places: F (1 + sine sin nq + cosine cos nq + slope (q − q₀)).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PositionFriction {
    /// Part that goes with sin nq.
    #[serde(default)]
    pub sine: f64,
    /// Part that goes with cos nq.
    #[serde(default)]
    pub cosine: f64,
    /// Wavenumber n [1/m] or [1/rad].
    #[serde(default)]
    pub wavenumber: f64,
    /// Slope of a slow change [1/m] or [1/rad].
    #[serde(default)]
    pub slope: f64,
    /// Where the slow change is nothing q₀ [m] or [rad].
    #[serde(default)]
    pub q_0: f64,
    /// Whether the level alone differs at which bristles slip, and not their stiffness.
    #[serde(default)]
    pub level: bool,
}

impl PositionFriction {
    fn growth(&self, now: &Now) -> f64 {
        let (sin, cos) = (self.wavenumber * now.q).sin_cos();
        self.sine * sin + self.cosine * cos + self.slope * (now.q - self.q_0)
    }
}

impl Effect for PositionFriction {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(scenario.friction.level() > 0.0, "a friction model with a Coulomb level")
    }

    fn share(&self, now: &Now, _x: &[f64]) -> f64 {
        if self.level { 0.0 } else { self.growth(now) }
    }
    fn rise(&self, now: &Now, _x: &[f64]) -> f64 {
        if self.level { now.level * self.growth(now) } else { 0.0 }
    }
}
