//! `cargo xtask bench anchors`: the problems P1 to P6 by all methods.

use super::{built, machine, patch, table};
use crate::{
    cli::AnchorsArgs,
    exit::{Exit, Failure},
    output,
    saved::{self, Machine, Patched, Reference, Saved},
};
use anyhow::anyhow;
use record::write_whole;
use serde::de::DeserializeOwned;
use serde_json::Value;
use simulation::anchors::Row;
use std::{
    collections::BTreeMap,
    ffi::OsString,
    fs,
    io::{IsTerminal, stderr},
    path::Path,
};

/// Builds the program, runs it, prints its rows or a table of them, and keeps the run if asked to.
pub(super) fn run(root: &Path, arguments: &AnchorsArgs) -> Result<Exit, Failure> {
    if let Some(name) = &arguments.saved {
        let run = saved::read(root, name)?;
        if arguments.json {
            run.rows.iter().for_each(print);
        } else {
            output::line(table::text(&run).trim_end());
        }
        return Ok(Exit::Done);
    }
    // What can be wrong is looked at before minutes are spent.
    let place = arguments.save.as_ref().map(|name| saved::place(root, name)).transpose()?;
    let told = program_arguments(arguments)?;
    let target = root.join("target/duhem/bench");
    let native = !arguments.portable;
    let (program, patched) = match &arguments.patch {
        Some(asked) => {
            let (program, patched) = patch::build(root, asked, native)?;
            (program, Some(patched))
        }
        None => (built::build((root, "simulation", "anchors"), &target, native, true)?, None),
    };
    let mut run = empty(root, arguments, program.rustc.clone(), patched)?;
    built::run(&program.program, &told, |value| take(&mut run, value, arguments.json))?;
    if !arguments.json {
        output::line(table::text(&run).trim_end());
    }
    if let Some(place) = place {
        write_whole(&place, run.text().as_bytes())?;
        output::note(&format!("kept as {}", place.display()));
    }
    Ok(Exit::Done)
}

/// What the program is told.
fn program_arguments(arguments: &AnchorsArgs) -> Result<Vec<OsString>, Failure> {
    let mut told: Vec<OsString> = arguments.problems.iter().map(OsString::from).collect();
    if arguments.quick {
        told.push("--quick".into());
    }
    if let Some(refs) = &arguments.refs {
        if !refs.is_dir() {
            let words = format!("--refs {}: expected a folder of tables", refs.display());
            return Err(Failure::usage(words));
        }
        let whole = fs::canonicalize(refs).map_err(Failure::environment)?;
        told.extend(["--refs".into(), whole.into()]);
    }
    Ok(told)
}

/// A run before its first row.
fn empty(
    root: &Path,
    arguments: &AnchorsArgs,
    rustc: String,
    patch: Option<Patched>,
) -> Result<Saved, Failure> {
    let (claims, measures) = saved::ledger(root)?;
    let text = |(name, version): (&str, &str)| (name.to_owned(), version.to_owned());
    let mut libraries: BTreeMap<_, _> = integrate::versions().into_iter().map(text).collect();
    if let Some(patch) = &patch {
        libraries.insert(patch.library.clone(), patch.version.clone());
    }
    let machine = Machine {
        processor: machine::processor(),
        native: !arguments.portable,
        target_features: Vec::new(),
        rustc,
    };
    let (quick, references, rows) = (arguments.quick, Vec::new(), Vec::new());
    Ok(Saved { machine, libraries, patch, quick, references, rows, claims, measures })
}

/// Takes down one thing the program tells; a row is printed as it comes if that is wanted.
fn take(run: &mut Saved, mut value: Value, as_json: bool) -> Result<(), Failure> {
    if let Some(built) = value.get_mut("built") {
        run.machine.target_features = meant(built["target_features"].take())?;
    } else if let Some(reference) = value.get_mut("reference") {
        let reference: Reference = meant(reference.take())?;
        if stderr().is_terminal() {
            let parameter = reference.parameter.map_or(String::new(), |value| format!(" {value}"));
            output::note(&format!("{}{parameter} …", reference.problem));
        }
        run.references.push(reference);
    } else if let Some(row) = value.get_mut("row") {
        let row: Row = meant(row.take())?;
        if as_json {
            print(&row);
        }
        run.rows.push(row);
    }
    Ok(())
}

/// In the order of the design, which a map of JSON would not keep.
fn print(row: &Row) {
    if let Ok(text) = serde_json::to_string(row) {
        output::line(&text);
    }
}

fn meant<T: DeserializeOwned>(value: Value) -> Result<T, Failure> {
    let bug = |why| Failure { exit: Exit::Bug, error: anyhow!("the benchmark told: {why}") };
    serde_json::from_value(value).map_err(bug)
}
