//! The contact is elastic before it slides: Dahl’s, where Coulomb’s is declared.

use super::{Effect, unless};
use crate::{Friction, Scenario};
use serde::{Deserialize, Serialize};

/// The contact is elastic before it slides: Dahl’s, where Coulomb’s is declared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Presliding {
    /// Rest stiffness σ [N/m] or [N·m/rad].
    pub sigma: f64,
}

impl Effect for Presliding {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let dry = matches!(scenario.friction, Friction::Coulomb { .. });
        unless(dry && self.sigma > 0.0, "Coulomb friction, and a stiffness above 0")
    }
    fn rewrite(&self, scenario: &mut Scenario) {
        if let Friction::Coulomb { f_c, sigma_2 } = scenario.friction
            && self.sigma.is_finite()
        {
            scenario.friction = Friction::Dahl { f_c, sigma: self.sigma, gamma: 1.0, sigma_2 };
        }
    }
}
