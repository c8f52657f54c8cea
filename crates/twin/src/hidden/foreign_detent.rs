//! A place where it drags: the friction model is stronger around one angle only.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// A place where it drags: the friction model is stronger around one angle only.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignDetent {
    /// How much stronger there.
    pub ratio: f64,
    /// Where [m] or [rad].
    pub at: f64,
    /// Half of its width [m] or [rad].
    pub width: f64,
}

impl Effect for ForeignDetent {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let rubs = scenario.friction.level() > 0.0;
        unless(
            rubs && self.width > 0.0,
            "a friction model with a Coulomb level, and a width above 0",
        )
    }

    fn share(&self, now: &Now, _x: &[f64]) -> f64 {
        self.ratio * (-((now.q - self.at) / self.width).powi(2)).exp()
    }
}
