//! From the names in a rig file to the numbers of the march, and from a fit's own variables to both.

use crate::{
    Rig,
    effects::{self, Key, Shape, Term},
    march::{Balance, Contact, Model, Real},
};
use duhem::Parameter;

/// The effect that makes Coulomb's friction Dahl's.
const PRESLIDING: &str = "presliding";

/// Standard gravity as the rig file's format has it [m/s²].
const GRAVITY: f64 = 9.81;

/// The torque of each cable of a drum in the middle, and by how much it grows with the angle.
fn cables<D: Real>(plant: &dyn Fn(&str) -> D) -> [[D; 2]; 2] {
    let r = plant("radius");
    [[plant("f_10") * r, plant("k_1") * r * r], [plant("f_20") * r, -(plant("k_2") * r * r)]]
}

/// The plant and the friction of `rig`, where `free` says what stands for a parameter instead of its value.
///
/// With `f_s` equal to `f_c` and only `f_c` free LuGre has no Stribeck effect, and the two stay tied.
pub fn model<D: Real>(rig: &Rig, free: &dyn Fn(&str) -> Option<D>) -> Model<D> {
    let plant = |key: &str| {
        let given = rig.plant.get(key).copied().unwrap_or(0.0);
        free(key).unwrap_or_else(|| D::from(given))
    };
    let zero = D::from(0.0);
    let nothing = Balance { gain: zero, ..Balance::alone(zero) };
    let balance = match rig.kind {
        "drum" => {
            let r = plant("radius");
            Balance {
                mass: plant("inertia"),
                gain: plant("motor_constant"),
                constant: (plant("f_20") - plant("f_10")) * r,
                stiffness: (plant("k_1") + plant("k_2")) * r * r,
                cables: cables(&plant),
                ..nothing
            }
        }
        "mass-spring" => Balance {
            mass: plant("mass"),
            gain: D::from(1.0),
            stiffness: plant("stiffness"),
            ..nothing
        },
        "axis" => {
            let force = rig.channels.contains_key("force");
            let gain = if force { D::from(1.0) } else { plant("gain") };
            Balance { mass: plant("inertia"), gain, ..nothing }
        }
        "pendulum" => {
            let k = plant("torque_constant") / plant("resistance");
            Balance {
                mass: plant("inertia"),
                gain: k,
                damping: k * plant("torque_constant"),
                gravity: plant("mass") * plant("length") * GRAVITY,
                ..nothing
            }
        }
        _ => nothing,
    };
    let sigma_2 = free("sigma_2").unwrap_or_else(|| D::from(viscous(rig)));
    Model {
        balance,
        contact: contact(rig, free),
        sigma_2,
        offset: plant("offset"),
        radius: rig.plant.get("radius").copied().unwrap_or(1.0),
        effects: terms(rig, free),
    }
}

/// The effects that are part of the rig's model; one whose amounts are all 0, and stay so, is none: its states would
/// shorten steps for nothing.
pub(super) fn terms<D: Real>(rig: &Rig, free: &dyn Fn(&str) -> Option<D>) -> Vec<Term<D>> {
    let of = |effect: &crate::Effect| {
        let kind = effects::Kind::named(&effect.name)?;
        let value = |key: &str| {
            let given = effect.values.get(key).copied().unwrap_or(0.0);
            free(&format!("{}.{key}", effect.name)).unwrap_or_else(|| D::from(given))
        };
        let mut amounts =
            kind.about().keys.iter().filter(|key| key.shape == Shape::Amount).peekable();
        let is_none = |key: &Key| {
            effect.values.get(key.name) == Some(&0.0)
                && free(&format!("{}.{}", effect.name, key.name)).is_none()
        };
        let neutral = amounts.peek().is_some() && amounts.all(is_none);
        (!neutral).then(|| kind.term(&value))
    };
    rig.effects.iter().filter_map(of).collect()
}

/// The viscous coefficient of the nominal friction [N·s/m], LuGre's own among them.
fn viscous(rig: &Rig) -> f64 {
    match rig.friction.parameters.0.get("sigma_2") {
        Some(Parameter::Scalar(value)) => *value,
        _ => rig.friction.sigma_2,
    }
}

/// The number that the friction has under `key`, 0 if there is none.
pub(super) fn given(rig: &Rig, key: &str) -> f64 {
    match rig.friction.parameters.0.get(key) {
        Some(Parameter::Scalar(value)) => *value,
        _ => 0.0,
    }
}

