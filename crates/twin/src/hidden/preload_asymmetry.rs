//! The springs of the drum are tightened unequally: F₁ by half of it more, F₂ by half of it less.

use super::{Effect, unless};
use crate::{PlantKind, Scenario};
use serde::{Deserialize, Serialize};

/// The springs of the drum are tightened unequally: F₁ by half of it more, F₂ by half of it less.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PreloadAsymmetry {
    /// Difference of the two prestresses F₁₀ − F₂₀ beyond the declared one [N].
    pub force: f64,
}

impl Effect for PreloadAsymmetry {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(matches!(scenario.plant, PlantKind::Drum { .. }), "a drum with its two springs")
    }

    fn rewrite(&self, scenario: &mut Scenario) {
        if let PlantKind::Drum { f_10, f_20, .. } = &mut scenario.plant {
            *f_10 += self.force / 2.0;
            *f_20 -= self.force / 2.0;
        }
    }
}
