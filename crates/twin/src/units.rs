//! What a sensor can measure and in which units.

use crate::TwinError;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// What a sensor measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Motor current, the drum's input [A].
    Current,
    /// Motor voltage, the input of an axis or a pendulum [V].
    Voltage,
    /// Driving force of a mass or an axis, measured force of an imposed motion [N].
    Force,
    /// Imposed displacement [m].
    Displacement,
    /// Angle of a drum or a pendulum [rad].
    Angle,
    /// Position of a mass or an axis [m].
    Position,
    /// Speed [rad/s] or [m/s].
    Velocity,
    /// Force of the drum's first spring [N].
    #[serde(rename = "force_1")]
    Force1,
    /// Force of the drum's second spring [N].
    #[serde(rename = "force_2")]
    Force2,
    /// Where the controller of an axis wants it to be [m].
    Reference,
    /// What is added to the controller's command [V].
    AddedInput,
}

impl Quantity {
    /// Its name in a rig file's channels.
    pub fn name(self) -> &'static str {
        match self {
            Self::Current => "current",
            Self::Voltage => "voltage",
            Self::Force => "force",
            Self::Displacement => "displacement",
            Self::Angle => "angle",
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Force1 => "force_1",
            Self::Force2 => "force_2",
            Self::Reference => "reference",
            Self::AddedInput => "added_input",
        }
    }

    /// The units it is written in, with how many of them make one in SI; the first is the SI unit itself.
    fn units(self, rotary: bool) -> &'static [(&'static str, f64)] {
        match self {
            Self::Current => &[("A", 1.0), ("mA", 1e3)],
            Self::Voltage | Self::AddedInput => &[("V", 1.0), ("mV", 1e3)],
            Self::Force | Self::Force1 | Self::Force2 => &[("N", 1.0), ("mN", 1e3), ("kN", 1e-3)],
            Self::Displacement | Self::Position | Self::Reference => {
                &[("m", 1.0), ("mm", 1e3), ("um", 1e6)]
            }
            Self::Angle => &[("rad", 1.0), ("deg", 180.0 / PI), ("rev", 1.0 / TAU)],
            Self::Velocity if rotary => {
                &[("rad/s", 1.0), ("deg/s", 180.0 / PI), ("rpm", 60.0 / TAU)]
            }
            Self::Velocity => &[("m/s", 1.0), ("mm/s", 1e3)],
        }
    }

    /// The unit of this name and how many of them make one in SI.
    pub(crate) fn unit(
        self,
        name: Option<&str>,
        rotary: bool,
    ) -> Result<(&'static str, f64), TwinError> {
        let units = self.units(rotary);
        let Some(name) = name else { return Ok(units[0]) };
        units.iter().find(|(known, _)| *known == name).copied().ok_or_else(|| {
            let known: Vec<&str> = units.iter().map(|(known, _)| *known).collect();
            TwinError::value(
                format!("unit of {}", self.name()),
                format!("`{name}`"),
                &format!("one of {}", known.join(", ")),
            )
        })
    }
}
