//! The units a column may be written in.

use super::RigError;
use std::f64::consts::TAU;

/// What a quantity is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// [s]
    Time,
    /// [m]
    Length,
    /// [rad]
    Angle,
    /// [m/s]
    Velocity,
    /// [rad/s]
    AngularVelocity,
    /// [N]
    Force,
    /// [N·m]
    Torque,
    /// [A]
    Current,
    /// [V]
    Voltage,
}

/// One unit of the list.
#[derive(Debug, Clone, Copy)]
pub struct Unit {
    /// How it is written.
    pub name: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// Its size in the SI unit.
    pub size: f64,
}

const fn unit(name: &'static str, dimension: Dimension, size: f64) -> Unit {
    Unit { name, dimension, size }
}

/// The units, the SI unit of each dimension first.
pub const UNITS: &[Unit] = &[
    unit("s", Dimension::Time, 1.0),
    unit("ms", Dimension::Time, 1e-3),
    unit("us", Dimension::Time, 1e-6),
    unit("µs", Dimension::Time, 1e-6),
    unit("ns", Dimension::Time, 1e-9),
    unit("min", Dimension::Time, 60.0),
    unit("m", Dimension::Length, 1.0),
    unit("cm", Dimension::Length, 1e-2),
    unit("mm", Dimension::Length, 1e-3),
    unit("um", Dimension::Length, 1e-6),
    unit("µm", Dimension::Length, 1e-6),
    unit("nm", Dimension::Length, 1e-9),
    unit("rad", Dimension::Angle, 1.0),
    unit("mrad", Dimension::Angle, 1e-3),
    unit("deg", Dimension::Angle, TAU / 360.0),
    unit("°", Dimension::Angle, TAU / 360.0),
    unit("rev", Dimension::Angle, TAU),
    unit("m/s", Dimension::Velocity, 1.0),
    unit("cm/s", Dimension::Velocity, 1e-2),
    unit("mm/s", Dimension::Velocity, 1e-3),
    unit("um/s", Dimension::Velocity, 1e-6),
    unit("µm/s", Dimension::Velocity, 1e-6),
    unit("rad/s", Dimension::AngularVelocity, 1.0),
    unit("mrad/s", Dimension::AngularVelocity, 1e-3),
    unit("deg/s", Dimension::AngularVelocity, TAU / 360.0),
    unit("°/s", Dimension::AngularVelocity, TAU / 360.0),
    unit("rev/s", Dimension::AngularVelocity, TAU),
    unit("rpm", Dimension::AngularVelocity, TAU / 60.0),
    unit("N", Dimension::Force, 1.0),
    unit("mN", Dimension::Force, 1e-3),
    unit("kN", Dimension::Force, 1e3),
    unit("N·m", Dimension::Torque, 1.0),
    unit("Nm", Dimension::Torque, 1.0),
    unit("mNm", Dimension::Torque, 1e-3),
    unit("Nmm", Dimension::Torque, 1e-3),
    unit("A", Dimension::Current, 1.0),
    unit("mA", Dimension::Current, 1e-3),
    unit("V", Dimension::Voltage, 1.0),
    unit("mV", Dimension::Voltage, 1e-3),
];

impl Dimension {
    /// Its SI unit.
    pub fn si(self) -> &'static str {
        UNITS.iter().find(|u| u.dimension == self).map_or("", |u| u.name)
    }

    /// In a word.
    fn word(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Length => "length",
            Self::Angle => "angle",
            Self::Velocity => "velocity",
            Self::AngularVelocity => "angular velocity",
            Self::Force => "force",
            Self::Torque => "torque",
            Self::Current => "current",
            Self::Voltage => "voltage",
        }
    }
}

/// The number by which a value written in `name` becomes SI, for a quantity of one of the `dimensions`.
///
/// A minus before the unit turns the channel around: `-A` is a current that is counted the other way.
/// The letter µ may be either of the two that look alike.
/// Fails on a unit that is not known, or that measures something else; the error lists those that fit.
pub fn size_in_si(name: &str, dimensions: &[Dimension]) -> Result<f64, RigError> {
    let micro = name.replace('\u{3bc}', "\u{b5}"); // Greek mu for the micro sign
    let (sign, plain) = micro.strip_prefix('-').map_or((1.0, micro.as_str()), |rest| (-1.0, rest));
    let fits = |u: &&Unit| dimensions.contains(&u.dimension);
    if let Some(unit) = UNITS.iter().filter(fits).find(|u| u.name == plain) {
        return Ok(sign * unit.size);
    }
    let words: Vec<&str> = dimensions.iter().map(|d| d.word()).collect();
    let known: Vec<&str> = UNITS.iter().filter(fits).map(|u| u.name).collect();
    let found = match UNITS.iter().find(|u| u.name == plain) {
        Some(other) => format!("\"{name}\", a unit of {}", other.dimension.word()),
        None => super::error::quoted(name),
    };
    let expected = format!("a unit of {}: {}", words.join(" or "), known.join(", "));
    Err(RigError::Invalid { line: None, key: "unit".to_owned(), found, expected })
}
