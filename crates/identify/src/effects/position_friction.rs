//! `position_friction`: Friction differs from place to place.

use super::{About, Act, At, Channel, Key, Law, Measure, cogging::{NO_OVERTONE, waves}, family::{grows, in_forms, rubs}};
use crate::march::Real;

/// Friction differs from place to place.
pub(super) struct PositionFriction;

impl Law for PositionFriction {
    const ABOUT: About = About {
        name: "position_friction",
        physics: "Friction differs from place to place.",
        equation: "F (1 + s(q)), s = sine sin κq + cosine cos κq with κ = wavenumber, and share_2 of s(2κq + phase_2)",
        channel: Channel::Torque,
        // The overtone as in `cogging`.
        keys: &[
            Key::amount("sine", Measure::Amplitude, 0.9),
            Key::amount("cosine", Measure::Amplitude, 0.9),
            Key::fitted("wavenumber", Measure::Wavenumber),
            Key::probed("form", Measure::One),
            Key::spare("share_2", Measure::One, NO_OVERTONE),
            Key::spare("phase_2", Measure::One, 1.0),
        ],
        probes: |c| in_forms(c, &super::wavenumbers(c, 1..=6, c.waves[1]), &[1.0, 2.0]),
        applies: rubs,
        confused: &["load_friction", "friction_drift"],
        separated_by: "the same stretch travelled under another load",
        test: 0.1,
    };

    const FORMS: &[f64] = &[1.0, 2.0, 3.0, 4.0];

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        grows(p[3].re(), waves([p[0], p[1], p[2], p[4], p[5]], at.q), at.f_c())
    }
}
