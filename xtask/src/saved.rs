//! A saved run of the benchmark: what was built and where, the rows, and the claims and measures then.

use crate::{
    claims,
    exit::{Exit, Failure},
    root,
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::{Map, Value, json};
use simulation::anchors::Row;
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

/// The version of a saved run.
const FORMAT: u32 = 1;

/// What a saved run calls itself.
const KIND: &str = "duhem benchmark";

/// A run of the benchmark.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Saved {
    /// How and where it was made.
    pub(crate) machine: Machine,
    /// The libraries' versions.
    pub(crate) libraries: BTreeMap<String, String>,
    /// The library that was changed, if one was.
    pub(crate) patch: Option<Patched>,
    /// Whether it was a quick look.
    pub(crate) quick: bool,
    /// What the rows are judged by.
    pub(crate) references: Vec<Reference>,
    /// The rows.
    pub(crate) rows: Vec<Row>,
    /// The claims of the committed reports.
    pub(crate) claims: Vec<ClaimThen>,
    /// The measures of the committed reports.
    pub(crate) measures: Vec<MeasureThen>,
}

/// How and where a run was made: runs compare their counts exactly where all of it is the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Machine {
    /// The processor.
    pub(crate) processor: String,
    /// Whether it was built for the processor at hand.
    pub(crate) native: bool,
    /// Those features of the processor the compiler was allowed to use.
    pub(crate) target_features: Vec<String>,
    /// The compiler.
    pub(crate) rustc: String,
}

/// A library built from a folder instead of the registry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Patched {
    /// The library.
    pub(crate) library: String,
    /// The version its manifest states.
    pub(crate) version: String,
    /// The SHA-256 over its sources.
    pub(crate) sources: String,
}

/// What the rows of an anchor are judged by.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Reference {
    /// The problem.
    pub(crate) problem: String,
    /// Its parameter.
    pub(crate) parameter: Option<f64>,
    /// How ours was made.
    pub(crate) way: String,
    /// The relative error of ours, if it is known.
    pub(crate) error: Option<f64>,
    /// Whether a table from elsewhere is taken instead.
    pub(crate) table: bool,
    /// The relative difference of both.
    pub(crate) apart: Option<f64>,
}

/// A claim as the reports had it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ClaimThen {
    pub(crate) id: String,
    pub(crate) verdict: String,
    pub(crate) ours: Option<f64>,
    pub(crate) error: Option<f64>,
    pub(crate) unit: String,
}

/// A measure as the reports had it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeasureThen {
    pub(crate) id: String,
    pub(crate) value: f64,
    pub(crate) error: f64,
    pub(crate) unit: String,
}

/// The claims and measures of the committed reports.
pub(crate) fn ledger(root: &Path) -> Result<(Vec<ClaimThen>, Vec<MeasureThen>), Failure> {
    let summaries = claims::committed(root, &root.join("reports"))?;
    let claim = |c: &record::ClaimRow| ClaimThen {
        id: c.id.clone(),
        verdict: c.verdict.clone(),
        ours: c.ours,
        error: c.error,
        unit: c.unit.clone(),
    };
    let measure = |m: &record::MeasureRow| MeasureThen {
        id: m.id.clone(),
        value: m.value,
        error: m.error,
        unit: m.unit.clone(),
    };
    Ok((
        summaries.iter().flat_map(|s| s.claims.iter().map(claim)).collect(),
        summaries.iter().flat_map(|s| s.measures.iter().map(measure)).collect(),
    ))
}

/// Where a run of this name is kept; the name is checked.
pub(crate) fn place(root: &Path, name: &str) -> Result<PathBuf, Failure> {
    if !root::plain(name) {
        return Err(Failure::usage(format!(
            "`{name}` cannot name a run: expected lower case letters, digits and dashes"
        )));
    }
    Ok(folder(root).join(format!("{name}.json")))
}

fn folder(root: &Path) -> PathBuf {
    root.join("target/duhem/bench")
}

