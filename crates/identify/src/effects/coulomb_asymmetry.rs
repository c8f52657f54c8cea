//! `coulomb_asymmetry`: Friction is stronger in one direction than in the other.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{rubs}};
use crate::march::Real;

/// Friction is stronger in one direction than in the other.
pub(super) struct CoulombAsymmetry;

impl Law for CoulombAsymmetry {
    const ABOUT: About = About {
        name: "coulomb_asymmetry",
        physics: "Friction is stronger in one direction than in the other.",
        equation: "F (1 + ratio sgn F)",
        channel: Channel::Torque,
        keys: &[Key::amount("ratio", Measure::One, 0.8)],
        probes: About::no_shape,
        applies: rubs,
        confused: &["current_bias", "preload_asymmetry", "viscous_asymmetry"],
        separated_by: "a drive that just fails to move the plant in either direction: a bias pushes at rest, an asymmetry of friction does not",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], _: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        Act::Skew(p[0])
    }
}
