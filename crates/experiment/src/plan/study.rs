//! One study as checked.

use super::{corners_name, fixed_step, input};
use crate::{
    error::{Complaint, one_of},
    spec::{HistorySpec, StudySpec},
};
use duhem::{
    FrictionModel, Input, MODELS, ModelEntry, Parameter, ParameterError, Parameters,
    closed_form::{REFERENCES, ReferenceEntry},
};
use integrate::{Corners, SOLVERS, Solver};
use std::collections::BTreeMap;

/// The most points a sweep may have: more is a slip of the pen.
const MOST_POINTS: usize = 10_000;

/// One study as checked: model × input × solvers × controls.
#[derive(Debug)]
pub struct Study {
    /// Its name.
    pub name: String,
    /// Its title, for the report.
    pub title: String,
    /// The label of its curve in a figure.
    pub label: String,
    /// The physics, for the report.
    pub text: String,
    /// The model.
    pub model: &'static ModelEntry,
    /// The model's parameters outside the sweep, as a reader would write them.
    pub model_text: String,
    /// The input.
    pub input: Input,
    /// The input, as a reader would write it.
    pub input_text: String,
    /// The points of the sweep; one without a label if there is no sweep.
    pub points: Vec<Point>,
    /// The input's period, or the span if it has none [s].
    pub period: f64,
    /// The end of the time span; it starts at 0 [s].
    pub span: f64,
    /// The internal state at t = 0.
    pub initial: Vec<f64>,
    /// The solvers.
    pub solvers: Vec<&'static Solver>,
    /// Steps per period, for the methods of fixed step.
    pub steps: Vec<f64>,
    /// Relative tolerances, for the adaptive methods.
    pub rtol: Vec<f64>,
    /// Whether solvers restart at corners, or both.
    pub corners: Vec<Corners>,
    /// The exact answer errors are judged by.
    pub reference: Option<&'static ReferenceEntry>,
    /// The most evaluations a case may use.
    pub budget: u64,
    history: Vec<HistorySpec>,
}

/// One point of a sweep.
#[derive(Debug, Clone)]
pub struct Point {
    /// As `gamma=0.25`.
    pub label: String,
    /// The swept parameters.
    pub values: BTreeMap<String, f64>,
    /// All parameters of the model.
    pub parameters: Parameters,
}

impl Study {
    pub(super) fn check(spec: &StudySpec, budget: u64) -> Result<Self, Complaint> {
        let (model, base) = model(&spec.model)?;
        let points = points(spec, model, &base)?;
        let (input, input_text) = input::check(&spec.input).map_err(|c| c.under("input"))?;
        if !(spec.periods > 0.0 && spec.periods <= 1e4) {
            return Err(Complaint::new(
                "periods",
                spec.periods.to_string(),
                "above 0, at most 1e4",
            ));
        }
        let period = input.period().ok_or_else(|| {
            Complaint::new("input.shape", "an input without a period", "a periodic one")
        })?;
        let states = build(model, &points[0].parameters)?.states();
        let initial = spec.initial.clone().unwrap_or_else(|| vec![0.0; states]);
        if initial.len() != states || initial.iter().any(|x| !x.is_finite()) {
            let expected = format!("{states} finite numbers, one for each state of the model");
            return Err(Complaint::new("initial", format!("{initial:?}"), expected));
        }
        let study = Self {
            name: spec.name.clone(),
            title: spec.title.clone(),
            label: if spec.label.is_empty() { model.name } else { &spec.label }.to_owned(),
            text: spec.text.trim().to_owned(),
            model,
            model_text: model_text(model, &base, &spec.sweep),
            input,
            input_text,
            points,
            period,
            span: spec.periods * period,
            initial,
            solvers: solvers(&spec.solvers)?,
            steps: steps(&spec.steps, spec.periods)?,
            rtol: tolerances(&spec.rtol)?,
            corners: corners(&spec.corners)?,
            reference: reference(spec.reference.as_deref())?,
            budget,
            history: spec.history.clone(),
        };
        study.complete()?;
        study.references_exist()?;
        Ok(study)
    }

    /// Solvers without controls would silently run nothing.
    fn complete(&self) -> Result<(), Complaint> {
        let needs = |fixed: bool| self.solvers.iter().any(|s| fixed_step(s) == fixed);
        if needs(true) && self.steps.is_empty() {
            return Err(Complaint::new(
                "steps",
                "none",
                "steps per period for the fixed-step solvers",
            ));
        }
        if needs(false) && self.rtol.is_empty() {
            return Err(Complaint::new("rtol", "none", "tolerances for the adaptive solvers"));
        }
        if !self.solvers.is_empty() && self.corners.is_empty() {
            return Err(Complaint::new("corners", "none", "\"restart\", \"ignore\" or both"));
        }
        if !self.solvers.is_empty() && self.reference.is_none() {
            return Err(Complaint::new(
                "reference",
                "none",
                "the exact answer to judge solvers by",
            ));
        }
        for (i, wanted) in self.history.iter().enumerate() {
            let solver = self.solvers.iter().any(|s| s.name == wanted.solver && !fixed_step(s));
            let corners = self.corners.iter().any(|c| corners_name(*c) == wanted.corners);
            if !(solver && corners && self.rtol.contains(&wanted.rtol)) {
                let found =
                    format!("{} at rtol {:e}, {}", wanted.solver, wanted.rtol, wanted.corners);
                let expected = "an adaptive solver, a tolerance and corners of this study";
                return Err(Complaint::new(format!("history[{i}]"), found, expected));
            }
        }
        Ok(())
    }

