//! `inertia`: More mass moves than the model says, or less.

use super::{About, Channel, Key, Law, Measure, family::{driven, is_free}};
use crate::march::Real;

/// The smallest ratio by which a mass grows.
const LEAST: f64 = -0.95;

/// More mass moves than the model says, or less.
pub(super) struct Inertia;

impl Law for Inertia {
    const ABOUT: About = About {
        name: "inertia",
        physics: "More mass moves than the model says, or less.",
        equation: "M (1 + ratio)",
        channel: Channel::Torque,
        keys: &[Key::amount("ratio", Measure::One, 4.0)],
        probes: About::no_shape,
        applies: |rig| driven(rig) && !is_free(rig, if rig.kind == "mass-spring" { "mass" } else { "inertia" }),
        confused: &["input_delay"],
        separated_by: "faster drives",
        test: 0.1,
    };

    fn mass<D: Real>(p: &[D], mass: &mut D) {
        // No plant has less than nothing.
        let ratio = if p[0].re() > LEAST { p[0] } else { D::from(LEAST) };
        *mass += *mass * ratio;
    }
}
