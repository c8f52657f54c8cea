//! `cable_slack`: A cable cannot push: a spring whose force has come down to nothing stays there.

use super::{About, Act, At, Channel, Key, Law, Load, Measure, family::{has_springs}};
use crate::march::Real;

/// A cable cannot push: a spring whose force has come down to nothing stays there.
pub(super) struct CableSlack;

impl Law for CableSlack {
    const ABOUT: About = About {
        name: "cable_slack",
        physics: "A cable cannot push: a spring whose force has come down to nothing stays there.",
        equation: "springs push with 1 − amount of what they would push with",
        channel: Channel::Loads,
        keys: &[Key::positive("amount", Measure::One, 1.5)],
        probes: About::no_shape,
        applies: has_springs,
        confused: &["cubic_spring"],
        separated_by: "load cells",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        // What each cable would push with, were it a rod, is not there.
        let [one, other] = at.balance.cables.map(|[taut, by]| {
            let torque = taut + by * at.q;
            if torque.re() < 0.0 { torque } else { D::from(0.0) }
        });
        Act::Force((other - one) * p[0])
    }

    fn load<D: Real>(p: &[D], _: &Load, force: D) -> D {
        if force.re() < 0.0 { force - force * p[0] } else { force }
    }
}
