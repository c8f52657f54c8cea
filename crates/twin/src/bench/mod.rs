//! Records for a benchmark, by seed: a true scenario, the rig as an analyst is told of it, and the key.
//!
//! Every parameter that the rig file declares is wrong by 2 %, so that no answer stands in it.
//! How well an effect can be seen is measured, not guessed: two records without noise, with and without it.

mod draw;
mod excite;
mod family;
mod foreign;
mod nominal;
mod seen;
mod visible;

use crate::{HiddenEffect, Scenario, TwinError};
pub use excite::Excitation;
use excite::Excitation as E;
pub use family::{Family, FrictionKind, Noise};
use nominal::Wrong;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha20Rng;
use serde::{Deserialize, Serialize};
pub use visible::Visible;

/// Length of a record [s].
pub const DURATION: f64 = 60.0;
/// Its sampling rate [Hz].
pub const RATE: f64 = 200.0;

/// What is hidden in a record.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hides {
    /// Nothing: the rig is right but for its 2 %.
    Nothing,
    /// A free parameter of the rig is wrong by 20 to 60 %.
    Parameter,
    /// Effects of these names.
    Effects(Vec<String>),
}

/// What a record is to be.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recipe {
    /// The plant and what is measured of it.
    pub family: Family,
    /// Its drive.
    pub excitation: Excitation,
    /// The noise of its sensors.
    pub noise: Noise,
    /// Its friction.
    pub friction: FrictionKind,
    /// What is hidden.
    pub hides: Hides,
    /// Its input between samples.
    #[serde(default)]
    pub input: Between,
    /// Whether what is hidden takes the uncommon form of its law, if it has two.
    #[serde(default)]
    pub other: bool,
}

/// The input between samples, and what the rig file says of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Between {
    /// Held, as the rig file says.
    #[default]
    Held,
    /// Held; the rig file says nothing.
    Unsaid,
    /// It goes on as a generator does; the rig file says nothing.
    Smooth,
}

/// A parameter that is very wrong in the rig file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WrongParameter {
    /// Its name, as the rig's free parameters say it.
    pub name: String,
    /// What it is in nature [SI].
    pub truth: f64,
    /// What the rig file says [SI].
    pub nominal: f64,
}

/// What only those who judge may read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Key {
    /// `nothing`, `parameter`, `effect` or `foreign`.
    pub verdict: String,
    /// The parameter that is very wrong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameter: Option<WrongParameter>,
    /// The effects with their values.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<HiddenEffect>,
    /// How well all of them together can be seen in each channel; for a parameter, how well its error can.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub visible: Vec<Visible>,
}

/// A record of the benchmark, before it is made.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Its seed, for [`crate::make`] too.
    pub seed: u64,
    /// What it is.
    pub recipe: Recipe,
    /// What nature does.
    pub scenario: Scenario,
    /// The rig file's text.
    pub rig: String,
    /// The key.
    pub key: Key,
}

/// The case of a seed: family, drive, noise, friction and what is hidden are drawn.
///
/// # Errors
/// A motion that cannot be followed.
pub fn case(seed: u64) -> Result<Case, TwinError> {
    case_of(&Recipe::drawn(seed), seed)
}

