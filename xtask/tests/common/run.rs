//! The experiments of this repository, run once into a store that all tests share.

use experiment::{Options, Plan, run, summary};
use record::{CaseRow, Store, Summary};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::{Arc, atomic::AtomicBool},
    thread,
    time::Duration,
};

/// The TOML files of this repository, sorted.
pub(crate) fn experiments() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments");
    let entries = std::fs::read_dir(folder).expect("experiments/");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    assert!(!paths.is_empty(), "no experiment");
    paths
}

/// The tables of an experiment: its cases run, or found where another test of this build left them.
pub(crate) fn tables(path: &Path) -> Summary {
    let kinds: Vec<&str> = report::FIGURES.iter().map(|kind| kind.name).collect();
    let plan = Arc::new(Plan::read(path, &kinds).expect("a right experiment"));
    let stop = AtomicBool::new(false);
    let options = Options {
        store: Store::new(Path::new(env!("CARGO_TARGET_TMPDIR")).join("records")),
        fresh: false,
        threads: thread::available_parallelism().map_or(1, usize::from),
        watchdog: Duration::from_mins(2),
        stop: &stop,
    };
    let finished = run(&plan, &options, &|_| ()).expect("all cases");
    summary(&plan, &finished).expect("the tables")
}

/// The tables of the experiment in this file.
pub(crate) fn named(file: &str) -> Summary {
    let paths = experiments();
    tables(paths.iter().find(|path| path.ends_with(file)).unwrap_or_else(|| panic!("no {file}")))
}

/// Whether a row is one of our own methods that are given the task.
pub(crate) fn ours(row: &CaseRow) -> bool {
    row.control == "none" || (row.library == "own" && row.control == "rtol")
}

/// The fewest evaluations, Jacobians included, with which each solver reaches an error at a point of a study,
/// with restart.
pub(crate) fn fewest<'a>(tables: &'a Summary, at: (&str, &str), error: f64) -> Vec<(u64, &'a str)> {
    among(tables, at, error, |row| !ours(row))
}

/// The same of our own methods that are given the task.
pub(crate) fn fewest_of_ours<'a>(
    tables: &'a Summary,
    at: (&str, &str),
    error: f64,
) -> Vec<(u64, &'a str)> {
    among(tables, at, error, ours)
}

fn among<'a>(
    tables: &'a Summary,
    (study, point): (&str, &str),
    error: f64,
    belongs: fn(&CaseRow) -> bool,
) -> Vec<(u64, &'a str)> {
    let mut found: BTreeMap<&str, u64> = BTreeMap::new();
    for row in tables.cases.iter().filter(|row| belongs(row)) {
        let names =
            (row.study.as_str(), row.point.as_str(), row.corners.as_str(), row.status.as_str());
        if names == (study, point, "restart", "solved") && row.error_max.is_some_and(|e| e <= error)
        {
            let work = row.evaluations + row.jacobians;
            let least = found.entry(&row.solver).or_insert(work);
            *least = work.min(*least);
        }
    }
    let mut found: Vec<_> = found.into_iter().map(|(solver, work)| (work, solver)).collect();
    found.sort_unstable();
    found
}
