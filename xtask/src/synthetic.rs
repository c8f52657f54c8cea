//! `record`: a synthetic record of a rig, its card, and its truth kept apart.

use crate::{
    cli::RecordArgs,
    exit::{Exit, Failure},
    output,
};
use anyhow::{Context, anyhow};
use serde::Serialize;
use serde_json::json;
use std::{
    fs,
    path::{Path, PathBuf},
};
use twin::{Column, Made, SCENARIOS, Scenario, Truth};

/// The version of cards and truths.
const FORMAT: u32 = 1;
/// What a card of such a record calls itself.
const KIND: &str = "synthetic";
/// The longest scenario that is read [bytes].
const LONGEST: u64 = 1 << 20;

/// What stands beside a record for everyone to read.
#[derive(Debug, Serialize)]
struct Card<'a> {
    format: u32,
    kind: &'a str,
    title: &'a str,
    #[serde(skip_serializing_if = "str::is_empty")]
    text: &'a str,
    made: String,
    seed: u64,
    record: String,
    truth: String,
    rows: usize,
    duration: f64,
    rate: f64,
    #[serde(rename = "column")]
    columns: &'a [Column],
}

/// What only those who judge may read.
#[derive(Debug, Serialize)]
struct TruthFile<'a> {
    format: u32,
    kind: &'a str,
    #[serde(flatten)]
    truth: &'a Truth,
}

/// The files of one record.
pub(crate) struct Places {
    pub(crate) record: PathBuf,
    pub(crate) card: PathBuf,
    pub(crate) truth: PathBuf,
}

/// Makes a record, or lists the scenarios that have a name.
pub(crate) fn record(root: &Path, arguments: &RecordArgs) -> Result<Exit, Failure> {
    if arguments.list {
        return list(arguments.json);
    }
    let Some(out) = &arguments.out else {
        return Err(Failure::usage("say where the record goes with --out FILE"));
    };
    let places = places(out, arguments)?;
    let scenario = scenario(arguments)?;
    let made = twin::make(&scenario, arguments.seed)?;
    let command = command(root, &places, arguments);
    write(&places, &made, command)?;
    tell(&places, &made, arguments.json);
    Ok(Exit::Done)
}

fn list(as_json: bool) -> Result<Exit, Failure> {
    let mut rows = Vec::new();
    for (name, _) in SCENARIOS {
        rows.push((*name, twin::scenario(name)?));
    }
    if as_json {
        let rows: Vec<_> = rows
            .iter()
            .map(|(name, s)| {
                json!({ "name": name, "plant": s.plant.kind(), "title": s.title,
                        "duration": s.duration, "rate": s.rate })
            })
            .collect();
        output::line(&format!("{:#}", json!({ "format": FORMAT, "scenarios": rows })));
    } else {
        for (name, scenario) in rows {
            output::line(&format!("{name:12} {}", scenario.title));
        }
    }
    Ok(Exit::Done)
}

/// The scenario asked for, by its name or in its file.
fn scenario(arguments: &RecordArgs) -> Result<Scenario, Failure> {
    match (&arguments.name, &arguments.scenario) {
        (Some(name), None) => Ok(twin::scenario(name)?),
        (None, Some(path)) => {
            let shown = path.display().to_string();
            let input = |error: anyhow::Error| Failure { exit: Exit::Input, error };
            let about = fs::metadata(path).with_context(|| shown.clone()).map_err(input)?;
            if !about.is_file() || about.len() > LONGEST {
                let expected = "expected a scenario: a file of at most 1 MiB";
                return Err(input(anyhow!("{shown}: {expected}")));
            }
            let text = fs::read_to_string(path).with_context(|| shown.clone()).map_err(input)?;
            Scenario::parse(&text).with_context(|| shown).map_err(input)
        }
        _ => {
            let known: Vec<&str> = SCENARIOS.iter().map(|(name, _)| *name).collect();
            Err(Failure::usage(format!(
                "say which scenario: {}, or a file with --scenario FILE",
                known.join(", ")
            )))
        }
    }
}

