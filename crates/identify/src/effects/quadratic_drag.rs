//! `quadratic_drag`: Drag grows with the square of the speed.

use super::{About, Act, At, Channel, Key, Law, Measure};
use crate::march::Real;

/// Drag grows with the square of the speed.
pub(super) struct QuadraticDrag;

impl Law for QuadraticDrag {
    const ABOUT: About = About {
        name: "quadratic_drag",
        physics: "Drag grows with the square of the speed.",
        equation: "F + c q' |q'|",
        channel: Channel::Torque,
        keys: &[Key::positive("c", Measure::Drag, 5.0)],
        probes: About::no_shape,
        applies: |_| true,
        confused: &["torque_saturation", "sublinear_drag", "viscous"],
        separated_by: "two amplitudes of the drive: drag goes with the speed, saturation with the drive",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        Act::Force(p[0] * at.v * if at.v.re() < 0.0 { -at.v } else { at.v })
    }
}
