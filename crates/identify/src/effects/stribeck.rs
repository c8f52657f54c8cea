//! `stribeck`: Friction falls from its break-away value to that of sliding.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{is_free, value}};
use crate::march::Real;

/// Friction falls from its break-away value to that of sliding.
pub(super) struct Stribeck;

impl Law for Stribeck {
    const ABOUT: About = About {
        name: "stribeck",
        physics: "Friction falls from its break-away value to that of sliding.",
        channel: Channel::Torque,
        keys: &[Key::positive("drop", Measure::Force, 3.0), Key::fitted("v_s", Measure::Speed)],
        probes: |c| [1e-3, 1e-2, 0.05, 0.2].iter().map(|s| vec![s * c.speed]).collect(),
        applies: |rig| (value(rig, "f_s") == value(rig, "f_c") || rig.value("f_s").is_none()) && !is_free(rig, "f_s") && rig.friction.name != "none",
        confused: &["dwell_stiction", "maxwell_slip", "sublinear_drag"],
        separated_by: "slow ramps through zero speed without rests, and rests of several lengths",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        let s = at.v / p[1];
        Act::rise(p[0] * (-s * s).exp())
    }
}
