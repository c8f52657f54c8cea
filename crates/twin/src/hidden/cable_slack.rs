//! The drum’s cables cannot push, and their prestress is lower than declared.

use super::{Effect, unless};
use crate::{PlantKind, Scenario};
use serde::{Deserialize, Serialize};

/// The drum’s cables cannot push, and their prestress is lower than declared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CableSlack {
    /// What of the prestress is lacking [N].
    pub level: f64,
}

impl Effect for CableSlack {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let drum = matches!(scenario.plant, PlantKind::Drum { .. });
        unless(drum && self.level >= 0.0, "a drum with its two springs, and a level of 0 or above")
    }
    fn springs(&self, _drawn: f64, forces: [f64; 2]) -> [f64; 2] {
        forces.map(|force| (force - self.level).max(0.0))
    }
}
