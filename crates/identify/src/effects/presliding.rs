//! `presliding`: Before it slides a contact gives way like a spring, and dissipates.

use super::{About, Channel, Key, Law, Measure, family::{value}};

/// The largest exponent of a contact: the paper has 0 to 2. With a larger one friction is still growing where the contact
/// has slid for long, and then it is drag that grows less than the speed.
const STEEPEST: f64 = 3.0;

/// Before it slides a contact gives way like a spring, and dissipates.
pub(super) struct Presliding;

impl Law for Presliding {
    const ABOUT: About = About {
        name: "presliding",
        physics: "Before it slides a contact gives way like a spring, and dissipates.",
        equation: "Coulomb friction becomes Dahl's, with sigma and gamma",
        channel: Channel::Torque,
        keys: &[
            Key::fitted("sigma", Measure::Stiffness),
            Key::fitted("gamma", Measure::One).usually(1.0).up_to(STEEPEST),
        ],
        probes: |c| [1e5, 1e4, 1e3, 100.0].iter().map(|s| vec![s * c.force / c.span, 1.0]).collect(),
        applies: |rig| (rig.friction.name == "coulomb" || rig.friction.name == "none") && value(rig, "f_c") > 0.0,
        confused: &["maxwell_slip", "backlash"],
        separated_by: "small reversals, smaller than the presliding distance",
        test: 0.1,
    };

    // Binding makes the rig's Coulomb friction a Dahl model of this stiffness and exponent.
}
