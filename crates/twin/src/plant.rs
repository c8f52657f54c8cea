//! The balance of forces: all driven plants in one form.

use crate::{PlantKind, Quantity, TwinError};

/// M q̈ = G u + b − K q − W sin q − c q̇ − F, with F positive against q̇ > 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Balance {
    /// Inertia M [kg] or [kg·m²].
    pub(crate) inertia: f64,
    /// Force of one unit of the input G.
    pub(crate) gain: f64,
    /// Constant force b [N] or [N·m].
    pub(crate) constant: f64,
    /// Stiffness K [N/m] or [N·m/rad].
    pub(crate) stiffness: f64,
    /// Torque of the weight at a right angle W [N·m].
    pub(crate) weight: f64,
    /// Drag of the motor's back-EMF c [N·m·s/rad].
    pub(crate) drag: f64,
}

/// Acceleration of gravity [m/s²].
const GRAVITY: f64 = 9.81;

impl Balance {
    /// What pulls at the plant at rest [N] or [N·m], friction apart.
    pub(crate) fn pull(&self, u: f64, q: f64) -> f64 {
        self.gain * u + self.constant - self.stiffness * q - self.weight * q.sin()
    }

    /// Slope of the pull over q [N/m] or [N·m/rad].
    pub(crate) fn pull_slope(&self, q: f64) -> f64 {
        -self.stiffness - self.weight * q.cos()
    }
}

/// The plant at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Instant {
    /// Input u.
    pub(crate) u: f64,
    /// Displacement q.
    pub(crate) q: f64,
    /// Speed v.
    pub(crate) v: f64,
    /// Friction force with its offset; only told of an imposed motion.
    pub(crate) force: f64,
    /// Where a controller wants it to be.
    pub(crate) reference: f64,
    /// What is added to the controller's command.
    pub(crate) added: f64,
}

impl PlantKind {
    /// Its kind, as a rig file says it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Drum { .. } => "drum",
            Self::MassSpring { .. } => "mass-spring",
            Self::Axis { .. } => "axis",
            Self::Pendulum { .. } => "pendulum",
            Self::Prescribed { .. } => "prescribed",
        }
    }

    /// Whether its displacement is an angle.
    pub(crate) fn rotary(&self) -> bool {
        matches!(self, Self::Drum { .. } | Self::Pendulum { .. })
    }

    /// Constant part of the friction force [N] or [N·m].
    pub(crate) fn offset(&self) -> f64 {
        match *self {
            Self::Drum { offset, .. }
            | Self::MassSpring { offset, .. }
            | Self::Axis { offset, .. }
            | Self::Pendulum { offset, .. }
            | Self::Prescribed { offset } => offset,
        }
    }

    /// Its balance; `None` if the motion is imposed.
    pub(crate) fn balance(&self) -> Option<Balance> {
        let free = |inertia, gain| Balance {
            inertia,
            gain,
            constant: -self.offset(),
            stiffness: 0.0,
            weight: 0.0,
            drag: 0.0,
        };
        match *self {
            Self::Drum { inertia, radius, k_1, k_2, f_10, f_20, motor_constant, .. } => {
                let mut drum = free(inertia, motor_constant);
                drum.constant -= (f_10 - f_20) * radius;
                drum.stiffness = (k_1 + k_2) * radius * radius;
                Some(drum)
            }
            Self::MassSpring { mass, stiffness, .. } => {
                Some(Balance { stiffness, ..free(mass, 1.0) })
            }
            Self::Axis { inertia, gain, .. } => Some(free(inertia, gain)),
            Self::Pendulum { inertia, mass, length, torque_constant, resistance, .. } => {
                Some(Balance {
                    weight: mass * GRAVITY * length,
                    drag: torque_constant * torque_constant / resistance,
                    ..free(inertia, torque_constant / resistance)
                })
            }
            Self::Prescribed { .. } => None,
        }
    }

    /// What a quantity is at an instant [SI].
    pub(crate) fn read(&self, quantity: Quantity, now: &Instant) -> Result<f64, TwinError> {
        use Quantity as Q;
        Ok(match (self, quantity) {
            (Self::Drum { .. }, Q::Current)
            | (Self::Axis { .. } | Self::Pendulum { .. }, Q::Voltage)
            | (Self::MassSpring { .. }, Q::Force) => now.u,
            (Self::Axis { .. }, Q::Reference) => now.reference,
            (Self::Axis { .. }, Q::AddedInput) => now.added,
            (Self::Axis { gain, .. }, Q::Force) => gain * now.u,
            (Self::Prescribed { .. }, Q::Force) => now.force,
            (Self::Drum { .. } | Self::Pendulum { .. }, Q::Angle)
            | (Self::MassSpring { .. } | Self::Axis { .. }, Q::Position)
            | (Self::Prescribed { .. }, Q::Displacement) => now.q,
            (_, Q::Velocity) => now.v,
            (Self::Drum { radius, k_1, f_10, .. }, Q::Force1) => f_10 + k_1 * radius * now.q,
            (Self::Drum { radius, k_2, f_20, .. }, Q::Force2) => f_20 - k_2 * radius * now.q,
            _ => {
                let expected = match self {
                    Self::Drum { .. } => "current, angle, velocity, force_1 or force_2",
                    Self::MassSpring { .. } => "force, position or velocity",
                    Self::Axis { .. } => {
                        "force, voltage, position, velocity, reference or added_input"
                    }
                    Self::Pendulum { .. } => "voltage, angle or velocity",
                    Self::Prescribed { .. } => "displacement, velocity or force",
                };
                let key = format!("sensor of a {}", self.kind());
                return Err(TwinError::value(key, quantity.name(), expected));
            }
        })
    }
}
