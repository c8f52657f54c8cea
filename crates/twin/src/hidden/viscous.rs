//! The lubricant drags: T_f grows by σ₂ v.

use super::{Effect, Now};
use serde::{Deserialize, Serialize};

/// The lubricant drags: T_f grows by σ₂ v.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Viscous {
    /// Viscous coefficient σ₂ [N·s/m] or [N·m·s/rad].
    pub sigma_2: f64,
}

impl Effect for Viscous {
    fn friction(&self, now: &Now, _x: &[f64]) -> f64 {
        self.sigma_2 * now.v
    }
}
