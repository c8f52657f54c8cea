//! The parameters of a rig by their names.

use super::{Kind, Range, Rig, RigError};
use crate::effects::Kind as Effects;
use duhem::{MODELS, Parameter, Parameters};

/// Two values whose ratio is nearer to one are one that was written with six digits.
const WRITTEN: f64 = 1e-5;

/// Where a parameter is kept.
enum Home<'a> {
    Plant(&'a str),
    /// A friction parameter, and the element of it if it is a list.
    Model(&'a str, Option<usize>),
    /// The viscous term beside a model that has none of its own.
    Viscous,
    Effect(&'a str, &'a str),
}

impl Rig {
    /// The names of all its parameters: `inertia`, `offset`, `f_c`, `k[2]`, `sigma_2`, `effect.value`.
    pub fn parameters(&self) -> Vec<String> {
        let order = Kind::of(self.kind).map_or(&[][..], |kind| kind.keys);
        let plant = order.iter().map(|k| k.key).filter(|k| self.plant.contains_key(*k));
        let mut names: Vec<String> = plant.map(str::to_owned).collect();
        for key in self.model_keys() {
            match self.friction.parameters.0.get(*key) {
                Some(Parameter::List(list)) => {
                    names.extend((1..=list.len()).map(|i| format!("{key}[{i}]")));
                }
                Some(Parameter::Scalar(_)) => names.push((*key).to_owned()),
                None => {}
            }
        }
        if !self.model_keys().contains(&"sigma_2") {
            names.push("sigma_2".to_owned());
        }
        for effect in &self.effects {
            names.extend(effect.values.keys().map(|key| format!("{}.{key}", effect.name)));
        }
        names
    }

    /// The free parameters one by one: `k` is `k[1]`, `k[2]` and so on.
    pub fn free_parameters(&self) -> Vec<String> {
        self.free.iter().flat_map(|name| self.expand(name)).collect()
    }

    /// What a name in `[fit] free` stands for; nothing if it names nothing.
    pub(super) fn expand(&self, name: &str) -> Vec<String> {
        match self.friction.parameters.0.get(name) {
            Some(Parameter::List(list)) => {
                (1..=list.len()).map(|i| format!("{name}[{i}]")).collect()
            }
            _ if self.value(name).is_some() => vec![name.to_owned()],
            _ => Vec::new(),
        }
    }

    /// The value of a parameter, in SI units.
    pub fn value(&self, name: &str) -> Option<f64> {
        match self.home(name)? {
            Home::Plant(key) => self.plant.get(key).copied(),
            Home::Model(key, element) => match (self.friction.parameters.0.get(key)?, element) {
                (Parameter::Scalar(value), None) => Some(*value),
                (Parameter::List(list), Some(i)) => list.get(i).copied(),
                _ => None,
            },
            Home::Viscous => Some(self.friction.sigma_2),
            Home::Effect(effect, key) => {
                self.effects.iter().find(|e| e.name == effect)?.values.get(key).copied()
            }
        }
    }

    /// Sets a parameter [SI]; where the friction force is [tied](Self::tied), f_s follows f_c.
    ///
    /// Fails on a name that is not among [`Self::parameters`] and on a value outside [`Self::bounds`];
    /// the rig is then as it was.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), RigError> {
        if self.value(name).is_none() {
            let known = self.parameters();
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            return Err(RigError::unknown(None, "parameter", name, &known));
        }
        let (low, high) = self.bounds(name);
        if !(low..=high).contains(&value) {
            let expected = expected((low, high), "a finite number", self.unit(name));
            let (key, found) = (name.to_owned(), value.to_string());
            return Err(RigError::Invalid { line: None, key, found, expected });
        }
        if name == "f_c" && self.tied() {
            self.place("f_s", value);
        }
        self.place(name, value);
        Ok(())
    }

    /// Whether f_s follows f_c: LuGre with F_S = F_C has no Stribeck effect, and as long as f_s is not
    /// free itself, it gets none by f_c moving away from it.
    pub fn tied(&self) -> bool {
        let f_s = self.value("f_s");
        f_s.is_some() && f_s == self.value("f_c") && !self.free.iter().any(|name| name == "f_s")
    }

    /// A stiction that differs from the sliding friction by less than how they were written is that.
    pub(super) fn tie(&mut self) {
        if let (Some(f_s), Some(f_c)) = (self.value("f_s"), self.value("f_c"))
            && (f_s - f_c).abs() < WRITTEN * f_c
        {
            self.place("f_s", f_c);
        }
    }

    /// The SI unit of a parameter; empty for a pure number and for a name that is not known.
    pub fn unit(&self, name: &str) -> &'static str {
        let Some(kind) = Kind::of(self.kind) else { return "" };
        match self.home(name) {
            Some(Home::Plant(key)) => {
                kind.keys.iter().find(|k| k.key == key).map_or("", |k| k.unit)
            }
            Some(Home::Model(key, _)) => {
                let model = MODELS.iter().find(|m| m.name == self.friction.name);
                let unit = model
                    .and_then(|m| m.keys.iter().zip(m.units).find(|(k, _)| **k == key))
                    .map_or("", |(_, unit)| unit);
                kind.friction_unit(unit)
            }
            Some(Home::Viscous) => kind.friction_unit("N·s/m"),
            Some(Home::Effect(effect, key)) => {
                Effects::named(effect).map_or("", |kind| kind.about().unit(key, self))
            }
            None => "",
        }
    }

    /// The smallest and the largest value that a parameter can have [SI]; any for a name not known.
    pub fn bounds(&self, name: &str) -> (f64, f64) {
        match self.home(name) {
            Some(Home::Plant(key)) => Kind::of(self.kind)
                .and_then(|kind| kind.keys.iter().find(|k| k.key == key))
                .map_or(Range::Any, |k| k.range)
                .bounds(),
            Some(Home::Model(key, _)) => model_bounds(&self.friction.name, key),
            Some(Home::Viscous) => Range::NotNegative.bounds(),
            Some(Home::Effect(..)) | None => Range::Any.bounds(),
        }
    }

    fn model_keys(&self) -> &'static [&'static str] {
        MODELS.iter().find(|m| m.name == self.friction.name).map_or(&[], |m| m.keys)
    }

    fn home<'a>(&self, name: &'a str) -> Option<Home<'a>> {
        if let Some((effect, key)) = name.split_once('.') {
            return Some(Home::Effect(effect, key));
        }
        if self.plant.contains_key(name) {
            return Some(Home::Plant(name));
        }
        let (key, element) = match name.strip_suffix(']').and_then(|n| n.split_once('[')) {
            Some((key, element)) => {
                // One spelling only, so that no parameter has two names.
                let plain =
                    element.bytes().all(|b| b.is_ascii_digit()) && !element.starts_with('0');
                let i = element.parse::<usize>().ok().filter(|_| plain)?;
                (key, Some(i.checked_sub(1)?))
            }
            None => (name, None),
        };
        if self.friction.parameters.0.contains_key(key) {
            return Some(Home::Model(key, element));
        }
        (name == "sigma_2").then_some(Home::Viscous)
    }

    /// Writes a value whose name and range are known to be right.
    fn place(&mut self, name: &str, value: f64) {
        match self.home(name) {
            Some(Home::Plant(key)) => {
                self.plant.insert(key.to_owned(), value);
            }
            Some(Home::Model(key, element)) => {
                match (self.friction.parameters.0.get_mut(key), element) {
                    (Some(Parameter::Scalar(old)), None) => *old = value,
                    (Some(Parameter::List(list)), Some(i)) => {
                        if let Some(old) = list.get_mut(i) {
                            *old = value;
                        }
                    }
                    _ => {}
                }
            }
            Some(Home::Viscous) => self.friction.sigma_2 = value,
            Some(Home::Effect(effect, key)) => {
                let effect = self.effects.iter_mut().find(|e| e.name == effect);
                if let Some(old) = effect.and_then(|e| e.values.get_mut(key)) {
                    *old = value;
                }
            }
            None => {}
        }
    }
}

/// The range of a model's parameter, asked of the model itself: does it take a zero?
pub(super) fn model_bounds(model: &str, key: &str) -> (f64, f64) {
    let Some(entry) = MODELS.iter().find(|m| m.name == model) else { return Range::Any.bounds() };
    let with_zero = |list: bool| {
        let value = |k: &&str| match (*k == key, list) {
            (zero, false) => Parameter::Scalar(if zero { 0.0 } else { 1.0 }),
            (zero, true) => Parameter::List(vec![if zero { 0.0 } else { 1.0 }]),
        };
        let parameters: Parameters = entry.keys.iter().map(|k| (*k, value(k))).collect();
        (entry.build)(&parameters).is_ok()
    };
    let zero = with_zero(false) || with_zero(true);
    if zero { Range::NotNegative.bounds() } else { Range::Positive.bounds() }
}

/// What belongs to a key, in words with its unit.
pub(super) fn expected((low, high): (f64, f64), what: &str, unit: &str) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
    format!("{what}{unit}, from {low:e} to {high:e}")
}