/// Where record, card and truth go; never onto a file that is something else.
fn places(out: &Path, arguments: &RecordArgs) -> Result<Places, Failure> {
    let known = out.extension().is_some_and(|e| e == "parquet" || e == "csv");
    let (Some(stem), true) = (out.file_stem(), known) else {
        let message =
            format!("--out {}: expected a name that ends in .parquet or .csv", out.display());
        return Err(Failure::usage(message));
    };
    let card = out.with_extension("toml");
    let truth = arguments.truth.clone().unwrap_or_else(|| {
        out.with_file_name("truth").join(Path::new(stem).with_extension("toml"))
    });
    for path in [&card, &truth] {
        if path.exists() && !ours(path) {
            let message = format!(
                "{} is there already and tells of no synthetic record; choose another name",
                path.display()
            );
            return Err(Failure::usage(message));
        }
    }
    if out.exists() && !ours(&card) {
        let message =
            format!("{} is there already without a card; choose another name", out.display());
        return Err(Failure::usage(message));
    }
    if card == truth {
        return Err(Failure::usage(
            "the truth is kept apart from the card; choose another --truth",
        ));
    }
    Ok(Places { record: out.to_path_buf(), card, truth })
}

/// Whether a file is a card or a truth written by this command.
fn ours(path: &Path) -> bool {
    let text = fs::read_to_string(path).unwrap_or_default();
    let table: toml::Table = toml::from_str(&text).unwrap_or_default();
    table.get("kind").and_then(toml::Value::as_str) == Some(KIND)
}

/// The command that makes this record again, without the folders of one machine.
fn command(root: &Path, places: &Places, arguments: &RecordArgs) -> String {
    let within = |path: &Path| {
        let whole = std::path::absolute(path).unwrap_or_default();
        let root = std::path::absolute(root).unwrap_or_default();
        match whole.strip_prefix(root) {
            Ok(inside) => inside.display().to_string(),
            Err(_) => file_name(path),
        }
    };
    let what = match (&arguments.name, &arguments.scenario) {
        (None, Some(path)) => format!("--scenario {}", within(path)),
        (name, _) => name.clone().unwrap_or_default(),
    };
    let out = within(&places.record);
    let truth = arguments.truth.as_ref().map(|path| format!(" --truth {}", within(path)));
    let (truth, seed) = (truth.unwrap_or_default(), arguments.seed);
    format!("cargo xtask record {what} --out {out}{truth} --seed {seed}")
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Writes a record, its card, and its truth.
pub(crate) fn write(places: &Places, made: &Made, command: String) -> Result<(), Failure> {
    let columns: Vec<(&str, &[f64])> =
        made.columns.iter().map(|(name, values)| (name.as_str(), values.as_slice())).collect();
    let folder = places.record.parent().unwrap_or(Path::new(""));
    let truth = places.truth.strip_prefix(folder).unwrap_or(&places.truth);
    let scenario = &made.truth.scenario;
    let card = Card {
        format: FORMAT,
        kind: KIND,
        title: &scenario.title,
        text: &scenario.text,
        made: command,
        seed: made.truth.seed,
        record: file_name(&places.record),
        truth: if truth.is_absolute() { file_name(truth) } else { truth.display().to_string() },
        rows: scenario.samples(),
        duration: scenario.duration,
        rate: scenario.rate,
        columns: &made.about,
    };
    let truth = TruthFile { format: FORMAT, kind: KIND, truth: &made.truth };
    if places.record.extension().is_some_and(|e| e == "csv") {
        record::write_sheet_csv(&places.record, &columns)?;
    } else {
        record::write_sheet_parquet(&places.record, &columns)?;
    }
    record::write_whole(&places.truth, text(&truth)?.as_bytes())?;
    record::write_whole(&places.card, text(&card)?.as_bytes())?;
    Ok(())
}

/// A value as TOML.
pub(crate) fn text(value: &impl Serialize) -> Result<String, Failure> {
    toml::to_string_pretty(value).map_err(|e| Failure { exit: Exit::Bug, error: e.into() })
}

fn tell(places: &Places, made: &Made, as_json: bool) {
    let shown = |path: &Path| path.display().to_string();
    let (record, card, truth) = (shown(&places.record), shown(&places.card), shown(&places.truth));
    let rows = made.truth.scenario.samples();
    if as_json {
        let columns: Vec<&str> = made.columns.iter().map(|(name, _)| name.as_str()).collect();
        let told = json!({ "format": FORMAT, "record": record, "card": card, "truth": truth,
                           "rows": rows, "columns": columns, "seed": made.truth.seed });
        output::line(&format!("{told:#}"));
    } else {
        output::line(&format!(
            "wrote {record} ({rows} rows), its card {card}, and its truth {truth}"
        ));
    }
}
