//! The answer for a machine.

use super::{Run, Told, verdict};
use crate::fit::FORMAT;
use discover::{Found, Gap, Limit, MapOf, Moved, Ranked};
use identify::Hold;
use serde_json::{Map, Value, json};

/// The 97.5 % quantile of the normal distribution.
const NORMAL: f64 = 1.959_963_984_540_054;

/// The answer; what is not finite is null.
pub(super) fn as_json(told: &Told) -> Value {
    let found = &told.found;
    let [before, refit, after] = found.chi_squared;
    let mut shares = Map::new();
    for share in &found.shares {
        shares.insert(share.part.to_owned(), json!(share.share));
    }
    let mut value = json!({
        "format": FORMAT,
        "verdict": found.verdict.name(),
        "says": verdict(told),
        "complete": found.complete,
        "check": {
            "problems": told.check.problems,
            "notes": told.check.notes,
            "gravest": told.check.gravest,
        },
        "parameters": found.parameters.iter().map(parameter).collect::<Vec<_>>(),
        "effects": found.effects.iter().map(effect).collect::<Vec<_>>(),
        "input_hold": found.hold.map(Hold::name),
        "chi_squared": { "before": before, "refit": refit, "after": after },
        "gap": found.gap.iter().map(gap).collect::<Vec<_>>(),
        "where": shares,
        "map": found.map.as_ref().map(map),
        "tone": found.tone,
        "ranking": found.ranking.iter().map(ranked).collect::<Vec<_>>(),
        "detectability": found.detectability.iter().map(limit).collect::<Vec<_>>(),
    });
    for run in &told.runs {
        let (gaps, command) =
            if run.held { ("holdout", "holdout_command") } else { ("record", "command") };
        value[gaps] = json!(run.gap.iter().map(gap).collect::<Vec<_>>());
        if let Some(error) = command_error(run) {
            value[command] = error;
        }
    }
    value
}

/// The error of the simulated command [%].
fn command_error(run: &Run) -> Option<Value> {
    run.command.map(|[before, after]| json!({ "before": before, "after": after, "unit": "%" }))
}

/// Whether the record says anything of a parameter that cannot be negative: without a sign, half of it is all.
pub(super) fn identified(p: &Moved) -> bool {
    let error = p.found.standard_error;
    error.is_finite() && (p.given == 0.0 || error < 0.5 * p.found.value.abs().max(p.given.abs()))
}

/// The 95 % interval of a parameter, by its standard error.
fn interval(p: &Moved) -> [Option<f64>; 2] {
    let reach = NORMAL * p.found.standard_error;
    let known = identified(p) && reach.is_finite();
    [-reach, reach].map(|reach| known.then_some(p.found.value + reach))
}

fn parameter(p: &Moved) -> Value {
    json!({ "name": p.found.name, "given": p.given, "found": p.found.value,
            "standard_error": p.found.standard_error, "unit": p.found.unit, "moved": p.moved,
            "identified": identified(p), "interval": interval(p) })
}

fn effect(effect: &Found) -> Value {
    let values = effect.values.iter().map(|v| {
        json!({ "name": v.name, "value": v.value, "standard_error": v.standard_error,
                "unit": v.unit })
    });
    json!({ "name": effect.name, "set": effect.set, "values": values.collect::<Vec<_>>(),
            "shrink": effect.shrink, "t": effect.t, "separated_by": effect.separated_by })
}

fn gap(gap: &Gap) -> Value {
    json!({ "channel": gap.channel, "unit": gap.unit, "before": gap.before, "refit": gap.refit,
            "after": gap.after, "floor": gap.floor })
}

fn map(map: &MapOf) -> Value {
    json!({ "of": map.of.name(), "axis": map.axis, "at": map.at, "force": map.force,
            "shrink": map.shrink, "gain": map.gain })
}

fn ranked(r: &Ranked) -> Value {
    json!({ "name": r.name, "round": r.round, "shrink": r.shrink, "t": r.t,
            "plausible": r.plausible })
}

fn limit(limit: &Limit) -> Value {
    json!({ "name": limit.name, "amount": limit.amount, "unit": limit.unit,
            "hidden_by": limit.hidden_by })
}
