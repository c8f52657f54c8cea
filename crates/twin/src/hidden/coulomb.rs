//! Dry friction, stuck or sliding, on a plant that is declared to have none.

use super::{Effect, unless};
use crate::{Friction, Scenario};
use serde::{Deserialize, Serialize};

/// Dry friction, stuck or sliding, on a plant that is declared to have none.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    /// Coulomb force F_C [N] or [N·m].
    pub f_c: f64,
}

impl Effect for Coulomb {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let none = matches!(scenario.friction, Friction::None { .. });
        unless(none && self.f_c >= 0.0, "a plant without friction, and a force of 0 or above")
    }
    fn rewrite(&self, scenario: &mut Scenario) {
        if let Friction::None { sigma_2 } = scenario.friction {
            scenario.friction = Friction::Coulomb { f_c: self.f_c, sigma_2 };
        }
    }
}
