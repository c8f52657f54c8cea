//! What is measured and judged, as checked.

use super::{Known, Point, Study, input, judged_record as of_record, methods, study};
use crate::{
    checks::{CHECKS, Check},
    error::{Complaint, one_of},
    quantities::{QUANTITIES, Quantity},
    spec::{ClaimSpec, IrreproducibleSpec, PrintedSpec, Spec},
};
use integrate::Corners;
use simulation::Method;
use std::collections::{BTreeMap, BTreeSet};

/// Among what a subject's index counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whose {
    /// The studies.
    Study,
    /// The fits.
    Fit,
    /// The searches for what a model lacks.
    Discovery,
}

/// What a quantity or a check is taken of: a study at some points of its sweep.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The index of the study, the fit or the search.
    pub study: usize,
    /// Which of them it is.
    pub of: Whose,
    /// The points' indices; all of them if none was named.
    pub points: Vec<usize>,
    /// What a check is told to expect, and what of a fit or a search is meant; empty if it needs no telling.
    pub expect: String,
    /// The numbers that a quantity or a check takes besides, by their keys.
    pub arguments: BTreeMap<String, Vec<f64>>,
}

impl Subject {
    /// So many numbers under a key that the quantity or check takes.
    pub fn argument<const N: usize>(&self, key: &str) -> Result<[f64; N], String> {
        let given = self.arguments.get(key).map_or(&[][..], Vec::as_slice);
        given.try_into().map_err(|_| format!("{key} = {given:?}: expected {N} numbers"))
    }
}

/// One quantity to measure.
#[derive(Debug)]
pub struct Measure {
    /// Its id.
    pub id: String,
    /// Its unit.
    pub unit: String,
    /// What it is taken of.
    pub subject: Subject,
    /// How.
    pub quantity: &'static Quantity,
}

