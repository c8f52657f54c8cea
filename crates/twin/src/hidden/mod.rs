//! What nature has and a model does not know: effects, each in a file of its own.
//!
//! An effect acts where it would in a machine: in the converter, in the amplifier, in the contact, in the
//! joint between motor and load, at the load, or in a sensor; some carry states of their own.

use crate::{Friction, Quantity, Scenario, TwinError};
use serde::{Deserialize, Serialize};

mod backlash;
mod cable_slack;
mod cogging;
mod compliance;
mod coulomb;
mod coulomb_asymmetry;
mod cubic_spring;
mod current_bias;
mod dwell_stiction;
mod foreign_acceleration;
mod foreign_deadzone;
mod foreign_detent;
mod foreign_fault;
mod foreign_heat;
mod foreign_motor_constant;
mod foreign_outward;
mod foreign_random_walk;
mod foreign_rattle;
mod foreign_relaxation;
mod foreign_sensor_hysteresis;
mod foreign_tone;
mod foreign_winding;
mod friction_drift;
mod gravity_unbalance;
mod inertia;
mod input_delay;
mod load_cell_drift;
mod load_friction;
mod maxwell_slip;
mod position_friction;
mod preload_asymmetry;
mod presliding;
mod quadratic_drag;
mod stribeck;
mod sublinear_drag;
mod tach_bias;
mod tach_gain;
mod torque_saturation;
mod velocity_lag;
mod viscous;
mod viscous_asymmetry;

/// An effect hidden in a driven plant: it acts beside everything the scenario says.
/// Each method's own text is what it does where nothing is hidden.
pub trait Hidden {
    /// A force or torque [N or N·m] added to what drives the plant, at time t, displacement q and speed v.
    fn drive(&self, _t: f64, _q: f64, _v: f64) -> f64 {
        0.0
    }
}

/// Nothing is hidden.
#[derive(Debug)]
pub(crate) struct Nothing;

impl Hidden for Nothing {}

/// The plant at an instant, as an effect sees it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Now {
    /// Time [s].
    pub(crate) t: f64,
    /// True drive T [N] or [N·m].
    pub(crate) drive: f64,
    /// Displacement of the motor's side q.
    pub(crate) q: f64,
    /// Speed of the motor's side v.
    pub(crate) v: f64,
    /// Displacement of the load; q where motor and load are one.
    pub(crate) load_q: f64,
    /// Speed of the load.
    pub(crate) load_v: f64,
    /// Force of the friction model alone, without its viscous part [N] or [N·m].
    pub(crate) friction: f64,
    /// Speed with which the contact slips, its elastic part apart.
    pub(crate) slip: f64,
    /// Coulomb level of the friction model F_C [N] or [N·m].
    pub(crate) level: f64,
    /// Slip that renews the contact.
    pub(crate) grain: f64,
    /// Inertia M [kg] or [kg·m²].
    pub(crate) inertia: f64,
}

/// The joint between motor and load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Joint {
    /// Stiffness [N/m] or [N·m/rad]; infinite if there is none to be seen.
    pub(crate) stiffness: f64,
    /// Play [m] or [rad].
    pub(crate) gap: f64,
}

/// What an effect does; each method's own text is to do nothing. `x` are its own states, 0 at the start.
pub(crate) trait Effect {
    /// What it would need and the scenario, or its own values, do not have.
    fn refuses(&self, _scenario: &Scenario) -> Option<&'static str> {
        None
    }
    /// Other parameters of the same nature.
    fn rewrite(&self, _scenario: &mut Scenario) {}
    /// A contact that works beside the declared one.
    fn beside(&self) -> Option<Friction> {
        None
    }
    /// How late the converter is [s].
    fn delay(&self) -> f64 {
        0.0
    }
    /// What the amplifier gets for a command u.
    fn input(&self, u: f64) -> f64 {
        u
    }
    /// What the motor gives where it should give `drive` for u [N] or [N·m].
    fn amplifier(&self, _u: f64, drive: f64) -> f64 {
        drive
    }
    /// Added to the friction on the motor's side [N] or [N·m].
    fn friction(&self, _now: &Now, _x: &[f64]) -> f64 {
        0.0
    }
    /// By what share the friction model is stronger.
    fn share(&self, _now: &Now, _x: &[f64]) -> f64 {
        0.0
    }
    /// By how much the level at which the contact slips is higher [N] or [N·m].
    fn rise(&self, _now: &Now, _x: &[f64]) -> f64 {
        0.0
    }
    /// Added to the friction at the load [N] or [N·m].
    fn load(&self, _now: &Now) -> f64 {
        0.0
    }
    /// Forces of the two springs where they are drawn by so much, from what they would be [N].
    fn springs(&self, _drawn: f64, forces: [f64; 2]) -> [f64; 2] {
        forces
    }
    /// How much longer the drum's lever is.
    fn lever(&self, _q: f64) -> f64 {
        1.0
    }
    /// The angle that draws the springs as far on a round drum [rad].
    fn drawn(&self, q: f64) -> f64 {
        q
    }
    /// What becomes of the joint.
    fn joint(&self, _joint: &mut Joint) {}
    /// How many states it has.
    fn states(&self) -> usize {
        0
    }
    /// Its states at the start.
    fn start(&self, _now: &Now, _x: &mut [f64]) {}
    /// Their slopes in time.
    fn rates(&self, _now: &Now, _x: &[f64], _rates: &mut [f64]) {}
    /// What a sensor is shown in place of the true value [SI].
    fn sense(&self, _quantity: Quantity, _now: &Now, _x: &[f64], value: f64) -> f64 {
        value
    }
}

