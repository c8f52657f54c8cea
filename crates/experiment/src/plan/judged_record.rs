//! What is measured and judged of a record, by a fit or by a search for what its model lacks, as checked.

use super::{
    Discovery, Fit, Known, input,
    judged::{Decision, Measure, Subject, Whose},
};
use crate::{
    checks::CHECKS,
    error::{Complaint, one_of},
    quantities::{CHANNEL, OF_A_DISCOVERY, OF_A_FIT, PARAMETER, QUANTITIES, Quantity, SPRING},
    spec::MeasureSpec,
};
use identify::{Rig, effects, rig::Kind};
use std::collections::BTreeMap;

/// A fit or a search by its name.
struct Named<'a> {
    of: Whose,
    index: usize,
    rig: &'a Rig,
}

impl<'a> Named<'a> {
    fn find(name: &str, all: Known<'a>) -> Option<Self> {
        let fit = |index: usize| Self { of: Whose::Fit, index, rig: &all.fits[index].rig };
        let search = |index: usize| {
            let rig = &all.discoveries[index].source.rig;
            Self { of: Whose::Discovery, index, rig }
        };
        let fits = |f: &Fit| f.name == name;
        let searches = |d: &Discovery| d.name == name;
        all.fits
            .iter()
            .position(fits)
            .map(fit)
            .or_else(|| all.discoveries.iter().position(searches).map(search))
    }

    /// The model of the quantities and checks that are made for it.
    fn model(&self) -> &'static str {
        if self.of == Whose::Discovery { OF_A_DISCOVERY } else { OF_A_FIT }
    }
}

/// A quantity of a fit or a search, if `written` is of one: `what` names it, `of` what of it is meant, and what it
/// takes.
pub(super) fn measure(written: &MeasureSpec, all: Known<'_>) -> Option<Result<Measure, Complaint>> {
    Named::find(&written.study, all).map(|named| measure_of(written, &named))
}

fn measure_of(written: &MeasureSpec, named: &Named<'_>) -> Result<Measure, Complaint> {
    let name = input::text(&written.what, "quantity").map_err(|c| c.under("what"))?;
    let of_these = || QUANTITIES.iter().filter(|q| q.model == named.model());
    let quantity = of_these().find(|q| q.name == name).ok_or_else(|| {
        let expected = one_of(name, of_these().map(|q| q.name));
        Complaint::new("what.quantity", format!("`{name}`"), expected)
    })?;
    let subject = subject(&written.what, ("quantity", "of", quantity.takes), named);
    let subject = subject.map_err(|c| c.under("what"))?;
    let unit = unit(quantity, &subject.expect, named.rig)?;
    if written.unit != unit {
        let expected = format!("`{unit}`, the unit of {name} {}", subject.expect);
        return Err(Complaint::new("unit", format!("`{}`", written.unit), expected));
    }
    Ok(Measure { id: written.id.clone(), unit: unit.to_owned(), subject, quantity })
}

/// The unit of a quantity, where it is that of the parameter, the effect's value or the channel that is meant.
fn unit(quantity: &Quantity, of: &str, rig: &Rig) -> Result<&'static str, Complaint> {
    let kind = Kind::of(rig.kind);
    let unknown = |expected: String| Complaint::new("what.of", format!("`{of}`"), expected);
    let unit = match quantity.unit {
        SPRING => "N/m",
        PARAMETER if quantity.model == OF_A_DISCOVERY => value_unit(of, rig).ok_or_else(|| {
            unknown(format!(
                "EFFECT.VALUE, the effect {}",
                one_of(of, effects::NAMES.iter().copied())
            ))
        })?,
        PARAMETER => {
            let free = rig.free_parameters();
            if !free.iter().any(|name| name == of) {
                return Err(unknown(one_of(of, free.iter().map(String::as_str))));
            }
            rig.unit(of)
        }
        CHANNEL => {
            let found = kind.and_then(|kind| kind.channel(of)?.dimensions.first());
            found.ok_or_else(|| unknown("a channel of the record".to_owned()))?.si()
        }
        _ => quantity.unit_of(kind.is_some_and(Kind::turns)),
    };
    Ok(if unit.is_empty() { "1" } else { unit })
}

/// The unit of a value of an effect, written as `current_bias.bias`.
fn value_unit(of: &str, rig: &Rig) -> Option<&'static str> {
    let (effect, key) = of.split_once('.')?;
    let about = effects::Kind::named(effect)?.about();
    about.keys.iter().any(|known| known.name == key).then(|| about.unit(key, rig))
}

/// A check of a fit or a search, if `study` is one.
pub(super) fn check(
    table: &toml::Table,
    study: &str,
    all: Known<'_>,
) -> Option<Result<Decision, Complaint>> {
    Named::find(study, all).map(|named| check_of(table, &named))
}

fn check_of(table: &toml::Table, named: &Named<'_>) -> Result<Decision, Complaint> {
    let name = input::text(table, "name")?;
    let of_these = || CHECKS.iter().filter(|c| c.model == named.model());
    let check = of_these().find(|c| c.name == name).ok_or_else(|| {
        Complaint::new("name", format!("`{name}`"), one_of(name, of_these().map(|c| c.name)))
    })?;
    let subject = subject(table, ("name", "expect", check.takes), named)?;
    let expect = subject.expect.as_str();
    if !check.expects.is_empty() && !check.expects.contains(&expect) {
        let expected = one_of(expect, check.expects.iter().copied());
        return Err(Complaint::new("expect", format!("`{expect}`"), expected));
    }
    Ok(Decision::Check(check, subject))
}

/// What a table says besides its own name: what is meant, and the numbers that are taken.
fn subject(
    table: &toml::Table,
    (own, meant, takes): (&str, &str, &[&str]),
    named: &Named<'_>,
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
        study: named.index,
        of: named.of,
        points: vec![0],
        expect: expect.to_owned(),
        arguments,
    })
}