/// The case of a recipe; the seed draws all values.
///
/// # Errors
/// An effect that is in no list or does not suit the plant, and a motion that cannot be followed.
pub fn case_of(recipe: &Recipe, seed: u64) -> Result<Case, TwinError> {
    let mut stream = stream(seed, 1);
    let mut scenario = family::scenario(recipe, &mut stream);
    let without = scenario.clone();
    let mut key =
        Key { verdict: "nothing".to_owned(), parameter: None, effects: vec![], visible: vec![] };
    let mut wrong = None;
    match &recipe.hides {
        Hides::Nothing => {}
        Hides::Parameter => {
            "parameter".clone_into(&mut key.verdict);
            let (at, factor) = nominal::drawn(recipe.family, &without, &mut stream);
            let mut off = without.clone();
            nominal::scale(&mut off, &at, factor);
            let [right, off] = [&without, &off].map(|nature| visible::shown(nature, seed));
            key.visible = visible::visible(&right?, &off?);
            wrong = Some(Wrong { name: at, factor });
        }
        Hides::Effects(names) => {
            for name in names {
                let effect = draw::calibrated(&without, name, recipe.other, (seed, &mut stream))?;
                scenario.hidden.push(effect);
            }
            let foreign = scenario.hidden.iter().any(HiddenEffect::foreign);
            if foreign { "foreign" } else { "effect" }.clone_into(&mut key.verdict);
            key.effects.clone_from(&scenario.hidden);
            let [with, alone] = [&scenario, &without].map(|nature| visible::shown(nature, seed));
            key.visible = visible::visible(&with?, &alone?);
        }
    }
    let (rig, told) = nominal::rig(recipe, &without, wrong.as_ref(), &mut stream);
    key.parameter = wrong.and_then(|w| {
        let (truth, nominal) =
            (nominal::value(&without, &w.name)?, nominal::value(&told, &w.name)?);
        Some(WrongParameter { name: w.name, truth, nominal })
    });
    Ok(Case { seed, recipe: recipe.clone(), scenario, rig, key })
}

impl Recipe {
    /// A recipe by its seed: one record in five hides nothing, one in seven a wrong parameter, one in seven an
    /// effect that is in no library, one in ten two effects, the others one.
    pub fn drawn(seed: u64) -> Self {
        let mut stream = stream(seed, 0);
        let family = pick(Family::ALL, &mut stream);
        let excitation = pick(Excitation::ALL, &mut stream);
        let noise = pick(Noise::ALL, &mut stream);
        let friction = pick(family.frictions(), &mut stream);
        let smooth = matches!(excitation, E::Sine | E::Multisine | E::Chirp);
        // Of its own, so that what else is drawn stays what it was.
        let mut aside = self::stream(seed, 2);
        let input = match aside.random_range(0..4) {
            0 | 1 => Between::Held,
            2 if smooth && family != Family::AxisPd => Between::Smooth,
            _ => Between::Unsaid,
        };
        let other = aside.random();
        let hides = Hides::Nothing;
        let mut recipe = Self { family, excitation, noise, friction, hides, input, other };
        let chance: f64 = stream.random();
        if chance < 0.2 {
            return recipe;
        }
        if chance < 0.34 {
            recipe.hides = Hides::Parameter;
            return recipe;
        }
        let (count, foreign) = if chance < 0.48 { (1, true) } else { (1, false) };
        let count = if chance > 0.9 { 2 } else { count };
        let mut names = Vec::new();
        for _ in 0..count {
            let known = family.effects(recipe.friction, foreign);
            let left: Vec<&str> = known.into_iter().filter(|n| !names.contains(n)).collect();
            let name = pick(&left, &mut stream);
            names.push(name);
            recipe.friction = family.friction_for(name, recipe.friction);
        }
        recipe.hides = Hides::Effects(names.into_iter().map(str::to_owned).collect());
        recipe
    }
}

/// One of a list that is not empty.
fn pick<T: Copy>(list: &[T], stream: &mut ChaCha20Rng) -> T {
    list[stream.random_range(0..list.len())]
}

/// A number between two.
fn between(low: f64, high: f64, stream: &mut ChaCha20Rng) -> f64 {
    low + (high - low) * stream.random::<f64>()
}

/// A number between two positive ones, as likely to lie in each octave.
fn octaves(low: f64, high: f64, stream: &mut ChaCha20Rng) -> f64 {
    (between(low.ln(), high.ln(), stream)).exp()
}

/// 1 or −1.
fn sign(stream: &mut ChaCha20Rng) -> f64 {
    if stream.random::<bool>() { 1.0 } else { -1.0 }
}

fn stream(seed: u64, number: u64) -> ChaCha20Rng {
    let mut stream = ChaCha20Rng::seed_from_u64(seed);
    // Far from the streams of sensors and drives.
    stream.set_stream(1000 + number);
    stream
}
