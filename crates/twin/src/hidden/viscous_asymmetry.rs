//! Drag that is stronger one way: T_f grows by c |v|.

use super::{Effect, Now};
use serde::{Deserialize, Serialize};

/// Drag that is stronger one way: T_f grows by c |v|.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViscousAsymmetry {
    /// Difference of the two coefficients, halved, c [N·s/m] or [N·m·s/rad].
    pub c: f64,
}

impl Effect for ViscousAsymmetry {
    fn friction(&self, now: &Now, _x: &[f64]) -> f64 {
        self.c * now.v.abs()
    }
}
