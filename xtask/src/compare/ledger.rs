//! The claims and the measures of two runs.

use crate::saved::{ClaimThen, MeasureThen};
use std::collections::BTreeMap;

/// What became of a claim or a measure.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Change {
    pub(super) id: String,
    pub(super) what: String,
}

/// Numbers that differ by less than this share are the same, whatever their errors: another processor's
/// last bits.
const ROUNDING: f64 = 1e-12;

/// Claims whose verdict, or whose number, beyond its error, changed; and those that are new or gone. None
/// if one of the runs holds no claims at all.
pub(super) fn claims(a: &[ClaimThen], b: &[ClaimThen]) -> Vec<Change> {
    both(
        a,
        b,
        |claim| &claim.id,
        |a, b| {
            if a.verdict != b.verdict {
                return Some(format!("{} → {}", a.verdict, b.verdict));
            }
            let error = a.error.unwrap_or(0.0) + b.error.unwrap_or(0.0);
            match (a.ours, b.ours) {
                (Some(a), Some(number)) => number_change(a, number, error, &b.unit),
                (None, None) => None,
                (a, b) => Some(format!("{a:?} → {b:?}")),
            }
        },
    )
}

/// Measures that changed beyond their errors, and those that are new or gone.
pub(super) fn measures(a: &[MeasureThen], b: &[MeasureThen]) -> Vec<Change> {
    let changed = |a: &MeasureThen, b: &MeasureThen| {
        number_change(a.value, b.value, a.error + b.error, &b.unit)
    };
    both(a, b, |measure| &measure.id, changed)
}

fn number_change(a: f64, b: f64, error: f64, unit: &str) -> Option<String> {
    let allowed = error + ROUNDING * a.abs().max(b.abs());
    let unit = if unit == "1" { "" } else { unit };
    ((b - a).abs() > allowed)
        .then(|| format!("{a:e} → {b:e} {unit}, beyond {allowed:.1e}").replace(" ,", ","))
}

fn both<T>(
    a: &[T],
    b: &[T],
    id: impl Fn(&T) -> &String,
    changed: impl Fn(&T, &T) -> Option<String>,
) -> Vec<Change> {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let after: BTreeMap<&String, &T> = b.iter().map(|item| (id(item), item)).collect();
    let before: BTreeMap<&String, &T> = a.iter().map(|item| (id(item), item)).collect();
    let mut changes = Vec::new();
    for (name, item) in &before {
        let what = match after.get(*name) {
            None => Some("gone".to_owned()),
            Some(after) => changed(item, after),
        };
        changes.extend(what.map(|what| Change { id: (*name).clone(), what }));
    }
    let new = after.keys().filter(|name| !before.contains_key(*name));
    changes.extend(new.map(|name| Change { id: (*name).clone(), what: "new".to_owned() }));
    changes
}
