//! The cable winds upon itself: the drum’s radius is r (1 + ratio θ).

use super::{Effect, unless};
use crate::{PlantKind, Scenario};
use serde::{Deserialize, Serialize};

/// The cable winds upon itself: the drum’s radius is r (1 + ratio θ).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignWinding {
    /// Growth of the radius [1/rad].
    pub ratio: f64,
}

impl Effect for ForeignWinding {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(matches!(scenario.plant, PlantKind::Drum { .. }), "a drum with its two springs")
    }

    fn lever(&self, q: f64) -> f64 {
        1.0 + self.ratio * q
    }
    fn drawn(&self, q: f64) -> f64 {
        q * (1.0 + self.ratio * q / 2.0)
    }
}
