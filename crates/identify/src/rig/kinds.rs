//! The kinds of plant a rig file may declare, their parameters and their channels.

use super::units::Dimension::{self, Angle, AngularVelocity, Current, Force, Length, Time};
use super::units::Dimension::{Velocity, Voltage};

/// One kind of plant of the list.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// Its name in the rig file.
    pub name: &'static str,
    /// Its parameters.
    pub keys: &'static [PlantKey],
    /// Its channels, time first.
    pub channels: &'static [Quantity],
    /// The channels of which exactly one is given: what drives the plant, or, where the motion is imposed,
    /// the force that it takes.
    pub drives: &'static [&'static str],
    /// The channel of its displacement q.
    pub displacement: &'static str,
    /// The channel of its velocity, of which a prescribed motion has none.
    pub velocity: Option<&'static str>,
    /// The unit of the displacement, [m] or [rad].
    pub displacement_unit: &'static str,
    /// The unit of the velocity, [m/s] or [rad/s].
    pub velocity_unit: &'static str,
    /// The unit of the friction, [N] or [N·m].
    pub force_unit: &'static str,
}

/// One parameter of a plant.
#[derive(Debug, Clone, Copy)]
pub struct PlantKey {
    /// Its key.
    pub key: &'static str,
    /// Its SI unit; empty for a pure number.
    pub unit: &'static str,
    /// Where it may lie.
    pub range: Range,
    /// Whether the file has to give it.
    pub required: bool,
}

/// Where a parameter may lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Range {
    /// From 1e-60 to 1e60.
    Positive,
    /// From 0 to 1e60.
    NotNegative,
    /// From -1e60 to 1e60.
    Any,
}

/// One channel of a plant.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Its name.
    pub name: &'static str,
    /// What it may be; the first is meant where the file says no unit.
    pub dimensions: &'static [Dimension],
    /// Whether the file has to name a column for it.
    pub required: bool,
}

impl Kind {
    /// The kind of this name.
    pub fn of(name: &str) -> Option<&'static Self> {
        KINDS.iter().find(|kind| kind.name == name)
    }

    /// Its channel of this name.
    pub fn channel(&self, name: &str) -> Option<&'static Quantity> {
        self.channels.iter().find(|quantity| quantity.name == name)
    }

    /// Whether it turns, so that forces are torques.
    pub fn turns(&self) -> bool {
        self.displacement_unit == "rad"
    }

    /// Whether it has a gear, so that angle and velocity may be the motor's.
    pub fn geared(&self) -> bool {
        self.keys.iter().any(|k| k.key == "gear_ratio")
    }

    /// The unit that takes the place of a `unit` which a friction model states for a plant that slides.
    pub fn friction_unit(&self, unit: &str) -> &'static str {
        let (slides, turns) = FRICTION_UNITS.iter().find(|(s, _)| *s == unit).unwrap_or(&("", ""));
        if self.turns() { turns } else { slides }
    }
}

impl Range {
    /// The smallest and the largest value.
    pub fn bounds(self) -> (f64, f64) {
        match self {
            Self::Positive => (1e-60, 1e60),
            Self::NotNegative => (0.0, 1e60),
            Self::Any => (-1e60, 1e60),
        }
    }

    /// In words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Positive => "a positive, finite number",
            Self::NotNegative => "a finite number, zero or more",
            Self::Any => "a finite number",
        }
    }
}

/// The units of [`duhem::MODELS`] for a plant that slides, and for one that turns.
const FRICTION_UNITS: &[(&str, &str)] = &[
    ("N", "N·m"),
    ("m", "rad"),
    ("m/s", "rad/s"),
    ("N/m", "N·m/rad"),
    ("N·s/m", "N·m·s/rad"),
    ("", ""),
];

const fn positive(key: &'static str, unit: &'static str) -> PlantKey {
    PlantKey { key, unit, range: Range::Positive, required: true }
}

