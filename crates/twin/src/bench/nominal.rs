//! The rig as an analyst is told of it.

use super::{Between, Family, Recipe, between, pick, sign};
use crate::{Controller, Friction, PlantKind, Quantity, Scenario};
use rand_chacha::ChaCha20Rng;

/// By how much every parameter is wrong.
const OFF: f64 = 0.02;

/// A parameter that is very wrong.
pub(super) struct Wrong {
    pub(super) name: String,
    pub(super) factor: f64,
}

/// A place in a scenario for each parameter that a rig file declares, by its name there.
fn places(scenario: &mut Scenario) -> Vec<(String, &mut f64)> {
    let mut places: Vec<(&str, &mut f64)> = match &mut scenario.plant {
        PlantKind::Drum {
            inertia,
            radius,
            k_1,
            k_2,
            f_10,
            f_20,
            motor_constant,
            gear_ratio,
            ..
        } => vec![
            ("inertia", inertia),
            ("radius", radius),
            ("k_1", k_1),
            ("k_2", k_2),
            ("f_10", f_10),
            ("f_20", f_20),
            ("motor_constant", motor_constant),
            ("gear_ratio", gear_ratio),
        ],
        PlantKind::MassSpring { mass, stiffness, .. } => {
            vec![("mass", mass), ("stiffness", stiffness)]
        }
        PlantKind::Axis { inertia, gain, .. } => vec![("inertia", inertia), ("gain", gain)],
        PlantKind::Pendulum { inertia, mass, length, torque_constant, resistance, .. } => vec![
            ("inertia", inertia),
            ("mass", mass),
            ("length", length),
            ("torque_constant", torque_constant),
            ("resistance", resistance),
        ],
        PlantKind::Prescribed { .. } => vec![],
    };
    let mut lists = Vec::new();
    match &mut scenario.friction {
        Friction::None { sigma_2 } => places.push(("sigma_2", sigma_2)),
        Friction::Coulomb { f_c, sigma_2 } => {
            places.extend([("f_c", f_c), ("sigma_2", sigma_2)]);
        }
        Friction::Dahl { f_c, sigma, sigma_2, .. } => {
            places.extend([("f_c", f_c), ("sigma", sigma), ("sigma_2", sigma_2)]);
        }
        Friction::LuGre { f_c, f_s, v_s, sigma_0, sigma_1, sigma_2 } => places.extend([
            ("f_c", f_c),
            ("f_s", f_s),
            ("v_s", v_s),
            ("sigma_0", sigma_0),
            ("sigma_1", sigma_1),
            ("sigma_2", sigma_2),
        ]),
        Friction::MaxwellSlip { k, delta, sigma_2 } => {
            for (key, list) in [("k", k), ("delta", delta)] {
                let numbered = list.iter_mut().enumerate();
                lists.extend(numbered.map(|(i, value)| (format!("{key}[{}]", i + 1), value)));
            }
            places.push(("sigma_2", sigma_2));
        }
    }
    places.into_iter().map(|(name, value)| (name.to_owned(), value)).chain(lists).collect()
}

/// How many of the places are the plant's; they come first.
fn keys(plant: &PlantKind) -> usize {
    match plant {
        PlantKind::Drum { .. } => 8,
        PlantKind::MassSpring { .. } | PlantKind::Axis { .. } => 2,
        PlantKind::Pendulum { .. } => 5,
        PlantKind::Prescribed { .. } => 0,
    }
}

/// Whether LuGre's stiction is its Coulomb force, so that the two are one parameter.
fn tied(friction: &Friction) -> bool {
    matches!(friction, Friction::LuGre { f_c, f_s, .. } if f_c == f_s)
}

/// The parameter of this name.
pub(super) fn value(scenario: &Scenario, name: &str) -> Option<f64> {
    let mut scenario = scenario.clone();
    places(&mut scenario).into_iter().find(|(known, _)| known == name).map(|(_, value)| *value)
}

/// Makes a parameter so many times as large, and the stiction with a Coulomb force it is tied to.
pub(super) fn scale(scenario: &mut Scenario, name: &str, factor: f64) {
    let tied = tied(&scenario.friction);
    for (known, value) in places(scenario) {
        if known == name || tied && name == "f_c" && known == "f_s" {
            *value *= factor;
        }
    }
}

/// A free parameter that a record shows well, and the factor by which it is wrong.
pub(super) fn drawn(
    family: Family,
    scenario: &Scenario,
    stream: &mut ChaCha20Rng,
) -> (String, f64) {
    let free = free(family, scenario);
    // Preloads, bristle damping and Stribeck's velocity hardly show.
    let shows = |name: &&String| {
        !["f_10", "f_20", "v_s", "sigma_1"].contains(&name.as_str()) && !name.contains('[')
    };
    let mut names: Vec<String> = free.iter().filter(shows).cloned().collect();
    if names.is_empty() {
        names = free;
    }
    let name = names[pick(&(0..names.len()).collect::<Vec<_>>(), stream)].clone();
    (name, 1.0 + sign(stream) * between(0.2, 0.6, stream))
}

