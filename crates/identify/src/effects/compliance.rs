//! `compliance`: The gear gives way like a spring between motor and load.

use super::{About, At, Channel, Key, Law, Measure, family::is_joined, joint::Joint};
use crate::march::Real;

/// The gear gives way like a spring between motor and load.
pub(super) struct Compliance;

impl Law for Compliance {
    const ABOUT: About = About {
        name: "compliance",
        physics: "The gear gives way like a spring between motor and load.",
        channel: Channel::Kinematics,
        keys: &[
            Key::positive("compliance", Measure::Flexibility, 1.0),
            // The load's mass, of the motor's, the damping of its ringing, of the critical one, and its own friction.
            Key::fitted("ratio", Measure::One),
            Key::fitted("damping", Measure::One),
            Key::fitted("rubs", Measure::Force),
        ],
        probes: |c| {
            let own = |ratio: f64| vec![ratio, 0.3, 0.01 * c.force];
            [0.05, 0.25].map(own).to_vec()
        },
        applies: is_joined,
        confused: &["tach_gain", "backlash", "velocity_lag"],
        separated_by: "a drive that is held against a stop",
        test: 0.1,
    };
    const STATES: usize = 2;
    const JOINS: bool = true;
    const TRIED: &[f64] = &[1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];

    fn joint<D: Real>(p: &[D], at: &At<D>) -> Option<Joint<D>> {
        let (mass, stiffness) = (p[1] * at.mass, p[0].recip());
        let damping = p[2] * (stiffness * mass).sqrt() * 2.0;
        Some(Joint { mass, stiffness, damping, half: None, rubs: p[3] })
    }
}
