//! One study as checked.

use super::{
    answer::{Answers, Exact},
    control_name, corners_name, input,
    sweep::{self, Point},
};
use crate::{
    error::{Complaint, one_of},
    spec::{HistorySpec, StudySpec},
};
use duhem::{FrictionModel, Input, ModelEntry, PlantEntry};
use integrate::Corners;
use simulation::{DrivenPlant, Method, Motion, PrescribedMotion, Task};
use std::collections::BTreeMap;

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
    /// The model with its parameters, and the plant with its own, as a reader would write them.
    pub model_text: String,
    /// The plant that the input drives; none if the motion is imposed.
    pub plant: Option<&'static PlantEntry>,
    /// The input: a displacement, or what drives the plant.
    pub input: Input,
    /// The input, as a reader would write it.
    pub input_text: String,
    /// The points of the sweep; one without a label if there is no sweep.
    pub points: Vec<Point>,
    /// What steps are counted over [s]: the input's period, or the span where that is given.
    pub period: f64,
    /// The end of the time span; it starts at 0 [s].
    pub span: f64,
    /// The state at t = 0: the model's, after displacement and velocity if there is a plant.
    pub initial: Vec<f64>,
    /// The solvers, and the methods of our own that take one of the points.
    pub solvers: Vec<Method>,
    /// Steps per period, for the methods of fixed step.
    pub steps: Vec<f64>,
    /// Relative tolerances, for the adaptive methods.
    pub rtol: Vec<f64>,
    /// Whether solvers restart at corners, or both.
    pub corners: Vec<Corners>,
    /// The exact answers errors are judged by, one for each point.
    pub reference: Option<Answers>,
    /// The most evaluations a case may use.
    pub budget: u64,
    history: Vec<HistorySpec>,
}

impl Study {
    pub(super) fn check(spec: &StudySpec, budget: u64) -> Result<Self, Complaint> {
        let (model, base) = sweep::model(&spec.model)?;
        let plant = spec.plant.as_ref().map(sweep::plant).transpose()?;
        let points = sweep::points(spec, (model, &base), plant.as_ref())?;
        let (input, input_text) = input::check(&spec.input, plant.as_ref().map(|p| p.entry))
            .map_err(|c| c.under("input"))?;
        let (period, span) = span(spec, &input)?;
        let bristles = sweep::build(model, &points[0].parameters)?.states();
        let states = bristles + if plant.is_some() { 2 } else { 0 };
        let initial = spec.initial.clone().unwrap_or_else(|| vec![0.0; states]);
        if initial.len() != states || initial.iter().any(|x| !x.is_finite()) {
            let of = if plant.is_some() { "the plant and the model" } else { "the model" };
            let expected = format!("{states} finite numbers, one for each state of {of}");
            return Err(Complaint::new("initial", format!("{initial:?}"), expected));
        }
        let reference = match &spec.reference {
            Some(name) => Some(Answers::find(name, plant.is_some(), points.len())?),
            None => None,
        };
        if let Some(name) = reference.as_ref().map(|r| r.name).filter(|name| *name != model.name) {
            let expected = format!("`{}`, the study's model", model.name);
            return Err(Complaint::new("reference", format!("`{name}`"), expected));
        }
        let mut study = Self {
            name: spec.name.clone(),
            title: spec.title.clone(),
            label: if spec.label.is_empty() { model.name } else { &spec.label }.to_owned(),
            text: spec.text.trim().to_owned(),
            model,
            model_text: sweep::text((model, &base), plant.as_ref(), &spec.sweep),
            plant: plant.map(|p| p.entry),
            input,
            input_text,
            points,
            period,
            span,
            initial,
            solvers: Vec::new(),
            steps: steps(&spec.steps, span / period)?,
            rtol: tolerances(&spec.rtol)?,
            corners: corners(&spec.corners)?,
            reference,
            budget,
            history: spec.history.clone(),
        };
        study.solvers = study.taken(&spec.solvers)?;
        study.complete()?;
        study.references_exist()?;
        Ok(study)
    }

