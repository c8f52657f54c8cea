//! `tach_bias`: The velocity sensor shows a constant beside the velocity.

use super::{About, Channel, Key, Law, Measure, Sense, family::{has_tachometer}};
use crate::march::Real;

/// The velocity sensor shows a constant beside the velocity.
pub(super) struct TachBias;

impl Law for TachBias {
    const ABOUT: About = About {
        name: "tach_bias",
        physics: "The velocity sensor shows a constant beside the velocity.",
        equation: "w = q' + bias",
        channel: Channel::Kinematics,
        keys: &[Key::amount("bias", Measure::Speed, 0.9)],
        probes: About::no_shape,
        applies: has_tachometer,
        confused: &[],
        separated_by: "a rest",
        test: 0.1,
    };

    fn sense<D: Real>(p: &[D], sense: &mut Sense<D>, _: &mut D) {
        sense.v += p[0];
    }
}