fn contact<D: Real>(rig: &Rig, free: &dyn Fn(&str) -> Option<D>) -> Contact<D> {
    let given = |key: &str| given(rig, key);
    let of = |key: &str| free(key).unwrap_or_else(|| D::from(given(key)));
    let effect = |name: &str| free(name).unwrap_or_else(|| D::from(rig.value(name).unwrap_or(0.0)));
    let list = |key: &str| match rig.friction.parameters.0.get(key) {
        Some(Parameter::List(values)) => values
            .iter()
            .enumerate()
            .map(|(i, v)| free(&format!("{key}[{}]", i + 1)).unwrap_or_else(|| D::from(*v)))
            .collect(),
        _ => Vec::new(),
    };
    match rig.friction.name.as_str() {
        // What gives way before it slides is no longer Coulomb's.
        "coulomb" if rig.effects.iter().any(|e| e.name == PRESLIDING) => Contact::Dahl {
            f_c: of("f_c"),
            sigma: effect("presliding.sigma"),
            gamma: effect("presliding.gamma"),
        },
        "coulomb" => Contact::Coulomb { f_c: of("f_c") },
        "dahl" => Contact::Dahl { f_c: of("f_c"), sigma: of("sigma"), gamma: of("gamma") },
        "lugre" => {
            let tied = given("f_s") == given("f_c") && free("f_s").is_none();
            Contact::LuGre {
                f_c: of("f_c"),
                f_s: if tied { of("f_c") } else { of("f_s") },
                v_s: of("v_s"),
                sigma_0: of("sigma_0"),
                sigma_1: of("sigma_1"),
            }
        }
        "maxwell-slip" => Contact::MaxwellSlip { k: list("k"), delta: list("delta") },
        _ => Contact::None,
    }
}

/// In what the fit moves a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// In its logarithm, which is 1 at this size [the parameter's unit]: it is positive, and twice is like half.
    Logarithm(f64),
    /// In the logarithm of what it has above another parameter, 1 at this size [its unit]: F_S above F_C.
    Above(f64),
    /// In its inverse square, 1 at this size [its unit]: so v_S and F_S − F_C, which a record often shows only
    /// together as (F_S − F_C) exp(−(v/v_S)²), trade along a straight line.
    InverseSquare(f64),
    /// In multiples of this size [the parameter's unit]: it may have either sign.
    Linear(f64),
}

/// A parameter goes no further than this from its nominal size, up or down.
pub const FAR: f64 = 1e4;

/// A free parameter and in what it moves.
#[derive(Debug, Clone, PartialEq)]
pub struct Free {
    /// Its name in the rig file.
    pub name: String,
    /// Its nominal value [its unit].
    pub given: f64,
    /// In what it moves.
    pub scale: Scale,
}

impl Free {
    /// The value at the fit's variable `x`, within [`FAR`] of its size.
    pub fn value(&self, x: f64) -> f64 {
        match self.scale {
            Scale::Logarithm(unit) | Scale::Above(unit) => {
                unit * (x - 1.0).exp().clamp(FAR.recip(), FAR)
            }
            Scale::InverseSquare(unit) => unit / x.clamp(FAR.powi(-2), FAR.powi(2)).sqrt(),
            Scale::Linear(size) => x * size,
        }
    }

    /// The fit's variable for a `value`.
    pub fn variable(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Logarithm(unit) | Scale::Above(unit) => 1.0 + (value / unit).ln(),
            Scale::InverseSquare(unit) => (unit / value).powi(2),
            Scale::Linear(size) => value / size,
        }
    }

    /// The derivative of the value by the variable, where the value is `value`.
    pub fn slope(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Logarithm(_) | Scale::Above(_) => value,
            Scale::InverseSquare(unit) => -0.5 * value * (value / unit).powi(2),
            Scale::Linear(size) => size,
        }
    }

    /// Whether `value` is as far from its size as it may go.
    pub fn at_bound(&self, value: f64) -> bool {
        match self.scale {
            Scale::Logarithm(unit) | Scale::Above(unit) | Scale::InverseSquare(unit) => {
                let share = (value / unit).ln().abs() / FAR.ln();
                share > 0.999
            }
            Scale::Linear(_) => false,
        }
    }
}

/// The free parameters of `rig` with their scales; `force` [N] and `speed` [m/s] are what the record reaches,
/// the sizes of what is nominally zero.
pub fn free(rig: &Rig, force: f64, speed: f64) -> Vec<Free> {
    let f_c = given(rig, "f_c");
    let mut all = Vec::new();
    for name in names(rig) {
        let given = value(rig, &name).unwrap_or(0.0);
        let scale = match name.as_str() {
            _ if name.contains('.') => match key(&name) {
                Some(key) if key.shape != Shape::Amount => Scale::Logarithm(given),
                _ => Scale::Linear(effect_size(rig, &name, [force, speed])),
            },
            "f_s" if given > f_c => Scale::Above(given - f_c),
            "f_s" => Scale::Above(0.1 * f_c),
            "v_s" if given > 0.0 => Scale::InverseSquare(given),
            "offset" => Scale::Linear(0.1 * force),
            "f_10" | "f_20" => Scale::Linear(given.abs().max(1e-3)),
            "sigma_1" | "sigma_2" if given == 0.0 => Scale::Logarithm(0.01 * force / speed),
            _ if given > 0.0 => Scale::Logarithm(given),
            _ => Scale::Linear(given.abs().max(1.0)),
        };
        all.push(Free { name, given, scale });
    }
    all
}

