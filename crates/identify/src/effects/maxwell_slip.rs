//! `maxwell_slip`: Springs that slip act beside the friction, and remember more than the last turn.

use super::{About, Act, At, Channel, Key, Law, Measure, Past};
use crate::march::Real;

/// Springs that slip act beside the friction, and remember more than the last turn.
pub(super) struct MaxwellSlip;

impl Law for MaxwellSlip {
    const ABOUT: About = About {
        name: "maxwell_slip",
        physics: "Springs that slip act beside the friction, and remember more than the last turn.",
        equation: "F + Σ k share_i z_i, z_i' = q' while |z_i| < delta_i, up to four of them, the first with share 1 and delta",
        channel: Channel::Torque,
        // Of every further spring the stiffness is a share of the first one's.
        keys: &[
            Key::positive("k", Measure::Stiffness, 1e4),
            Key::fitted("delta", Measure::Length),
            Key::spare("share_2", Measure::One, NO_SPRING),
            Key::spare("delta_2", Measure::Length, 1.0),
            Key::spare("share_3", Measure::One, NO_SPRING),
            Key::spare("delta_3", Measure::Length, 1.0),
            Key::spare("share_4", Measure::One, NO_SPRING),
            Key::spare("delta_4", Measure::Length, 1.0),
        ],
        probes: |c| [0.003, 0.01, 0.03, 0.1, 0.3].iter().map(|s| vec![s * c.span]).collect(),
        applies: |_| true,
        confused: &["stribeck", "cubic_spring", "position_friction"],
        separated_by: "small loops inside a large one",
        test: 0.1,
    };
    const STATES: usize = SPRINGS;

    fn act<D: Real>(p: &[D], at: &At<D>, base: &[D], z: &mut [D]) -> Act<D> {
        // The state is the deflection in deadbands, so that it has a size when there is no effect.
        let mut force = D::from(0.0);
        for i in 0..SPRINGS {
            let (share, delta) = spring(p, i);
            if share.re() > NO_SPRING {
                z[i] = within(base[i] + at.v * at.dt / delta);
                force += p[0] * share * delta * z[i];
            }
        }
        Act::Force(force)
    }

    fn start<D: Real>(p: &[D], place: usize, (way, _, past): (f64, f64, Past<'_>)) -> D {
        let path = past.path;
        if path.len() < 2 {
            return D::from(way);
        }
        let delta = spring(p, place).1;
        let moved = |z: D, step: &[f64]| within(z + delta.recip() * (step[1] - step[0]));
        path.windows(2).fold(D::from(0.0), moved)
    }
}

/// How many springs there can be.
const SPRINGS: usize = 4;

/// The share of a spring that is not there [1].
const NO_SPRING: f64 = 1e-30;

/// The stiffness of a spring as a share of the first one's, and its deadband [1, m].
fn spring<D: Real>(p: &[D], place: usize) -> (D, D) {
    if place == 0 { (D::from(1.0), p[1]) } else { (p[2 * place], p[2 * place + 1]) }
}

/// A deflection of no more than one deadband.
fn within<D: Real>(z: D) -> D {
    if z.re() > 1.0 {
        D::from(1.0)
    } else if z.re() < -1.0 {
        D::from(-1.0)
    } else {
        z
    }
}

#[cfg(test)]
mod tests {
    use super::{MaxwellSlip, Past};
    use crate::effects::Law;

    #[test]
    fn every_spring_remembers_by_its_own_deadband() {
        let p = [2.0, 1e-3, 0.5, 4e-3, super::NO_SPRING, 1.0, super::NO_SPRING, 1.0];
        // It went on by 10 mm and came back by 3: the first spring is pulled to its end, the second to 1 mm of 4.
        let past = Past { path: &[0.0, 0.01, 0.007], rested: 0.0, ..Past::unknown() };
        let states = [0, 1].map(|place| MaxwellSlip::start(&p, place, (-1.0, 0.0, past)));
        assert!((states[0] + 1.0).abs() < 1e-12 && (states[1] - 0.25).abs() < 1e-12, "{states:?}");
    }
}
