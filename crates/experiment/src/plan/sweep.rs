//! The model and the plant of a study, and the points of its sweep.

use super::input;
use crate::{
    error::{Complaint, one_of},
    spec::StudySpec,
};
use duhem::{
    FrictionModel, MODELS, ModelEntry, PLANTS, Parameter, ParameterError, Parameters, Plant,
    PlantEntry,
};
use std::collections::BTreeMap;

/// The most points a sweep may have: more is a slip of the pen.
const MOST_POINTS: usize = 10_000;

/// One point of a sweep.
#[derive(Debug, Clone)]
pub struct Point {
    /// As `gamma=0.25`.
    pub label: String,
    /// The swept parameters.
    pub values: BTreeMap<String, f64>,
    /// All parameters of the model.
    pub parameters: Parameters,
    /// All parameters of the plant.
    pub plant_parameters: Parameters,
    /// The plant, if there is one.
    pub plant: Option<Plant>,
}

/// A plant's entry and its parameters outside the sweep.
#[derive(Debug)]
pub(super) struct Written {
    pub(super) entry: &'static PlantEntry,
    base: Parameters,
}

/// A unit of motion along a line as that of a rotation: N as N·m, m as rad.
pub(crate) fn angular(unit: &'static str) -> &'static str {
    match unit {
        "N" => "N·m",
        "m" => "rad",
        "m/s" => "rad/s",
        "N/m" => "N·m/rad",
        "N·s/m" => "N·m·s/rad",
        other => other,
    }
}

/// The model, or what is wrong with its parameters.
pub(super) fn build(
    model: &ModelEntry,
    parameters: &Parameters,
) -> Result<Box<dyn FrictionModel>, Complaint> {
    (model.build)(parameters).map_err(|e| refused("model", e))
}

fn refused(table: &str, error: ParameterError) -> Complaint {
    let at = format!("{table}.{}", error.key());
    match error {
        ParameterError::Unknown { expected, .. } => {
            Complaint::new(at, "an unknown key", format!("one of {expected}"))
        }
        ParameterError::Missing { expected, .. } => Complaint::new(at, "nothing", expected),
        ParameterError::Invalid { found, expected, .. } => Complaint::new(at, found, expected),
    }
}

/// The model's entry and its parameters outside the sweep.
pub(super) fn model(table: &toml::Table) -> Result<(&'static ModelEntry, Parameters), Complaint> {
    let name = input::text(table, "name").map_err(|c| c.under("model"))?;
    let known = MODELS.iter().map(|m| m.name);
    let entry = MODELS
        .iter()
        .find(|m| m.name == name)
        .ok_or_else(|| Complaint::new("model.name", format!("`{name}`"), one_of(name, known)))?;
    let parameters = parameters(table, "name", entry.keys).map_err(|c| c.under("model"))?;
    Ok((entry, parameters))
}

/// The plant's entry and its parameters outside the sweep.
pub(super) fn plant(table: &toml::Table) -> Result<Written, Complaint> {
    let kind = input::text(table, "kind").map_err(|c| c.under("plant"))?;
    let known = PLANTS.iter().map(|p| p.name);
    let entry = PLANTS
        .iter()
        .find(|p| p.name == kind)
        .ok_or_else(|| Complaint::new("plant.kind", format!("`{kind}`"), one_of(kind, known)))?;
    let base = parameters(table, "kind", entry.keys).map_err(|c| c.under("plant"))?;
    Ok(Written { entry, base })
}

/// The numbers and lists of a table, but for its `name`.
fn parameters(table: &toml::Table, name: &str, keys: &[&str]) -> Result<Parameters, Complaint> {
    let mut parameters = BTreeMap::new();
    for (key, value) in table.iter().filter(|(key, _)| *key != name) {
        if !keys.contains(&key.as_str()) {
            let expected = one_of(key, keys.iter().copied());
            return Err(Complaint::new(key, "an unknown key", expected));
        }
        let value =
            parameter(value).ok_or_else(|| Complaint::new(key, value.to_string(), "a number"))?;
        parameters.insert(key.clone(), value);
    }
    Ok(Parameters(parameters))
}

fn parameter(value: &toml::Value) -> Option<Parameter> {
    if let Some(list) = value.as_array() {
        return list.iter().map(input::as_number).collect::<Option<_>>().map(Parameter::List);
    }
    input::as_number(value).map(Parameter::Scalar)
}

/// Every combination of the sweep's values, each tried as a model and a plant.
pub(super) fn points(
    spec: &StudySpec,
    (model, base): (&ModelEntry, &Parameters),
    plant: Option<&Written>,
) -> Result<Vec<Point>, Complaint> {
    let mut points = vec![Point {
        label: String::new(),
        values: BTreeMap::new(),
        parameters: base.clone(),
        plant_parameters: plant.map_or_else(Parameters::default, |p| p.base.clone()),
        plant: None,
    }];
    let plant_keys = plant.map_or(&[][..], |p| p.entry.keys);
    for (key, values) in &spec.sweep {
        let of_plant = plant_keys.contains(&key.as_str());
        sweepable(key, values, &points, (model.keys, plant_keys))?;
        let grown = points.iter().flat_map(|point| {
            values.iter().map(move |value| {
                let mut point = point.clone();
                let space = if point.label.is_empty() { "" } else { " " };
                point.label = format!("{}{space}{key}={value}", point.label);
                point.values.insert(key.clone(), *value);
                let own =
                    if of_plant { &mut point.plant_parameters } else { &mut point.parameters };
                own.0.insert(key.clone(), Parameter::Scalar(*value));
                point
            })
        });
        points = grown.collect();
    }
    for point in &mut points {
        let swept = |mut c: Complaint| {
            let key = c.key.split_once('.').map_or("", |(_, key)| key);
            if spec.sweep.contains_key(key) {
                c.key = format!("sweep.{key}");
            }
            c
        };
        build(model, &point.parameters).map_err(swept)?;
        if let Some(plant) = plant {
            let built = (plant.entry.build)(&point.plant_parameters);
            point.plant = Some(built.map_err(|e| swept(refused("plant", e)))?);
        }
    }
    Ok(points)
}

fn sweepable(
    key: &str,
    values: &[f64],
    points: &[Point],
    (model, plant): (&[&str], &[&str]),
) -> Result<(), Complaint> {
    let at = format!("sweep.{key}");
    if !model.contains(&key) && !plant.contains(&key) {
        let expected = one_of(key, model.iter().chain(plant).copied());
        return Err(Complaint::new(at, "an unknown parameter", expected));
    }
    if values.is_empty() {
        return Err(Complaint::new(at, "an empty list", "at least one value"));
    }
    let twice =
        |p: &Point| p.parameters.0.contains_key(key) || p.plant_parameters.0.contains_key(key);
    if points.iter().any(twice) {
        let expected = "the parameter in its own table or in `sweep`, not in both";
        return Err(Complaint::new(at, "a second value", expected));
    }
    if points.len() * values.len() > MOST_POINTS {
        let found = format!("more than {MOST_POINTS} points");
        return Err(Complaint::new("sweep", found, "fewer values"));
    }
    Ok(())
}

/// The model and the plant with their parameters, as a reader would write them.
pub(super) fn text(
    (model, base): (&ModelEntry, &Parameters),
    plant: Option<&Written>,
    sweep: &BTreeMap<String, Vec<f64>>,
) -> String {
    let turning = plant.is_some_and(|p| p.entry.q_unit == "rad");
    let unit = |unit: &'static str| if turning { angular(unit) } else { unit };
    let units: Vec<&str> = model.units.iter().map(|u| unit(u)).collect();
    let model = format!("{}: {}", model.name, listed(model.keys, &units, base, sweep));
    match plant {
        None => model,
        Some(p) => {
            let values = listed(p.entry.keys, p.entry.units, &p.base, sweep);
            format!("{model}, on a {}: {values}", p.entry.name)
        }
    }
}

fn listed(
    keys: &[&str],
    units: &[&str],
    base: &Parameters,
    sweep: &BTreeMap<String, Vec<f64>>,
) -> String {
    let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
    let mut parts = vec![];
    for (key, unit) in keys.iter().zip(units) {
        let value = match (base.0.get(*key), sweep.get(*key)) {
            (_, Some(values)) | (Some(Parameter::List(values)), None) => list(values),
            (Some(Parameter::Scalar(value)), None) => value.to_string(),
            (None, None) => continue,
        };
        parts.push(format!("{key} = {value} {unit}").trim_end().to_owned());
    }
    parts.join("; ")
}