    /// A model's reference that refuses these parameters is the experiment's mistake, not a case's.
    fn references_exist(&self) -> Result<(), Complaint> {
        let Some(reference) = self.reference else { return Ok(()) };
        for point in &self.points {
            (reference.build)(&point.parameters, &self.input, &self.initial, (0.0, self.span))
                .map_err(|e| Complaint::new("reference", e.to_string(), "an exact answer"))?;
        }
        Ok(())
    }

    /// Whether the steps of this case are kept.
    pub(super) fn keeps(&self, solver: &Solver, value: f64, corners: Corners) -> bool {
        let fits = |h: &HistorySpec| {
            h.solver == solver.name && h.rtol == value && h.corners == corners_name(corners)
        };
        self.history.iter().any(fits)
    }

    /// The model at a point.
    pub fn model_at(&self, point: &Point) -> Result<Box<dyn FrictionModel>, String> {
        (self.model.build)(&point.parameters).map_err(|e| e.to_string())
    }

    /// The points whose swept values are among `select`.
    pub(crate) fn selected(
        &self,
        select: &BTreeMap<String, Vec<f64>>,
    ) -> Result<Vec<&Point>, Complaint> {
        for (key, values) in select {
            for value in values {
                if !self.points.iter().any(|p| p.values.get(key) == Some(value)) {
                    let expected = format!("a value of the sweep of study `{}`", self.name);
                    return Err(Complaint::new(key, value.to_string(), expected));
                }
            }
        }
        let fits = |p: &&Point| {
            select.iter().all(|(key, values)| p.values.get(key).is_some_and(|v| values.contains(v)))
        };
        Ok(self.points.iter().filter(fits).collect())
    }
}

fn build(model: &ModelEntry, parameters: &Parameters) -> Result<Box<dyn FrictionModel>, Complaint> {
    (model.build)(parameters).map_err(|e| {
        let at = format!("model.{}", e.key());
        match e {
            ParameterError::Unknown { expected, .. } => {
                Complaint::new(at, "an unknown key", format!("one of {expected}"))
            }
            ParameterError::Missing { expected, .. } => Complaint::new(at, "nothing", expected),
            ParameterError::Invalid { found, expected, .. } => Complaint::new(at, found, expected),
        }
    })
}

/// The model's entry and its parameters outside the sweep.
fn model(table: &toml::Table) -> Result<(&'static ModelEntry, Parameters), Complaint> {
    let name = input::text(table, "name").map_err(|c| c.under("model"))?;
    let known = MODELS.iter().map(|m| m.name);
    let entry = MODELS
        .iter()
        .find(|m| m.name == name)
        .ok_or_else(|| Complaint::new("model.name", format!("`{name}`"), one_of(name, known)))?;
    let mut parameters = BTreeMap::new();
    for (key, value) in table.iter().filter(|(key, _)| *key != "name") {
        if !entry.keys.contains(&key.as_str()) {
            let expected = one_of(key, entry.keys.iter().copied());
            return Err(Complaint::new(format!("model.{key}"), "an unknown key", expected));
        }
        let value = parameter(value)
            .ok_or_else(|| Complaint::new(format!("model.{key}"), value.to_string(), "a number"))?;
        parameters.insert(key.clone(), value);
    }
    Ok((entry, Parameters(parameters)))
}

fn parameter(value: &toml::Value) -> Option<Parameter> {
    if let Some(list) = value.as_array() {
        return list.iter().map(input::as_number).collect::<Option<_>>().map(Parameter::List);
    }
    input::as_number(value).map(Parameter::Scalar)
}

