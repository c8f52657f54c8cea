//! Drag of a lubricant that thins with shear: T_f grows by c v/√(1 + (v/v₀)²).

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// Drag of a lubricant that thins with shear: T_f grows by c v/√(1 + (v/v₀)²).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SublinearDrag {
    /// Drag in slow motion c [N·s/m] or [N·m·s/rad].
    pub c: f64,
    /// Velocity v₀ from which on it is nearly constant [m/s] or [rad/s].
    pub v_0: f64,
}

impl Effect for SublinearDrag {
    fn refuses(&self, _scenario: &Scenario) -> Option<&'static str> {
        unless(self.v_0 > 0.0, "a velocity v_0 above 0")
    }

    fn friction(&self, now: &Now, _x: &[f64]) -> f64 {
        self.c * now.v / (now.v / self.v_0).hypot(1.0)
    }
}
