//! Friction that grows with the size of the acceleration, which a lag of τ measures.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};

/// Friction that grows with the size of the acceleration, which a lag of τ measures.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignAcceleration {
    /// Growth at large accelerations.
    pub ratio: f64,
    /// Acceleration at which three quarters of it are there [m/s²] or [rad/s²].
    pub half: f64,
    /// Time constant of the lag τ [s].
    pub tau: f64,
}

impl Effect for ForeignAcceleration {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let rubs = scenario.friction.level() > 0.0;
        unless(
            rubs && self.half > 0.0 && self.tau > 0.0,
            "a friction model with a Coulomb level, and an acceleration and a time constant above 0",
        )
    }

    fn states(&self) -> usize {
        1
    }
    fn start(&self, now: &Now, x: &mut [f64]) {
        x.fill(now.v);
    }
    fn rates(&self, now: &Now, x: &[f64], rates: &mut [f64]) {
        rates[0] = (now.v - x[0]) / self.tau;
    }
    fn share(&self, now: &Now, x: &[f64]) -> f64 {
        let a = (now.v - x[0]) / (self.tau * self.half);
        self.ratio * (a * a).tanh()
    }
}
