//! The answer.

use crate::{
    gram::Gram,
    maps::Of,
    screen::{self, Visible},
};
use identify::{Hold, Rig, effects::Kind};

/// The longest of the benchmark's right answers that were looked at took 26 000; where nothing in the library comes near, or
/// friction sticks all the time, a search had not ended after a quarter of an hour.
const SIMULATIONS: u64 = 30_000;

/// What is asked for.
#[derive(Debug, Clone)]
pub struct Options {
    /// The seed of the floor's perturbations.
    pub seed: u64,
    /// How many effects are looked for, one after the other.
    pub most: usize,
    /// How many effects of the screen are refitted in full.
    pub short_list: usize,
    /// How often the record may be simulated before no more is looked for, derivatives counted for what they take.
    pub simulations: u64,
    /// Who is told how far the search has come, line by line; it may take minutes.
    pub told: Option<fn(&str)>,
}

impl Options {
    /// The same, but for so many simulations that were done already.
    pub(crate) fn after(&self, simulated: u64) -> Self {
        Self { simulations: self.simulations.saturating_sub(simulated), ..self.clone() }
    }

    /// Tells how far the search has come, where somebody listens.
    pub(crate) fn tell(&self, what: impl FnOnce() -> String) {
        if let Some(told) = self.told {
            told(&what());
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self { seed: 1, most: 3, short_list: 5, simulations: SIMULATIONS, told: None }
    }
}

/// The six honest verdicts; one of a set is an effect whose set is longer than one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing is missing at this noise.
    NothingMissing,
    /// A parameter was wrong.
    Parameter,
    /// Effects are missing, and with them nothing more is.
    Effect,
    /// Effects are missing, and something more.
    Partial,
    /// Something is missing that is not in the library.
    NotInLibrary,
}

impl Verdict {
    /// As the answer has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::NothingMissing => "nothing_missing",
            Self::Parameter => "parameter",
            Self::Effect => "effect",
            Self::Partial => "partial",
            Self::NotInLibrary => "not_in_library",
        }
    }
}

/// A value with its standard error.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// Its key.
    pub name: String,
    /// The value [its unit].
    pub value: f64,
    /// Standard error [its unit]; not a number where it could not be had.
    pub standard_error: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// A nominal parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// As given [its unit].
    pub given: f64,
    /// As found.
    pub found: Value,
    /// Whether it was wrong by more than nominal values are.
    pub moved: bool,
}

/// A named effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Its name.
    pub name: &'static str,
    /// Every name that this record cannot tell from it, itself first.
    pub set: Vec<&'static str>,
    /// Its values.
    pub values: Vec<Value>,
    /// How much of the excess over the floor it takes away on the judging blocks [1].
    pub shrink: f64,
    /// Student's t of that over the blocks.
    pub t: f64,
    /// What would tell the names of the set apart; empty if there is one alone.
    pub separated_by: String,
}

/// The misfit of a channel on the judging blocks, root mean square, after what the noise of the input may move was
/// weighed down: see [`Whitening`](identify::fit::whitening::Whitening).
#[derive(Debug, Clone, PartialEq)]
pub struct Gap {
    /// The channel.
    pub channel: String,
    /// Its unit.
    pub unit: &'static str,
    /// With the nominal model as given [its unit].
    pub before: f64,
    /// With its own parameters refitted.
    pub refit: f64,
    /// With the effects.
    pub after: f64,
    /// What noise alone leaves.
    pub floor: f64,
}

/// An effect as it was ranked.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranked {
    /// Its name.
    pub name: &'static str,
    /// How much of the excess it would take away on the judging blocks [1].
    pub shrink: f64,
    /// Student's t of that.
    pub t: f64,
    /// Whether its values are plausible.
    pub plausible: bool,
    /// In which round.
    pub round: usize,
}

/// The smallest amount of an effect that this record would have shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// The effect.
    pub name: &'static str,
    /// The amount at five standard errors.
    pub amount: f64,
    /// Its unit.
    pub unit: &'static str,
    /// The free parameter that would have taken it up.
    pub hidden_by: Option<String>,
}

/// The share of the excess in one part of the record.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// Which part.
    pub part: &'static str,
    /// Its share [1].
    pub share: f64,
}

/// A map of what has no name.
#[derive(Debug, Clone, PartialEq)]
pub struct MapOf {
    /// What the force is: one beside the friction, or more friction.
    pub of: Of,
    /// Over what.
    pub axis: &'static str,
    /// Places [the axis' unit].
    pub at: Vec<f64>,
    /// The force there [N].
    pub force: Vec<f64>,
    /// How much of the excess it takes away [1].
    pub shrink: f64,
    /// By how much it lowers the sum of squares that it is fitted to, in units of the floor [1]; by chance as much as it
    /// has places.
    pub gain: f64,
}

/// The whole answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Discovery {
    /// The verdict.
    pub verdict: Verdict,
    /// The nominal parameters.
    pub parameters: Vec<Moved>,
    /// The effects in the order in which they were found.
    pub effects: Vec<Found>,
    /// The channels.
    pub gap: Vec<Gap>,
    /// Where the excess of the refitted nominal model is.
    pub shares: Vec<Share>,
    /// The best map, where the library did not explain all.
    pub map: Option<MapOf>,
    /// The frequency of a tone in what is left, which the motion does not have [Hz].
    pub tone: Option<f64>,
    /// Every effect that was refitted.
    pub ranking: Vec<Ranked>,
    /// What this record would have shown.
    pub detectability: Vec<Limit>,
    /// Mean squared residual on the judging blocks, in units of the floor: before, refitted, after [1].
    pub chi_squared: [f64; 3],
    /// What the input does between its samples, where the record tells it and not the rig file.
    pub hold: Option<Hold>,
    /// Whether all was looked for; not if that took more simulations than were asked for.
    pub complete: bool,
    /// The rig with the effects.
    pub rig: Rig,
}

/// How much of each effect the record would have shown.
pub(crate) fn limits(start: &Gram, rig: &Rig) -> Vec<Limit> {
    let one = |v: Visible| Limit {
        name: name(v.kind),
        amount: v.amount,
        unit: v.kind.about().unit(v.kind.about().keys[0].name, rig),
        hidden_by: v.hidden_by,
    };
    screen::detectability(start).into_iter().map(one).collect()
}

/// The name of an effect.
pub(crate) fn name(kind: Kind) -> &'static str {
    kind.about().name
}
