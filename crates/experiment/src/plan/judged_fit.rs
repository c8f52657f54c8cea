//! What is measured and judged of a fit, as checked.

use super::{
    Fit, input,
    judged::{Decision, Measure, Subject},
};
use crate::{
    checks::CHECKS,
    error::{Complaint, one_of},
    quantities::{
        OF_A_FIT, QUANTITIES,
        fit::{PARAMETER, SPRING},
    },
    spec::MeasureSpec,
};
use std::collections::BTreeMap;

/// A quantity of a fit: `what` names it, `of` what of the fit is meant, and what it takes.
pub(super) fn measure(
    written: &MeasureSpec,
    (index, fit): (usize, &Fit),
) -> Result<Measure, Complaint> {
    let name = input::text(&written.what, "quantity").map_err(|c| c.under("what"))?;
    let of_fits = || QUANTITIES.iter().filter(|q| q.model == OF_A_FIT);
    let quantity = of_fits().find(|q| q.name == name).ok_or_else(|| {
        let expected = one_of(name, of_fits().map(|q| q.name));
        Complaint::new("what.quantity", format!("`{name}`"), expected)
    })?;
    let subject = subject(&written.what, ("quantity", "of", quantity.takes), index);
    let subject = subject.map_err(|c| c.under("what"))?;
    let mut unit = quantity
        .unit_of(identify::rig::Kind::of(fit.rig.kind).is_some_and(identify::rig::Kind::turns));
    if quantity.unit == SPRING {
        unit = "N/m";
    }
    if quantity.unit == PARAMETER {
        if !fit.rig.free_parameters().contains(&subject.expect) {
            let free = fit.rig.free_parameters();
            let expected = one_of(&subject.expect, free.iter().map(String::as_str));
            return Err(Complaint::new("what.of", format!("`{}`", subject.expect), expected));
        }
        unit = match fit.rig.unit(&subject.expect) {
            "" => "1",
            unit => unit,
        };
    }
    if written.unit != unit {
        let expected = format!("`{unit}`, the unit of {name} {}", subject.expect);
        return Err(Complaint::new("unit", format!("`{}`", written.unit), expected));
    }
    Ok(Measure { id: written.id.clone(), unit: unit.to_owned(), subject, quantity })
}

/// A check of a fit.
pub(super) fn check(table: &toml::Table, index: usize) -> Result<Decision, Complaint> {
    let name = input::text(table, "name")?;
    let of_fits = || CHECKS.iter().filter(|c| c.model == OF_A_FIT);
    let check = of_fits().find(|c| c.name == name).ok_or_else(|| {
        Complaint::new("name", format!("`{name}`"), one_of(name, of_fits().map(|c| c.name)))
    })?;
    let subject = subject(table, ("name", "expect", check.takes), index)?;
    let expect = subject.expect.as_str();
    if !check.expects.is_empty() && !check.expects.contains(&expect) {
        let expected = one_of(expect, check.expects.iter().copied());
        return Err(Complaint::new("expect", format!("`{expect}`"), expected));
    }
    Ok(Decision::Check(check, subject))
}

/// What a table says besides its own name: which of the fit is meant, and the numbers that are taken.
fn subject(
    table: &toml::Table,
    (own, meant, takes): (&str, &str, &[&str]),
    index: usize,
) -> Result<Subject, Complaint> {
    let expect = if table.contains_key(meant) { input::text(table, meant)? } else { "" };
    let mut arguments = BTreeMap::new();
    for (key, value) in table.iter().filter(|(k, _)| ![own, meant, "study"].contains(&k.as_str())) {
        let known = takes.iter().copied().chain([meant]);
        if !takes.contains(&key.as_str()) {
            return Err(Complaint::new(key, "an unknown key", one_of(key, known)));
        }
        let number = input::as_number(value)
            .ok_or_else(|| Complaint::new(key, value.to_string(), "a number"))?;
        arguments.insert(key.clone(), vec![number]);
    }
    if let Some(key) = takes.iter().find(|key| !arguments.contains_key(**key)) {
        return Err(Complaint::new(*key, "nothing", "a number"));
    }
    Ok(Subject {
        study: index,
        of_fit: true,
        points: vec![0],
        expect: expect.to_owned(),
        arguments,
    })
}
