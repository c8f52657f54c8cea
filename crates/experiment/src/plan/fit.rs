//! One fit as checked: its files read, its truth looked up.

use super::source::{self, Source};
use crate::{error::Complaint, spec::FitSpec};
use identify::{
    Recording, Rig,
    fit::{Data, Options, binding},
};
use record::{FitRecord, Key};
use std::{collections::BTreeMap, path::Path, sync::OnceLock};

/// A rig's free parameters, to be fitted to a record.
#[derive(Debug)]
pub struct Fit {
    /// Its name.
    pub name: String,
    /// Its title, for the report.
    pub title: String,
    /// What is to be known of it, for the report.
    pub text: String,
    /// The record's file, without its folder.
    pub file: String,
    /// The rig with its nominal parameters.
    pub rig: Rig,
    /// The record's channels.
    pub recording: Recording,
    /// The record as the fit needs it.
    pub data: Data,
    /// The true values of the parameters of a synthetic record, as this rig would have them.
    pub truth: BTreeMap<String, f64>,
    /// How it is fitted.
    pub options: Options,
    /// The hash of record and rig file.
    pub(crate) content: String,
    /// The fit itself, once it was made or found.
    pub(crate) done: OnceLock<Fitted>,
}

/// A fit that was made or found in the store.
#[derive(Debug)]
pub struct Fitted {
    /// What is kept of it.
    pub record: FitRecord,
    /// Its key in the store.
    pub key: Key,
    /// Why it was made or not.
    pub why: crate::Why,
}

impl Fit {
    /// Reads and checks its files, which `folder` holds.
    pub(super) fn check(spec: &FitSpec, folder: &Path) -> Result<Self, Complaint> {
        let Source { file, rig, recording, data, content } =
            Source::read(&spec.record, &spec.rig, folder)?;
        let truth = source::truth(spec.truth.as_ref(), folder, |text| truth(text, &rig))?;
        if let Some(window) = spec.window.filter(|w| !(w.is_finite() && *w > 0.0)) {
            return Err(Complaint::new("window", window.to_string(), "a time [s]"));
        }
        Ok(Self {
            name: spec.name.clone(),
            title: spec.title.clone(),
            text: spec.text.clone(),
            options: options(spec),
            done: OnceLock::new(),
            truth: truth.unwrap_or_default(),
            file,
            data,
            content,
            rig,
            recording,
        })
    }

    /// The fit with its key, once it was made or found.
    pub fn done(&self) -> Option<&Fitted> {
        self.done.get()
    }

    /// What was found; a text if nothing was fitted yet.
    pub fn found(&self) -> Result<&FitRecord, String> {
        let done = self.done.get().ok_or_else(|| format!("fit `{}` was not made", self.name))?;
        Ok(&done.record)
    }

    /// The rig with the fitted values.
    pub(crate) fn fitted_rig(&self) -> Result<Rig, String> {
        let mut rig = self.rig.clone();
        for row in &self.found()?.parameters {
            binding::set(&mut rig, &row.parameter, row.found);
        }
        Ok(rig)
    }
}

fn options(spec: &FitSpec) -> Options {
    let usual = Options::default();
    Options {
        window: spec.window,
        starts: spec.starts.map_or(usual.starts, |n| n as usize),
        seed: spec.seed.map_or(usual.seed, u64::from),
        models: spec.models.unwrap_or(true),
        // Its interval is not among the tables: two intervals of one parameter say less than one.
        bootstrap: 0,
        ..usual
    }
}

/// The parameters of the rig's own names that a truth file holds.
///
/// What a biased sensor reads too much of the input looks like a constant force to a fit: it belongs to `offset`.
fn truth(text: &str, rig: &Rig) -> Result<BTreeMap<String, f64>, String> {
    let file: toml::Table = text.parse().map_err(|e: toml::de::Error| e.message().to_owned())?;
    let scenario = file.get("scenario").and_then(toml::Value::as_table).ok_or("no [scenario]")?;
    let table = |key: &str| scenario.get(key).and_then(toml::Value::as_table);
    let plant = table("plant").ok_or("no [scenario.plant]")?;
    let friction = table("friction").ok_or("no [scenario.friction]")?;
    let same = friction.get("name").and_then(toml::Value::as_str) == Some(&rig.friction.name);
    let mut made = rig.clone();
    let mut truth = BTreeMap::new();
    for name in rig.parameters() {
        let place =
            if rig.plant.contains_key(&name) { Some(plant) } else { same.then_some(friction) };
        if let Some(value) = place.and_then(|t| t.get(&name)).and_then(toml::Value::as_float) {
            binding::set(&mut made, &name, value);
            truth.insert(name, value);
        }
    }
    let gain = binding::model::<f64>(&made, &|_| None).balance.gain;
    let drives = identify::rig::Kind::of(rig.kind).map_or(&[][..], |kind| kind.drives);
    let sensors = scenario.get("sensor").and_then(toml::Value::as_array);
    for sensor in sensors.into_iter().flatten() {
        let quantity = sensor.get("quantity").and_then(toml::Value::as_str).unwrap_or_default();
        let bias = sensor.get("bias").and_then(toml::Value::as_float).unwrap_or(0.0);
        if drives.contains(&quantity) && rig.kind != "prescribed" {
            *truth.entry("offset".to_owned()).or_insert(0.0) += gain * bias;
        }
    }
    Ok(truth)
}
