//! The rig file: the plant, its nominal friction, what is free, and which column is which channel.
//!
//! It is TOML: `title`, `[plant]` with a `kind` of [`KINDS`] and its keys, `[friction]` with a `name` of
//! [`duhem::MODELS`] or `none` and its keys, `[fit] free`, `[channels]`, `[controller]` and `[[effect]]`.
//! What the file leaves out: `offset` is 0, Dahl's `gamma` 1, every model's `sigma_2` 0, a controller's
//! `hold` zero-order, a channel's unit SI, and its `hold` what the record tells, or else linear. Exactly one of a plant's drives is a channel, and
//! an axis has a `gain` if and only if that is a voltage. A `[controller]` needs the channel `reference`. A
//! minus before a unit turns the channel around. A `quantum` is in SI units on the side `at` which is measured.

mod error;
mod kinds;
mod parameters;
mod parse;
mod tables;
pub mod units;
mod write;

pub use error::RigError;
pub(crate) use error::quoted;
pub use kinds::{KINDS, Kind, PlantKey, Quantity, Range};

use std::collections::BTreeMap;

/// The names of the effects that an `[[effect]]` table may name.
pub use crate::effects::NAMES as EFFECTS;

/// A rig, as its file declares it, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// What it is.
    pub title: String,
    /// The kind of plant, a name of [`crate::rig::KINDS`].
    pub kind: &'static str,
    /// The plant's parameters by their keys: `offset` always, an axis' `gain` if it is driven by a voltage.
    pub plant: BTreeMap<String, f64>,
    /// Its nominal friction.
    pub friction: Friction,
    /// The names of the free parameters, as written: `f_c`, `k[2]`, `current_bias.bias`.
    pub free: Vec<String>,
    /// Which column is which channel, by the channel's name.
    pub channels: BTreeMap<String, Channel>,
    /// The controller that made the record, where it is declared.
    pub controller: Option<Controller>,
    /// What is part of the model beside plant and friction.
    pub effects: Vec<Effect>,
}

/// A friction model by its name, with its parameters and the viscous term every one of them may have.
#[derive(Debug, Clone, PartialEq)]
pub struct Friction {
    /// A name of [`duhem::MODELS`], or `none`.
    pub name: String,
    /// The model's parameters by their keys, without the viscous one of models that have none.
    pub parameters: duhem::Parameters,
    /// Viscous coefficient σ₂ [N·s/m] or [N·m·s/rad], added to the model's force; 0 for a model that has
    /// a `sigma_2` among its own parameters, so that it never counts twice.
    pub sigma_2: f64,
}

/// A column of the record.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// The column's header.
    pub column: String,
    /// The unit in which it is written; SI if none is said.
    pub unit: Option<String>,
    /// The step of an encoder or converter, in SI units and on the side `at`, where it is known.
    pub quantum: Option<f64>,
    /// On which side of the gear it is measured.
    pub at: Shaft,
    /// What an input does between its samples, where it is said.
    pub hold: Option<Hold>,
}

/// The two sides of the gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shaft {
    /// At the load: the drum.
    #[default]
    Drum,
    /// At the motor: an angle or a speed is divided by `gear_ratio`.
    Motor,
}

/// What an input does between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Hold {
    /// It goes straight from one to the next.
    #[default]
    Linear,
    /// It goes on smoothly: along the cubic through the two before and the two after.
    Smooth,
    /// It stays, and jumps at the next.
    ZeroOrder,
}

impl Hold {
    /// As a rig file has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Smooth => "smooth",
            Self::ZeroOrder => "zero-order",
        }
    }
}

/// A controller that made the record.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// Its kind: `pd`.
    pub kind: String,
    /// Position gain k_p [1/s]; [1/s] for a turning plant too.
    pub kp: f64,
    /// Velocity gain k_v [V·s/m].
    pub kv: f64,
    /// Largest command [V].
    pub limit: f64,
    /// Sampling time [s].
    pub sample_time: f64,
    /// What its command does between its samples.
    pub hold: Hold,
}

/// An effect that is part of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Its name.
    pub name: String,
    /// Its values by their keys, in SI units.
    pub values: BTreeMap<String, f64>,
}

impl Rig {
    /// The channel that drives the plant, if the rig file does not say what it does between its samples; an imposed
    /// motion goes straight on, and a controller says it of its own command.
    pub fn unsaid(&self) -> Option<&'static str> {
        let driven = self.kind != "prescribed" && self.controller.is_none();
        let kind = Kind::of(self.kind).filter(|_| driven)?;
        let unsaid = |name: &&&str| self.channels.get(**name).is_some_and(|c| c.hold.is_none());
        kind.drives.iter().find(unsaid).copied()
    }

    /// The same rig, not saying what its input does between its samples.
    #[must_use]
    pub fn asking(mut self) -> Self {
        self.channels.values_mut().for_each(|channel| channel.hold = None);
        self
    }

    /// The same rig, its input doing so between its samples where nothing else is said.
    #[must_use]
    pub fn saying(mut self, hold: Option<Hold>) -> Self {
        if let Some(channel) = self.unsaid().and_then(|name| self.channels.get_mut(name)) {
            channel.hold = hold;
        }
        self
    }

    /// Whether motor and load are two masses in it.
    pub fn two_masses(&self) -> bool {
        let joins = |effect: &Effect| {
            let kind = crate::effects::Kind::named(&effect.name).filter(|kind| kind.is_joint());
            kind.is_some_and(|kind| {
                let key = kind.about().keys[0].name;
                effect.values.get(key).is_some_and(|value| *value != 0.0)
                    || self.free.contains(&format!("{}.{key}", effect.name))
            })
        };
        self.effects.iter().any(joins)
    }
}
