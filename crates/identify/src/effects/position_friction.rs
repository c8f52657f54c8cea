//! `position_friction`: Friction differs from place to place.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{grows, in_forms, rubs}};
use crate::march::Real;

/// Friction differs from place to place.
pub(super) struct PositionFriction;

impl Law for PositionFriction {
    const ABOUT: About = About {
        name: "position_friction",
        physics: "Friction differs from place to place.",
        channel: Channel::Torque,
        keys: &[Key::amount("sine", Measure::Amplitude, 0.9), Key::amount("cosine", Measure::Amplitude, 0.9), Key::fitted("wavenumber", Measure::Wavenumber), Key::probed("form", Measure::One)],
        probes: |c| in_forms(c, &super::wavenumbers(c, 1..=6, c.waves[1]), &[1.0, 2.0]),
        applies: rubs,
        confused: &["load_friction", "friction_drift"],
        separated_by: "the same stretch travelled under another load",
        test: 0.1,
    };

    const FORMS: &[f64] = &[1.0, 2.0, 3.0];

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        let turned = p[2] * at.q;
        grows(p[3].re(), p[0] * turned.sin() + p[1] * turned.cos(), at.f_c())
    }
}
