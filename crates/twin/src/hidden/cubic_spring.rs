//! The springs harden: k₃ q³ on a mass, k₃ (rθ)³/2 in each of the drum’s two.

use super::{Effect, unless};
use crate::{PlantKind, Scenario};
use serde::{Deserialize, Serialize};

/// The springs harden: k₃ q³ on a mass, k₃ (rθ)³/2 in each of the drum’s two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CubicSpring {
    /// Hardening k₃ [N/m³].
    pub k_3: f64,
}

impl Effect for CubicSpring {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        use PlantKind::{Drum, MassSpring};
        unless(matches!(scenario.plant, Drum { .. } | MassSpring { .. }), "a plant with springs")
    }
    fn springs(&self, drawn: f64, forces: [f64; 2]) -> [f64; 2] {
        let more = self.k_3 * drawn.powi(3) / 2.0;
        [forces[0] + more, forces[1] - more]
    }
}
