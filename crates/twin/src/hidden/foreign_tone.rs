//! Something shakes the plant at its own frequency in time, whatever the drive does.

use super::{Effect, Now};
use serde::{Deserialize, Serialize};

/// Something shakes the plant at its own frequency in time, whatever the drive does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignTone {
    /// Amplitude [N] or [N·m].
    pub force: f64,
    /// Angular frequency ω [rad/s].
    pub omega: f64,
    /// Phase [rad].
    pub phase: f64,
}

impl Effect for ForeignTone {
    fn friction(&self, now: &Now, _x: &[f64]) -> f64 {
        -self.force * (self.omega * now.t + self.phase).sin()
    }
}
