//! Rules for the text of sources: sizes, equation numbers, no path of a machine, no unfinished mark.

use super::{read, rust_files};
use crate::exit::Failure;
use std::{collections::BTreeMap, path::Path};

/// The longest file [lines]; a model's is shorter.
const LONGEST: usize = 400;
/// The longest file of a model [lines].
const LONGEST_MODEL: usize = 80;

/// What no committed text may hold, put together here so that this file does not hold it either.
fn forbidden() -> [(String, &'static str); 7] {
    let slash = "/";
    [
        (format!("{slash}home{slash}"), "a path of one machine"),
        (format!("{slash}root{slash}"), "a path of one machine"),
        (format!("{slash}work{slash}"), "a path of one machine"),
        (format!("{}!(", "todo"), "an unfinished mark"),
        (format!("{}!(", "unimplemented"), "an unfinished mark"),
        (format!("TO{}", "DO"), "an unfinished mark"),
        (format!("FIX{}", "ME"), "an unfinished mark"),
    ]
}

pub(super) fn rules(root: &Path) -> Result<Vec<String>, Failure> {
    let mut breaches = Vec::new();
    let mut equations: BTreeMap<String, String> = BTreeMap::new();
    let mut files = rust_files(&root.join("crates"))?;
    files.extend(rust_files(&root.join("xtask"))?);
    let forbidden = forbidden();
    for path in files {
        let shown = path.strip_prefix(root).unwrap_or(&path).display().to_string();
        let text = read(&path)?;
        let lines = text.lines().count();
        let tests = text.split("#[cfg(test)]").next().unwrap_or("").lines().count();
        if lines > LONGEST {
            breaches.push(format!("{shown}: {lines} lines; a file stays below {LONGEST}"));
        }
        if shown.contains("/models/") && !shown.ends_with("mod.rs") && tests > LONGEST_MODEL {
            breaches.push(format!(
                "{shown}: {tests} lines; a model's file stays below {LONGEST_MODEL}"
            ));
        }
        for (i, line) in text.lines().enumerate() {
            for (mark, what) in &forbidden {
                if line.contains(mark.as_str()) {
                    breaches.push(format!("{shown}:{}: {what}", i + 1));
                }
            }
            let Some(number) = equation(line) else { continue };
            let here = format!("{shown}:{}", i + 1);
            if let Some(there) = equations.insert(number.clone(), here.clone()) {
                breaches.push(format!("{here}: equation ({number}) stands at {there} already"));
            }
        }
    }
    for name in crate::root::experiments(root)? {
        let text = read(&root.join("experiments").join(format!("{name}.toml")))?;
        for (mark, what) in &forbidden {
            if text.contains(mark.as_str()) {
                breaches.push(format!("experiments/{name}.toml: {what}"));
            }
        }
    }
    Ok(breaches)
}

/// The number that a doc line ends with, as in `/// F = … (19)`.
pub(super) fn equation(line: &str) -> Option<String> {
    let text = line.trim_start().strip_prefix("///")?;
    let (before, number) = text.trim_end().strip_suffix(')')?.rsplit_once('(')?;
    let digits = !number.is_empty() && number.chars().all(|c| c.is_ascii_digit());
    (digits && before.contains(['=', '<', '≤', '>'])).then(|| number.to_owned())
}
