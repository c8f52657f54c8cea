//! A case of the benchmark: what nature is like, and what is known of it.

use crate::exit::{Exit, Failure};
use anyhow::anyhow;
use identify::{Recording, Rig, fit::Data};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use toml::{Table, Value};
use twin::{Made, Scenario};

/// The cases: the friction model as the tables call it, and the scenario with the nominal values and what is free.
pub(super) const CASES: [(&str, &str); 5] = [
    ("coulomb", include_str!("coulomb.toml")),
    ("coulomb + viscous", include_str!("coulomb-viscous.toml")),
    ("dahl", include_str!("dahl.toml")),
    ("lugre", include_str!("lugre.toml")),
    ("maxwell-slip", include_str!("maxwell-slip.toml")),
];

/// The truth lies within this of the nominal values [1] …
const FAR: f64 = 0.3;
/// … and no nearer than this, so that a fit that stays at its start is seen [1].
const NEAR: f64 = 0.02;

/// A case, ready to be drawn from.
#[derive(Debug, Clone)]
pub(super) struct Case {
    pub(super) name: &'static str,
    /// The nominal rig.
    pub(super) rig: Rig,
    /// The scenario's text as a table, with the nominal values.
    scenario: Table,
}

/// A record, drawn.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) data: Data,
    /// The true value of each free parameter, in the order of the rig's.
    pub(super) truth: Vec<f64>,
}

impl Case {
    /// The case of this name and text.
    pub(super) fn new((name, text): (&'static str, &str)) -> Result<Self, Failure> {
        let bug = |why: String| Failure { exit: Exit::Bug, error: anyhow!("{name}: {why}") };
        let mut scenario: Table = text.parse().map_err(|e: toml::de::Error| bug(e.to_string()))?;
        let free = scenario.remove("free").ok_or_else(|| bug("nothing is free".to_owned()))?;
        let rig = rig(&scenario, free).map_err(bug)?;
        Ok(Self { name, rig, scenario })
    }

    /// The record of this seed: truth, random drives and noise are all drawn from it.
    pub(super) fn draw(&self, seed: u64) -> Result<Drawn, Failure> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut scenario = self.scenario.clone();
        let mut truth = Vec::new();
        for name in self.rig.free_parameters() {
            let nominal = self.rig.value(&name).unwrap_or(f64::NAN);
            let side = if random.random::<bool>() { 1.0 } else { -1.0 };
            let value = nominal * (1.0 + side * random.random_range(NEAR..FAR));
            set(&mut scenario, &name, value);
            truth.push(value);
        }
        draw_steps(&mut scenario, &mut random);
        let scenario: Scenario = Scenario::parse(&scenario.to_string())?;
        let made = twin::make(&scenario, seed)?;
        let data = data(&self.rig, &made)
            .map_err(|why| Failure { exit: Exit::Bug, error: anyhow!("{}: {why}", self.name) })?;
        Ok(Drawn { data, truth })
    }
}

fn data(rig: &Rig, made: &Made) -> Result<Data, String> {
    let column = |header: &str| {
        let found = made.columns.iter().find(|(name, _)| name == header);
        found.map(|(_, values)| values.as_slice()).ok_or_else(|| format!("no column {header}"))
    };
    let recording = Recording::new(rig, &column).map_err(|why| why.to_string())?;
    Ok(Data::of(rig, &recording))
}

/// The rig file that belongs to a scenario: the same plant and friction, and its sensors as channels.
fn rig(scenario: &Table, free: Value) -> Result<Rig, String> {
    let take = |key: &str| scenario.get(key).cloned().ok_or_else(|| format!("no {key}"));
    let mut channels = Table::new();
    channels.insert("time".to_owned(), "time_s".into());
    for sensor in take("sensor")?.as_array().into_iter().flatten() {
        let mut channel = Table::new();
        channel.insert("column".to_owned(), sensor["column"].clone());
        for key in ["unit", "quantum"] {
            if let Some(value) = sensor.get(key) {
                channel.insert(key.to_owned(), value.clone());
            }
        }
        let quantity = sensor["quantity"].as_str().unwrap_or_default().to_owned();
        let drives = ["force", "current", "voltage"].contains(&quantity.as_str());
        if drives && scenario["input"].get("hold").is_some() {
            channel.insert("hold".to_owned(), "zero-order".into());
        }
        channels.insert(quantity, Value::Table(channel));
    }
    let mut file = Table::new();
    for key in ["title", "plant", "friction"] {
        file.insert(key.to_owned(), take(key)?);
    }
    file.insert("fit".to_owned(), Value::Table(Table::from_iter([("free".to_owned(), free)])));
    file.insert("channels".to_owned(), Value::Table(channels));
    Rig::parse(&file.to_string()).map_err(|why| why.to_string())
}

/// Random steps that begin after a while at rest, where nobody has to guess how the contact is stretched: in
/// place of each part `{ shape = "steps", amplitude, every }` of the drive.
fn draw_steps(scenario: &mut Table, random: &mut ChaCha8Rng) {
    let number = |value: &Value| value.as_float().unwrap_or(f64::NAN);
    let duration = number(&scenario["duration"]);
    let parts = scenario.get_mut("input").and_then(|input| input.get_mut("part"));
    for part in parts.and_then(Value::as_array_mut).into_iter().flatten() {
        let Some(part) = part.as_table_mut().filter(|p| p["shape"].as_str() == Some("steps"))
        else {
            continue;
        };
        let removed = [part.remove("amplitude"), part.remove("every")];
        let [Some(amplitude), Some(every)] = removed.map(|v| v.as_ref().map(number)) else {
            continue;
        };
        let mut times = vec![every];
        while times[times.len() - 1] + every < duration {
            times.push(times[times.len() - 1] + every);
        }
        let mut value = |_: &f64| Value::from(amplitude * random.random_range(-1.0..1.0));
        let values: Vec<Value> = times.iter().map(&mut value).collect();
        part.insert("times".to_owned(), times.into());
        part.insert("values".to_owned(), values.into());
    }
}

/// Writes a parameter, `f_c`, `mass` or `k[2]`, into the scenario.
fn set(scenario: &mut Table, name: &str, to: f64) {
    let (key, place) = match name.split_once('[') {
        Some((key, rest)) => (key, rest.trim_end_matches(']').parse::<usize>().ok()),
        None => (name, None),
    };
    for table in ["friction", "plant"] {
        let Some(value) = scenario.get_mut(table).and_then(|t| t.get_mut(key)) else { continue };
        match (place, value) {
            (Some(place), Value::Array(list)) => list[place - 1] = to.into(),
            (_, value) => *value = to.into(),
        }
        return;
    }
}
