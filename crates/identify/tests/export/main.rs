//! The C header, compiled with the C compiler and run beside our own simulation.

mod plant;
mod prescribed;
mod text;

use duhem::Parameters;
use identify::{Friction, Rig};
use std::{
    collections::BTreeMap,
    io::Write,
    process::{Command, Stdio},
};

/// A rig by its plant and its friction.
fn rig(kind: &'static str, plant: &[(&str, f64)], friction: Friction) -> Rig {
    Rig {
        title: format!("{kind} with {}", friction.name),
        kind,
        plant: plant.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect(),
        friction,
        free: Vec::new(),
        channels: BTreeMap::new(),
        controller: None,
        effects: Vec::new(),
    }
}

fn friction(name: &str, parameters: Parameters, sigma_2: f64) -> Friction {
    Friction { name: name.to_owned(), parameters, sigma_2 }
}

/// What `program`, with the header of `rig`, answers to pairs of numbers: one row for each.
fn run(rig: &Rig, program: &str, pairs: &[(f64, f64)]) -> Vec<Vec<f64>> {
    let folder = tempfile::tempdir().expect("a folder");
    let (source, built) = (folder.path().join("main.c"), folder.path().join("main"));
    let header = identify::export::c_header(rig).expect("a header");
    std::fs::write(folder.path().join("model.h"), &header).expect("written");
    std::fs::write(&source, program).expect("written");
    let flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O2"];
    let mut compiler = Command::new("cc");
    compiler.args(flags).arg(&source).arg("-o").arg(&built).arg("-lm");
    let compiled = compiler.output().expect("a C compiler, cc");
    assert!(compiled.status.success(), "{}\n{header}", String::from_utf8_lossy(&compiled.stderr));
    let mut child =
        Command::new(&built).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it runs");
    let mut stdin = child.stdin.take().expect("a pipe");
    let lines: Vec<String> = pairs.iter().map(|(a, b)| format!("{a:?} {b:?}\n")).collect();
    let writer = std::thread::spawn(move || stdin.write_all(lines.concat().as_bytes()));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("written").expect("written");
    let answer = String::from_utf8(output.stdout).expect("numbers");
    let numbers = |line: &str| line.split(' ').map(|n| n.parse().expect("a number")).collect();
    let rows: Vec<Vec<f64>> = answer.lines().map(numbers).collect();
    assert_eq!(rows.len(), pairs.len(), "rows");
    rows
}
