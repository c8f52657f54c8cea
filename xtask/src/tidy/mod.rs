//! The house rules that a program can check.

mod crates;
mod equations;
mod lists;
mod sources;

use crate::{
    claims, effects,
    exit::{Exit, Failure},
    output, root,
};
use serde_json::json;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Checks every rule, prints every breach, ends with 1 if there is one.
pub(crate) fn tidy(root: &Path, as_json: bool) -> Result<Exit, Failure> {
    let mut breaches = layout(root)?;
    breaches.extend(crates::directions(root)?);
    breaches.extend(lists::complete(root)?);
    breaches.extend(sources::rules(root)?);
    breaches.extend(readme(root)?);
    if as_json {
        output::line(&format!("{:#}", json!({ "format": record::FORMAT, "breaches": breaches })));
    } else {
        for breach in &breaches {
            output::line(breach);
        }
    }
    if breaches.is_empty() {
        output::note("tidy: every house rule holds");
        return Ok(Exit::Done);
    }
    output::note(&format!("tidy: {} house rules are broken", breaches.len()));
    Ok(Exit::CheckFailed)
}

/// What may stand in the root besides dot files and the build's folder.
const ROOT: [&str; 12] = [
    "Cargo.toml",
    "Cargo.lock",
    "CITATION.cff",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "crates",
    "data",
    "experiments",
    "reports",
    "xtask",
    "target",
];

fn layout(root: &Path) -> Result<Vec<String>, Failure> {
    let mut breaches = Vec::new();
    let found = entries(root)?;
    for name in found.iter().filter(|n| !n.starts_with('.') && !ROOT.contains(&n.as_str())) {
        breaches.push(format!("{name}: the root holds only {}", ROOT.join(" ")));
    }
    for name in ROOT.iter().filter(|n| **n != "target" && !found.iter().any(|f| f == *n)) {
        breaches.push(format!("{name}: is missing from the root"));
    }
    Ok(breaches)
}

/// Prints the index of equations that the README shows.
pub(crate) fn equations(root: &Path) -> Result<Exit, Failure> {
    output::line(equations::table(root)?.trim_end());
    Ok(Exit::Done)
}

/// The README opens with the two commands, has its generated tables and a picture of every experiment,
/// and `.ci/run` calls the commands.
fn readme(root: &Path) -> Result<Vec<String>, Failure> {
    let mut breaches = Vec::new();
    let readme = read(&root.join("README.md"))?;
    for command in ["cargo xtask reproduce", "cargo test --workspace"] {
        if !readme.lines().take(40).any(|line| line.starts_with(command)) {
            breaches.push(format!("README.md: `{command}` does not stand in its first 40 lines"));
        }
    }
    for name in root::experiments(root)? {
        // A picture is `![…](reports/NAME/figure.svg)`.
        let place = format!("](reports/{name}/");
        let shown = readme.split(&place).skip(1).any(|rest| {
            rest.split_once(')')
                .is_some_and(|(file, _)| Path::new(file).extension().is_some_and(|e| e == "svg"))
        });
        if !shown {
            breaches.push(format!("README.md: shows no picture of {name}"));
        }
    }
    breaches.extend(equations::rules(root, &readme)?);
    let claims = claims::table(&claims::committed(root, &root.join("reports"))?);
    for (of, table) in [("claims", claims), ("effects", effects::table())] {
        if !readme.contains(&table) {
            let command = format!("cargo xtask {of} --markdown");
            breaches.push(format!("README.md: its table of {of} is not what `{command}` prints"));
        }
    }
    let ci = read(&root.join(".ci/run"))?;
    for command in
        ["cargo fmt", "cargo clippy", "cargo test --workspace", "tidy", "reproduce --check"]
    {
        if !ci.contains(command) {
            breaches.push(format!(".ci/run: does not call `{command}`"));
        }
    }
    Ok(breaches)
}

/// The names in a folder, sorted.
fn entries(folder: &Path) -> Result<Vec<String>, Failure> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(|e| missing(folder, e))? {
        names.push(entry.map_err(Failure::environment)?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

fn read(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path).map_err(|e| missing(path, e))
}

fn missing(path: &Path, error: std::io::Error) -> Failure {
    Failure::environment(anyhow::Error::new(error).context(path.display().to_string()))
}

/// Every Rust file below a folder, sorted.
fn rust_files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for name in entries(folder)? {
        let path = folder.join(&name);
        if path.is_dir() {
            files.extend(rust_files(&path)?);
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    Ok(files)
}
