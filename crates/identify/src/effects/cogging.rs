//! `cogging`: A torque that repeats with the angle, as of magnets and teeth.

use super::{About, Act, At, Channel, Key, Law, Measure};
use crate::march::Real;

/// A torque that repeats with the angle, as of magnets and teeth.
pub(super) struct Cogging;

impl Law for Cogging {
    const ABOUT: About = About {
        name: "cogging",
        physics: "A torque that repeats with the angle, as of magnets and teeth.",
        channel: Channel::Torque,
        keys: &[Key::amount("sine", Measure::Force, 2.0), Key::amount("cosine", Measure::Force, 2.0), Key::fitted("wavenumber", Measure::Wavenumber)],
        probes: |c| super::wavenumbers(c, 2..=8, c.waves[0]),
        applies: |_| true,
        confused: &["gravity_unbalance", "cubic_spring", "position_friction"],
        separated_by: "a longer stretch, several of its periods",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        let turned = p[2] * at.q;
        Act::force(p[0] * turned.sin() + p[1] * turned.cos())
    }
}
