//! `friction_drift`: Friction changes with time, as when it warms up.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{grows, in_forms, rubs}};
use crate::march::Real;

/// Friction changes with time, as when it warms up.
pub(super) struct FrictionDrift;

impl Law for FrictionDrift {
    const ABOUT: About = About {
        name: "friction_drift",
        physics: "Friction changes with time, as when it warms up.",
        equation: "F (1 + amount (1 − exp(−t/tau)))",
        channel: Channel::Torque,
        keys: &[Key::amount("amount", Measure::One, 0.9), Key::fitted("tau", Measure::Time), Key::probed("form", Measure::One)],
        probes: |c| {
            let taus = [0.1, 0.4, 4.0].map(|share| vec![share * c.duration]);
            in_forms(c, &taus, &[1.0, 2.0])
        },
        applies: rubs,
        confused: &["torque_saturation"],
        separated_by: "a longer record, or the same drive again",
        test: 0.1,
    };

    const FORMS: &[f64] = &[1.0, 2.0, 3.0, 4.0];

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        grows(p[2].re(), p[0] * (-(-p[1].recip() * at.t).exp() + 1.0), at.f_c())
    }
}