/// Reads a saved run, given by its name or by the path of its file.
pub(crate) fn read(root: &Path, given: &str) -> Result<Saved, Failure> {
    let by_path = given.contains('/') || Path::new(given).extension().is_some_and(|e| e == "json");
    let path = if by_path { PathBuf::from(given) } else { place(root, given)? };
    if !path.is_file() {
        let known = names(root);
        let known = if known.is_empty() { "none is saved".to_owned() } else { known.join(", ") };
        return Err(Failure::usage(format!("{given}: no such saved run; known: {known}")));
    }
    let text = fs::read_to_string(&path).map_err(|why| damaged(&path, &why.to_string()))?;
    Saved::parse(&text).map_err(|why| damaged(&path, &why))
}

fn names(root: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder(root)).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let saved = paths.filter(|path| path.extension().is_some_and(|e| e == "json"));
    let stem = |path: PathBuf| path.file_stem().map(|s| s.to_string_lossy().into_owned());
    // The folder is cargo's too, which has a hidden file of that kind.
    let mut names: Vec<String> =
        saved.filter_map(stem).filter(|name| !name.starts_with('.')).collect();
    names.sort();
    names
}

fn damaged(path: &Path, why: &str) -> Failure {
    Failure { exit: Exit::Input, error: anyhow::anyhow!("{}: {why}", path.display()) }
}

impl Saved {
    /// The run as the text of a file.
    pub(crate) fn text(&self) -> String {
        let value = json!({
            "kind": KIND, "format": FORMAT, "machine": self.machine, "libraries": self.libraries,
            "patch": self.patch, "quick": self.quick, "references": self.references, "rows": self.rows,
            "claims": self.claims, "measures": self.measures,
        });
        format!("{value:#}\n")
    }

    /// The run of such a text; what is wrong is told with its key.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let value: Value = serde_json::from_str(text).map_err(|why| format!("no JSON: {why}"))?;
        let Value::Object(mut map) = value else {
            return Err("expected a saved run, found no object".to_owned());
        };
        let kind: String = take(&mut map, "kind")?;
        if kind != KIND {
            return Err(format!("kind: expected `{KIND}`, found `{kind}`"));
        }
        let format: u32 = take(&mut map, "format")?;
        if format != FORMAT {
            return Err(format!("format: expected {FORMAT}, found {format}"));
        }
        let saved = Self {
            machine: take(&mut map, "machine")?,
            libraries: take(&mut map, "libraries")?,
            patch: take(&mut map, "patch")?,
            quick: take(&mut map, "quick")?,
            references: list(&mut map, "references")?,
            rows: list(&mut map, "rows")?,
            claims: list(&mut map, "claims")?,
            measures: list(&mut map, "measures")?,
        };
        if let Some(key) = map.keys().next() {
            return Err(format!("{key}: unknown key"));
        }
        saved.check()?;
        Ok(saved)
    }

    /// No row stands twice, and times are times.
    fn check(&self) -> Result<(), String> {
        let mut seen = BTreeMap::new();
        for (i, row) in self.rows.iter().enumerate() {
            if let Some(before) = seen.insert(row.key(), i) {
                return Err(format!("rows[{i}]: `{}` stands at rows[{before}] too", row.key()));
            }
            let times = row.cpu_s.iter().chain(&row.repeats_s);
            if times.clone().any(|time| time.is_nan() || *time <= 0.0) {
                return Err(format!("rows[{i}].repeats_s: expected times above 0 s"));
            }
        }
        Ok(())
    }
}

fn take<T: DeserializeOwned>(map: &mut Map<String, Value>, key: &str) -> Result<T, String> {
    let value = map.remove(key).ok_or_else(|| format!("{key}: is missing"))?;
    serde_json::from_value(value).map_err(|why| format!("{key}: {why}"))
}

fn list<T: DeserializeOwned>(map: &mut Map<String, Value>, key: &str) -> Result<Vec<T>, String> {
    let values: Vec<Value> = take(map, key)?;
    let item =
        |(i, value)| serde_json::from_value(value).map_err(|why| format!("{key}[{i}]: {why}"));
    values.into_iter().enumerate().map(item).collect()
}
