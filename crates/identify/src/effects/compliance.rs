//! `compliance`: The gear gives way like a spring between motor and load.

use super::{About, At, Channel, Key, Law, Measure, family::is_joined, joint::{AT_MOTOR, DRAGS, ENCODER, GIVES, Joint}};
use crate::march::Real;

/// The gear gives way like a spring between motor and load.
pub(super) struct Compliance;

impl Law for Compliance {
    const ABOUT: About = About {
        name: "compliance",
        physics: "The gear gives way like a spring between motor and load.",
        equation: "load and motor, together M, joined by a spring of 1/compliance with a damping ratio, damping; the load has ratio of the motor's inertia, rubs and drags; encoder: 1 shows the load, 2 the motor, w always the motor",
        channel: Channel::Kinematics,
        keys: &[
            Key::positive("compliance", Measure::Flexibility, 1.0),
            // The load's mass, of the motor's, the damping of its ringing, of the critical one, and its own friction.
            Key::fitted("ratio", Measure::One),
            Key::fitted("damping", Measure::One),
            Key::fitted("rubs", Measure::Force),
            ENCODER,
            GIVES,
            DRAGS,
        ],
        probes: |c| {
            // A load that rubs much from the first on hides what else it does; where it does, the descent finds it.
            let own = |(ratio, rubs, encoder): (f64, f64, f64)| vec![ratio, 0.3, rubs * c.force, encoder];
            let all = [(0.05, 1e-3, 1.0), (0.25, 1e-3, 1.0), (0.3, 0.01, AT_MOTOR)].map(own);
            all.into_iter().filter(|probe| c.hidden || probe[3] != AT_MOTOR).collect()
        },
        applies: is_joined,
        confused: &["tach_gain", "backlash", "velocity_lag"],
        separated_by: "a drive that is held against a stop",
        test: 0.1,
    };
    const STATES: usize = 3;
    const JOINS: bool = true;
    const TRIED: &[f64] = &[1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];

    fn joint<D: Real>(p: &[D], at: &At<D>) -> Option<Joint<D>> {
        let (mass, stiffness) = (p[1] * at.mass, p[0].recip());
        let damping = p[2] * (stiffness * mass).sqrt() * 2.0;
        Some(Joint { mass, stiffness, damping, half: None, rubs: p[3], gives: p[5], drags: p[6] })
    }
}
