//! The motor’s teeth pull: T_f grows by sine sin nq + cosine cos nq.

use super::{Effect, Now};
use serde::{Deserialize, Serialize};

/// The motor’s teeth pull: T_f grows by sine sin nq + cosine cos nq.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cogging {
    /// Part that goes with sin nq [N] or [N·m].
    pub sine: f64,
    /// Part that goes with cos nq [N] or [N·m].
    pub cosine: f64,
    /// Wavenumber n [1/m] or [1/rad].
    pub wavenumber: f64,
}

impl Effect for Cogging {
    fn friction(&self, now: &Now, _x: &[f64]) -> f64 {
        let (sin, cos) = (self.wavenumber * now.q).sin_cos();
        self.sine * sin + self.cosine * cos
    }
}