macro_rules! effects {
    ($($module:ident $name:ident,)*) => {
        $(pub use $module::$name;)*

        /// An effect hidden in a scenario, with its values.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
        #[serde(tag = "name", rename_all = "snake_case")]
        pub enum HiddenEffect {
            $(#[doc = concat!("See [`", stringify!($name), "`].")] $name($name),)*
        }

        impl HiddenEffect {
            /// The names of all effects.
            pub const NAMES: &[&str] = &[$(stringify!($module)),*];

            /// Its name.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$name(_) => stringify!($module),)*
                }
            }

            /// What it does.
            pub(crate) fn effect(&self) -> &dyn Effect {
                match self {
                    $(Self::$name(effect) => effect,)*
                }
            }
        }
    };
}

effects! {
    current_bias CurrentBias,
    preload_asymmetry PreloadAsymmetry,
    viscous Viscous,
    stribeck Stribeck,
    quadratic_drag QuadraticDrag,
    sublinear_drag SublinearDrag,
    coulomb Coulomb,
    coulomb_asymmetry CoulombAsymmetry,
    viscous_asymmetry ViscousAsymmetry,
    position_friction PositionFriction,
    load_friction LoadFriction,
    friction_drift FrictionDrift,
    dwell_stiction DwellStiction,
    presliding Presliding,
    maxwell_slip MaxwellSlip,
    cogging Cogging,
    backlash Backlash,
    compliance Compliance,
    cubic_spring CubicSpring,
    cable_slack CableSlack,
    torque_saturation TorqueSaturation,
    input_delay InputDelay,
    velocity_lag VelocityLag,
    tach_gain TachGain,
    tach_bias TachBias,
    load_cell_drift LoadCellDrift,
    gravity_unbalance GravityUnbalance,
    inertia Inertia,
    foreign_detent ForeignDetent,
    foreign_acceleration ForeignAcceleration,
    foreign_rattle ForeignRattle,
    foreign_heat ForeignHeat,
    foreign_motor_constant ForeignMotorConstant,
    foreign_tone ForeignTone,
    foreign_random_walk ForeignRandomWalk,
    foreign_winding ForeignWinding,
    foreign_deadzone ForeignDeadzone,
    foreign_sensor_hysteresis ForeignSensorHysteresis,
    foreign_fault ForeignFault,
    foreign_outward ForeignOutward,
    foreign_relaxation ForeignRelaxation,
}

impl HiddenEffect {
    /// Whether it is in no library of effects.
    pub fn foreign(&self) -> bool {
        self.name().starts_with("foreign_")
    }

    /// Names and values of its parameters, in SI units.
    ///
    /// # Errors
    /// None that is known: an effect is a flat table.
    pub fn values(&self) -> Result<Vec<(String, f64)>, TwinError> {
        let table =
            toml::Table::try_from(self).map_err(|error| TwinError::Syntax(error.to_string()))?;
        let number = |value: &toml::Value| {
            value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
        };
        Ok(table.iter().filter_map(|(key, value)| Some((key.clone(), number(value)?))).collect())
    }

    /// Whether it can be hidden in this scenario.
    pub(crate) fn check(&self, scenario: &Scenario) -> Result<(), TwinError> {
        for (key, value) in self.values()? {
            // An infinite stiffness or limit is none.
            if value.is_nan() || value == f64::NEG_INFINITY {
                let key = format!("hidden.{}.{key}", self.name());
                return Err(TwinError::value(key, value, "a number"));
            }
        }
        match self.effect().refuses(scenario) {
            Some(expected) => {
                Err(TwinError::value("hidden", format!("`{}`", self.name()), expected))
            }
            None => Ok(()),
        }
    }
}

/// What is expected, unless it is there.
fn unless(there: bool, expected: &'static str) -> Option<&'static str> {
    if there { None } else { Some(expected) }
}