    /// Solvers without controls would silently run nothing.
    fn complete(&self) -> Result<(), Complaint> {
        let needs = |control: &str| self.solvers.iter().any(|s| control_name(*s) == control);
        if needs("step") && self.steps.is_empty() {
            return Err(Complaint::new(
                "steps",
                "none",
                "steps per period for the fixed-step solvers",
            ));
        }
        if needs("rtol") && self.rtol.is_empty() {
            return Err(Complaint::new("rtol", "none", "tolerances for the adaptive solvers"));
        }
        let told = self.solvers.iter().any(|s| matches!(s, Method::Solver(_)));
        if told && self.corners.is_empty() {
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
            let adaptive =
                |s: &Method| matches!(s, Method::Solver(_)) && control_name(*s) == "rtol";
            let solver = self.solvers.iter().any(|s| s.name() == wanted.solver && adaptive(s));
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

    /// A reference that refuses these parameters is the experiment's mistake, not a case's. A plant's is
    /// solved when it is first asked for: that takes its time.
    fn references_exist(&self) -> Result<(), Complaint> {
        if self.reference.is_none() || self.plant.is_some() {
            return Ok(());
        }
        for point in 0..self.points.len() {
            self.exact(point).map_err(|e| Complaint::new("reference", e, "an exact answer"))?;
        }
        Ok(())
    }

    /// The exact answer at a point of the sweep.
    pub fn exact(&self, point: usize) -> Result<&Exact, String> {
        let answers = self.reference.as_ref().ok_or("a study without a reference")?;
        answers.at(self, point)
    }

    /// The study at a point of its sweep, as what a solver is run on.
    pub fn motion(&self, point: usize) -> Result<Box<dyn Motion>, String> {
        if self.plant.is_some() {
            return Ok(Box::new(self.driven(point)?));
        }
        let (model, input) = (self.model_at(&self.points[point])?, self.input.clone());
        Ok(Box::new(PrescribedMotion::new(model, input, (0.0, self.span))))
    }

    /// The study at a point of its sweep, as what a method of our own is built from.
    pub(crate) fn task(&self, point: usize) -> Result<Task, String> {
        let point = self.points.get(point).ok_or("no such point of the sweep")?;
        Ok(Task {
            model: self.model,
            parameters: point.parameters.clone(),
            plant: point.plant,
            input: self.input.clone(),
            y0: self.initial.clone(),
            span: (0.0, self.span),
        })
    }

    /// The values of a method's control; an exact one has none, and is run once.
    pub(super) fn values(&self, method: Method) -> &[f64] {
        match control_name(method) {
            "step" => &self.steps,
            "rtol" => &self.rtol,
            _ => &[0.0],
        }
    }

    /// What a method does at corners; one of our own knows them from its task.
    pub(super) fn corners_of(&self, method: Method) -> &[Corners] {
        match method {
            Method::Solver(_) => &self.corners,
            Method::Exact(_) | Method::Adaptive(_) => &[Corners::Restart],
        }
    }

    /// The plant with its model at a point.
    pub(crate) fn driven(&self, point: usize) -> Result<DrivenPlant, String> {
        let point = &self.points[point];
        let plant = point.plant.ok_or("an imposed motion where a plant is needed")?;
        Ok(DrivenPlant::new(self.model_at(point)?, plant, self.input.clone(), (0.0, self.span)))
    }

    /// What errors are taken of.
    pub fn response(&self) -> &'static str {
        match self.plant.map(|plant| plant.q_unit) {
            None => "force F",
            Some("rad") => "angle θ",
            Some(_) => "displacement q",
        }
    }

    /// Whether the steps of this case are kept.
    pub(super) fn keeps(&self, solver: Method, value: f64, corners: Corners) -> bool {
        let fits = |h: &HistorySpec| {
            h.solver == solver.name() && h.rtol == value && h.corners == corners_name(corners)
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

/// What steps are counted over, and the end of the time span.
fn span(spec: &StudySpec, input: &Input) -> Result<(f64, f64), Complaint> {
    match (spec.periods, spec.span) {
        (Some(periods), None) => {
            if !(periods > 0.0 && periods <= 1e4) {
                let expected = "above 0, at most 1e4";
                return Err(Complaint::new("periods", periods.to_string(), expected));
            }
            let period = input.period().ok_or_else(|| {
                let expected = "a periodic one, or `span` in the place of `periods`";
                Complaint::new("input.shape", "an input without a period", expected)
            })?;
            Ok((period, periods * period))
        }
        (None, Some(span)) => {
            if !(span > 0.0 && span <= 1e9) {
                let expected = "a time above 0 [s], at most 1e9";
                return Err(Complaint::new("span", span.to_string(), expected));
            }
            Ok((span, span))
        }
        (None, None) => Err(Complaint::new("periods", "none", "`periods` or `span`")),
        (Some(_), Some(_)) => {
            Err(Complaint::new("span", "`periods` besides it", "`periods` or `span`, not both"))
        }
    }
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