/// What decides a claim.
#[derive(Debug)]
pub enum Decision {
    /// A measure, by its index, against the printed number.
    Measure(usize),
    /// A check of a sentence.
    Check(&'static Check, Subject),
    /// Nothing: it is an impression, or what it needs was never published.
    Nothing,
}

/// One sentence of the paper to judge.
#[derive(Debug)]
pub struct Claim {
    /// As written.
    pub written: ClaimSpec,
    /// The printed number.
    pub printed: Option<PrintedSpec>,
    /// What decides it.
    pub decision: Decision,
}

/// Rows whose numbers are not reproducible by nature.
#[derive(Debug)]
pub struct Irreproducible {
    /// A short name, for the rows.
    pub name: String,
    /// The reason.
    pub why: String,
    /// Whether not even the status is reproducible.
    pub any_status: bool,
    /// The studies' indices, each with the points meant.
    places: Vec<(usize, BTreeSet<String>)>,
    solvers: Vec<Method>,
    corners: Vec<Corners>,
}

impl Irreproducible {
    /// Whether a row is meant.
    pub fn covers(
        &self,
        (study, point): (usize, &Point),
        solver: Method,
        corners: Corners,
    ) -> bool {
        self.places.iter().any(|(s, points)| *s == study && points.contains(&point.label))
            && (self.solvers.is_empty() || self.solvers.iter().any(|s| s.name() == solver.name()))
            && (self.corners.is_empty() || self.corners.contains(&corners))
    }
}

pub(super) struct Judged {
    pub(super) measures: Vec<Measure>,
    pub(super) claims: Vec<Claim>,
    pub(super) irreproducible: Vec<Irreproducible>,
}

pub(super) fn check(spec: &Spec, all: Known<'_>) -> Result<Judged, Complaint> {
    let measures = measures(spec, all)?;
    let mut claims = Vec::new();
    for (i, written) in spec.claim.iter().enumerate() {
        for id in crate::judge::placeholders(&written.why) {
            known(spec, id).map_err(|c| c.under(&format!("claim[{i}].why")))?;
        }
        if !written.figure.is_empty() && !spec.figure.iter().any(|f| f.name == written.figure) {
            let known = spec.figure.iter().map(|f| f.name.as_str());
            let expected = one_of(&written.figure, known);
            let key = format!("claim[{i}].figure");
            return Err(Complaint::new(key, format!("`{}`", written.figure), expected));
        }
        let claim = claim(written, &measures, all);
        claims.push(claim.map_err(|c| c.under(&format!("claim[{i}]")))?);
    }
    let mut seen = BTreeSet::new();
    if let Some(i) = spec.claim.iter().position(|c| !super::plain(&c.id) || !seen.insert(&c.id)) {
        let found = format!("`{}`", spec.claim[i].id);
        return Err(Complaint::new(format!("claim[{i}].id"), found, "a plain id of its own"));
    }
    let mut rules = Vec::new();
    for (i, written) in spec.irreproducible.iter().enumerate() {
        let rule = irreproducible(written, all.studies);
        rules.push(rule.map_err(|c| c.under(&format!("irreproducible[{i}]")))?);
    }
    Ok(Judged { measures, claims, irreproducible: rules })
}

/// The quantities to measure, each looked up for its study's model.
fn measures(spec: &Spec, all: Known<'_>) -> Result<Vec<Measure>, Complaint> {
    let studies = all.studies;
    let mut measures: Vec<Measure> = Vec::new();
    for (i, written) in spec.measure.iter().enumerate() {
        let under = |c: Complaint| c.under(&format!("measure[{i}]"));
        if !super::plain(&written.id) || measures.iter().any(|m| m.id == written.id) {
            let found = format!("`{}`", written.id);
            return Err(under(Complaint::new("id", found, "a plain id of its own")));
        }
        if let Some(measure) = of_record::measure(written, all) {
            measures.push(measure.map_err(under)?);
            continue;
        }
        let mut what = written.what.clone();
        what.insert("study".to_owned(), written.study.clone().into());
        let name = input::text(&written.what, "quantity").map_err(|c| under(c.under("what")))?;
        let study = input::text(&what, "study").map_err(|c| under(c.under("what")))?;
        let model = studies[find_study(study, studies).map_err(under)?].model.name;
        let quantity =
            named(QUANTITIES, |q| (q.name, q.model), (name, model)).ok_or_else(|| {
                let known = QUANTITIES.iter().map(|q| q.name);
                under(Complaint::new("what.quantity", format!("`{name}`"), one_of(name, known)))
            })?;
        let subject = subject(&what, ("quantity", quantity.takes), studies)
            .map_err(|c| under(c.under("what")))?;
        if subject.points.len() != 1 {
            let found = format!("{} points of the sweep", subject.points.len());
            return Err(under(Complaint::new(
                "what",
                found,
                "one: name a value of each swept parameter",
            )));
        }
        made_for(quantity.model, &studies[subject.study]).map_err(|c| under(c.under("what")))?;
        let unit = quantity.unit_in(&studies[subject.study]);
        if written.unit != unit {
            let expected = format!("`{unit}`, the unit of {}", quantity.name);
            return Err(under(Complaint::new("unit", format!("`{}`", written.unit), expected)));
        }
        let (id, unit) = (written.id.clone(), written.unit.clone());
        measures.push(Measure { id, unit, subject, quantity });
    }
    Ok(measures)
}

/// Whether a text may ask for this measure's value.
pub(super) fn known(spec: &Spec, id: &str) -> Result<(), Complaint> {
    let ids = || spec.measure.iter().map(|m| m.id.as_str());
    let found = ids().any(|known| known == id);
    found.then_some(()).ok_or_else(|| Complaint::new("", format!("{{{id}}}"), one_of(id, ids())))
}

fn find_study(name: &str, studies: &[Study]) -> Result<usize, Complaint> {
    studies.iter().position(|s| s.name == name).ok_or_else(|| {
        let known = studies.iter().map(|s| s.name.as_str());
        Complaint::new("study", format!("`{name}`"), one_of(name, known))
    })
}

/// The study and the points that a table names: but for what the quantity or check takes, every other key is a
/// swept parameter, with one value or a list.
fn subject(
    table: &toml::Table,
    (other, takes): (&str, &[&str]),
    studies: &[Study],
) -> Result<Subject, Complaint> {
    let index = find_study(input::text(table, "study")?, studies)?;
    let expect = if table.contains_key("expect") { input::text(table, "expect")? } else { "" };
    let (mut select, mut arguments) = (BTreeMap::new(), BTreeMap::new());
    for (key, value) in
        table.iter().filter(|(key, _)| !["study", "expect", other].contains(&key.as_str()))
    {
        let one = |v| input::as_number(v).map(|number| vec![number]);
        let list = value.as_array().map(|l| l.iter().map(input::as_number).collect());
        let numbers: Option<Vec<f64>> = list.unwrap_or_else(|| one(value));
        let numbers = numbers.ok_or_else(|| {
            Complaint::new(key, value.to_string(), "a number of the sweep, or a list")
        })?;
        let taken = takes.contains(&key.as_str());
        let place = if taken { &mut arguments } else { &mut select };
        place.insert(key.clone(), numbers);
    }
    if let Some(key) = takes.iter().find(|key| !arguments.contains_key(**key)) {
        return Err(Complaint::new(*key, "nothing", "a number, or a list"));
    }
    let study = &studies[index];
    let chosen = study.selected(&select)?;
    let place = |label: &str| study.points.iter().position(|p| p.label == label);
    let points = chosen.iter().filter_map(|point| place(&point.label)).collect();
    let of = Whose::Study;
    Ok(Subject { study: index, of, points, expect: expect.to_owned(), arguments })
}

fn claim(written: &ClaimSpec, measures: &[Measure], all: Known<'_>) -> Result<Claim, Complaint> {
    let ids = || measures.iter().map(|m| m.id.as_str());
    let find = |key: &str, id: &str| {
        measures
            .iter()
            .position(|m| m.id == id)
            .ok_or_else(|| Complaint::new(key, format!("`{id}`"), one_of(id, ids())))
    };
    let decision = match (&written.measure, &written.check) {
        (Some(id), None) => Decision::Measure(find("measure", id)?),
        (None, Some(table)) => decided(table, all).map_err(|complaint| complaint.under("check"))?,
        (None, None) if written.qualitative || written.under_specified.is_some() => {
            Decision::Nothing
        }
        _ => return Err(Complaint::new("", "both or neither", "a `measure` or a `check`")),
    };
    match (&decision, &written.printed) {
        (Decision::Measure(index), Some(number)) => {
            printed(number, &measures[*index]).map_err(|c| c.under("printed"))?;
        }
        (Decision::Check(..) | Decision::Nothing, None) => {}
        _ => {
            let expected = "a printed number with a `measure`, none with a `check`";
            return Err(Complaint::new("printed", "this", expected));
        }
    }
    Ok(Claim { written: written.clone(), printed: written.printed.clone(), decision })
}

/// The check that a claim names, told what it needs.
fn decided(table: &toml::Table, all: Known<'_>) -> Result<Decision, Complaint> {
    let (study, studies) = (input::text(table, "study")?, all.studies);
    if let Some(check) = of_record::check(table, study, all) {
        return check;
    }
    let name = input::text(table, "name")?;
    let model = studies[find_study(study, studies)?].model.name;
    let check = named(CHECKS, |c| (c.name, c.model), (name, model)).ok_or_else(|| {
        let known = CHECKS.iter().map(|c| c.name);
        Complaint::new("name", format!("`{name}`"), one_of(name, known))
    })?;
    let subject = subject(table, ("name", check.takes), studies)?;
    told(check, &subject, &studies[subject.study])?;
    Ok(Decision::Check(check, subject))
}

/// The entry of this name made for this model, or else the first of this name: one name may stand for
/// the same thing in several models.
fn named<T>(
    list: &'static [T],
    names: fn(&T) -> (&'static str, &'static str),
    (name, model): (&str, &str),
) -> Option<&'static T> {
    let called = || list.iter().filter(|entry| names(entry).0 == name);
    let made = |entry: &&T| ["", model].contains(&names(entry).1);
    called().find(made).or_else(|| called().next())
}

