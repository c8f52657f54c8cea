//! `gravity_unbalance`: A weight out of the middle pulls once a turn.

use super::{About, Act, At, Channel, Key, Law, Measure};
use crate::march::Real;

/// A weight out of the middle pulls once a turn.
pub(super) struct GravityUnbalance;

impl Law for GravityUnbalance {
    const ABOUT: About = About {
        name: "gravity_unbalance",
        physics: "A weight out of the middle pulls once a turn.",
        equation: "F + sine sin q + cosine cos q",
        channel: Channel::Torque,
        keys: &[Key::amount("sine", Measure::Force, 5.0), Key::amount("cosine", Measure::Force, 5.0)],
        // Whether an axis turns or slides is not said; what does not come as far as a radian shows no turn.
        probes: |c| if c.turns || c.span > 1.0 { vec![Vec::new()] } else { Vec::new() },
        applies: |rig| rig.kind == "drum" || rig.kind == "pendulum" || rig.kind == "axis",
        confused: &["cubic_spring", "current_bias", "cogging"],
        separated_by: "load cells, or a whole turn",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        Act::Force(p[0] * at.q.sin() + p[1] * at.q.cos())
    }
}
