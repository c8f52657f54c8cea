//! From a rig to the text of its file.

use super::{Channel, Kind, Rig, Shaft};
use duhem::{MODELS, Parameter};
use std::fmt::Write;

impl Rig {
    /// A rig file of which [`Rig::parse`] makes the same rig, with the unit beside each number.
    pub fn write(&self) -> String {
        let mut text = format!("title = {}\n", string(&self.title));
        self.write_plant(&mut text);
        self.write_friction(&mut text);
        if !self.free.is_empty() {
            let names: Vec<String> = self.free.iter().map(|name| string(name)).collect();
            let _ = write!(text, "\n[fit]\nfree = [{}]\n", names.join(", "));
        }
        self.write_channels(&mut text);
        self.write_controller(&mut text);
        for effect in &self.effects {
            let _ = write!(text, "\n[[effect]]\nname = {}\n", string(&effect.name));
            for (key, value) in &effect.values {
                line(&mut text, &string(key), &format!("{value:?}"), "");
            }
        }
        text
    }

    fn write_plant(&self, text: &mut String) {
        let _ = write!(text, "\n[plant]\nkind = {}\n", string(self.kind));
        for key in Kind::of(self.kind).map_or(&[][..], |kind| kind.keys) {
            if let Some(value) = self.plant.get(key.key) {
                line(text, key.key, &format!("{value:?}"), key.unit);
            }
        }
    }

    fn write_friction(&self, text: &mut String) {
        let _ = write!(text, "\n[friction]\nname = {}\n", string(&self.friction.name));
        let keys = MODELS.iter().find(|m| m.name == self.friction.name).map_or(&[][..], |m| m.keys);
        for key in keys {
            match self.friction.parameters.0.get(*key) {
                Some(Parameter::Scalar(value)) => {
                    line(text, key, &format!("{value:?}"), self.unit(key));
                }
                Some(Parameter::List(list)) => {
                    line(text, key, &format!("{list:?}"), self.unit(key));
                }
                None => {}
            }
        }
        if !keys.contains(&"sigma_2") {
            line(text, "sigma_2", &format!("{:?}", self.friction.sigma_2), self.unit("sigma_2"));
        }
    }

    fn write_channels(&self, text: &mut String) {
        *text += "\n[channels]\n";
        for quantity in Kind::of(self.kind).map_or(&[][..], |kind| kind.channels) {
            let Some(channel) = self.channels.get(quantity.name) else { continue };
            let unit = quantity.dimensions.first().map_or("", |d| d.si());
            let unit = channel.unit.as_deref().unwrap_or(unit);
            line(text, quantity.name, &written(channel), unit);
        }
    }

    fn write_controller(&self, text: &mut String) {
        let Some(controller) = &self.controller else { return };
        let _ = write!(text, "\n[controller]\nkind = {}\n", string(&controller.kind));
        line(text, "kp", &format!("{:?}", controller.kp), "1/s");
        line(text, "kv", &format!("{:?}", controller.kv), "V·s/m");
        line(text, "limit", &format!("{:?}", controller.limit), "V");
        line(text, "sample_time", &format!("{:?}", controller.sample_time), "s");
        line(text, "hold", &string(controller.hold.name()), "");
    }
}

fn written(channel: &Channel) -> String {
    let mut parts = vec![format!("column = {}", string(&channel.column))];
    parts.extend(channel.unit.as_ref().map(|unit| format!("unit = {}", string(unit))));
    parts.extend(channel.quantum.map(|quantum| format!("quantum = {quantum:?}")));
    if channel.at == Shaft::Motor {
        parts.push("at = \"motor\"".to_owned());
    }
    parts.extend(channel.hold.map(|between| format!("hold = {}", string(between.name()))));
    match parts.as_slice() {
        [_] => string(&channel.column),
        _ => format!("{{ {} }}", parts.join(", ")),
    }
}

fn line(text: &mut String, key: &str, value: &str, unit: &str) {
    let unit = if unit.is_empty() { String::new() } else { format!(" # {unit}") };
    let _ = writeln!(text, "{key} = {value}{unit}");
}

/// A text as TOML writes it.
fn string(text: &str) -> String {
    toml::Value::from(text).to_string()
}
