//! `dwell_stiction`: The longer a contact rests, the more it takes to break it away.

use super::{About, Act, At, Channel, Key, Law, Measure, Past, family::{rubs}};
use crate::march::Real;

/// The longer a contact rests, the more it takes to break it away.
pub(super) struct DwellStiction;

impl Law for DwellStiction {
    const ABOUT: About = About {
        name: "dwell_stiction",
        physics: "The longer a contact rests, the more it takes to break it away.",
        equation: "F_C + drop z, z' = (1 − z)/tau − z |q'|/(wear d), d the deflection of the bristles at which they slip",
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
        let worn = speed * at.held(p[0] * base[0]) * at.dt / (p[2] * at.grain());
        z[0] = (base[0] + aged) / (aged + worn + 1.0);
        Act::Rise(p[0] * z[0])
    }

    fn start<D: Real>(p: &[D], _: usize, (_, grain, past): (f64, f64, Past<'_>)) -> D {
        // As old as a rest before the last samples made it, and then as they did.
        let lately: f64 = past.lately.iter().map(|[time, _]| time).sum();
        let rested = (past.rested - lately).max(0.0);
        let mut age = D::from(1.0) - (-(p[1].recip() * rested)).exp();
        let mut last = 0.0;
        for [time, run] in past.lately {
            let way = if *run < last { *run } else { run - last };
            // Back from a turn the bristles first let go, and then hold the other way: exact of Dahl's and LuGre's in slow
            // motion, and near of the others.
            let held = (1.0 - 2.0 * (-run / grain).exp()).abs();
            let aged = p[1].recip() * *time;
            age = (age + aged) / (aged + p[2].recip() * (way * held / grain) + 1.0);
            last = *run;
        }
        age
    }
}

#[cfg(test)]
mod tests {
    use super::{At, DwellStiction, Past};
    use crate::{
        effects::Law,
        march::{Balance, Contact},
    };

    #[test]
    fn what_slides_steadily_is_as_old_as_its_slip_leaves_it_at_the_level_that_its_age_raised() {
        let contact =
            Contact::LuGre { f_c: 4.0, f_s: 6.0, v_s: 0.01, sigma_0: 1e5, sigma_1: 300.0 };
        let ([drop, tau, wear], v) = ([3.0, 0.5, 10.0], 2e-4_f64);
        // (1 − a)/τ = a v/(wear · F_C/σ₀), and bristles that hold F_C + (F_S − F_C) exp(−(v/v_S)²) + drop · a.
        let age = 1.0 / (1.0 + tau * v / (wear * 4e-5));
        let level = 4.0 + 2.0 * (-(v / 0.01).powi(2)).exp() + drop * age;
        let balance = Balance::alone(1.0);
        let at = At {
            t: 0.0,
            dt: 0.01,
            drive: 0.0,
            q: 0.0,
            v,
            radius: 1.0,
            contact: (&contact, &[level / 1e5]),
            balance: &balance,
            mass: 1.0,
        };
        let mut z = [0.0];
        let act = DwellStiction::act(&[drop, tau, wear], &at, &[age], &mut z);
        assert!((z[0] - age).abs() < 1e-12, "{} for {age}", z[0]);
        assert!(matches!(act, super::Act::Rise(rise) if (rise - drop * age).abs() < 1e-12), "{act:?}");
    }

    #[test]
    fn a_contact_is_as_old_as_it_has_rested() {
        let age = |rested: f64, lately: &[[f64; 2]]| {
            let past = Past { rested, lately, ..Past::unknown() };
            DwellStiction::start(&[1.0, 0.5, 1.0], 0, (0.0, 0.1, past))
        };
        let there = 1.0 - (-1.0_f64).exp();
        assert!((age(0.5, &[]) - there).abs() < 1e-12);
        assert_eq!(age(0.0, &[]), 0.0);
        let rests = vec![[0.001, 0.0]; 500];
        assert!((age(0.5, &rests) - there).abs() < 1e-3);
        // It ages by (1 − 1/2)/0.5 s and wears by 0.2/0.1 · 1/2 in a second.
        let slips: Vec<[f64; 2]> = (0..5000).map(|i| [0.001, 0.0002 * f64::from(i)]).collect();
        assert!((age(0.0, &slips) - 0.5).abs() < 1e-3);
    }
}
