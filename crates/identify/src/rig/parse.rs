//! From the text of a rig file to the rig.

use super::tables::{Table, line_of};
use super::{
    Channel, Controller, EFFECTS, Effect, Friction, Hold, KINDS, Kind, PlantKey, Rig, RigError,
    Shaft, parameters, units,
};
use duhem::{MODELS, ModelEntry, Parameter, Parameters};
use std::collections::BTreeMap;
use toml::de::DeTable;

/// The longest rig file [bytes].
const LONGEST: usize = 1 << 20;

/// The most elements in a list.
const ELEMENTS: usize = 1000;

const TABLES: &[&str] = &["title", "plant", "friction", "fit", "channels", "controller", "effect"];

impl Rig {
    /// The rig that a rig file declares.
    ///
    /// The format stands at the head of [`crate::rig`]. Fails on a text that is not TOML or longer than 1 MiB, on an
    /// unknown key or name, on a key that is missing and on a value that cannot be meant; the error names
    /// the line, the key, what was found and what was expected.
    pub fn parse(text: &str) -> Result<Self, RigError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let document = document(text)?;
        let file = Table { text, name: "the rig file", line: 1, entries: document.get_ref() };
        file.only(TABLES)?;
        let needed = |key: &'static str, name| {
            file.table(key, name)?.ok_or_else(|| file.missing(key, "a table"))
        };
        let plant = needed("plant", "[plant]")?;
        let kind = kind(&plant)?;
        let channels = needed("channels", "[channels]")?;
        let mut rig = Self {
            title: file.get("title", "a text")?.text("a text")?.to_owned(),
            kind: kind.name,
            plant: BTreeMap::new(),
            friction: friction(&needed("friction", "[friction]")?, kind)?,
            free: Vec::new(),
            channels: read_channels(&channels, kind)?,
            controller: file.table("controller", "[controller]")?.map(controller).transpose()?,
            effects: Vec::new(),
        };
        rig.plant = plant_values(&plant, kind, &rig.channels)?;
        rig.effects = effects(&file, &rig)?;
        if rig.controller.is_some() && !rig.channels.contains_key("reference") {
            let expected = "the column of the reference that the controller followed";
            return Err(channels.missing("reference", expected));
        }
        if let Some(fit) = file.table("fit", "[fit]")? {
            rig.free = free(&fit, &rig)?;
        }
        rig.tie();
        Ok(rig)
    }
}

fn document(text: &str) -> Result<toml::Spanned<DeTable<'_>>, RigError> {
    if text.len() > LONGEST {
        let found = format!("a text of {} bytes, above the {LONGEST} allowed", text.len());
        return Err(RigError::Syntax { line: None, found });
    }
    DeTable::parse(text).map_err(|e| RigError::Syntax {
        line: e.span().map(|span| line_of(text, span.start)),
        found: super::error::quoted(e.message()).trim_matches('"').replace("\\'", "'"),
    })
}

fn kind(plant: &Table) -> Result<&'static Kind, RigError> {
    let known: Vec<&str> = KINDS.iter().map(|k| k.name).collect();
    let expected = format!("a kind of plant: {}", known.join(", "));
    let item = plant.get("kind", &expected)?;
    let name = item.text(&expected)?;
    Kind::of(name).ok_or_else(|| RigError::unknown(Some(item.line), "kind of plant", name, &known))
}

/// The plant's values; a `gain` belongs to a voltage and only to it.
fn plant_values(
    plant: &Table,
    kind: &Kind,
    channels: &BTreeMap<String, Channel>,
) -> Result<BTreeMap<String, f64>, RigError> {
    let keys: Vec<&str> = kind.keys.iter().map(|k| k.key).collect();
    plant.only(&[&["kind"], keys.as_slice()].concat())?;
    let mut values = BTreeMap::new();
    for PlantKey { key, unit, range, required } in kind.keys {
        let expected = parameters::expected(range.bounds(), range.words(), unit);
        let gain = *key == "gain";
        let voltage = channels.contains_key("voltage");
        let value = match plant.find(key) {
            Some(item) if gain && !voltage => {
                return Err(item.invalid("no gain, as the drive is a force and not a voltage"));
            }
            Some(item) => {
                let value = item.number(&expected)?;
                let (low, high) = range.bounds();
                if !(low..=high).contains(&value) {
                    return Err(item.invalid(&expected));
                }
                value
            }
            None if *required || gain && voltage => return Err(plant.missing(key, &expected)),
            None if gain => continue,
            None => 0.0,
        };
        values.insert((*key).to_owned(), value);
    }
    Ok(values)
}

