//! What was found missing in the model of a recorded drive: rows and what is kept of it.

use crate::{ParameterRow, table::table};
use serde::{Deserialize, Serialize};

table! {
    /// One search for what the model of a record lacks.
    pub struct DiscoveryRow {
        /// Its name in the experiment.
        discovery: String = "discovery",
        /// Its title.
        title: String = "title",
        /// What is to be known of it, for the report.
        text: String = "text",
        /// The record, as the experiment names it.
        record: String = "record",
        /// How many samples it has.
        samples: u64 = "samples",
        /// The rig, as its file titles it.
        rig: String = "rig",
        /// The verdict.
        verdict: String = "verdict",
        /// What it names: effects in the order found, or parameters that were wrong; separated by `;`.
        names: String = "names",
        /// The verdict of the truth file; empty without one.
        truth: String = "truth",
        /// What the truth file names, separated by `;`.
        hidden: String = "hidden",
        /// Mean squared residual on blocks that were not fitted, in units of the floor, with the model as given;
        /// none where it has no motion.
        before: Option<f64> = "chi squared before [1]",
        /// The same with its own parameters refitted.
        refit: Option<f64> = "chi squared refitted [1]",
        /// The same with what was named.
        after: Option<f64> = "chi squared after [1]",
    }
}

table! {
    /// One value of one effect that was named.
    pub struct EffectRow {
        /// The search.
        discovery: String = "discovery",
        /// The effect.
        effect: String = "effect",
        /// Every name that the record cannot tell from it, itself first, separated by `;`.
        set: String = "set",
        /// What would tell them apart; empty if there is one alone.
        separated_by: String = "separated by",
        /// The share of the excess over the floor that it takes away on blocks that were not fitted.
        shrink: f64 = "taken away [1]",
        /// Student's t of that over the blocks.
        t: Option<f64> = "t [1]",
        /// The value's key.
        key: String = "key",
        /// Its unit; `1` for none.
        unit: String = "unit",
        /// The value.
        value: f64 = "value",
        /// Its standard error; none where it could not be had.
        standard_error: Option<f64> = "standard error",
        /// The truth of a synthetic record; none where truth and library have no such number in common.
        truth: Option<f64> = "truth",
    }
}

table! {
    /// The gap of one channel, on blocks that were not fitted.
    pub struct GapRow {
        /// The search.
        discovery: String = "discovery",
        /// The channel.
        channel: String = "channel",
        /// Its unit.
        unit: String = "unit",
        /// Root mean square of the residual with the model as given; none where it has no motion.
        before: Option<f64> = "before",
        /// With its own parameters refitted.
        refit: Option<f64> = "refitted",
        /// With what was named.
        after: Option<f64> = "after",
        /// What noise alone leaves.
        floor: f64 = "floor",
    }
}

table! {
    /// One candidate, refitted in full.
    pub struct RankedRow {
        /// The search.
        discovery: String = "discovery",
        /// In which round, from 1.
        round: u64 = "round",
        /// The effect.
        effect: String = "effect",
        /// The share of the excess that it would take away on blocks that were not fitted.
        shrink: f64 = "taken away [1]",
        /// Student's t of that.
        t: Option<f64> = "t [1]",
        /// Whether its values are plausible.
        plausible: bool = "plausible",
    }
}

table! {
    /// The share of the refitted model's excess in one part of the record.
    pub struct ShareRow {
        /// The search.
        discovery: String = "discovery",
        /// Which part.
        part: String = "part",
        /// Its share; none where there is no excess.
        share: Option<f64> = "share [1]",
    }
}

/// What is kept of a finished search.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DiscoveryRecord {
    /// Its row in the table.
    pub row: DiscoveryRow,
    /// The values of the effects that were named, without the truth.
    pub effects: Vec<EffectRow>,
    /// The gap of every channel.
    pub gaps: Vec<GapRow>,
    /// Every candidate that was refitted.
    pub ranking: Vec<RankedRow>,
    /// Where the excess is.
    pub shares: Vec<ShareRow>,
    /// The nominal parameters as given and as found.
    pub parameters: Vec<ParameterRow>,
    /// The names of the parameters that were wrong.
    pub moved: Vec<String>,
    /// The rig file of the model with the effects.
    pub model: String,
}
