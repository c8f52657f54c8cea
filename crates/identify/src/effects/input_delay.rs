//! `input_delay`: The drive acts later than it was recorded.

use super::{About, Channel, Key, Law, Measure, family::{driven}};
use crate::march::Real;

/// The drive acts later than it was recorded.
pub(super) struct InputDelay;

impl Law for InputDelay {
    const ABOUT: About = About {
        name: "input_delay",
        physics: "The drive acts later than it was recorded.",
        equation: "u(t) = u_recorded(t − delay)",
        channel: Channel::Torque,
        keys: &[Key::positive("delay", Measure::Time, 20.0)],
        probes: About::no_shape,
        applies: driven,
        confused: &["inertia", "viscous", "velocity_lag"],
        separated_by: "steps of the drive",
        test: 0.1,
    };

    fn delay<D: Real>(p: &[D]) -> Option<D> {
        Some(p[0])
    }
}