/// What a friction parameter is if the file does not say it.
const DEFAULTS: &[(&str, &str, f64)] = &[("dahl", "gamma", 1.0), ("lugre", "sigma_2", 0.0)];

fn friction(table: &Table, kind: &Kind) -> Result<Friction, RigError> {
    let known: Vec<&str> = MODELS.iter().map(|m| m.name).chain(["none"]).collect();
    let expected = format!("a friction model: {}", known.join(", "));
    let item = table.get("name", &expected)?;
    let name = item.text(&expected)?;
    let model = MODELS.iter().find(|m| m.name == name);
    if model.is_none() && name != "none" {
        return Err(RigError::unknown(Some(item.line), "friction model", name, &known));
    }
    let keys = model.map_or(&[][..], |m| m.keys);
    let own = keys.contains(&"sigma_2");
    let viscous: &[&str] = if own { &[] } else { &["sigma_2"] };
    table.only(&[&["name"], keys, viscous].concat())?;
    let mut friction =
        Friction { name: name.to_owned(), parameters: Parameters::default(), sigma_2: 0.0 };
    if let Some(model) = model {
        friction.parameters = model_parameters(table, kind, model)?;
    }
    if let (Some(item), false) = (table.find("sigma_2"), own) {
        let (low, high) = super::Range::NotNegative.bounds();
        let unit = kind.friction_unit("N·s/m");
        let expected = parameters::expected((low, high), "a finite number", unit);
        friction.sigma_2 = item.number(&expected)?;
        if !(low..=high).contains(&friction.sigma_2) {
            return Err(item.invalid(&expected));
        }
    }
    Ok(friction)
}

fn model_parameters(
    table: &Table,
    kind: &Kind,
    model: &ModelEntry,
) -> Result<Parameters, RigError> {
    let mut values = Parameters::default();
    for (key, unit) in model.keys.iter().zip(model.units) {
        let unit = kind.friction_unit(unit);
        let default = DEFAULTS.iter().find(|(m, k, _)| m == &model.name && k == key);
        let value = match (table.find(key), default) {
            (Some(item), _) if item.value.as_array().is_some_and(|list| list.len() > ELEMENTS) => {
                return Err(item.invalid(&format!("a list of at most {ELEMENTS}")));
            }
            (Some(item), _) if item.value.is_array() => {
                Parameter::List(item.numbers(&format!("a list of numbers [{unit}]"))?)
            }
            (Some(item), _) => {
                let (low, high) = parameters::model_bounds(model.name, key);
                let expected = parameters::expected((low, high), "a finite number", unit);
                let value = item.number(&expected)?;
                if !(low..=high).contains(&value) {
                    return Err(item.invalid(&expected));
                }
                Parameter::Scalar(value)
            }
            (None, Some((_, _, value))) => Parameter::Scalar(*value),
            (None, None) => return Err(table.missing(key, &format!("a number [{unit}]"))),
        };
        values.0.insert((*key).to_owned(), value);
    }
    // The model has the last word: lists of unlike lengths, elements that are not positive.
    (model.build)(&values).map_err(|error| {
        let item = table.find(error.key());
        let found = match &values.0.get(error.key()) {
            Some(Parameter::List(list)) => format!("{list:?}"),
            Some(Parameter::Scalar(value)) => value.to_string(),
            None => "nothing".to_owned(),
        };
        let expected = match &error {
            duhem::ParameterError::Invalid { expected, .. }
            | duhem::ParameterError::Missing { expected, .. }
            | duhem::ParameterError::Unknown { expected, .. } => expected.clone(),
        };
        let line = item.map(|item| item.line);
        RigError::Invalid { line, key: error.key().to_owned(), found, expected }
    })?;
    Ok(values)
}

