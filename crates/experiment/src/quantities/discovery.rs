//! Quantities of a search for what a model lacks.

use super::{CHANNEL, Measured, NORMAL, OF_A_DISCOVERY, PARAMETER, Quantity};
use crate::plan::{Discovery, Plan, Subject};
use record::{DiscoveryRecord, EffectRow, GapRow};

macro_rules! quantity {
    ($const:ident, $name:literal, $unit:expr, $what:literal, ($method:literal, $second:literal), $measure:expr) => {
        pub(super) const $const: Quantity = Quantity {
            name: $name,
            model: OF_A_DISCOVERY,
            unit: $unit,
            what: $what,
            method: $method,
            second: $second,
            code: concat!("crates/experiment/src/quantities/discovery.rs, ", stringify!($const)),
            takes: &[],
            measure: $measure,
        };
    };
}

quantity!(
    VALUE,
    "effect_value",
    PARAMETER,
    "value of the effect that was named",
    ("the search by simulated motions", "what was hidden in the record, and its 95 % interval"),
    |plan, subject| {
        let row = value(at(plan, subject), &subject.expect)?;
        let truth = row.truth.ok_or_else(|| format!("no truth of {}", subject.expect))?;
        let mut found = Measured::of(row.value, truth);
        found.error = found.error.max(NORMAL * row.standard_error.ok_or("no standard error")?);
        Ok(found)
    }
);

quantity!(
    TAKEN_AWAY,
    "taken_away",
    "1",
    "share of the excess over the floor that the effect takes away",
    ("mean over the blocks that were not fitted", "their scatter, as a 95 % interval"),
    |plan, subject| {
        let rows = &at(plan, subject).found()?.effects;
        let row = rows.iter().find(|row| row.effect == subject.expect);
        let row = row.ok_or_else(|| unnamed(rows, &subject.expect))?;
        let t = row.t.ok_or("no t")?;
        Ok(Measured::of(row.shrink, row.shrink * (1.0 - NORMAL / t)))
    }
);

quantity!(
    LEVEL_BEFORE,
    "level_before",
    "1",
    "residual of the model as given, in units of the floor",
    (
        "root of the mean square over samples and channels",
        "the same of the channels' own gaps and floors"
    ),
    |plan, subject| level(at(plan, subject), |r| r.row.before, |g| g.before)
);

quantity!(
    LEVEL_REFIT,
    "level_refit",
    "1",
    "residual of the model with its own parameters refitted, in units of the floor",
    (
        "root of the mean square over samples and channels",
        "the same of the channels' own gaps and floors"
    ),
    |plan, subject| level(at(plan, subject), |r| r.row.refit, |g| g.refit)
);

quantity!(
    LEVEL_AFTER,
    "level_after",
    "1",
    "residual of the model with what was named, in units of the floor",
    (
        "root of the mean square over samples and channels",
        "the same of the channels' own gaps and floors"
    ),
    |plan, subject| level(at(plan, subject), |r| r.row.after, |g| g.after)
);

quantity!(
    GAP_AFTER,
    "gap_after",
    CHANNEL,
    "residual of a channel with what was named",
    ("root mean square over the blocks that were not fitted", "what noise alone leaves"),
    |plan, subject| {
        let rows = &at(plan, subject).found()?.gaps;
        let row = rows.iter().find(|row| row.channel == subject.expect).ok_or_else(|| {
            let known: Vec<&str> = rows.iter().map(|row| row.channel.as_str()).collect();
            format!("found `{}`: expected one of {}", subject.expect, known.join(", "))
        })?;
        Ok(Measured::of(row.after.ok_or("no motion")?, row.floor))
    }
);

/// How well a floor is known: the noise is estimated from the record, and the search ends near a minimum.
const FLOOR: f64 = 0.02;

/// The search that is meant.
pub(crate) fn at<'a>(plan: &'a Plan, subject: &Subject) -> &'a Discovery {
    &plan.discoveries[subject.study]
}

/// A value of an effect, named as `current_bias.bias`.
fn value<'a>(search: &'a Discovery, name: &str) -> Result<&'a EffectRow, String> {
    let rows = &search.found()?.effects;
    let meant = |row: &&EffectRow| format!("{}.{}", row.effect, row.key) == name;
    rows.iter().find(meant).ok_or_else(|| unnamed(rows, name))
}

fn unnamed(rows: &[EffectRow], name: &str) -> String {
    let known: Vec<String> = rows.iter().map(|row| format!("{}.{}", row.effect, row.key)).collect();
    let known = if known.is_empty() { "none was named".to_owned() } else { known.join(", ") };
    format!("found `{name}`: expected one of what was named: {known}")
}

/// The root of the mean squared residual in units of the floor, and the same from the gaps of the channels.
fn level(
    search: &Discovery,
    whole: fn(&DiscoveryRecord) -> Option<f64>,
    of: fn(&GapRow) -> Option<f64>,
) -> Result<Measured, String> {
    let record = search.found()?;
    let squared = whole(record).ok_or("the model has no motion on this record")?;
    let ratios: Option<Vec<f64>> =
        record.gaps.iter().map(|gap| Some((of(gap)? / gap.floor).powi(2))).collect();
    let ratios = ratios.ok_or("a channel without a gap")?;
    let second = ratios.iter().sum::<f64>() / ratios.len() as f64;
    let mut found = Measured::of(squared.max(0.0).sqrt(), second.sqrt());
    found.error = found.error.max(FLOOR * found.value);
    Ok(found)
}
