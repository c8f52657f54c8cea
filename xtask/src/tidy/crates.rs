//! Which crate may depend on which.

use super::{entries, read};
use crate::exit::{Exit, Failure};
use std::path::Path;

/// Our crates and those of ours they may depend on.
const MAY: [(&str, &[&str]); 10] = [
    ("duhem", &[]),
    ("integrate", &[]),
    ("simulation", &["duhem", "integrate"]),
    ("identify", &["duhem", "integrate", "simulation"]),
    // The twin in its tests alone.
    ("discover", &["duhem", "identify", "twin"]),
    ("twin", &[]),
    ("record", &[]),
    ("experiment", &["duhem", "integrate", "simulation", "identify", "discover", "record"]),
    ("report", &["record"]),
    (
        "xtask",
        &[
            "duhem",
            "integrate",
            "simulation",
            "identify",
            "discover",
            "twin",
            "record",
            "experiment",
            "report",
        ],
    ),
];

/// The heavy crates and the only ones of ours that may use them.
const HEAVY: [(&str, &[&str]); 5] = [
    ("diffsol", &["integrate"]),
    ("ode_solvers", &["integrate"]),
    ("polars", &["record"]),
    ("plotters", &["report"]),
    ("rayon", &["experiment", "identify", "discover", "integrate"]),
];

pub(super) fn directions(root: &Path) -> Result<Vec<String>, Failure> {
    let mut names = entries(&root.join("crates"))?;
    names.push("xtask".to_owned());
    let mut breaches = Vec::new();
    for name in &names {
        let file = if name == "xtask" {
            "xtask/Cargo.toml".to_owned()
        } else {
            format!("crates/{name}/Cargo.toml")
        };
        let Some((_, may)) = MAY.iter().find(|(known, _)| known == name) else {
            breaches.push(format!("{file}: the style sheet knows no crate `{name}`"));
            continue;
        };
        let table: toml::Table = toml::from_str(&read(&root.join(&file))?).map_err(|e| {
            Failure { exit: Exit::Input, error: anyhow::Error::new(e).context(file.clone()) }
        })?;
        for section in ["dependencies", "dev-dependencies", "build-dependencies"] {
            let Some(dependencies) = table.get(section).and_then(toml::Value::as_table) else {
                continue;
            };
            for (dependency, how) in dependencies {
                let ours = MAY.iter().any(|(known, _)| known == dependency);
                if ours && !may.contains(&dependency.as_str()) {
                    breaches.push(format!("{file}: {name} may not depend on {dependency}"));
                }
                let heavy = HEAVY.iter().find(|(heavy, _)| heavy == dependency);
                if heavy.is_some_and(|(_, places)| !places.contains(&name.as_str())) {
                    breaches.push(format!("{file}: {dependency} has no place in {name}"));
                }
                if how.get("workspace").is_none() || how.get("features").is_some() {
                    breaches.push(format!(
                        "{file}: {dependency}: versions and features stand in the root manifest only"
                    ));
                }
            }
        }
    }
    Ok(breaches)
}