fn free(fit: &Table, rig: &Rig) -> Result<Vec<String>, RigError> {
    fit.only(&["free"])?;
    let expected = "a list of names of parameters";
    let Some(item) = fit.find("free") else { return Ok(Vec::new()) };
    let known = rig.parameters();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let (mut names, mut all) = (Vec::new(), Vec::new());
    let texts = item.texts(fit.text, expected)?;
    // Who names an element 0 counts from there.
    let from_zero = texts.iter().any(|(_, name)| name.ends_with("[0]"));
    for (line, written) in texts {
        let counted = if from_zero { one_later(written) } else { None };
        let name = counted.as_deref().unwrap_or(written);
        let elements = rig.expand(name);
        if elements.is_empty() {
            return Err(RigError::unknown(Some(line), "parameter", written, &known));
        }
        if elements.iter().any(|element| all.contains(element)) {
            let found = super::error::quoted(name);
            let expected = "each parameter once".to_owned();
            return Err(RigError::Invalid {
                line: Some(line),
                key: "free".to_owned(),
                found,
                expected,
            });
        }
        all.extend(elements);
        names.push(name.to_owned());
    }
    Ok(names)
}

/// The name of a list's element that is counted from 0, counted from 1.
fn one_later(name: &str) -> Option<String> {
    let (list, place) = name.strip_suffix(']')?.split_once('[')?;
    Some(format!("{list}[{}]", place.parse::<usize>().ok()?.checked_add(1)?))
}

fn read_channels(table: &Table, kind: &Kind) -> Result<BTreeMap<String, Channel>, RigError> {
    let known: Vec<&str> = kind.channels.iter().map(|c| c.name).collect();
    table.only(&known)?;
    let mut channels: BTreeMap<String, Channel> = BTreeMap::new();
    for quantity in kind.channels {
        let Some(item) = table.find(quantity.name) else {
            if quantity.required {
                return Err(table.missing(quantity.name, "the header of its column"));
            }
            continue;
        };
        let channel = match item.value.as_str() {
            Some(column) => Channel {
                column: column.to_owned(),
                unit: None,
                quantum: None,
                at: Shaft::Drum,
                hold: None,
            },
            None => channel(&item.table(table.text, quantity.name)?, quantity, kind)?,
        };
        if let Some((other, _)) = channels.iter().find(|(_, c)| c.column == channel.column) {
            return Err(item.invalid(&format!("a column other than that of {other}")));
        }
        channels.insert(quantity.name.to_owned(), channel);
    }
    let drives: Vec<&str> =
        kind.drives.iter().filter(|d| channels.contains_key(**d)).copied().collect();
    match (drives.first(), drives.get(1)) {
        (Some(_), None) => Ok(channels),
        (None, _) => Err(table.missing(&kind.drives.join(" or "), "the header of its column")),
        (Some(_), Some(second)) => {
            let second = table.get(second, "")?;
            Err(second.invalid(&format!("one of {}, not both", kind.drives.join(" and "))))
        }
    }
}

fn channel(table: &Table, quantity: &super::Quantity, kind: &Kind) -> Result<Channel, RigError> {
    table.only(&["column", "unit", "quantum", "at", "hold"])?;
    let header = "the header of its column";
    let mut channel = Channel {
        column: table.get("column", header)?.text(header)?.to_owned(),
        unit: None,
        quantum: None,
        at: Shaft::Drum,
        hold: hold(table)?,
    };
    if let Some(item) = table.find("unit") {
        let unit = item.text("a unit")?;
        units::size_in_si(unit, quantity.dimensions).map_err(|e| e.at(item.line, "unit"))?;
        channel.unit = Some(unit.to_owned());
    }
    if let Some(item) = table.find("quantum") {
        let unit = quantity.dimensions.first().map_or("", |d| d.si());
        let range = super::Range::Positive;
        let expected = parameters::expected(range.bounds(), range.words(), unit);
        let quantum = item.number(&expected)?;
        if !(1e-60..=1e60).contains(&quantum) {
            return Err(item.invalid(&expected));
        }
        channel.quantum = Some(quantum);
    }
    if let Some(item) = table.find("at") {
        let moves = quantity.name == kind.displacement || Some(quantity.name) == kind.velocity;
        channel.at = match item.text("\"motor\" or \"drum\"")? {
            "drum" => Shaft::Drum,
            "motor" if moves && kind.geared() => Shaft::Motor,
            "motor" => {
                return Err(item.invalid("\"motor\" only for angle and velocity of a drum"));
            }
            _ => return Err(item.invalid("\"motor\" or \"drum\"")),
        };
    }
    Ok(channel)
}

