//! The library of effects that a model can lack.

use crate::{exit::Exit, output};
use identify::effects::{About, Key, LAWS, Measure, Shape};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Prints the library: for people, as JSON, or as the table in the README.
pub(crate) fn effects(as_json: bool, markdown: bool) -> Exit {
    if as_json {
        output::line(&format!("{:#}", json!({ "format": record::FORMAT, "effects": all() })));
    } else if markdown {
        output::line(table().trim_end());
    } else {
        output::line(text().trim_end());
    }
    Exit::Done
}

fn all() -> Vec<Value> {
    let key = |key: &Key| {
        let amount = key.shape == Shape::Amount;
        json!({ "name": key.name, "unit": unit(key), "amount": amount, "usual": key.usual })
    };
    let one = |about: &About| {
        json!({
            "name": about.name, "physics": about.physics, "equation": about.equation,
            "parameters": about.keys.iter().map(key).collect::<Vec<Value>>(),
            "confused_with": about.confused, "separated_by": about.separated_by,
        })
    };
    LAWS.iter().map(|kind| one(kind.about())).collect()
}

fn text() -> String {
    let mut text = String::new();
    for about in LAWS.iter().map(|kind| kind.about()) {
        let _ = writeln!(text, "{}\n  {}\n  {}", about.name, about.physics, about.equation);
        let _ = writeln!(text, "  parameters: {}", parameters(about));
        if !about.confused.is_empty() {
            let confused = about.confused.join(", ");
            let _ = writeln!(text, "  confused with {confused}; apart by {}", about.separated_by);
        }
    }
    text
}

/// The library as the README shows it.
pub(crate) fn table() -> String {
    let mut text = String::from("| effect | what it changes | parameters |\n|---|---|---|\n");
    for about in LAWS.iter().map(|kind| kind.about()) {
        let equation = about.equation.replace('|', "\\|");
        let _ = writeln!(text, "| `{}` | {equation} | {} |", about.name, parameters(about));
    }
    text
}

/// The parameters of an effect with their units, and what they are if they are not told.
fn parameters(about: &About) -> String {
    let one = |key: &Key| {
        let unit = unit(key);
        let unit = if unit.is_empty() { unit } else { format!(" [{unit}]") };
        let usual = key.usual.filter(|_| key.shape != Shape::Spare);
        let usual = usual.map(|usual| format!(" = {usual}"));
        format!("{}{unit}{}", key.name, usual.unwrap_or_default())
    };
    about.keys.iter().map(one).collect::<Vec<String>>().join(", ")
}

/// The unit of a parameter, where it slides and where it turns; none of a pure number.
fn unit(key: &Key) -> String {
    match key.measure.units() {
        _ if key.measure == Measure::Input => "the input's unit".to_owned(),
        [slides, turns] if slides == turns => slides.to_owned(),
        [slides, turns] => format!("{slides} or {turns}"),
    }
}
