//! `current_bias`: The true input is what was recorded and a constant more.

use super::{About, Channel, Key, Law, Measure, family::{driven, is_free}};
use crate::march::Real;

/// The true input is what was recorded and a constant more.
pub(super) struct CurrentBias;

impl Law for CurrentBias {
    const ABOUT: About = About {
        name: "current_bias",
        physics: "The true input is what was recorded and a constant more.",
        equation: "u = u_recorded + bias",
        channel: Channel::Torque,
        keys: &[Key::amount("bias", Measure::Input, 0.9)],
        probes: About::no_shape,
        applies: |rig| driven(rig) && !is_free(rig, "offset"),
        confused: &["coulomb_asymmetry", "preload_asymmetry", "gravity_unbalance", "viscous_asymmetry"],
        separated_by: "a drive that just fails to move the plant in either direction: a bias pushes at rest, an asymmetry of friction does not",
        test: 0.1,
    };

    fn input<D: Real>(p: &[D], u: &mut D) {
        *u += p[0];
    }
}
