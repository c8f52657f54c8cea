//! An experiment's text, and where in it something stands.

use crate::{
    ExperimentError,
    error::{Complaint, one_of},
    spec::Spec,
};
use std::path::Path;
use toml::{Spanned, de::DeTable, de::DeValue};

/// The largest TOML that is read [bytes]; an experiment is a page or two.
const LARGEST: usize = 1 << 20;

/// A spec with the text it was read from, so that a complaint finds its line.
#[derive(Debug)]
pub(crate) struct Written<'a> {
    path: &'a Path,
    text: &'a str,
    tree: Spanned<DeTable<'a>>,
    /// The keys.
    pub(crate) spec: Spec,
}

impl<'a> Written<'a> {
    /// Parses `text`, the content of `path`.
    pub(crate) fn parse(path: &'a Path, text: &'a str) -> Result<Self, ExperimentError> {
        if text.len() > LARGEST {
            return Err(at(
                path,
                1,
                Complaint::new(
                    "the file",
                    format!("{} bytes", text.len()),
                    format!("at most {LARGEST} bytes"),
                ),
            ));
        }
        let tree = DeTable::parse(text).map_err(|e| syntax(path, text, &e))?;
        let spec = toml::from_str(text).map_err(|e| syntax(path, text, &e))?;
        Ok(Self { path, text, tree, spec })
    }

    /// The complaint with its file and line.
    pub(crate) fn error(&self, complaint: Complaint) -> ExperimentError {
        at(self.path, self.line(&complaint.key), complaint)
    }

    /// The line of `key`, as `study[0].model.gamma`, or of the innermost part of it that is written.
    fn line(&self, key: &str) -> usize {
        let mut table = Some(self.tree.get_ref());
        let mut start = 0;
        for step in key.split('.') {
            let (name, index) = match step.split_once('[') {
                Some((name, rest)) => (name, rest.trim_end_matches(']').parse::<usize>().ok()),
                None => (step, None),
            };
            let Some((written, value)) = table.and_then(|t| t.get_key_value(name)) else { break };
            start = written.span().start;
            let value = match (value.get_ref(), index) {
                (DeValue::Array(items), Some(i)) if i < items.len() => {
                    start = items[i].span().start;
                    items[i].get_ref()
                }
                (other, _) => other,
            };
            table = value.as_table();
        }
        line_at(self.text, start)
    }
}

fn line_at(text: &str, offset: usize) -> usize {
    1 + text.as_bytes().iter().take(offset).filter(|b| **b == b'\n').count()
}

fn at(path: &Path, line: usize, complaint: Complaint) -> ExperimentError {
    let Complaint { key, found, expected } = complaint;
    ExperimentError::Spec { path: path.to_path_buf(), line, key, found, expected }
}

/// A parser's error in our words, with the near miss named where it lists what it expected.
fn syntax(path: &Path, text: &str, error: &toml::de::Error) -> ExperimentError {
    let span = error.span().unwrap_or(0..0);
    let line = line_at(text, span.start);
    let message = error.message().lines().collect::<Vec<_>>().join("; ");
    if let Some((_, rest)) = message.split_once("unknown field `")
        && let Some((field, list)) = rest.split_once('`')
    {
        let known: Vec<&str> = list.split('`').skip(1).step_by(2).collect();
        let complaint = Complaint::new(field, "an unknown key", one_of(field, known));
        return at(path, line, complaint);
    }
    let tree = DeTable::parse(text).ok();
    let key = tree.and_then(|tree| key_at(tree.get_ref(), span.start));
    let key = key.unwrap_or_else(|| "TOML".to_owned());
    if let Some(missing) = message.strip_prefix("missing field ") {
        return at(path, line, Complaint::new(key, "nothing", format!("a key {missing}")));
    }
    if let Some((found, expected)) =
        message.strip_prefix("invalid type: ").and_then(|rest| rest.split_once(", expected "))
    {
        return at(path, line, Complaint::new(key, found, expected));
    }
    let written = text.get(span).unwrap_or("").lines().next().unwrap_or("");
    let short: String = written.chars().take(40).collect();
    let found = if short.is_empty() { message } else { format!("`{short}`: {message}") };
    at(path, line, Complaint::new(key, found, "TOML that can be read"))
}

/// The innermost key that stands at `offset` or whose value does, as `study[0].model.gamma`.
/// A table's own span is that of its header only, so every table is looked into.
fn key_at(table: &DeTable, offset: usize) -> Option<String> {
    table.iter().find_map(|(name, value)| {
        let inside = |value: &DeValue| value.as_table().and_then(|inner| key_at(inner, offset));
        let items = value.get_ref().as_array().into_iter().flatten().enumerate();
        let in_item = items.filter_map(|(i, item)| {
            let inner = inside(item.get_ref()).map(|key| format!("[{i}].{key}"));
            inner.or_else(|| item.span().contains(&offset).then(|| format!("[{i}]")))
        });
        let inner = in_item.last().or_else(|| inside(value.get_ref()).map(|key| format!(".{key}")));
        let here = name.span().contains(&offset) || value.span().contains(&offset);
        let tail = inner.or_else(|| here.then(String::new))?;
        Some(format!("{}{tail}", name.get_ref()))
    })
}
