//! `cargo xtask compare`: two saved runs of the benchmark, before and after a change.

mod ledger;
mod rows;
mod times;
mod words;

use crate::{
    cli::CompareArgs,
    exit::{Exit, Failure},
    output,
    saved::{self, Saved},
};
use std::path::Path;

/// What two runs differ in.
#[derive(Debug)]
struct Comparison<'a> {
    a: &'a Saved,
    b: &'a Saved,
    /// Why counts may differ without anybody's fault; empty if they may not.
    apart: Vec<String>,
    rows: Vec<rows::RowChange>,
    /// Rows that stand in both.
    shared: usize,
    /// Rows of one only: of the first, of the second.
    alone: [Vec<String>; 2],
    times: Option<Vec<times::TimeChange>>,
    claims: Vec<ledger::Change>,
    measures: Vec<ledger::Change>,
}

impl Comparison<'_> {
    /// The rows that became worse.
    fn regressions(&self) -> impl Iterator<Item = &rows::RowChange> {
        self.rows.iter().filter(|change| change.worse)
    }

    /// Those that are slower beyond doubt.
    fn slower(&self) -> usize {
        self.times.iter().flatten().filter(|change| change.slower()).count()
    }

    fn exit(&self) -> Exit {
        let worse = self.regressions().count() + self.slower();
        if worse > 0 && self.apart.is_empty() { Exit::Regression } else { Exit::Done }
    }
}

/// Compares two runs, prints what differs, and ends with 3 if the second is worse.
pub(crate) fn compare(root: &Path, arguments: &CompareArgs) -> Result<Exit, Failure> {
    let (a, b) = (saved::read(root, &arguments.a)?, saved::read(root, &arguments.b)?);
    let comparison = of(&a, &b, arguments.times);
    if arguments.json {
        output::line(&format!("{:#}", words::json(&comparison)));
    } else if arguments.markdown {
        let names = (arguments.a.as_str(), arguments.b.as_str());
        output::line(words::markdown(&comparison, names).trim_end());
    } else {
        output::line(words::text(&comparison).trim_end());
    }
    Ok(comparison.exit())
}

fn of<'a>(a: &'a Saved, b: &'a Saved, with_times: bool) -> Comparison<'a> {
    let pairs = rows::pairs(a, b);
    Comparison {
        a,
        b,
        apart: apart(a, b),
        rows: pairs.iter().filter_map(|(key, a, b)| rows::change(key, a, b)).collect(),
        shared: pairs.len(),
        alone: [rows::missing(a, b), rows::missing(b, a)],
        times: with_times
            .then(|| pairs.iter().filter_map(|(_, a, b)| times::change(a, b)).collect()),
        claims: ledger::claims(&a.claims, &b.claims),
        measures: ledger::measures(&a.measures, &b.measures),
    }
}

/// In what the runs differ that moves last bits, and with them counts, or limits.
fn apart(a: &Saved, b: &Saved) -> Vec<String> {
    let (m, n) = (&a.machine, &b.machine);
    let told = |differ: bool, what: &str, a: &str, b: &str| {
        differ.then(|| format!("{what}: {a}, then {b}"))
    };
    let features = [m, n].map(|machine| machine.target_features.join(" "));
    let quick = [a, b].map(|run| if run.quick { "a quick look" } else { "a whole run" });
    let found = [
        told(m.processor != n.processor, "processor", &m.processor, &n.processor),
        told(features[0] != features[1], "features used", &features[0], &features[1]),
        told(quick[0] != quick[1], "extent", quick[0], quick[1]),
    ];
    found.into_iter().flatten().collect()
}
