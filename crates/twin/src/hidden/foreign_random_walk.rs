//! The friction wanders: F (1 + amount W(t)), W a path of Brown’s over the time given, as Karhunen’s series.

use super::{Effect, Now, unless};
use crate::Scenario;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, SQRT_2};

/// The friction wanders: F (1 + amount W(t)), W a path of Brown’s over the time given, as Karhunen’s series.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForeignRandomWalk {
    /// Standard deviation at the end of the time.
    pub amount: f64,
    /// The time [s].
    pub over: f64,
    /// Which path.
    pub seed: u32,
}

impl Effect for ForeignRandomWalk {
    fn refuses(&self, scenario: &Scenario) -> Option<&'static str> {
        let rubs = scenario.friction.level() > 0.0;
        unless(rubs && self.over > 0.0, "a friction model with a Coulomb level, and a time above 0")
    }

    fn share(&self, now: &Now, _x: &[f64]) -> f64 {
        let term = |k: u32| {
            let omega = (f64::from(k) + 0.5) * PI;
            SQRT_2 * normal(self.seed, k) * (omega * now.t / self.over).sin() / omega
        };
        self.amount * (0..10).map(term).sum::<f64>()
    }
}

/// The k-th number of a seed, of mean 0 and variance 1: a sum of uniform ones, for its tails do not matter here.
fn normal(seed: u32, k: u32) -> f64 {
    let mut state = (u64::from(seed) << 32) | u64::from(k);
    let mut uniform = || {
        // Steele, Lea and Flood's SplitMix64.
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..6).map(|_| uniform() - 0.5).sum::<f64>() * SQRT_2
}
