//! The input's table, checked.

use crate::error::{Complaint, one_of};
use duhem::{Input, PlantEntry};

/// The shapes an input may have, each with its keys besides `shape`.
const SHAPES: [(&str, &[&str]); 7] = [
    ("sine", &["amplitude", "omega"]),
    ("cosine-offset", &["amplitude", "omega"]),
    ("triangle", &["amplitude", "omega"]),
    ("staircase", &["levels", "rise_time", "hold_time"]),
    ("sequence", &["parts"]),
    ("sampled", &["t", "u"]),
    ("polyline", &["t", "u"]),
];

/// The input and how a reader would write it: the displacement u, or what drives a plant.
pub(super) fn check(
    table: &toml::Table,
    plant: Option<&PlantEntry>,
) -> Result<(Input, String), Complaint> {
    let (symbol, unit) = match plant.map(|p| p.input_unit) {
        None => ("u", "m"),
        Some("A") => ("i_m", "A"),
        Some(unit) => ("F_e", unit),
    };
    let shape = text(table, "shape")?;
    let Some((_, keys)) = SHAPES.iter().find(|(name, _)| *name == shape) else {
        let known = SHAPES.iter().map(|(name, _)| *name);
        return Err(Complaint::new("shape", format!("`{shape}`"), one_of(shape, known)));
    };
    if let Some(key) = table.keys().find(|k| *k != "shape" && !keys.contains(&k.as_str())) {
        return Err(Complaint::new(key, "an unknown key", one_of(key, keys.iter().copied())));
    }
    let refused = |e: duhem::InputError| {
        let message = e.to_string();
        let named = keys.iter().find(|key| message.contains(**key)).copied().unwrap_or("shape");
        Complaint::new(named, message, format!("what a {shape} can be made of"))
    };
    let wave = || Ok((number(table, "amplitude")?, number(table, "omega")?));
    Ok(match shape {
        "sine" => {
            let (a, omega) = wave()?;
            let input = Input::sine(a, omega).map_err(refused)?;
            (input, format!("{symbol} = {}sin({omega} t) {unit}", times(a)))
        }
        "cosine-offset" => {
            let (a, omega) = wave()?;
            let input = Input::cosine_offset(a, omega).map_err(refused)?;
            (input, format!("{symbol} = {}(cos({omega} t) − 1) {unit}", times(a)))
        }
        "triangle" => {
            let (a, omega) = wave()?;
            let input = Input::triangle(a, omega).map_err(refused)?;
            (input, format!("{symbol} = triangle wave, {a} {unit}, {omega} rad/s"))
        }
        "staircase" => {
            let (rise, hold) = (number(table, "rise_time")?, number(table, "hold_time")?);
            let levels = numbers(table, "levels")?;
            let words = format!("{symbol} = staircase of {} levels", levels.len());
            (Input::staircase(levels, rise, hold).map_err(refused)?, words)
        }
        "sequence" => sequence(table, plant)?,
        "polyline" => {
            let (t, u) = (numbers(table, "t")?, numbers(table, "u")?);
            let words = format!("{symbol} = polyline through {u:?} {unit} at {t:?} s, repeated");
            (Input::polyline(t, u).map_err(refused)?, words)
        }
        _ => {
            let (t, u) = (numbers(table, "t")?, numbers(table, "u")?);
            let words = format!("{symbol} = {} samples", t.len());
            (Input::sampled(t, u).map_err(refused)?, words)
        }
    })
}

/// An amplitude as a factor; 1 is not written.
fn times(amplitude: f64) -> String {
    if amplitude == 1.0 { String::new() } else { format!("{amplitude} ") }
}

fn sequence(table: &toml::Table, plant: Option<&PlantEntry>) -> Result<(Input, String), Complaint> {
    let list = table.get("parts").and_then(toml::Value::as_array);
    let list = list.ok_or_else(|| Complaint::new("parts", "none", "a list of inputs"))?;
    let (mut parts, mut words) = (Vec::new(), Vec::new());
    for (i, part) in list.iter().enumerate() {
        let under = |c: Complaint| c.under(&format!("parts[{i}]"));
        let mut part = part
            .as_table()
            .cloned()
            .ok_or_else(|| under(Complaint::new("", part.to_string(), "a table")))?;
        let duration = number(&part, "duration").map_err(under)?;
        part.remove("duration");
        let (input, text) = check(&part, plant).map_err(under)?;
        words.push(format!("{text} for {duration} s"));
        parts.push((input, duration));
    }
    let input = Input::sequence(parts)
        .map_err(|e| Complaint::new("parts", e.to_string(), "parts that join"))?;
    Ok((input, words.join(", then ")))
}

/// The text under `key`.
pub(super) fn text<'a>(table: &'a toml::Table, key: &str) -> Result<&'a str, Complaint> {
    let value = table.get(key).ok_or_else(|| Complaint::new(key, "none", "a text"))?;
    value.as_str().ok_or_else(|| Complaint::new(key, value.to_string(), "a text"))
}

fn number(table: &toml::Table, key: &str) -> Result<f64, Complaint> {
    let value = table.get(key).ok_or_else(|| Complaint::new(key, "none", "a number"))?;
    as_number(value).ok_or_else(|| Complaint::new(key, value.to_string(), "a number"))
}

fn numbers(table: &toml::Table, key: &str) -> Result<Vec<f64>, Complaint> {
    let value = table.get(key).and_then(toml::Value::as_array);
    let list = value.ok_or_else(|| Complaint::new(key, "none", "a list of numbers"))?;
    list.iter()
        .map(|v| as_number(v).ok_or_else(|| Complaint::new(key, v.to_string(), "a number")))
        .collect()
}

/// A TOML number as f64; whole numbers are numbers too.
#[expect(clippy::cast_precision_loss, reason = "parameters are far below 2^53")]
pub(super) fn as_number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}
