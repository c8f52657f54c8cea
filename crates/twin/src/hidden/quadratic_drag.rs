//! Turbulent drag: T_f grows by c v |v|.

use super::{Effect, Now};
use serde::{Deserialize, Serialize};

/// Turbulent drag: T_f grows by c v |v|.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QuadraticDrag {
    /// Drag c [N·s²/m²] or [N·m·s²/rad²].
    pub c: f64,
}

impl Effect for QuadraticDrag {
    fn friction(&self, now: &Now, _x: &[f64]) -> f64 {
        self.c * now.v * now.v.abs()
    }
}
