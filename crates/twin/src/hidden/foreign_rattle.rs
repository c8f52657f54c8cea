//! A loose part that rattles in a box on the motor's side: a mass between two elastic walls.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A loose part that rattles in a box on the motor's side: a mass between two elastic walls.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignRattle {
    /// Its share of the inertia.
    pub mass: f64,
    /// How far it can move [m] or [rad].
    pub room: f64,
    /// Frequency of its contact with a wall [Hz].
    pub frequency: f64,
}

impl Effect for ForeignRattle {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let driven = scenario.plant.balance().is_some();
        unless(
            driven && self.mass > 0.0 && self.room > 0.0 && self.frequency > 0.0,
            "a driven plant, and a mass, a room and a frequency above 0",
        )
    }

    fn states(&self) -> usize {
        2
    }
    fn start(&self, now: &Now, x: &mut [f64]) {
        x.copy_from_slice(&[now.q, now.v]);
    }
    fn rates(&self, now: &Now, x: &[f64], rates: &mut [f64]) {
        rates[0] = x[1];
        rates[1] = self.push(now, x);
    }
    fn friction(&self, now: &Now, x: &[f64]) -> f64 {
        self.mass * now.inertia * self.push(now, x)
    }
}

/// The dent that is well damped, as a share of the room.
const DENT: f64 = 0.05;

impl ForeignRattle {
    /// How the walls accelerate it [m/s²] or [rad/s²].
    fn push(&self, now: &Now, x: &[f64]) -> f64 {
        let omega = TAU * self.frequency;
        let apart = now.q - x[0];
        let into = apart - apart.clamp(-self.room / 2.0, self.room / 2.0);
        if into == 0.0 {
            return 0.0;
        }
        // Hunt and Crossley's wall: its damping grows with the dent, so that no force jumps.
        let damped = 1.0 + 0.3 * (now.v - x[1]) * into.signum() / (omega * DENT * self.room);
        omega * omega * into * damped.max(0.0)
    }
}
