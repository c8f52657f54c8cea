//! `sublinear_drag`: Friction grows with the speed, and less and less.

use super::{About, Act, At, Channel, Key, Law, Measure};
use crate::march::Real;

/// The form in which molecules are shorn past each other: c v_0 asinh(v/v_0) (Bird, Armstrong and Hassager, section 4.1;
/// Eyring, Journal of Chemical Physics 4, 1936).
const EYRING: f64 = 2.0;

/// The inverse of the hyperbolic sine.
fn asinh<D: Real>(x: D) -> D {
    let size = if x.re() < 0.0 { -x } else { x };
    if size.re() < 1e-4 {
        return x - x * x * x / 6.0;
    }
    let root = ((size * size + 1.0).ln() * 0.5).exp();
    let found = (size + root).ln();
    if x.re() < 0.0 { -found } else { found }
}

/// Friction grows with the speed, and less and less.
pub(super) struct SublinearDrag;

impl Law for SublinearDrag {
    const ABOUT: About = About {
        name: "sublinear_drag",
        physics: "Friction grows with the speed, and less and less.",
        equation: "F + c q' (1 + (q'/v_0)²)^(−bend/2), of form 2 c v_0 asinh(bend q'/v_0)/bend",
        channel: Channel::Torque,
        // Carreau's law of a lubricant that thins with shear, its power index 1 − bend (Bird, Armstrong and Hassager,
        // Dynamics of Polymeric Liquids, vol. 1, Wiley 1987, eq. 4.1-9).
        keys: &[
            Key::positive("c", Measure::Damping, 50.0),
            Key::fitted("v_0", Measure::Speed),
            Key::fitted("bend", Measure::One).usually(1.0),
            Key::probed("form", Measure::One),
        ],
        probes: |c| {
            [0.03, 0.1, 0.3].map(|s| vec![s * c.speed, 1.0, 1.0]).to_vec()
        },
        applies: |_| true,
        confused: &["viscous", "stribeck", "coulomb"],
        separated_by: "slow and fast runs at constant speed",
        test: 0.1,
    };

    const FORMS: &[f64] = &[1.0, EYRING];

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        let s = at.v / p[1];
        if p[3].re() == EYRING {
            return Act::Force(p[0] * p[1] * asinh(s * p[2]) / p[2]);
        }
        // What falls again in faster motion is another effect.
        let bend = if p[2].re() > 1.0 { D::from(1.0) } else { p[2] };
        Act::Force(p[0] * at.v * ((s * s + 1.0).ln() * (bend * -0.5)).exp())
    }
}
