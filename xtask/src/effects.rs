//! The library of effects that a model can lack.

use crate::{exit::Exit, output};
use identify::effects::{Key, LAWS, Measure, Shape};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Prints the library: for people, as JSON, or as the table in the README.
pub(crate) fn effects((as_json, markdown): (bool, bool)) -> Exit {
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
    let keys = |keys: &[Key]| -> Vec<Value> {
        let one = |key: &Key| {
            let amount = key.shape == Shape::Amount;
            json!({ "name": key.name, "units": key.measure.units(), "amount": amount, "usual": key.usual })
        };
        keys.iter().map(one).collect()
    };
    let one = |kind: &identify::effects::Kind| {
        let about = kind.about();
        json!({
            "name": about.name, "physics": about.physics, "equation": about.equation, "parameters": keys(about.keys),
            "confused_with": about.confused, "separated_by": about.separated_by,
        })
    };
    LAWS.iter().map(one).collect()
}

fn text() -> String {
    let mut text = String::new();
    for about in LAWS.iter().map(|kind| kind.about()) {
        let _ = writeln!(text, "{}\n  {}\n  {}", about.name, about.physics, about.equation);
        let keys: Vec<String> = about.keys.iter().map(parameter).collect();
        let _ = writeln!(text, "  parameters: {}", keys.join(", "));
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
        let keys: Vec<String> = about.keys.iter().map(parameter).collect();
        let equation = about.equation.replace('|', "\\|");
        let _ = writeln!(text, "| `{}` | {equation} | {} |", about.name, keys.join(", "));
    }
    text
}

/// A parameter with its units, where it slides and where it turns, and what it is if it is not told.
fn parameter(key: &Key) -> String {
    let unit = match key.measure.units() {
        _ if key.measure == Measure::Input => " [the input's unit]".to_owned(),
        ["", _] => String::new(),
        [slides, turns] if slides == turns => format!(" [{slides}]"),
        [slides, turns] => format!(" [{slides} or {turns}]"),
    };
    let usual = key.usual.filter(|_| key.shape != Shape::Spare);
    let usual = usual.map(|usual| format!(" = {usual}"));
    format!("{}{unit}{}", key.name, usual.unwrap_or_default())
}
