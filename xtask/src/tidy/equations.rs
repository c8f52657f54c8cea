//! The index of equations: which function stands below which, from the sources.

use super::{read, rust_files, sources::equation};
use crate::exit::Failure;
use std::{collections::BTreeMap, fmt::Write, path::Path};

/// The paper's last equation.
const LAST: u32 = 41;
/// The first of the plants' equations: until they are there, no whole index is asked for.
const PLANTS: u32 = 27;
/// The paper's own repeats: the number, the equation it repeats, and how.
const ALIASES: [(u32, u32, &str); 4] = [
    (30, 11, "(11) with u = q"),
    (34, 18, "(18) with u = q"),
    (35, 19, "(19) with u = q"),
    (36, 20, "(20) with u = q"),
];

/// One equation and what stands below it.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Equation {
    /// The equation as its doc line has it.
    text: String,
    /// The function or type, as `LuGre::x_dot`; none if nothing that has a name stands below.
    item: Option<String>,
    /// The file.
    file: String,
}

/// Every equation of the sources, by its number.
fn index(root: &Path) -> Result<BTreeMap<u32, Equation>, Failure> {
    let mut all = BTreeMap::new();
    for path in rust_files(&root.join("crates"))? {
        let file = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        for (number, text, item) in of_file(&read(&path)?) {
            all.entry(number).or_insert(Equation { text, item, file: file.clone() });
        }
    }
    Ok(all)
}

/// The equations of one file: number, text, and the item below.
fn of_file(text: &str) -> Vec<(u32, String, Option<String>)> {
    let lines: Vec<&str> = text.lines().collect();
    let number = |line: &str| equation(line).and_then(|number| number.parse().ok());
    let found = lines.iter().enumerate().filter_map(|(at, line)| Some((at, line, number(line)?)));
    let row = |(at, line, number): (usize, &&str, u32)| {
        let text = line.trim_start().trim_start_matches('/');
        let text = text.rsplit_once('(').map_or(text, |(text, _)| text).trim().to_owned();
        (number, text, below(&lines, at))
    };
    found.map(row).collect()
}

/// The name of the item below a doc line, with the type it belongs to.
fn below(lines: &[&str], at: usize) -> Option<String> {
    let mut inside_attribute = false;
    let item = lines[at..].iter().find(|line| {
        let line = line.trim();
        let attribute = inside_attribute || line.starts_with("#[");
        inside_attribute = attribute && !line.ends_with(']');
        !attribute && !line.starts_with("//")
    })?;
    let name = named(item)?;
    if !item.starts_with(' ') {
        return Some(name);
    }
    let owner = lines[..at].iter().rev().find_map(|line| owner(line))?;
    Some(format!("{owner}::{name}"))
}

/// The name that this line declares.
fn named(line: &str) -> Option<String> {
    const KINDS: [&str; 5] = ["fn", "struct", "enum", "trait", "type"];
    let mut words = line.split_whitespace().skip_while(|word| {
        word.starts_with("pub") || matches!(*word, "const" | "unsafe" | "async")
    });
    words.next().filter(|kind| KINDS.contains(kind))?;
    words.next().map(identifier)
}

/// The type or trait that a line without indent opens the inside of.
fn owner(line: &str) -> Option<String> {
    if let Some(rest) = line.strip_prefix("impl") {
        let of = rest.rsplit_once(" for ").map_or(rest, |(_, of)| of);
        return of.split_whitespace().map(identifier).find(|name| !name.is_empty());
    }
    let (_, rest) = line.split_once("trait ").filter(|(before, _)| {
        before.is_empty() || (before.starts_with("pub") && !before.contains("//"))
    })?;
    Some(identifier(rest))
}

