//! `maxwell_slip`: A spring that slips acts beside the friction, and remembers more than the last turn.

use super::{About, Act, At, Channel, Key, Law, Measure, Past};
use crate::march::Real;

/// A spring that slips acts beside the friction, and remembers more than the last turn.
pub(super) struct MaxwellSlip;

impl Law for MaxwellSlip {
    const ABOUT: About = About {
        name: "maxwell_slip",
        physics: "A spring that slips acts beside the friction, and remembers more than the last turn.",
        channel: Channel::Torque,
        keys: &[Key::positive("k", Measure::Stiffness, 1e4), Key::fitted("delta", Measure::Length)],
        probes: |c| [0.003, 0.01, 0.03, 0.1, 0.3].iter().map(|s| vec![s * c.span]).collect(),
        applies: |_| true,
        confused: &["stribeck", "cubic_spring", "position_friction"],
        separated_by: "small loops inside a large one",
        test: 0.1,
    };
    const STATES: usize = 1;

    fn act<D: Real>(p: &[D], at: &At<D>, base: &[D], z: &mut [D]) -> Act<D> {
        // The state is the deflection in deadbands, so that it has a size when there is no effect.
        z[0] = within(base[0] + at.v * at.dt / p[1]);
        Act::force(p[0] * p[1] * z[0])
    }

    fn start<D: Real>(p: &[D], way: f64, past: Past<'_>) -> D {
        let path = past.path;
        if path.len() < 2 {
            return D::from(way);
        }
        let moved = |z: D, step: &[f64]| within(z + p[1].recip() * (step[1] - step[0]));
        path.windows(2).fold(D::from(0.0), moved)
    }
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
