//! `velocity_lag`: The velocity sensor follows late, as behind a filter.

use super::{About, Channel, Key, Law, Measure, Sense, family::{has_tachometer}};
use crate::march::Real;

/// The velocity sensor follows late, as behind a filter.
pub(super) struct VelocityLag;

impl Law for VelocityLag {
    const ABOUT: About = About {
        name: "velocity_lag",
        physics: "The velocity sensor follows late, as behind a filter.",
        channel: Channel::Kinematics,
        keys: &[Key::positive("tau", Measure::Time, 50.0)],
        probes: About::no_shape,
        applies: has_tachometer,
        confused: &["input_delay", "compliance"],
        separated_by: "steps of the drive",
        test: 0.1,
    };

    fn sense<D: Real>(p: &[D], sense: &mut Sense<'_, D>) {
        if sense.dt > 0.0 {
            let share = p[0] / sense.dt;
            sense.v = (sense.v + share * *sense.memory) / (share + 1.0);
        }
        *sense.memory = sense.v;
    }
}
