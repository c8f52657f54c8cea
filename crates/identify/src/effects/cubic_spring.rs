//! `cubic_spring`: Springs grow stiffer, or softer, when they are drawn.

use super::{About, Act, At, Channel, Key, Law, Load, Measure};
use crate::march::Real;

/// Springs grow stiffer, or softer, when they are drawn.
pub(super) struct CubicSpring;

impl Law for CubicSpring {
    const ABOUT: About = About {
        name: "cubic_spring",
        physics: "Springs grow stiffer, or softer, when they are drawn.",
        equation: "F + k_3 q³",
        channel: Channel::Loads,
        keys: &[Key::amount("k_3", Measure::Cubic, 5.0)],
        probes: About::no_shape,
        applies: |rig| rig.kind == "drum" || rig.kind == "mass-spring" || rig.kind == "prescribed",
        confused: &["gravity_unbalance", "cogging", "maxwell_slip"],
        separated_by: "load cells, or a whole turn",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        Act::Force(p[0] * at.q * at.q * at.q)
    }

    fn load<D: Real>(p: &[D], load: &Load, force: D) -> D {
        // Half of the torque each, over the radius.
        let angle = load.stretch / load.radius;
        force + p[0] * (0.5 * angle.powi(3) / load.radius)
    }
}