/// The free parameters: the friction's, and of the plant what does not scale with the others.
pub(super) fn free(family: Family, scenario: &Scenario) -> Vec<String> {
    let plant: &[&str] = match family {
        Family::DrumCells => &["k_1", "k_2", "f_10", "f_20"],
        Family::DrumAngle | Family::Prescribed => &[],
        Family::MassSpring => &["mass", "stiffness"],
        Family::Axis | Family::AxisPd => &["inertia"],
        // The mass stands for its product with the length; the voltage is the scale.
        Family::Pendulum => &["inertia", "mass"],
    };
    let tied = tied(&scenario.friction);
    let mut scenario = scenario.clone();
    let count = keys(&scenario.plant);
    places(&mut scenario)
        .into_iter()
        .enumerate()
        .filter(|(i, (name, value))| {
            let free = if *i < count { plant.contains(&name.as_str()) } else { **value != 0.0 };
            free && !(tied && (name == "f_s" || name == "v_s"))
        })
        .map(|(_, (name, _))| name)
        .collect()
}

/// The rig file's text, and the scenario that it would be right for.
pub(super) fn rig(
    recipe: &Recipe,
    scenario: &Scenario,
    wrong: Option<&Wrong>,
    stream: &mut ChaCha20Rng,
) -> (String, Scenario) {
    let family = recipe.family;
    let mut told = scenario.clone();
    let names: Vec<String> = places(&mut told).into_iter().map(|(name, _)| name).collect();
    let tied = tied(&scenario.friction);
    for name in names.iter().filter(|name| !(tied && name.as_str() == "f_s")) {
        scale(&mut told, name, 1.0 + OFF * sign(stream));
    }
    if let Some(wrong) = wrong {
        // What is very wrong is so by the factor drawn, not by 2 % as well.
        let there = value(&told, &wrong.name).unwrap_or(1.0);
        let truth = value(scenario, &wrong.name).unwrap_or(1.0);
        scale(&mut told, &wrong.name, wrong.factor * truth / there);
    }
    let plant = table(&mut told, |i, count| i < count);
    let friction = table(&mut told, |i, count| i >= count);
    let free: Vec<String> =
        free(family, scenario).iter().map(|name| format!("\"{name}\"")).collect();
    let text = format!(
        "title = \"benchmark: {}\"\n\n[plant]\nkind = \"{}\"\n{plant}\n[friction]\nname = \"{}\"\n{friction}\n\
         [fit]\nfree = [{}]\n\n[channels]\ntime = \"time_s\"\n{}{}",
        scenario.plant.kind(),
        scenario.plant.kind(),
        name(&scenario.friction),
        free.join(", "),
        channels(scenario, recipe.input == Between::Held),
        controller(scenario)
    );
    (text, told)
}

/// The lines of plant or friction; a list on one.
fn table(told: &mut Scenario, keep: impl Fn(usize, usize) -> bool) -> String {
    let count = keys(&told.plant);
    let own = keep(count, count);
    let mut lines: Vec<String> = places(told)
        .into_iter()
        .enumerate()
        .filter(|(i, (name, _))| keep(*i, count) && !name.contains('['))
        .map(|(_, (name, value))| format!("{name} = {value:?}\n"))
        .collect();
    match &told.friction {
        Friction::MaxwellSlip { k, delta, .. } if own => {
            lines.push(format!("k = {k:?}\ndelta = {delta:?}\n"));
        }
        Friction::Dahl { gamma, .. } if own => lines.push(format!("gamma = {gamma:?}\n")),
        _ => {}
    }
    lines.concat()
}

fn name(friction: &Friction) -> &'static str {
    match friction {
        Friction::None { .. } => "none",
        Friction::Coulomb { .. } => "coulomb",
        Friction::Dahl { .. } => "dahl",
        Friction::LuGre { .. } => "lugre",
        Friction::MaxwellSlip { .. } => "maxwell-slip",
    }
}

fn channels(scenario: &Scenario, said: bool) -> String {
    let imposed = matches!(scenario.plant, PlantKind::Prescribed { .. });
    let line = |sensor: &crate::Sensor| {
        let input = match sensor.quantity {
            Quantity::Current | Quantity::Voltage | Quantity::AddedInput => true,
            Quantity::Force => !imposed,
            _ => false,
        };
        let quantum = match sensor.quantity {
            Quantity::Angle | Quantity::Position if sensor.quantum > 0.0 => {
                format!(", quantum = {:?}", sensor.quantum)
            }
            _ => String::new(),
        };
        let hold = if input && said { ", hold = \"zero-order\"" } else { "" };
        format!(
            "{} = {{ column = \"{}\"{quantum}{hold} }}\n",
            sensor.quantity.name(),
            sensor.column
        )
    };
    scenario.sensors.iter().map(line).collect()
}

fn controller(scenario: &Scenario) -> String {
    let Some(Controller::Pd { kp, kv, limit }) = scenario.controller else { return String::new() };
    format!(
        "\n[controller]\nkind = \"pd\"\nkp = {kp:?}\nkv = {kv:?}\nlimit = {limit:?}\nsample_time = {:?}\n\
         hold = \"zero-order\"\n",
        1.0 / scenario.rate
    )
}
