//! There is more inertia than declared: M (1 + ratio).

use super::{Effect, unless};
use crate::{PlantKind, Scenario};
use serde::{Deserialize, Serialize};

/// There is more inertia than declared: M (1 + ratio).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inertia {
    /// What there is more.
    pub ratio: f64,
}

impl Effect for Inertia {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(driven && self.ratio > -1.0, "a driven plant, and a ratio above −1")
    }

    fn rewrite(&self, scenario: &mut Scenario) {
        let (PlantKind::Drum { inertia, .. }
        | PlantKind::MassSpring { mass: inertia, .. }
        | PlantKind::Axis { inertia, .. }
        | PlantKind::Pendulum { inertia, .. }) = &mut scenario.plant
        else {
            return;
        };
        *inertia *= 1.0 + self.ratio;
    }
}
