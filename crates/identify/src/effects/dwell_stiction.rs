//! `dwell_stiction`: The longer a contact rests, the more it takes to break it away.

use super::{About, Act, At, Channel, Key, Law, Measure, Past, family::{rubs}};
use crate::march::Real;

/// The longer a contact rests, the more it takes to break it away.
pub(super) struct DwellStiction;

impl Law for DwellStiction {
    const ABOUT: About = About {
        name: "dwell_stiction",
        physics: "The longer a contact rests, the more it takes to break it away.",
        channel: Channel::Torque,
        keys: &[Key::positive("drop", Measure::Force, 3.0), Key::fitted("tau", Measure::Time), Key::fitted("wear", Measure::One).usually(1.0)],
        probes: |c| (if c.memory > 0.0 { [1.0, 10.0] } else { [3.0, 50.0] }).iter().flat_map(|wear| [0.1, 0.5, 2.0].map(|tau| vec![tau, *wear])).collect(),
        applies: rubs,
        confused: &["stribeck", "maxwell_slip"],
        separated_by: "rests of several lengths before the same break-away",
        test: 0.1,
    };
    const STATES: usize = 1;

    fn act<D: Real>(p: &[D], at: &At<D>, base: &[D], z: &mut [D]) -> Act<D> {
        // The age is forgotten as the contact slips by `wear` deflections of its bristles; what they follow is no slip.
        let speed = if at.v.re() < 0.0 { -at.v } else { at.v };
        let aged = p[1].recip() * at.dt;
        let worn = speed * at.held() * at.dt / (p[2] * at.grain());
        z[0] = (base[0] + aged) / (aged + worn + 1.0);
        Act::rise(p[0] * z[0])
    }

    fn start<D: Real>(p: &[D], _: usize, (way, past): (f64, Past<'_>)) -> D {
        if way == 0.0 { D::from(1.0) - (-(p[1].recip() * past.rested)).exp() } else { D::from(0.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::{DwellStiction, Past};
    use crate::effects::Law;

    #[test]
    fn a_contact_is_as_old_as_it_has_rested() {
        let age = |way: f64, rested: f64| {
            DwellStiction::start(&[1.0, 0.5, 1.0], 0, (way, Past { path: &[], rested }))
        };
        assert!((age(0.0, 0.5) - (1.0 - (-1.0_f64).exp())).abs() < 1e-12);
        assert_eq!((age(0.0, 0.0), age(1.0, 9.0)), (0.0, 0.0));
    }
}
