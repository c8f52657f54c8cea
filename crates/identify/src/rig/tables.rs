//! A table of a rig file whose every complaint names the line and the key.

use super::error::{RigError, quoted};
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

/// A table with its name and its text, from which the lines are counted.
#[derive(Debug, Clone, Copy)]
pub(super) struct Table<'a> {
    pub(super) text: &'a str,
    /// As it is written: `[plant]`, `force in [channels]`.
    pub(super) name: &'a str,
    pub(super) line: usize,
    pub(super) entries: &'a DeTable<'a>,
}

/// A value, with the key it stands under.
#[derive(Debug, Clone, Copy)]
pub(super) struct Item<'a> {
    pub(super) key: &'a str,
    pub(super) line: usize,
    pub(super) value: &'a DeValue<'a>,
}

/// The line, from 1, of a byte of a text.
pub(super) fn line_of(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|b| *b == b'\n').count()
}

impl<'a> Table<'a> {
    /// Refuses every key that is not among `known`.
    pub(super) fn only(&self, known: &[&str]) -> Result<(), RigError> {
        match self.entries.iter().find(|(key, _)| !known.contains(&key.get_ref().as_ref())) {
            None => Ok(()),
            Some((key, _)) => {
                let line = line_of(self.text, key.span().start);
                let what = format!("key in {}", self.name);
                Err(RigError::unknown(Some(line), &what, key.get_ref(), known))
            }
        }
    }

    /// All its values.
    pub(super) fn items(&self) -> impl Iterator<Item = Item<'a>> {
        let text = self.text;
        self.entries.iter().map(move |(key, value)| item(text, key.get_ref(), value))
    }

    /// The value under `key`, if there is one.
    pub(super) fn find(&self, key: &str) -> Option<Item<'a>> {
        self.items().find(|item| item.key == key)
    }

    /// The value under `key`, which has to be there.
    pub(super) fn get(&self, key: &str, expected: &str) -> Result<Item<'a>, RigError> {
        self.find(key).ok_or_else(|| self.missing(key, expected))
    }

    /// That `key` is not there.
    pub(super) fn missing(&self, key: &str, expected: &str) -> RigError {
        RigError::Missing {
            line: Some(self.line),
            key: format!("{key} in {}", self.name),
            expected: expected.to_owned(),
        }
    }

    /// The table under `key`, if there is one.
    pub(super) fn table(&self, key: &str, name: &'a str) -> Result<Option<Self>, RigError> {
        self.find(key).map(|item| item.table(self.text, name)).transpose()
    }
}

fn item<'a>(text: &str, key: &'a str, value: &'a Spanned<DeValue<'a>>) -> Item<'a> {
    Item { key, line: line_of(text, value.span().start), value: value.get_ref() }
}

impl<'a> Item<'a> {
    /// That it is not what was `expected`.
    pub(super) fn invalid(&self, expected: &str) -> RigError {
        RigError::Invalid {
            line: Some(self.line),
            key: self.key.to_owned(),
            found: shown(self.value),
            expected: expected.to_owned(),
        }
    }

    /// Its text.
    pub(super) fn text(&self, expected: &str) -> Result<&'a str, RigError> {
        self.value.as_str().ok_or_else(|| self.invalid(expected))
    }

    /// Its number.
    pub(super) fn number(&self, expected: &str) -> Result<f64, RigError> {
        number(self.value).ok_or_else(|| self.invalid(expected))
    }

    /// Its list of numbers.
    pub(super) fn numbers(&self, expected: &str) -> Result<Vec<f64>, RigError> {
        let list = self.value.as_array().ok_or_else(|| self.invalid(expected))?;
        let numbers: Option<Vec<f64>> = list.iter().map(|v| number(v.get_ref())).collect();
        numbers.ok_or_else(|| self.invalid(expected))
    }

    /// Its list of texts, each as an item of its own.
    pub(super) fn texts(
        &self,
        text: &str,
        expected: &str,
    ) -> Result<Vec<(usize, &'a str)>, RigError> {
        let list = self.value.as_array().ok_or_else(|| self.invalid(expected))?;
        let one = |value: &'a Spanned<DeValue<'a>>| {
            let item = item(text, self.key, value);
            Ok((item.line, item.text(expected)?))
        };
        list.iter().map(one).collect()
    }

    /// Its table.
    pub(super) fn table(&self, text: &'a str, name: &'a str) -> Result<Table<'a>, RigError> {
        let table = self.value.as_table().ok_or_else(|| self.invalid("a table"))?;
        Ok(Table { text, name, line: self.line, entries: table })
    }
}

/// The number a value is, also where it is not finite.
fn number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Float(f) => f.as_str().parse().ok(),
        DeValue::Integer(i) if i.radix() == 10 => i.as_str().parse().ok(),
        DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix()).ok().map(|i| i as f64),
        _ => None,
    }
}

/// A value as an error shows it.
fn shown(value: &DeValue) -> String {
    match value {
        DeValue::String(text) => quoted(text),
        DeValue::Float(f) => f.as_str().chars().take(40).collect(),
        DeValue::Integer(i) => i.as_str().chars().take(40).collect(),
        DeValue::Boolean(b) => b.to_string(),
        DeValue::Array(list) if list.len() > 8 => format!("a list of {}", list.len()),
        DeValue::Array(list) => {
            let flat = |v: &Spanned<DeValue>| match v.get_ref() {
                DeValue::Array(_) | DeValue::Table(_) => "…".to_owned(),
                plain => shown(plain),
            };
            format!("[{}]", list.iter().map(flat).collect::<Vec<_>>().join(", "))
        }
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
