//! `load_friction`: Friction grows with the load that the drive carries.

use super::{About, Act, At, Channel, Key, Law, Measure, family::{driven, grows, in_forms, rubs}};
use crate::march::Real;

/// Friction grows with the load that the drive carries.
pub(super) struct LoadFriction;

impl Law for LoadFriction {
    const ABOUT: About = About {
        name: "load_friction",
        physics: "Friction grows with the load that the drive carries.",
        equation: "F_C + ratio |load|; load: of forms 1, 2 and 5 what the drive gives, of 3, 4 and 6 what springs and weight pull with, of 7, 8 and 9 what a gear carries of both, (motor T + these)/(motor + 1), T being what the motor gives without its back-EMF",
        channel: Channel::Torque,
        // Forms 1, 2 and 5: by what drives it; 3, 4 and 6: by what springs and weight pull with; 7, 8 and 9: by both, as gears
        // of servos have it (Duclusaud et al., Extended friction models for the physics simulation of servo actuators,
        // arXiv:2410.08650: K_m τ_m - K_e τ_e, with motor = K_m/K_e and ratio = K_m + K_e).
        keys: &[
            Key::positive("ratio", Measure::One, 2.0),
            Key::probed("form", Measure::One),
            Key::spare("motor", Measure::One, 1.0),
        ],
        probes: |c| in_forms(c, &[Vec::new()], if c.loaded { &[1.0, 2.0, 3.0, 4.0, 7.0, 8.0] } else { &[1.0, 2.0] }),
        applies: |rig| driven(rig) && rubs(rig),
        confused: &["position_friction", "quadratic_drag", "viscous"],
        separated_by: "the same motion under another load",
        test: 0.1,
    };

    const FORMS: &[f64] = &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        let f_c = if at.f_c().re() > 0.0 { at.f_c() } else { D::from(1.0) };
        let (form, load) = match p[1].re() {
            form if form < 2.5 => (form, at.drive),
            form if form < 4.5 => (form - 2.0, at.pull()),
            form if form < 5.5 => (3.0, at.drive),
            form if form < 6.5 => (3.0, at.pull()),
            form => {
                let gives = at.drive - at.balance.damping * at.v;
                (form - 6.0, (p[2] * gives + at.pull()) / (p[2] + 1.0))
            }
        };
        let load = if load.re() < 0.0 { -load } else { load };
        grows(form, p[0] * load / f_c, f_c)
    }
}
