//! The rows of two runs: status, error and counts of work, exactly.

use crate::saved::Saved;
use simulation::anchors::{Row, SOLVED};
use std::collections::{BTreeMap, BTreeSet};

/// An error that changes by less than this factor is not told.
const SAME_ERROR: f64 = 1.05;

/// What changed in a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RowChange {
    pub(super) key: String,
    /// What changed, in words.
    pub(super) what: Vec<String>,
    /// Whether there is more work, or a right answer is lost.
    pub(super) worse: bool,
    /// Evaluations of right-hand side and Jacobian, before and after.
    pub(super) work: [u64; 2],
    /// The errors.
    pub(super) error: [Option<f64>; 2],
}

/// The rows that stand in both runs, in the order of the first.
pub(super) fn pairs<'a>(a: &'a Saved, b: &'a Saved) -> Vec<(String, &'a Row, &'a Row)> {
    let after: BTreeMap<String, &Row> = b.rows.iter().map(|row| (row.key(), row)).collect();
    let pair = |row: &'a Row| {
        let key = row.key();
        after.get(&key).map(|after| (key.clone(), row, *after))
    };
    a.rows.iter().filter_map(pair).collect()
}

/// The rows of `a` that `b` does not have.
pub(super) fn missing(a: &Saved, b: &Saved) -> Vec<String> {
    let there: BTreeSet<String> = b.rows.iter().map(Row::key).collect();
    a.rows.iter().map(Row::key).filter(|key| !there.contains(key)).collect()
}

/// What changed between two rows of one key, if anything did.
pub(super) fn change(key: &str, a: &Row, b: &Row) -> Option<RowChange> {
    let mut what = Vec::new();
    let mut worse = false;
    if a.status != b.status {
        worse |= a.status == SOLVED;
        what.push(format!("{} → {}", a.status, b.status));
    }
    if a.right() && !b.right() && b.status == SOLVED {
        worse = true;
        what.push("no longer right".to_owned());
    }
    if let Some(change) = error(a.error, b.error) {
        what.push(change);
    }
    // Two that failed stopped somewhere; how far each got is no measure of work.
    if a.status == SOLVED && b.status == SOLVED {
        for (name, a, b) in counts(a, b) {
            if a != b {
                worse |= b > a;
                what.push(format!("{name} {a} → {b}{}", share(a, b)));
            }
        }
    }
    let work = [a, b].map(|row| row.evaluations + row.jacobians);
    let error = [a.error, b.error];
    (!what.is_empty()).then(|| RowChange { key: key.to_owned(), what, worse, work, error })
}

fn counts(a: &Row, b: &Row) -> [(&'static str, u64, u64); 3] {
    let steps = |row: &Row| row.accepted + row.rejected.unwrap_or(0);
    [
        ("evaluations", a.evaluations, b.evaluations),
        ("Jacobians", a.jacobians, b.jacobians),
        ("steps", steps(a), steps(b)),
    ]
}

fn share(a: u64, b: u64) -> String {
    if a == 0 { String::new() } else { format!(" ({:+.1} %)", 100.0 * (b as f64 / a as f64 - 1.0)) }
}

fn error(a: Option<f64>, b: Option<f64>) -> Option<String> {
    let (a, b) = (a?, b?);
    let factor = if a > b { a / b } else { b / a };
    // Both zero is no change, and one of them a large one.
    (a != b && factor > SAME_ERROR).then(|| format!("error {a:.2e} → {b:.2e}"))
}
