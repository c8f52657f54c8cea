//! `backlash`: The load follows the motor only when a gap is used up.

use super::{About, At, Channel, Key, Law, Measure, family::is_joined, joint::{AT_MOTOR, DRAGS, ENCODER, GIVES, Joint, ZETA}};
use crate::march::Real;

/// The load follows the motor only when a gap is used up.
pub(super) struct Backlash;

/// The time in which teeth give way, of the sampling time: they are stiffer than what such a drive is sampled for.
const TEETH: [f64; 2] = [0.1, 0.25];

/// Or they are soft, and a heavy load drags and bounces on them: of three plays of three writers they gave way within 0.8 to
/// 1.5 samples, damped by 0.06 to 0.27 of the critical, under loads of 0.5 to 1 of the motor's inertia.
const SOFT: f64 = 1.0;
const HEAVY: f64 = 0.6;
const BOUNCES: f64 = 0.3;
const SLOWED: f64 = 0.1;

impl Law for Backlash {
    const ABOUT: About = About {
        name: "backlash",
        physics: "The load follows the motor only when a gap is used up.",
        equation: "load and motor, together M, touch beyond ±gap/2; the load has ratio of the motor's inertia, rubs and drags; encoder: 1 shows the load, 2 the motor, w always the motor; teeth: the time in which they give way",
        channel: Channel::Kinematics,
        keys: &[
            Key::positive("gap", Measure::Length, 0.8),
            // The load's mass, of the motor's, its own friction, and the time in which the teeth give way: one over
            // the frequency [rad/s] at which the load would ring on them.
            Key::fitted("ratio", Measure::One),
            Key::fitted("rubs", Measure::Force),
            Key::fitted("teeth", Measure::Time),
            ENCODER,
            GIVES,
            DRAGS,
            ZETA,
        ],
        probes: |c| {
            let load = [(0.05, 0.01), (0.05, 0.1), (0.25, 0.01), (0.25, 0.1)].map(|own| (own, 1.0));
            let motor = [(0.3, 0.01), (0.3, 0.1)].map(|own| (own, AT_MOTOR));
            let motor = motor.into_iter().filter(|_| c.hidden);
            let all = load.into_iter().chain(motor);
            let own = |((ratio, rubs), encoder): ((f64, f64), f64)| {
                TEETH.map(|teeth| vec![ratio, rubs * c.force, teeth * c.sample_time, encoder])
            };
            let heavy = |encoder: f64| {
                let (drags, gives) = (SLOWED * c.force / c.speed, GIVES.usual.unwrap_or(0.0));
                vec![HEAVY, 0.01 * c.force, SOFT * c.sample_time, encoder, gives, drags, BOUNCES]
            };
            let encoders: &[f64] = if c.hidden { &[1.0, AT_MOTOR] } else { &[1.0] };
            all.flat_map(own).chain(encoders.iter().map(|encoder| heavy(*encoder))).collect()
        },
        applies: is_joined,
        confused: &["compliance", "presliding"],
        separated_by: "slow reversals, with the motor's own angle recorded",
        test: 0.1,
    };
    const STATES: usize = 3;
    const JOINS: bool = true;
    // A play half as wide or twice as wide as the true one is a minimum of its own.
    const TRIED: &[f64] =
        &[3e-5, 6e-5, 1.2e-4, 2.5e-4, 5e-4, 1e-3, 2e-3, 4e-3, 8e-3, 1.6e-2, 3e-2, 6e-2, 0.12];

    fn joint<D: Real>(p: &[D], at: &At<D>) -> Option<Joint<D>> {
        // As a rule teeth do not ring: ζ = 1.
        let mass = p[1] * at.mass;
        let (stiffness, damping) = (mass / (p[3] * p[3]), mass * p[7] * 2.0 / p[3]);
        Some(Joint { mass, stiffness, damping, half: Some(p[0] * 0.5), rubs: p[2], gives: p[5], drags: p[6] })
    }
}