/// Whether a quantity or a check is made for the study's model.
fn made_for(model: &str, study: &Study) -> Result<(), Complaint> {
    if model.is_empty() || model == study.model.name {
        return Ok(());
    }
    let found = format!("`{}`, whose model is {}", study.name, study.model.name);
    Err(Complaint::new("study", found, format!("a study of the {model} model")))
}

/// Whether a check is told what it needs, no more and no less.
fn told(check: &Check, subject: &Subject, study: &Study) -> Result<(), Complaint> {
    made_for(check.model, study)?;
    if !check.many && subject.points.len() != 1 {
        let found = format!("{} points of the sweep", subject.points.len());
        return Err(Complaint::new("", found, "one: name a value of each swept parameter"));
    }
    let expect = subject.expect.as_str();
    match (check.expects.is_empty(), check.expects.contains(&expect)) {
        (true, _) if !expect.is_empty() => Err(Complaint::new(
            "expect",
            format!("`{expect}`"),
            "none: this check needs no telling",
        )),
        (false, false) => {
            let expected = one_of(expect, check.expects.iter().copied());
            Err(Complaint::new("expect", format!("`{expect}`"), expected))
        }
        _ => Ok(()),
    }
}

/// Whether a printed number can be compared with the measure.
fn printed(number: &PrintedSpec, measure: &Measure) -> Result<(), Complaint> {
    if !(number.value.is_finite() && number.value != 0.0) {
        return Err(Complaint::new("value", number.value.to_string(), "a finite number, not zero"));
    }
    if !(1..=17).contains(&number.digits) {
        let expected = "how many significant digits are printed, from 1 to 17";
        return Err(Complaint::new("digits", number.digits.to_string(), expected));
    }
    if number.unit != measure.unit {
        let expected = format!("`{}`, the unit of {}", measure.unit, measure.id);
        return Err(Complaint::new("unit", format!("`{}`", number.unit), expected));
    }
    Ok(())
}

fn irreproducible(
    spec: &IrreproducibleSpec,
    studies: &[Study],
) -> Result<Irreproducible, Complaint> {
    let mut places = Vec::new();
    for (i, name) in spec.studies.iter().enumerate() {
        let index = find_study(name, studies).map_err(|mut c| {
            c.key = format!("studies[{i}]");
            c
        })?;
        let points = studies[index].selected(&spec.select).map_err(|c| c.under("select"))?;
        places.push((index, points.into_iter().map(|p| p.label.clone()).collect()));
    }
    Ok(Irreproducible {
        name: spec.name.clone(),
        why: spec.why.trim().to_owned(),
        any_status: spec.any_status,
        places,
        solvers: methods::named(&spec.solvers)?,
        corners: study::corners(&spec.corners)?,
    })
}
