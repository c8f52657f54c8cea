//! One search for what a model lacks, as checked: its files read, what was hidden looked up.

use super::source::{Source, truth};
use crate::{error::Complaint, spec::DiscoverSpec};
use discover::Options;
use identify::Rig;
use record::{DiscoveryRecord, Key};
use serde::Deserialize;
use std::{collections::BTreeMap, path::Path, sync::OnceLock};

/// A record in which the model of its rig may lack something.
#[derive(Debug)]
pub struct Discovery {
    /// Its name.
    pub name: String,
    /// Its title, for the report.
    pub title: String,
    /// What is to be known of it, for the report.
    pub text: String,
    /// The record and the rig.
    pub source: Source,
    /// What was hidden in a synthetic record; for those who judge alone.
    pub hidden: Option<Hidden>,
    /// How it is looked for.
    pub options: Options,
    /// The answer, once it was made or found.
    pub(crate) done: OnceLock<Discovered>,
}

/// An answer that was made or found in the store.
#[derive(Debug)]
pub struct Discovered {
    /// What is kept of it.
    pub record: DiscoveryRecord,
    /// Its key in the store.
    pub key: Key,
    /// Why it was made or not.
    pub why: crate::Why,
}

/// What was hidden in a record.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hidden {
    /// The right verdict.
    pub verdict: String,
    /// The effects with their values; none where a parameter is wrong, or nothing.
    pub effects: BTreeMap<String, BTreeMap<String, f64>>,
    /// The parameters that were wrong, with their true values.
    pub parameters: BTreeMap<String, f64>,
}

impl Discovery {
    /// Reads and checks its files, which `folder` holds.
    pub(super) fn check(spec: &DiscoverSpec, folder: &Path) -> Result<Self, Complaint> {
        let source = Source::read(&spec.record, &spec.rig, folder)?;
        let hidden = truth(spec.truth.as_ref(), folder, |text| hidden(text, &source.rig))?;
        let usual = Options::default();
        Ok(Self {
            name: spec.name.clone(),
            title: spec.title.clone(),
            text: spec.text.clone(),
            options: Options { seed: spec.seed.map_or(usual.seed, u64::from), ..usual },
            done: OnceLock::new(),
            source,
            hidden,
        })
    }

    /// The answer with its key, once it was made or found.
    pub fn done(&self) -> Option<&Discovered> {
        self.done.get()
    }

    /// What was found; a text if nothing was looked for yet.
    pub fn found(&self) -> Result<&DiscoveryRecord, String> {
        let done = self.done.get().ok_or_else(|| format!("nothing looked for `{}`", self.name))?;
        Ok(&done.record)
    }
}

/// The part of a key file that says what was hidden.
#[derive(Debug, Deserialize)]
struct KeyFile {
    key: KeyTable,
}

#[derive(Debug, Deserialize)]
struct KeyTable {
    verdict: String,
    #[serde(default)]
    effects: Vec<toml::Table>,
    parameter: Option<WrongParameter>,
}

#[derive(Debug, Deserialize)]
struct WrongParameter {
    name: String,
    truth: f64,
}

/// What a truth file says was hidden: the key of a record of the benchmark, or the scenario of a record of the rig,
/// in which a sensor of the drive reads too much.
fn hidden(text: &str, rig: &Rig) -> Result<Hidden, String> {
    let file: toml::Table = text.parse().map_err(|e: toml::de::Error| e.message().to_owned())?;
    if file.contains_key("scenario") {
        return biased(&file, rig);
    }
    let file: KeyFile = toml::from_str(text).map_err(|e| e.message().to_owned())?;
    let key = file.key;
    let verdict = match key.verdict.as_str() {
        "nothing" => "nothing_missing",
        "foreign" => "not_in_library",
        same @ ("parameter" | "effect") => same,
        other => {
            let known = "nothing, parameter, effect, foreign";
            return Err(format!("found verdict `{other}`: expected one of {known}"));
        }
    };
    let effect = |table: &toml::Table| {
        let name = table.get("name").and_then(toml::Value::as_str).ok_or("an effect, no name")?;
        let value = |(key, v): (&String, &toml::Value)| Some((key.clone(), v.as_float()?));
        Ok::<_, String>((name.to_owned(), table.iter().filter_map(value).collect()))
    };
    Ok(Hidden {
        verdict: verdict.to_owned(),
        effects: key.effects.iter().map(effect).collect::<Result<_, _>>()?,
        parameters: key.parameter.into_iter().map(|p| (p.name, p.truth)).collect(),
    })
}

/// The bias of the drive's monitor in a scenario: the true input is what was read less that bias.
fn biased(file: &toml::Table, rig: &Rig) -> Result<Hidden, String> {
    let drives = identify::rig::Kind::of(rig.kind).map_or(&[][..], |kind| kind.drives);
    let sensors = file.get("scenario").and_then(|s| s.get("sensor")).and_then(|s| s.as_array());
    let of_drive = |sensor: &&toml::Value| {
        let quantity = sensor.get("quantity").and_then(toml::Value::as_str);
        quantity.is_some_and(|quantity| drives.contains(&quantity))
    };
    let sensor = sensors.into_iter().flatten().find(of_drive).ok_or("no sensor of the drive")?;
    let bias = sensor.get("bias").and_then(toml::Value::as_float).ok_or("no bias")?;
    let values = BTreeMap::from([("bias".to_owned(), -bias)]);
    Ok(Hidden {
        verdict: "effect".to_owned(),
        effects: BTreeMap::from([("current_bias".to_owned(), values)]),
        parameters: BTreeMap::new(),
    })
}