/// The key of an effect's parameter by its whole name.
pub fn key(name: &str) -> Option<&'static Key> {
    let (effect, key) = name.split_once('.')?;
    effects::Kind::named(effect)?.about().keys.iter().find(|k| k.name == key)
}

/// The size in which an effect's amount moves: what it has, or a part of what there could be of it.
fn effect_size(rig: &Rig, name: &str, [force, speed]: [f64; 2]) -> f64 {
    let given = rig.value(name).unwrap_or(0.0).abs();
    let size = key(name).map_or(1.0, |key| match key.measure {
        effects::Measure::Force => force,
        effects::Measure::Damping => force / speed,
        effects::Measure::Drag => force / (speed * speed),
        effects::Measure::Speed => speed,
        _ => 1.0,
    });
    if given > 0.0 { given } else { 0.01 * size }
}

/// The names of the free parameters: those of the rig file, or all of the friction and the viscous coefficient
/// if it names none; a list's name stands for all its elements.
fn names(rig: &Rig) -> Vec<String> {
    let mut names = rig.free.clone();
    if names.is_empty() {
        names = rig.friction.parameters.0.keys().filter(|k| *k != "gamma").cloned().collect();
        if rig.friction.name != "none" && !names.iter().any(|n| n == "sigma_2") {
            names.push("sigma_2".to_owned());
        }
    }
    let whole = |name: &str| match rig.friction.parameters.0.get(name) {
        Some(Parameter::List(values)) => {
            (1..=values.len()).map(|i| format!("{name}[{i}]")).collect()
        }
        _ => vec![name.to_owned()],
    };
    let mut all: Vec<String> = Vec::new();
    for name in names.iter().flat_map(|n| whole(n)) {
        if !all.contains(&name) {
            all.push(name);
        }
    }
    all
}

/// The element `k[2]` names, its list and its place from 0.
fn element(name: &str) -> Option<(&str, usize)> {
    let (list, rest) = name.split_once('[')?;
    let place: usize = rest.strip_suffix(']')?.parse().ok()?;
    Some((list, place.checked_sub(1)?))
}

/// The value that `rig` has under `name` [its unit].
pub fn value(rig: &Rig, name: &str) -> Option<f64> {
    if let Some((list, place)) = element(name) {
        return match rig.friction.parameters.0.get(list) {
            Some(Parameter::List(values)) => values.get(place).copied(),
            _ => None,
        };
    }
    match rig.friction.parameters.0.get(name) {
        _ if name.contains('.') => rig.value(name),
        Some(Parameter::Scalar(value)) => Some(*value),
        Some(Parameter::List(_)) => None,
        None if name == "sigma_2" => Some(rig.friction.sigma_2),
        None if name == "offset" => Some(rig.plant.get(name).copied().unwrap_or(0.0)),
        None => rig.plant.get(name).copied(),
    }
}

/// Writes `to` into `rig` under `name`; a name that is nowhere is left out. F_S stays tied to F_C where it was.
pub fn set(rig: &mut Rig, name: &str, to: f64) {
    if let Some((list, place)) = element(name) {
        if let Some(Parameter::List(values)) = rig.friction.parameters.0.get_mut(list)
            && let Some(element) = values.get_mut(place)
        {
            *element = to;
        }
        return;
    }
    if let Some((effect, key)) = name.split_once('.') {
        let effect = rig.effects.iter_mut().find(|e| e.name == effect);
        if let Some(old) = effect.and_then(|e| e.values.get_mut(key)) {
            *old = to;
        }
        return;
    }
    let tied = name == "f_c" && value(rig, "f_s") == value(rig, "f_c");
    if let Some(Parameter::Scalar(number)) = rig.friction.parameters.0.get_mut(name) {
        *number = to;
    } else if name == "sigma_2" {
        rig.friction.sigma_2 = to;
    } else {
        rig.plant.insert(name.to_owned(), to);
    }
    if tied {
        rig.friction.parameters.0.insert("f_s".to_owned(), Parameter::Scalar(to));
    }
}
