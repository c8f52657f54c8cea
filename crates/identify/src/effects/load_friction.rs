//! `load_friction`: Friction grows with the load that the drive carries.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{driven, rubs}};
use crate::march::Real;

/// Friction grows with the load that the drive carries.
pub(super) struct LoadFriction;

impl Law for LoadFriction {
    const ABOUT: About = About {
        name: "load_friction",
        physics: "Friction grows with the load that the drive carries.",
        channel: Channel::Torque,
        keys: &[Key::positive("ratio", Measure::One, 2.0)],
        probes: About::no_shape,
        applies: |rig| driven(rig) && rubs(rig),
        confused: &["position_friction", "quadratic_drag", "viscous"],
        separated_by: "the same motion under another load",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        let f_c = if at.f_c().re() > 0.0 { at.f_c() } else { D::from(1.0) };
        let load = if at.drive.re() < 0.0 { -at.drive } else { at.drive };
        Act::more(p[0] * load / f_c)
    }
}
