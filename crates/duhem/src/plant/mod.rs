//! The plants: a linear system that friction feeds back on, equations 27 to 33 and 37 to 41 (pp. 98–102).

mod entries;
mod rig;

pub use entries::{PLANTS, PlantEntry};
pub use rig::Rig;

/// A mass on a spring with friction, driven by a force; the rig's drum is the same plant, with its
/// inertia for the mass, its angle for q and torques for forces.
///
/// It is G in feedback with a Duhem model; equations 30 and 34 to 36 are the models' own with u = q.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plant {
    /// Mass m [kg], or inertia I [kg·m²].
    pub mass: f64,
    /// Stiffness of the spring k_s [N/m] or [N·m/rad].
    pub stiffness: f64,
    /// Driving force per unit of input [N per unit of input] or [N·m per unit of input].
    pub gain: f64,
    /// Constant part of the driving force [N] or [N·m].
    pub offset: f64,
}

impl Plant {
    /// The mass-spring system, whose input is the force F_e itself.
    pub fn mass_spring(mass: f64, stiffness: f64) -> Self {
        Self { mass, stiffness, gain: 1.0, offset: 0.0 }
    }

    /// The driving force F_e [N] of an `input` [N] or [A].
    pub fn drive(&self, input: f64) -> f64 {
        self.gain * input + self.offset
    }

    /// Solved for q̈ [m/s²]; `drive` is F_e, `friction` F [N].
    ///
    /// m q̈ + k_s q = F_e − F   (28)
    pub fn acceleration(&self, q: f64, drive: f64, friction: f64) -> f64 {
        (drive - friction - self.stiffness * q) / self.mass
    }

    /// From force to displacement [m/N], at a real s [1/s].
    ///
    /// G(s) = 1/(m s² + k_s)   (29)
    pub fn transfer(&self, s: f64) -> f64 {
        1.0 / (self.mass * s * s + self.stiffness)
    }

    /// Where the plant rests [m] under a constant `drive` F_e while the friction is F [N]; equation 27
    /// for this plant. Which F that is depends on how it came there: see [`Self::holding`].
    ///
    /// v = 0   (31)
    ///
    /// q = G(0)(u − z) = (F_e − F)/k_s   (32)
    pub fn rest(&self, drive: f64, friction: f64) -> f64 {
        output_at_rest(self.transfer(0.0), drive, friction)
    }

    /// The friction F [N] that holds the plant at rest at `q` [m] under the constant `drive` F_e.
    ///
    /// *Printed* as the condition on the friction: 1 − (F/F_C) sgn v = 0. *Read as* Ḟ = 0, which v = 0
    /// grants whatever F is, *because* at v = 0 the print says 1 = 0, as sgn 0 = 0; it is the condition
    /// of steady sliding. So a rest only needs a friction force that balances the others:
    ///
    /// F = F_e − k_s q   (33)
    pub fn holding(&self, q: f64, drive: f64) -> f64 {
        drive - self.stiffness * q
    }
}

/// The output in equilibrium of a linear system of static gain G(0) under the constant input u, with
/// the output z of a Duhem model fed back; it needs y, and with it z, to be constant.
///
/// y = G(0)(u − z)   (27)
pub fn output_at_rest(static_gain: f64, u: f64, z: f64) -> f64 {
    static_gain * (u - z)
}
