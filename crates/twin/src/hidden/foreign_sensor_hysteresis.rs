//! The position sensor sits on rubber: it lags behind by a deflection w, ẇ = v − |v| w/width.

use super::{Effect, Now, unless};
use crate::{Quantity, Scenario};
use serde::{Deserialize, Serialize};

/// The position sensor sits on rubber: it lags behind by a deflection w, ẇ = v − |v| w/width.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignSensorHysteresis {
    /// The largest deflection [m] or [rad].
    pub width: f64,
}

impl Effect for ForeignSensorHysteresis {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(driven && self.width >= 0.0, "a driven plant, and a width of 0 or above")
    }

    fn states(&self) -> usize {
        usize::from(self.width > 0.0)
    }
    fn rates(&self, now: &Now, x: &[f64], rates: &mut [f64]) {
        if self.width > 0.0 {
            rates[0] = now.load_v - now.load_v.abs() * x[0] / self.width;
        }
    }
    fn sense(&self, quantity: Quantity, _now: &Now, x: &[f64], value: f64) -> f64 {
        let shown = matches!(quantity, Quantity::Angle | Quantity::Position);
        if shown { value - x.first().unwrap_or(&0.0) } else { value }
    }
}
