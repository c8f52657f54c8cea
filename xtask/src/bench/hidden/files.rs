//! Cases as files: a record with its card, the rig file, and apart from them the truth and the key.
//!
//! `N.parquet` and `N-rig.toml` are what an analyst gets; `truth/N.toml` and `truth/N-key.toml` are for the scorer.
//! What was answered is kept in `answers/`, so that a run that was ended goes on where it was.

use super::{
    case::{Given, judged},
    row::Row,
};
use crate::{
    exit::{Exit, Failure},
    output,
    synthetic::{Places, text, write},
};
use anyhow::{Context, anyhow};
use record::{Found, Store, read_sheet, sha256, write_whole};
use serde::{Deserialize, Serialize};
use std::{fs, path::Path};
use twin::{
    Scenario,
    bench::{Case, Key, Recipe},
};

/// What only the scorer opens.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeyFile {
    seed: u64,
    /// How well each of what is hidden can be seen beside all that is free [σ].
    seen: Vec<f64>,
    recipe: Recipe,
    key: Key,
}

/// Writes the cases of these seeds, each so many seconds long.
pub(super) fn write_cases(folder: &Path, seeds: &[u64], seconds: f64) -> Result<(), Failure> {
    for seed in seeds {
        let mut case = twin::bench::case(*seed)?;
        case.scenario.duration = seconds;
        let made = twin::make(&case.scenario, *seed)?;
        let truth = folder.join("truth");
        let places = Places {
            record: folder.join(format!("{seed}.parquet")),
            card: folder.join(format!("{seed}.toml")),
            truth: truth.join(format!("{seed}.toml")),
        };
        let command = format!(
            "cargo xtask bench hidden-effects --write DIR --seeds {seed} --seconds {seconds}"
        );
        write(&places, &made, command)?;
        write_whole(&folder.join(format!("{seed}-rig.toml")), case.rig.as_bytes())?;
        let seen = case.seen()?;
        let key = KeyFile { seed: *seed, seen, recipe: case.recipe, key: case.key };
        write_whole(&truth.join(format!("{seed}-key.toml")), text(&key)?.as_bytes())?;
        output::note(&format!("wrote {}", places.record.display()));
    }
    Ok(())
}

/// The rows of the cases that stand in a folder, in the order of their seeds, of the first `most` if that is said. A
/// table that is to be `kept` can be made again from its first seed and their number.
pub(super) fn rows(folder: &Path, most: Option<usize>, kept: bool) -> Result<Vec<Row>, Failure> {
    let shown = folder.display().to_string();
    let entries = fs::read_dir(folder).with_context(|| shown.clone()).map_err(input)?;
    let paths = entries.flatten().map(|entry| entry.path());
    let records = paths.filter(|path| path.extension().is_some_and(|e| e == "parquet"));
    let mut seeds: Vec<u64> =
        records.filter_map(|path| path.file_stem()?.to_str()?.parse().ok()).collect();
    seeds.sort_unstable();
    seeds.truncate(most.unwrap_or(usize::MAX));
    if seeds.is_empty() {
        let expected =
            "expected records named by their seeds, as 17.parquet; make some with --write";
        return Err(input(anyhow!("{shown}: {expected}")));
    }
    if let Some(gap) = seeds.windows(2).find(|pair| kept && pair[1] != pair[0] + 1) {
        let (before, after) = (gap[0], gap[1]);
        let told = "a table that is kept has every seed from its first to its last";
        return Err(input(anyhow!(
            "{shown}: {before} is followed by {after}; {told}: write the others too"
        )));
    }
    let store = Store::new(folder.join("answers"));
    let mut rows = Vec::new();
    for seed in &seeds {
        rows.push(row(folder, *seed, &store)?);
        if rows.len().is_multiple_of(10) {
            output::note(&format!("{} of {} records", rows.len(), seeds.len()));
        }
    }
    Ok(rows)
}

fn row(folder: &Path, seed: u64, store: &Store) -> Result<Row, Failure> {
    let rig = read(&folder.join(format!("{seed}-rig.toml")))?;
    let path = folder.join(format!("{seed}.parquet"));
    let bytes = fs::read(&path).with_context(|| path.display().to_string()).map_err(input)?;
    let truth = folder.join(format!("truth/{seed}-key.toml"));
    let (key, truth_of) = (read(&truth)?, folder.join(format!("truth/{seed}.toml")));
    let parts = [experiment::SEARCH_SOURCES, &rig, &sha256(&bytes), &key, &read(&truth_of)?];
    let answer = record::Key::of(&parts);
    if let Found::Record(row) = store.read::<Row>(&answer)? {
        return Ok(*row);
    }
    let sheet = read_sheet(&path).with_context(|| path.display().to_string()).map_err(input)?;
    let given = Given::new(&rig, &|name| sheet.column(name).ok())?;
    let file: KeyFile =
        toml::from_str(&key).with_context(|| truth.display().to_string()).map_err(input)?;
    let scenario = scenario(&truth_of)?;
    let case = Case { seed, recipe: file.recipe, scenario, rig, key: file.key };
    let row = judged(&case, &given, file.seen)?;
    store.write(&answer, &row)?;
    Ok(row)
}

/// The scenario in a truth that stands beside a record.
fn scenario(path: &Path) -> Result<Scenario, Failure> {
    let shown = || path.display().to_string();
    let table: toml::Table = read(path)?.parse().with_context(shown).map_err(input)?;
    let scenario = table.get("scenario").ok_or_else(|| anyhow!("scenario is missing"));
    let scenario = text(scenario.with_context(shown).map_err(input)?)?;
    Scenario::parse(&scenario).with_context(shown).map_err(input)
}

fn read(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path).with_context(|| path.display().to_string()).map_err(input)
}

fn input(error: anyhow::Error) -> Failure {
    Failure { exit: Exit::Input, error }
}
