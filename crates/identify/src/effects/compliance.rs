//! `compliance`: The gear gives way like a spring between motor and load.

use super::{About, Channel, Key, Law, Measure, Sense, family::{has_tachometer}};
use crate::march::Real;

/// The gear gives way like a spring between motor and load.
pub(super) struct Compliance;

impl Law for Compliance {
    const ABOUT: About = About {
        name: "compliance",
        physics: "The gear gives way like a spring between motor and load.",
        channel: Channel::Kinematics,
        keys: &[Key::positive("compliance", Measure::Flexibility, 1.0)],
        probes: About::no_shape,
        applies: has_tachometer,
        confused: &["tach_gain", "backlash", "velocity_lag"],
        separated_by: "a drive that is held against a stop",
        test: 0.1,
    };

    fn sense<D: Real>(p: &[D], sense: &mut Sense<'_, D>) {
        sense.v += p[0] * sense.rate;
    }
}
