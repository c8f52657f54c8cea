//! The list of plants, as the experiments name them.

use super::{Plant, Rig};
use crate::{ParameterError, Parameters};

/// One plant of the list.
#[derive(Debug, Clone, Copy)]
pub struct PlantEntry {
    /// Its name in the experiments.
    pub name: &'static str,
    /// The keys of its parameters.
    pub keys: &'static [&'static str],
    /// Their units, in the same order; empty for a pure number.
    pub units: &'static [&'static str],
    /// The unit of what drives it.
    pub input_unit: &'static str,
    /// The unit of its displacement.
    pub q_unit: &'static str,
    /// The unit of the friction and of the drive.
    pub force_unit: &'static str,
    /// Builds the plant from its parameters.
    pub build: fn(&Parameters) -> Result<Plant, ParameterError>,
}

const MASS_SPRING: &[&str] = &["mass", "stiffness"];

const DRUM: &[&str] =
    &["inertia", "radius", "k_1", "k_2", "f_10", "f_20", "motor_constant", "gear_ratio"];

/// The plants.
pub const PLANTS: &[PlantEntry] = &[
    PlantEntry {
        name: "mass-spring",
        keys: MASS_SPRING,
        units: &["kg", "N/m"],
        input_unit: "N",
        q_unit: "m",
        force_unit: "N",
        build: mass_spring,
    },
    PlantEntry {
        name: "drum",
        keys: DRUM,
        units: &["kg·m²", "m", "N/m", "N/m", "N", "N", "N·m/A", ""],
        input_unit: "A",
        q_unit: "rad",
        force_unit: "N·m",
        build: |parameters| Rig::new(parameters).map(|rig| rig.plant()),
    },
];

fn mass_spring(parameters: &Parameters) -> Result<Plant, ParameterError> {
    parameters.only(MASS_SPRING)?;
    Ok(Plant::mass_spring(
        parameters.positive("mass", "mass [kg]")?,
        parameters.positive("stiffness", "stiffness [N/m]")?,
    ))
}

impl Rig {
    /// The rig with these parameters.
    pub fn new(parameters: &Parameters) -> Result<Self, ParameterError> {
        parameters.only(DRUM)?;
        Ok(Self {
            inertia: parameters.positive("inertia", "inertia [kg·m²]")?,
            radius: parameters.positive("radius", "radius [m]")?,
            k_1: parameters.positive("k_1", "stiffness [N/m]")?,
            k_2: parameters.positive("k_2", "stiffness [N/m]")?,
            f_10: parameters.not_negative("f_10", "force [N]")?,
            f_20: parameters.not_negative("f_20", "force [N]")?,
            motor_constant: parameters.positive("motor_constant", "torque per current [N·m/A]")?,
            gear_ratio: parameters.positive("gear_ratio", "ratio [1]")?,
        })
    }
}
