//! `stribeck`: Friction falls from its break-away value to that of sliding.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{is_free, value}};
use crate::march::Real;

/// Friction falls from its break-away value to that of sliding.
pub(super) struct Stribeck;

impl Law for Stribeck {
    const ABOUT: About = About {
        name: "stribeck",
        physics: "Friction falls from its break-away value to that of sliding.",
        equation: "F_C + drop exp(−(q'/v_s)²), of form 2 exp(−|q'|/v_s), of form 5 1/(1 + (q'/v_s)²); 3, 4 and 6 are these of the whole force",
        channel: Channel::Torque,
        keys: &[Key::positive("drop", Measure::Force, 3.0), Key::fitted("v_s", Measure::Speed), Key::probed("form", Measure::One)],
        probes: |c| {
            let first = [1e-3, 1e-2, 0.05, 0.2].map(|s| (s, 1.0));
            let others: &[f64] = if c.memory > 0.0 { &[2.0, 3.0, 4.0] } else { &[2.0] };
            let others = others.iter().flat_map(|form| [(0.01, *form), (0.1, *form)]);
            first.into_iter().chain(others).map(|(s, form)| vec![s * c.speed, form]).collect()
        },
        applies: |rig| (value(rig, "f_s") == value(rig, "f_c") || rig.value("f_s").is_none()) && !is_free(rig, "f_s") && rig.friction.name != "none",
        confused: &["dwell_stiction", "maxwell_slip", "sublinear_drag"],
        separated_by: "slow ramps through zero speed without rests, and rests of several lengths",
        test: 0.1,
    };

    const FORMS: &[f64] = &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        // Forms 1 and 3: exp(−(v/v_s)²), as in the paper; 2 and 4: exp(−|v|/v_s), as in older texts. The first two
        // change the level at which the contact slips, the others its whole force. 5 and 6: 1/(1 + (v/v_s)²), of the level
        // and of the whole force (Hess and Soom, Journal of Tribology 112, 1990).
        let (s, form) = (at.v / p[1], p[2].re());
        let share = if form > 4.5 {
            (s * s + 1.0).recip()
        } else {
            let power = if form % 2.0 == 1.0 { s * s } else if s.re() < 0.0 { -s } else { s };
            (-power).exp()
        };
        let (rise, f_c) = (p[0] * share, at.f_c());
        let level = form < 2.5 || form == 5.0;
        if level || f_c.re() <= 0.0 { Act::Rise(rise) } else { Act::More(rise / f_c) }
    }
}
