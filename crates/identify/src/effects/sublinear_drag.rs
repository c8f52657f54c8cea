//! `sublinear_drag`: Friction grows with the speed, and less and less.

use super::{About, Act, At, Channel, Key, Law, Measure};
use crate::march::Real;

/// Friction grows with the speed, and less and less.
pub(super) struct SublinearDrag;

impl Law for SublinearDrag {
    const ABOUT: About = About {
        name: "sublinear_drag",
        physics: "Friction grows with the speed, and less and less.",
        channel: Channel::Torque,
        keys: &[Key::positive("c", Measure::Damping, 50.0), Key::fitted("v_0", Measure::Speed)],
        probes: |c| vec![vec![0.03 * c.speed], vec![0.1 * c.speed], vec![0.3 * c.speed]],
        applies: |_| true,
        confused: &["viscous", "stribeck", "coulomb"],
        separated_by: "slow and fast runs at constant speed",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        let s = at.v / p[1];
        Act::force(p[0] * at.v / (s * s + 1.0).sqrt())
    }
}
