//! `coulomb_asymmetry`: Friction is stronger in one direction than in the other.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{rubs}};
use crate::march::Real;

/// The form in which the level at which the contact slips is higher in one direction, and its stiffness is not.
const LEVEL: f64 = 3.0;

/// Friction is stronger in one direction than in the other.
pub(super) struct CoulombAsymmetry;

impl Law for CoulombAsymmetry {
    const ABOUT: About = About {
        name: "coulomb_asymmetry",
        physics: "Friction is stronger in one direction than in the other.",
        equation: "F (1 + ratio sgn F), of form 2 also of viscous friction; of form 3 F_C (1 + ratio sgn q')",
        channel: Channel::Torque,
        keys: &[Key::amount("ratio", Measure::One, 0.8), Key::probed("form", Measure::One)],
        probes: |_| vec![vec![1.0]],
        applies: rubs,
        confused: &["current_bias", "preload_asymmetry", "viscous_asymmetry"],
        separated_by: "a drive that just fails to move the plant in either direction: a bias pushes at rest, an asymmetry of friction does not",
        test: 0.1,
    };

    const FORMS: &[f64] = &[1.0, 2.0, LEVEL];

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        match p[1].re() {
            // What has no bristles is its level.
            LEVEL if at.contact.0.memory() > 0.0 => {
                Act::Level(if at.v.re() < 0.0 { -p[0] } else { p[0] })
            }
            form if form == 1.0 || form == LEVEL => Act::Skew(p[0]),
            _ => Act::SkewOfAll(p[0]),
        }
    }
}
