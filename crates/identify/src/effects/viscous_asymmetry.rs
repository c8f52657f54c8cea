//! `viscous_asymmetry`: Drag is stronger in one direction than in the other.

use super::{About, Act, At, Channel, Key, Law, Measure};
use crate::march::Real;

/// Drag is stronger in one direction than in the other.
pub(super) struct ViscousAsymmetry;

impl Law for ViscousAsymmetry {
    const ABOUT: About = About {
        name: "viscous_asymmetry",
        physics: "Drag is stronger in one direction than in the other.",
        equation: "F + c |q'|",
        channel: Channel::Torque,
        keys: &[Key::amount("c", Measure::Damping, 5.0)],
        probes: About::no_shape,
        applies: |_| true,
        confused: &["coulomb_asymmetry", "current_bias"],
        separated_by: "runs at several speeds in both directions",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        Act::Force(p[0] * if at.v.re() < 0.0 { -at.v } else { at.v })
    }
}
