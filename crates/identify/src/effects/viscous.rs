//! `viscous`: Friction grows with the speed.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{is_free, value}};
use crate::march::Real;

/// Friction grows with the speed.
pub(super) struct Viscous;

impl Law for Viscous {
    const ABOUT: About = About {
        name: "viscous",
        physics: "Friction grows with the speed.",
        equation: "F + sigma_2 q'",
        channel: Channel::Torque,
        keys: &[Key::positive("sigma_2", Measure::Damping, 20.0)],
        probes: About::no_shape,
        applies: |rig| value(rig, "sigma_2") == 0.0 && !is_free(rig, "sigma_2"),
        confused: &["sublinear_drag", "quadratic_drag"],
        separated_by: "runs at several constant speeds",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        Act::Drag(p[0] * at.v)
    }
}
