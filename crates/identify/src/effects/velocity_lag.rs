//! `velocity_lag`: The velocity sensor follows late, as behind a filter.

use super::{About, Channel, Key, Law, Measure, Sense, family::{has_tachometer}};
use crate::march::Real;

/// The velocity sensor follows late, as behind a filter.
pub(super) struct VelocityLag;

/// A filter that has forgotten all but exp(−40) of a sample before.
const QUICK: f64 = 40.0;

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

    fn sense<D: Real>(p: &[D], sense: &mut Sense<D>, memory: &mut D) {
        // Exact where the velocity is a line from sample to sample, and was a parabola for long before the first.
        let (tau, slope) = (p[0], sense.slope);
        let follows = sense.v - (slope - sense.bend * tau) * tau;
        sense.v = if sense.dt == 0.0 || tau.re() * QUICK < sense.dt {
            // What was before the first is in what is shown there, which is known the better the longer it lasts.
            sense.shown.map_or(follows, |shown| {
                let square = tau * tau;
                follows + (-follows + shown.v) * (square / (square + shown.half * shown.half))
            })
        } else {
            let kept = (-tau.recip() * sense.dt).exp();
            follows + kept * (*memory - follows + slope * sense.dt)
        };
        *memory = sense.v;
    }
}