/// Every combination of the sweep's values, each tried as a model.
fn points(
    spec: &StudySpec,
    model: &ModelEntry,
    base: &Parameters,
) -> Result<Vec<Point>, Complaint> {
    let mut points =
        vec![Point { label: String::new(), values: BTreeMap::new(), parameters: base.clone() }];
    for (key, values) in &spec.sweep {
        let at = format!("sweep.{key}");
        if !model.keys.contains(&key.as_str()) {
            let expected = one_of(key, model.keys.iter().copied());
            return Err(Complaint::new(at, "an unknown parameter", expected));
        }
        if values.is_empty() {
            return Err(Complaint::new(at, "an empty list", "at least one value"));
        }
        if base.0.contains_key(key) {
            let expected = "the parameter in `model` or in `sweep`, not in both";
            return Err(Complaint::new(at, "a second value", expected));
        }
        if points.len() * values.len() > MOST_POINTS {
            let found = format!("more than {MOST_POINTS} points");
            return Err(Complaint::new("sweep", found, "fewer values"));
        }
        let grown = points.iter().flat_map(|point| {
            values.iter().map(move |value| {
                let mut point = point.clone();
                let space = if point.label.is_empty() { "" } else { " " };
                point.label = format!("{}{space}{key}={value}", point.label);
                point.values.insert(key.clone(), *value);
                point.parameters.0.insert(key.clone(), Parameter::Scalar(*value));
                point
            })
        });
        points = grown.collect();
    }
    for point in &points {
        build(model, &point.parameters).map_err(|mut c| {
            let key = c.key.trim_start_matches("model.");
            if spec.sweep.contains_key(key) {
                c.key = format!("sweep.{key}");
            }
            c
        })?;
    }
    Ok(points)
}

fn model_text(model: &ModelEntry, base: &Parameters, sweep: &BTreeMap<String, Vec<f64>>) -> String {
    let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
    let mut parts = vec![];
    for (key, unit) in model.keys.iter().zip(model.units) {
        let value = match (base.0.get(*key), sweep.get(*key)) {
            (_, Some(values)) | (Some(Parameter::List(values)), None) => list(values),
            (Some(Parameter::Scalar(value)), None) => value.to_string(),
            (None, None) => continue,
        };
        parts.push(format!("{key} = {value} {unit}").trim_end().to_owned());
    }
    format!("{}: {}", model.name, parts.join("; "))
}

/// The solvers of these names and sets, each once, in the order of the list.
pub(crate) fn solvers(names: &[String]) -> Result<Vec<&'static Solver>, Complaint> {
    let mut found: Vec<&'static Solver> = Vec::new();
    for name in names {
        let members = if name.starts_with('@') {
            integrate::set(name)
        } else {
            integrate::solver(name).map(|solver| vec![solver])
        };
        let known = SOLVERS.iter().map(|s| s.name).chain(integrate::SETS.iter().copied());
        let members = members
            .ok_or_else(|| Complaint::new("solvers", format!("`{name}`"), one_of(name, known)))?;
        for solver in members {
            if !found.iter().any(|s| s.name == solver.name) {
                found.push(solver);
            }
        }
    }
    Ok(found)
}

fn steps(steps: &[f64], periods: f64) -> Result<Vec<f64>, Complaint> {
    for n in steps {
        if !(n.fract() == 0.0 && *n >= 1.0 && n * periods <= 1e7) {
            let expected = "a whole number of steps per period, at least 1, at most 1e7 in all";
            return Err(Complaint::new("steps", format!("{n:?}"), expected));
        }
    }
    ordered("steps", steps, |a, b| a < b, "ascending")?;
    Ok(steps.to_vec())
}

/// Orders are taken between neighbours: coarse controls come first, and each once.
fn ordered(
    key: &str,
    values: &[f64],
    before: fn(f64, f64) -> bool,
    how: &str,
) -> Result<(), Complaint> {
    match values.windows(2).find(|pair| !before(pair[0], pair[1])) {
        None => Ok(()),
        Some(pair) => {
            let found = format!("{:e} before {:e}", pair[0], pair[1]);
            Err(Complaint::new(key, found, format!("{how} values, each once")))
        }
    }
}

fn tolerances(rtol: &[f64]) -> Result<Vec<f64>, Complaint> {
    for tolerance in rtol {
        if !(1e-14..=0.5).contains(tolerance) {
            return Err(Complaint::new("rtol", format!("{tolerance:?}"), "from 1e-14 to 0.5"));
        }
    }
    ordered("rtol", rtol, |a, b| a > b, "descending")?;
    Ok(rtol.to_vec())
}

pub(super) fn corners(names: &[String]) -> Result<Vec<Corners>, Complaint> {
    let one = |name: &String| match name.as_str() {
        "restart" => Ok(Corners::Restart),
        "ignore" => Ok(Corners::Ignore),
        other => {
            let expected = one_of(other, ["restart", "ignore"]);
            Err(Complaint::new("corners", format!("`{other}`"), expected))
        }
    };
    if names.iter().enumerate().any(|(i, name)| names[..i].contains(name)) {
        return Err(Complaint::new("corners", format!("{names:?}"), "each once"));
    }
    names.iter().map(one).collect()
}

fn reference(name: Option<&str>) -> Result<Option<&'static ReferenceEntry>, Complaint> {
    let Some(name) = name else { return Ok(None) };
    let known = REFERENCES.iter().map(|r| r.name);
    REFERENCES
        .iter()
        .find(|r| r.name == name)
        .map(Some)
        .ok_or_else(|| Complaint::new("reference", format!("`{name}`"), one_of(name, known)))
}
