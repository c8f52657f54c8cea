//! `preload_asymmetry`: The two springs are not drawn alike at rest.

use super::{About, Act, At, Channel, Key, Law, Load, Measure, family::{has_springs, is_free}};
use crate::march::Real;

/// The two springs are not drawn alike at rest.
pub(super) struct PreloadAsymmetry;

impl Law for PreloadAsymmetry {
    const ABOUT: About = About {
        name: "preload_asymmetry",
        physics: "The two springs are not drawn alike at rest.",
        channel: Channel::Loads,
        keys: &[Key::amount("force", Measure::Pull, 10.0)],
        probes: About::no_shape,
        applies: |rig| has_springs(rig) && !(is_free(rig, "f_10") && is_free(rig, "f_20")),
        confused: &["current_bias", "coulomb_asymmetry"],
        separated_by: "load cells at the springs",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        Act::force(p[0] * at.radius)
    }

    fn load<D: Real>(p: &[D], load: &Load, force: D) -> D {
        force + p[0] * if load.cell == 0 { 0.5 } else { -0.5 }
    }
}
