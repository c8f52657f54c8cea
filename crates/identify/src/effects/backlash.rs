//! `backlash`: The load follows the motor only when a gap is used up.

use super::{About, Channel, Key, Law, Measure, Sense, family::{has_tachometer}};
use crate::march::Real;

/// The load follows the motor only when a gap is used up.
pub(super) struct Backlash;

impl Law for Backlash {
    const ABOUT: About = About {
        name: "backlash",
        physics: "The load follows the motor only when a gap is used up.",
        channel: Channel::Kinematics,
        keys: &[Key::positive("gap", Measure::Length, 0.8)],
        probes: About::no_shape,
        applies: has_tachometer,
        confused: &["compliance", "presliding"],
        separated_by: "slow reversals, with the motor's own angle recorded",
        test: 0.1,
    };

    fn sense<D: Real>(p: &[D], sense: &mut Sense<'_, D>) {
        // The load lags by up to half a gap on either side; its place in the gap, of half of it, is remembered.
        let half = p[0] * 0.5;
        if sense.dt == 0.0 {
            *sense.memory = D::from(if sense.v.re() < 0.0 { -1.0 } else { 1.0 });
        } else if half.re() > 0.0 {
            let next = *sense.memory + sense.moved / half;
            *sense.memory = if next.re() > 1.0 {
                D::from(1.0)
            } else if next.re() < -1.0 {
                D::from(-1.0)
            } else {
                next
            };
        } else if sense.moved.re() != 0.0 {
            *sense.memory = D::from(sense.moved.re().signum());
        }
        sense.q -= half * *sense.memory;
    }
}
