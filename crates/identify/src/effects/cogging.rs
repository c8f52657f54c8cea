//! `cogging`: A torque that repeats with the angle, as of magnets and teeth.

use super::{About, Act, At, Channel, Key, Law, Measure};
use crate::march::Real;

/// The share of an overtone that is not there [1].
pub(super) const NO_OVERTONE: f64 = 1e-30;

/// A torque that repeats with the angle, as of magnets and teeth.
pub(super) struct Cogging;

impl Law for Cogging {
    const ABOUT: About = About {
        name: "cogging",
        physics: "A torque that repeats with the angle, as of magnets and teeth.",
        equation: "F + s(q), s = sine sin κq + cosine cos κq with κ = wavenumber, and share_2 of s(2κq + phase_2)",
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
        Act::Force(waves([p[0], p[1], p[2], p[3], p[4]], at.q))
    }
}

/// A wave along the way `q` [m] and its overtone: s sin kq + c cos kq, and the share of that at twice the angle and its phase.
pub(super) fn waves<D: Real>([sine, cosine, wavenumber, share, phase]: [D; 5], q: D) -> D {
    let wave = |turned: D| sine * turned.sin() + cosine * turned.cos();
    let turned = wavenumber * q;
    let overtone = share.re() > NO_OVERTONE;
    if overtone { wave(turned) + share * wave(turned * 2.0 + phase) } else { wave(turned) }
}
