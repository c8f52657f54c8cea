//! `coulomb`: Dry friction of a constant size against the motion.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{rubs}};
use crate::march::Real;

/// Dry friction of a constant size against the motion.
pub(super) struct Coulomb;

impl Law for Coulomb {
    const ABOUT: About = About {
        name: "coulomb",
        physics: "Dry friction of a constant size against the motion.",
        equation: "F + f_c sgn q', and at rest what holds, up to f_c",
        channel: Channel::Torque,
        keys: &[Key::positive("f_c", Measure::Force, 20.0)],
        probes: About::no_shape,
        applies: |rig| !rubs(rig),
        confused: &["sublinear_drag"],
        separated_by: "slow runs at several speeds",
        test: 0.1,
    };
    const DRY: bool = true;

    fn act<D: Real>(p: &[D], _: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        Act::Dry(p[0])
    }
}