const fn not_negative(key: &'static str, unit: &'static str) -> PlantKey {
    PlantKey { key, unit, range: Range::NotNegative, required: true }
}

/// The constant part of the friction; 0 if it is not said.
const fn offset(unit: &'static str) -> PlantKey {
    PlantKey { key: "offset", unit, range: Range::Any, required: false }
}

const fn needed(name: &'static str, dimensions: &'static [Dimension]) -> Quantity {
    Quantity { name, dimensions, required: true }
}

const fn extra(name: &'static str, dimensions: &'static [Dimension]) -> Quantity {
    Quantity { name, dimensions, required: false }
}

const TIME: Quantity = needed("time", &[Time]);

/// The kinds of plant.
pub const KINDS: &[Kind] = &[
    Kind {
        name: "drum",
        keys: &[
            positive("inertia", "kg·m²"),
            positive("radius", "m"),
            positive("k_1", "N/m"),
            positive("k_2", "N/m"),
            not_negative("f_10", "N"),
            not_negative("f_20", "N"),
            positive("motor_constant", "N·m/A"),
            positive("gear_ratio", ""),
            offset("N·m"),
        ],
        channels: &[
            TIME,
            needed("current", &[Current]),
            needed("angle", &[Angle]),
            extra("velocity", &[AngularVelocity]),
            extra("force_1", &[Force]),
            extra("force_2", &[Force]),
            extra("reference", &[Angle]),
            extra("added_input", &[Current]),
        ],
        drives: &["current"],
        displacement: "angle",
        velocity: Some("velocity"),
        displacement_unit: "rad",
        velocity_unit: "rad/s",
        force_unit: "N·m",
    },
    Kind {
        name: "mass-spring",
        keys: &[positive("mass", "kg"), positive("stiffness", "N/m"), offset("N")],
        channels: &[
            TIME,
            needed("force", &[Force]),
            needed("position", &[Length]),
            extra("velocity", &[Velocity]),
            extra("reference", &[Length]),
            extra("added_input", &[Force]),
        ],
        drives: &["force"],
        displacement: "position",
        velocity: Some("velocity"),
        displacement_unit: "m",
        velocity_unit: "m/s",
        force_unit: "N",
    },
    Kind {
        name: "axis",
        keys: &[
            positive("inertia", "kg"),
            PlantKey { key: "gain", unit: "N/V", range: Range::Positive, required: false },
            offset("N"),
        ],
        channels: &[
            TIME,
            extra("force", &[Force]),
            extra("voltage", &[Voltage]),
            needed("position", &[Length]),
            extra("velocity", &[Velocity]),
            extra("reference", &[Length]),
            extra("added_input", &[Voltage, Force]),
        ],
        drives: &["force", "voltage"],
        displacement: "position",
        velocity: Some("velocity"),
        displacement_unit: "m",
        velocity_unit: "m/s",
        force_unit: "N",
    },
    Kind {
        name: "pendulum",
        keys: &[
            positive("inertia", "kg·m²"),
            positive("mass", "kg"),
            positive("length", "m"),
            positive("torque_constant", "N·m/A"),
            positive("resistance", "Ω"),
            offset("N·m"),
        ],
        channels: &[
            TIME,
            needed("voltage", &[Voltage]),
            needed("angle", &[Angle]),
            extra("velocity", &[AngularVelocity]),
            extra("reference", &[Angle]),
            extra("added_input", &[Voltage]),
        ],
        drives: &["voltage"],
        displacement: "angle",
        velocity: Some("velocity"),
        displacement_unit: "rad",
        velocity_unit: "rad/s",
        force_unit: "N·m",
    },
    Kind {
        name: "prescribed",
        keys: &[offset("N")],
        channels: &[TIME, needed("displacement", &[Length]), needed("force", &[Force])],
        drives: &["force"],
        displacement: "displacement",
        velocity: None,
        displacement_unit: "m",
        velocity_unit: "m/s",
        force_unit: "N",
    },
];