fn hold(table: &Table) -> Result<Option<Hold>, RigError> {
    let expected = "\"linear\", \"smooth\" or \"zero-order\"";
    let Some(item) = table.find("hold") else { return Ok(None) };
    match item.text(expected)? {
        "linear" => Ok(Some(Hold::Linear)),
        "smooth" => Ok(Some(Hold::Smooth)),
        "zero-order" => Ok(Some(Hold::ZeroOrder)),
        _ => Err(item.invalid(expected)),
    }
}

fn controller(table: Table) -> Result<Controller, RigError> {
    table.only(&["kind", "kp", "kv", "limit", "sample_time", "hold"])?;
    let item = table.get("kind", "\"pd\"")?;
    if item.text("\"pd\"")? != "pd" {
        return Err(item.invalid("\"pd\", the one kind of controller known"));
    }
    let number = |key, range: super::Range, unit| {
        let expected = parameters::expected(range.bounds(), range.words(), unit);
        let item = table.get(key, &expected)?;
        let (low, high) = range.bounds();
        let value = item.number(&expected)?;
        if (low..=high).contains(&value) { Ok(value) } else { Err(item.invalid(&expected)) }
    };
    Ok(Controller {
        kind: "pd".to_owned(),
        kp: number("kp", super::Range::NotNegative, "1/s")?,
        kv: number("kv", super::Range::NotNegative, "V·s/m")?,
        limit: number("limit", super::Range::Positive, "V")?,
        sample_time: number("sample_time", super::Range::Positive, "s")?,
        hold: hold(&table)?.unwrap_or(Hold::ZeroOrder),
    })
}

fn effects(file: &Table, rig: &Rig) -> Result<Vec<Effect>, RigError> {
    let Some(item) = file.find("effect") else { return Ok(Vec::new()) };
    let expected = "tables [[effect]]";
    let list = item.value.as_array().ok_or_else(|| item.invalid(expected))?;
    let mut effects = Vec::new();
    for value in list {
        let line = line_of(file.text, value.span().start);
        let table = value.get_ref().as_table().ok_or_else(|| item.invalid(expected))?;
        let table = Table { text: file.text, name: "[[effect]]", line, entries: table };
        let name = table.get("name", "the name of an effect")?;
        let text = name.text("the name of an effect")?;
        // Maps and probes have names too, but in no rig file.
        let known = Some(text).filter(|text| EFFECTS.contains(text));
        let Some(kind) = known.and_then(crate::effects::Kind::named) else {
            return Err(RigError::unknown(Some(name.line), "effect", text, EFFECTS));
        };
        if effects.iter().any(|effect: &Effect| effect.name == text) {
            return Err(name.invalid("each effect once"));
        }
        let joint = |name: &str| {
            crate::effects::Kind::named(name).is_some_and(crate::effects::Kind::is_joint)
        };
        if joint(text) && effects.iter().any(|effect| joint(&effect.name)) {
            return Err(name.invalid("one joint between motor and load, backlash or compliance"));
        }
        let about = kind.about();
        let names = about.keys.iter().map(|key| key.name);
        table.only(&["name"].into_iter().chain(names).collect::<Vec<&str>>())?;
        let mut values = BTreeMap::new();
        for key in about.keys {
            let unit = about.unit(key.name, rig);
            let expected = parameters::expected(key.bounds(), key.words(), unit);
            if let (Some(usual), None) = (key.usual, table.find(key.name)) {
                values.insert(key.name.to_owned(), usual);
                continue;
            }
            let item = table.get(key.name, &expected)?;
            let value = item.number(&expected)?;
            let (low, high) = key.bounds();
            if !(low..=high).contains(&value) {
                return Err(item.invalid(&expected));
            }
            let forms = if key.name == "form" { kind.forms() } else { &[] };
            if !forms.is_empty() && !forms.contains(&value) {
                let all: Vec<String> = forms.iter().map(f64::to_string).collect();
                return Err(item.invalid(&format!("one of {}", all.join(", "))));
            }
            values.insert(key.name.to_owned(), value);
        }
        effects.push(Effect { name: text.to_owned(), values });
    }
    Ok(effects)
}
