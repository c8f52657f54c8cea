//! What can be measured: one entry for each quantity, with the two ways it is obtained.

mod dahl;
pub(crate) mod discovery;
pub(crate) mod fit;
mod input;
pub(crate) mod lugre;
pub(crate) mod maxwell_slip;
mod path;
mod plant;
mod quasi_static;
mod rig;

pub(crate) use path::{RINGING, View};

use crate::plan::{Plan, Study, Subject, angular};

/// The model of quantities and checks that are made for fits.
pub(crate) const OF_A_FIT: &str = "fit";
/// The model of those that are made for searches for what a model lacks.
pub(crate) const OF_A_DISCOVERY: &str = "discover";

/// The unit of a quantity that has the unit of the parameter which is meant.
pub(crate) const PARAMETER: &str = "parameter";
/// The unit of a quantity that has the unit of the channel which is meant.
pub(crate) const CHANNEL: &str = "channel";
/// The unit of a spring's stiffness, also of one that turns a drum.
pub(crate) const SPRING: &str = "spring";
/// Half the width of a 95 % interval, in standard errors.
pub(crate) const NORMAL: f64 = 1.959_963_984_540_054;

/// A measured value with an honest bound of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// How far the second way is from it, and no less than a few units of rounding.
    pub error: f64,
}

impl Measured {
    /// A value and its second parent.
    pub fn of(value: f64, second: f64) -> Self {
        /// The rounding of a dozen operations.
        const ROUNDING: f64 = 16.0 * f64::EPSILON;
        Self { value, error: (value - second).abs().max(ROUNDING * value.abs()) }
    }
}

/// One quantity that an experiment may ask for.
#[derive(Debug)]
pub struct Quantity {
    /// Its name in the TOML.
    pub name: &'static str,
    /// The model it is a quantity of; empty for any.
    pub model: &'static str,
    /// Its unit; `1` for none. Of a plant that turns, its angular twin: N·m for N, rad for m.
    pub unit: &'static str,
    /// What it is, in words.
    pub what: &'static str,
    /// How the value is obtained.
    pub method: &'static str,
    /// The second way, which bounds the error.
    pub second: &'static str,
    /// Where the code is.
    pub code: &'static str,
    /// The numbers it takes from the TOML, besides values of the sweep.
    pub takes: &'static [&'static str],
    /// Takes it.
    pub measure: fn(&Plan, &Subject) -> Result<Measured, String>,
}

impl Quantity {
    /// Its unit in a study.
    pub fn unit_in(&self, study: &Study) -> &'static str {
        self.unit_of(study.plant.is_some_and(|plant| plant.q_unit == "rad"))
    }

    /// Its unit where the plant turns, or slides.
    pub(crate) fn unit_of(&self, turning: bool) -> &'static str {
        if turning { angular(self.unit) } else { self.unit }
    }
}

/// All quantities; a name stands once for each model that has it.
pub const QUANTITIES: &[Quantity] = &[
    dahl::FORCE_AT_TURN,
    dahl::LOOP_AREA,
    dahl::FORCE_RISING_AT_ZERO,
    dahl::LAG,
    dahl::SATURATION_TRAVEL,
    dahl::FIRST_PERIOD_WORK,
    dahl::CONTRACTION,
    dahl::ALPHA_PLUS,
    dahl::F_MINUS_AT_ZERO,
    dahl::F_MINUS_AT_ZERO_AS_PRINTED,
    dahl::SPEED_AT_ZERO_FORCE,
    plant::Q_MAX,
    plant::Q_MIN,
    plant::V_MAX,
    plant::V_MIN,
    plant::DISPLACEMENT_DIFFERENCE,
    plant::TURN_TIME,
    plant::TURN_DISPLACEMENT,
    plant::WORK_OF_DRIVE,
    plant::SLIPS,
    plant::SLIP_ONSET_TIME,
    plant::SLIP_ONSET_DRIVE,
    plant::SLIP_RISE,
    plant::SLIP_PEAK_SPEED,
    plant::SLIP_FORCE_PEAK,
    plant::SLIP_FORCE_MIN,
    plant::SLIP_FORCE_REST,
    plant::SLIP_FORCE_DROP,
    plant::SLIP_FORCE_AMPLITUDE,
    plant::STICK_DRIVE,
    plant::FULL_SLIPS,
    plant::REST_SHARE,
    plant::FIRST_PEAK,
    quasi_static::Q_MAX,
    quasi_static::AREA,
    quasi_static::FIRST_PEAK,
    rig::STIFFNESS,
    rig::DRIVE_AMPLITUDE,
    rig::SLACK_ANGLE,
    rig::FULL_SLIP_FORCE,
    input::LARGEST_DISPLACEMENT,
    input::SMALLEST_DISPLACEMENT,
    input::LARGEST_SPEED,
    input::STATES,
    lugre::FORCE_MAX,
    lugre::FORCE_MAX_FROM_START,
    lugre::FORCE_AT_TURN,
    lugre::LOOP_AREA,
    lugre::FIRST_PERIOD_WORK,
    lugre::SLOW_LIMIT_AREA,
    lugre::SPEED_AT_MAXIMUM,
    lugre::SPEED_AT_MINIMUM,
    lugre::STEADY_MINIMUM,
    lugre::STEADY_AT_STRIBECK,
    lugre::STEADY_AT_LARGEST_SPEED,
    lugre::DISSIPATIVE_SPEED,
    lugre::RETURNING_SPEED,
    maxwell_slip::FORCE_MAX,
    maxwell_slip::FORCE_AT_TURN,
    maxwell_slip::FORCE_AT_LEFT_TURN,
    maxwell_slip::FORCE_RISING_AT_ZERO,
    maxwell_slip::LOOP_AREA,
    maxwell_slip::FIRST_PERIOD_WORK,
    maxwell_slip::LAG,
    maxwell_slip::AS_PRINTED,
    fit::FITTED,
    fit::SPRING_SLOPE,
    fit::DRIVE_BIAS,
    fit::DRIVE_HALF_SPAN,
    fit::LOOP_HEIGHT,
    fit::LOOP_MISFIT,
    fit::HELD_OUT_ERROR,
    fit::INTERVALS_WITH_TRUTH,
    discovery::VALUE,
    discovery::TAKEN_AWAY,
    discovery::LEVEL_BEFORE,
    discovery::LEVEL_REFIT,
    discovery::LEVEL_AFTER,
    discovery::GAP_AFTER,
];

#[cfg(test)]
mod tests {
    use super::Measured;

    #[test]
    fn the_error_sees_a_disagreement_and_never_vanishes() {
        assert!((Measured::of(2.0, 2.5).error - 0.5).abs() < 1e-15);
        let agreed = Measured::of(2.0, 2.0).error;
        assert!(agreed > 0.0 && agreed < 1e-14, "{agreed}");
    }
}
