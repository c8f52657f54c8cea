//! `compliance`: The gear gives way like a spring between motor and load.

use super::{About, Act, At, Channel, Key, Law, Measure, family::is_joined, joint::Joint};
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
            // The load's mass, of the motor's, and the damping of its ringing, of the critical one.
            Key::fitted("ratio", Measure::One),
            Key::fitted("damping", Measure::One),
        ],
        probes: |_| vec![vec![0.15, 0.3]],
        applies: is_joined,
        confused: &["tach_gain", "backlash", "velocity_lag"],
        separated_by: "a drive that is held against a stop",
        test: 0.1,
    };
    const STATES: usize = 2;
    const TRIED: &[f64] = &[1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2];

    fn joins<D: Real>(p: &[D]) -> bool {
        p[0].re() > 0.0
    }

    fn mass<D: Real>(p: &[D], mass: D) -> D {
        if Self::joins(p) { mass / (p[1] + 1.0) } else { mass }
    }

    fn act<D: Real>(p: &[D], at: &At<D>, base: &[D], z: &mut [D]) -> Act<D> {
        if !Self::joins(p) {
            z.copy_from_slice(base);
            return Act::none();
        }
        joint(p, at).act(at, base, z)
    }

    fn ahead<D: Real>(p: &[D], at: &At<D>, (way, off): (f64, D)) -> D {
        joint(p, at).ahead(at, way, off)
    }
}

fn joint<D: Real>(p: &[D], at: &At<D>) -> Joint<D> {
    let (mass, stiffness) = (p[1] * at.mass, p[0].recip());
    let damping = p[2] * (stiffness * mass).sqrt() * 2.0;
    Joint { mass, stiffness, damping, half: None, rubs: D::from(0.0) }
}
