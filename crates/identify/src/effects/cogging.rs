//! `cogging`: A torque that repeats with the angle, as of magnets and teeth.

use super::{About, Act, At, Channel, Key, Law, Measure};
use crate::march::Real;

/// The share of an overtone that is not there [1].
const NO_OVERTONE: f64 = 1e-30;

/// A torque that repeats with the angle, as of magnets and teeth.
pub(super) struct Cogging;

impl Law for Cogging {
    const ABOUT: About = About {
        name: "cogging",
        physics: "A torque that repeats with the angle, as of magnets and teeth.",
        channel: Channel::Torque,
        // The overtone has a share of the wave's amplitude, and is ahead of it by its phase [rad].
        keys: &[
            Key::amount("sine", Measure::Force, 2.0),
            Key::amount("cosine", Measure::Force, 2.0),
            Key::fitted("wavenumber", Measure::Wavenumber),
            Key::spare("share_2", Measure::One, NO_OVERTONE),
            Key::spare("phase_2", Measure::One, 1.0),
        ],
        probes: |c| super::wavenumbers(c, 2..=8, c.waves[0]),
        applies: |_| true,
        confused: &["gravity_unbalance", "cubic_spring", "position_friction"],
        separated_by: "a longer stretch, several of its periods",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        let wave = |turned: D| p[0] * turned.sin() + p[1] * turned.cos();
        let turned = p[2] * at.q;
        let overtone = p[3].re() > NO_OVERTONE;
        Act::Force(if overtone { wave(turned) + p[3] * wave(turned * 2.0 + p[4]) } else { wave(turned) })
    }
}
