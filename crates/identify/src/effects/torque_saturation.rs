//! `torque_saturation`: The drive gives less than it should when it is to give much.

use super::{About, Channel, Key, Law, Measure, family::{driven}};
use crate::march::Real;

/// So many widths beyond the knee the bend is over to the last digit.
const FAR: f64 = 36.0;

/// The form without a knee: the drive bends from the first on, as tanh does.
const ROUND: f64 = 2.0;

/// The form of which the bend has the knee as its asymptote: 1/(1 + |u/knee|^p)^(1/p), p = knee/width.
const POWER: f64 = 3.0;

/// The hyperbolic tangent.
fn tanh<D: Real>(x: D) -> D {
    let size = if x.re() < 0.0 { -x } else { x };
    let left = (size * -2.0).exp();
    let tanh = (D::from(1.0) - left) / (left + 1.0);
    if x.re() < 0.0 { -tanh } else { tanh }
}

/// The drive gives less than it should when it is to give much.
pub(super) struct TorqueSaturation;

impl Law for TorqueSaturation {
    const ABOUT: About = About {
        name: "torque_saturation",
        physics: "The drive gives less than it should when it is to give much: from the knee on, over the width of a bend.",
        equation: "of the drive τ so much is lost: loss (|τ| − knee) beyond the knee, over a bend of this width; form 2: knee tanh(τ/knee) is left; 3: τ/(1 + |τ/knee|^p)^(1/p), p = knee/width",
        channel: Channel::Torque,
        keys: &[
            Key::positive("loss", Measure::One, 1.2),
            Key::fitted("knee", Measure::Force),
            Key::fitted("width", Measure::Force),
            Key::probed("form", Measure::One),
        ],
        probes: |c| {
            [0.5, 0.65, 0.8, 0.9].map(|s| vec![s * c.drive, 0.05 * c.drive, 1.0]).to_vec()
        },
        applies: driven,
        confused: &["quadratic_drag", "friction_drift", "load_friction"],
        separated_by: "two amplitudes of the drive",
        test: 0.1,
    };

    const FORMS: &[f64] = &[1.0, ROUND, POWER];

    fn drive<D: Real>(p: &[D], force: &mut D) {
        *force -= lost(p, *force) * p[0];
    }
}

/// What a drive without any loss but this one loses of the `force` that it is to give [N].
fn lost<D: Real>(p: &[D], force: D) -> D {
        if p[3].re() == ROUND {
            // All that is lost where the drive gives the knee's tanh of what is asked.
            let given = p[1] * tanh(force / p[1]);
            return force - given;
        }
        if p[3].re() == POWER {
            if force.re() == 0.0 {
                return D::from(0.0);
            }
            // ln of 1 + |u/knee|^p, without its overflow.
            let power = p[1] / p[2];
            let size = if force.re() < 0.0 { -force } else { force };
            let over = (size / p[1]).ln() * power;
            let bend = if over.re() > FAR { over } else { (over.exp() + 1.0).ln() };
            let given = force * (-bend / power).exp();
            return force - given;
        }
        // What is beyond the knee, and a little of what is before: an amplifier bends, it has no corner.
        let size = if force.re() < 0.0 { -force } else { force };
        let over = (size - p[1]) / p[2];
        let beyond = if over.re() > FAR { over } else { (over.exp() + 1.0).ln() } * p[2];
        if force.re() < 0.0 { -beyond } else { beyond }
}
