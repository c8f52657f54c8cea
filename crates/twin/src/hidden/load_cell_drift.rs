//! The first load cell shows F₁ + rate · t.

use super::{Effect, Now, unless};
use crate::{Quantity, Scenario};
use serde::{Deserialize, Serialize};

/// The first load cell shows F₁ + rate · t.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadCellDrift {
    /// Drift [N/s].
    pub rate: f64,
}

impl Effect for LoadCellDrift {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        unless(scenario.shows(Quantity::Force1), "a load cell at the first spring")
    }
    fn sense(&self, quantity: Quantity, now: &Now, _x: &[f64], value: f64) -> f64 {
        if quantity == Quantity::Force1 { value + self.rate * now.t } else { value }
    }
}
