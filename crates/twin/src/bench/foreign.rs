//! Values of effects that are in no library.

use super::{DURATION, draw::Sizes};
use crate::HiddenEffect;
use crate::hidden as nature;
use std::f64::consts::TAU;

/// An effect of this strength, a share of what it acts on.
pub(super) fn effect(name: &str, s: f64, sizes: &Sizes) -> Option<HiddenEffect> {
    contact(name, s, sizes).or_else(|| beside(name, s, sizes))
}

/// What is in the contact.
fn contact(name: &str, s: f64, sizes: &Sizes) -> Option<HiddenEffect> {
    use HiddenEffect as E;
    let (speed, travel, signed) = (sizes.speed, sizes.travel(), s * sizes.sign);
    Some(match name {
        "foreign_detent" => E::ForeignDetent(nature::ForeignDetent {
            ratio: 3.0 * s,
            at: sizes.low + 2.0 * travel * (0.3 + 0.4 * sizes.shape[0]),
            width: travel * sizes.from(1, 0.03, 0.15),
        }),
        "foreign_acceleration" => E::ForeignAcceleration(nature::ForeignAcceleration {
            ratio: signed,
            half: speed * sizes.from(0, 5.0, 15.0),
            // A shorter lag would make the friction and the acceleration chase each other.
            tau: 0.1,
        }),
        // At the mean power the heat settles at 1.
        "foreign_heat" => {
            let tau = sizes.from(0, 3.0, 15.0);
            let energy = sizes.level * speed * tau;
            E::ForeignHeat(nature::ForeignHeat { ratio: signed, energy, tau })
        }
        "foreign_random_walk" => E::ForeignRandomWalk(nature::ForeignRandomWalk {
            amount: s,
            over: DURATION,
            seed: whole(sizes.shape[0] * 1e9),
        }),
        "foreign_fault" => {
            let from = DURATION * (0.15 + 0.5 * sizes.shape[0]);
            let to = from + DURATION * (0.05 + 0.1 * sizes.shape[1]);
            E::ForeignFault(nature::ForeignFault { ratio: 2.0 * s, from, to })
        }
        "foreign_outward" => E::ForeignOutward(nature::ForeignOutward {
            ratio: signed,
            home: f64::midpoint(sizes.low, sizes.high),
            near: 0.05 * travel,
            slow: 0.05 * speed,
        }),
        "foreign_relaxation" => {
            let tau = sizes.from(0, 0.1, 1.0);
            E::ForeignRelaxation(nature::ForeignRelaxation {
                k: s * sizes.level / (speed * tau),
                tau,
            })
        }
        _ => return None,
    })
}

/// What is beside the contact.
fn beside(name: &str, s: f64, sizes: &Sizes) -> Option<HiddenEffect> {
    use HiddenEffect as E;
    let travel = sizes.travel();
    Some(match name {
        "foreign_rattle" => E::ForeignRattle(nature::ForeignRattle {
            mass: 2.0 * s,
            room: travel * sizes.from(0, 0.05, 0.3),
            frequency: 30.0,
        }),
        // What gives less is the library's saturation by another formula.
        "foreign_motor_constant" => {
            E::ForeignMotorConstant(nature::ForeignMotorConstant { ratio: s, u_0: sizes.peak })
        }
        "foreign_tone" => E::ForeignTone(nature::ForeignTone {
            force: s * sizes.level,
            omega: sizes.from(0, 3.0, 40.0),
            phase: TAU * sizes.shape[1],
        }),
        "foreign_winding" => {
            E::ForeignWinding(nature::ForeignWinding { ratio: s * sizes.sign / travel.max(1.0) })
        }
        "foreign_deadzone" => {
            E::ForeignDeadzone(nature::ForeignDeadzone { zone: 0.5 * s * sizes.peak })
        }
        "foreign_sensor_hysteresis" => {
            E::ForeignSensorHysteresis(nature::ForeignSensorHysteresis { width: 0.1 * s * travel })
        }
        _ => return None,
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a number between 0 and 1e9"
)]
fn whole(value: f64) -> u32 {
    value as u32
}
