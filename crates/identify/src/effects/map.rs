//! A force that is known nowhere but where it acts: one hat of a map over time, angle, speed or drive, beside the friction or
//! as more of it.
//!
//! It is in no rig file; maps are drawn of it where no effect of the library explains what is left.

use super::{About, Act, At, Channel, Key, Law, Measure};
use crate::march::Real;

/// A force around one place of an axis, 0 time, 1 displacement, 2 velocity, 3 drive: beside the friction, or, of 1, so
/// much more of it.
pub(super) struct Map;

impl Law for Map {
    const ABOUT: About = About {
        name: "map",
        physics: "A force of unknown origin, and where it acts.",
        equation: "F + amount (1 − |x − center|/width), x an axis",
        channel: Channel::Torque,
        keys: &[
            Key::amount("amount", Measure::Force, 1e9),
            Key::probed("axis", Measure::One),
            Key::probed("center", Measure::One),
            Key::probed("width", Measure::One),
            Key::probed("of", Measure::One),
        ],
        probes: About::no_shape,
        applies: |_| false,
        confused: &[],
        separated_by: "",
        test: 0.0,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        let x = match p[1].re() {
            axis if axis < 0.5 => D::from(at.t),
            axis if axis < 1.5 => at.q,
            axis if axis < 2.5 => at.v,
            _ => at.drive,
        };
        let away = (x - p[2]) / p[3];
        let away = if away.re() < 0.0 { -away } else { away };
        if away.re() >= 1.0 {
            return Act::None;
        }
        let much = p[0] * (-away + 1.0);
        if p[4].re() < 0.5 { Act::Force(much) } else { Act::More(much) }
    }
}
