//! `tach_gain`: The velocity sensor shows too much or too little, in proportion.

use super::{About, Channel, Key, Law, Measure, Sense, family::{has_tachometer}};
use crate::march::Real;

/// The velocity sensor shows too much or too little, in proportion.
pub(super) struct TachGain;

impl Law for TachGain {
    const ABOUT: About = About {
        name: "tach_gain",
        physics: "The velocity sensor shows too much or too little, in proportion.",
        equation: "w = (1 + error) q'",
        channel: Channel::Kinematics,
        keys: &[Key::amount("error", Measure::One, 0.9)],
        probes: About::no_shape,
        applies: has_tachometer,
        confused: &["compliance"],
        separated_by: "a long run in one direction",
        test: 0.1,
    };

    fn sense<D: Real>(p: &[D], sense: &mut Sense<D>, _: &mut D) {
        sense.v += p[0] * sense.v;
    }
}