fn identifier(word: &str) -> String {
    word.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// The index as the README shows it.
pub(super) fn table(root: &Path) -> Result<String, Failure> {
    Ok(markdown(&index(root)?))
}

fn markdown(index: &BTreeMap<u32, Equation>) -> String {
    let mut text = "| equation | | function |\n|---|---|---|\n".to_owned();
    for number in 1..=LAST {
        let alias = ALIASES.iter().find(|(own, _, _)| *own == number);
        let of = if index.contains_key(&number) { None } else { alias };
        let Some(found) = index.get(&of.map_or(number, |(_, of, _)| *of)) else { continue };
        let says =
            of.map_or_else(|| format!("`{}`", found.text), |(_, _, says)| (*says).to_owned());
        let item = found.item.as_deref().unwrap_or("–");
        let says = says.replace('|', "\\|");
        let _ = writeln!(text, "| ({number}) | {says} | [`{item}`]({}) |", found.file);
    }
    text
}

/// Every equation has a function, and the README the index: as soon as the plants' equations are there.
pub(super) fn rules(root: &Path, readme: &str) -> Result<Vec<String>, Failure> {
    let index = index(root)?;
    let mut breaches = nameless(&index);
    if index.keys().any(|number| *number >= PLANTS) {
        breaches.extend(missing(&index));
        if !readme.contains(&markdown(&index)) {
            breaches.push(
                "README.md: its index of equations is not what `cargo xtask tidy --equations` prints"
                    .to_owned(),
            );
        }
    }
    Ok(breaches)
}

/// Equations above nothing that has a name, and numbers the paper does not have.
fn nameless(index: &BTreeMap<u32, Equation>) -> Vec<String> {
    let mut breaches = Vec::new();
    for (number, Equation { item, file, .. }) in index {
        if item.is_none() {
            breaches.push(format!("{file}: equation ({number}) stands above no function"));
        }
        if !(1..=LAST).contains(number) {
            breaches.push(format!("{file}: ({number}) is no equation of the paper, 1 to {LAST}"));
        }
    }
    breaches
}

/// Equations of the paper that have neither a function nor an alias with one.
fn missing(index: &BTreeMap<u32, Equation>) -> Vec<String> {
    let there = |number: u32| {
        let alias = ALIASES.iter().find(|(own, _, _)| *own == number);
        index.contains_key(&number) || alias.is_some_and(|(_, of, _)| index.contains_key(of))
    };
    (1..=LAST)
        .filter(|number| !there(*number))
        .map(|number| format!("equation ({number}) has neither a function nor an alias"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn equation(item: Option<&str>) -> Equation {
        let (text, file) = ("F = |x|".to_owned(), "crates/a.rs".to_owned());
        Equation { text, item: item.map(str::to_owned), file }
    }

    #[test]
    fn an_equation_belongs_to_the_function_below_it_and_its_type() {
        let text = "impl<'a> FrictionModel for LuGre<'a> {\n    /// More words.\n    ///\n    \
                    /// F = σ₀x   (19)\n    #[expect(\n        x, reason = \"y\"\n    )]\n    \
                    pub(crate) fn force(&self) {\n    }\n}\n\n/// U(v) = 1   (26)\npub const fn unit(v: f64) {\n}\n\
                    pub trait Form: Send {\n    /// y = h   (2)\n    /// v = 0   (31)\n    fn h(&self);\n}\n\
                    impl Wide {\n    /// G(s) = 1   (29)\n    pub field: f64,\n}\n";
        let all = of_file(text);
        let found: Vec<_> =
            all.iter().map(|(n, text, i)| (*n, text.as_str(), i.as_deref())).collect();
        assert_eq!(
            found,
            [
                (19, "F = σ₀x", Some("LuGre::force")),
                (26, "U(v) = 1", Some("unit")),
                (2, "y = h", Some("Form::h")),
                (31, "v = 0", Some("Form::h")),
                (29, "G(s) = 1", None),
            ]
        );
    }

    #[test]
    fn an_equation_without_function_or_alias_is_told_and_the_papers_repeats_are_aliases() {
        let aliases = [30, 34, 35, 36];
        let mut index: BTreeMap<u32, Equation> =
            (1..=LAST).filter(|n| !aliases.contains(n)).map(|n| (n, equation(Some("f")))).collect();
        assert_eq!(missing(&index), Vec::<String>::new());
        let text = markdown(&index);
        assert_eq!(text.lines().count(), 2 + 41);
        assert!(text.contains("| (30) | (11) with u = q | [`f`](crates/a.rs) |\n"), "{text}");
        assert!(text.contains("| (31) | `F = \\|x\\|` | [`f`](crates/a.rs) |\n"), "{text}");
        index.remove(&18);
        let told = missing(&index).join("; ");
        assert!(told.starts_with("equation (18) has neither a function nor an alias"), "{told}");
        assert!(
            told.contains("equation (34) has"),
            "a repeat of what is missing is missing: {told}"
        );
        index.insert(42, equation(None));
        assert_eq!(nameless(&index).len(), 2, "above nothing, and not of the paper");
    }
}
