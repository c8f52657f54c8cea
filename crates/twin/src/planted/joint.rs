//! Motor and load as two masses.

use crate::{PlantKind, hidden::Joint};
use std::f64::consts::TAU;

/// The load beyond the joint.
pub(super) struct Load {
    /// Its inertia, of the whole [kg] or [kg·m²].
    pub(super) inertia: f64,
    /// Stiffness of the joint where it touches [N/m] or [N·m/rad], and its damping.
    stiffness: f64,
    damping: f64,
    gap: f64,
    /// The load's own friction: force [N] or [N·m], deflection at which it slips, damping.
    rubs: f64,
    slips: f64,
    bristle_damping: f64,
}

/// Frequency at which the load rings on a joint without spring [Hz]: far above what is sampled.
const RING: f64 = 600.0;
/// Dent from which on the teeth damp in full, as a share of the gap.
const DENT: f64 = 1e-3;
/// Damping of the joint, as a share of twice the critical one.
const DAMPED: f64 = 0.5;
/// The same where there is play.
const DAMPED_TEETH: f64 = 1.5;
/// What of the friction is the load's own, in a gap.
const OWN: f64 = 0.01;

impl Load {
    /// The load of a plant; `None` if the joint is rigid and without play.
    pub(super) fn new(plant: &PlantKind, joint: &Joint, inertia: f64, level: f64) -> Option<Self> {
        if joint.gap == 0.0 && joint.stiffness.is_infinite() {
            return None;
        }
        // A gear makes the rotor by far the larger part of a drum's inertia.
        // A drum is held by springs and a pendulum by its weight; an axis' load by its guides alone.
        let (share, ring, own) = match plant {
            PlantKind::Drum { .. } => (0.05, RING, OWN),
            PlantKind::Axis { .. } => (0.2, RING / 4.0, 10.0 * OWN),
            _ => (0.2, RING / 2.0, OWN),
        };
        let inertia = share * inertia;
        let stiffness = if joint.gap > 0.0 {
            joint.stiffness.min(inertia * (TAU * ring).powi(2))
        } else {
            joint.stiffness
        };
        let rubs = if joint.gap > 0.0 { own * level } else { 0.0 };
        let slips = if joint.gap > 0.0 { joint.gap / 50.0 } else { 1.0 };
        let damped = if joint.gap > 0.0 { DAMPED_TEETH } else { DAMPED };
        Some(Self {
            inertia,
            stiffness,
            damping: 2.0 * damped * (stiffness * inertia).sqrt(),
            gap: joint.gap,
            rubs,
            slips,
            bristle_damping: 1.4 * (rubs / slips * inertia).sqrt(),
        })
    }

    /// What the joint drives the load with, where the motor is ahead by so much and faster by so much.
    pub(super) fn joint_force(&self, ahead: f64, faster: f64) -> f64 {
        if self.gap == 0.0 {
            return self.stiffness * ahead + self.damping * faster;
        }
        let half = self.gap / 2.0;
        let pressed = ahead - ahead.clamp(-half, half);
        // The damping grows with the dent, so that no force jumps; teeth push and do not pull.
        let damping = self.damping * (pressed.abs() / (DENT * self.gap)).min(1.0);
        let force = self.stiffness * pressed + damping * faster;
        if force * pressed <= 0.0 { 0.0 } else { force }
    }

    /// The load's own friction and the slope of its bristle.
    pub(super) fn friction(&self, v: f64, z: f64) -> (f64, f64) {
        let z_dot = v - v.abs() * z / self.slips;
        (self.rubs * z / self.slips + self.bristle_damping * z_dot, z_dot)
    }
}
