//! A project of its own in a temporary folder, and the built program run on it.

#![allow(dead_code, unused_imports, reason = "each test file uses its own part")]

pub(crate) mod run;
pub(crate) mod saved;

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;

/// The experiment of this repository that the tests use.
pub(crate) const REAL: &str = include_str!("../../../experiments/dahl-gamma-sweep.toml");

/// The smallest experiment that runs, with the given solvers.
pub(crate) fn small(solvers: &str) -> String {
    format!(
        r#"title = "small"
paper = "none"
text  = "A test."
budget = 20000

[[study]]
name      = "first"
title     = "The first"
model     = {{ name = "dahl", f_c = 0.75, sigma = 1.5 }}
input     = {{ shape = "sine", amplitude = 1.0, omega = 0.1 }}
sweep     = {{ gamma = [1.0, 2.0] }}
periods   = 1
solvers   = [{solvers}]
steps     = [33, 65]
rtol      = [1e-3, 1e-6]
corners   = ["restart"]
reference = "dahl"

[[figure]]
name        = "work"
kind        = "work_precision"
study       = "first"
title       = "Error against work"
description = "Error against work."
caption     = "All solvers."
"#
    )
}

/// A project: a folder with `experiments/` in it.
#[derive(Debug)]
pub(crate) struct Project {
    folder: TempDir,
}

impl Project {
    pub(crate) fn new(experiments: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::create_dir(folder.path().join("experiments")).expect("experiments/");
        for (name, text) in experiments {
            fs::write(folder.path().join("experiments").join(name), text).expect("an experiment");
        }
        Self { folder }
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// `what` is computed on one thread and again on eight, and then taken from its record: the files are the same,
    /// and one that ends in `table` is among them.
    pub(crate) fn same_on_threads_and_from_record(&self, what: &str, table: &str) {
        let run = |more: &[&str]| {
            let ran = self.run(&[&["reproduce", "--quick", "--explain"], more].concat());
            assert_eq!(ran.code, Some(0), "{ran:?}");
            (self.files("target/duhem/quick"), ran.err)
        };
        let (one, _) = run(&["--threads", "1"]);
        assert!(one.keys().any(|path| path.ends_with(table)), "{:?}", one.keys());
        let (eight, said) = run(&["--threads", "8", "--fresh"]);
        assert!(said.contains(&format!("{what}: ran")), "{said}");
        assert_eq!(difference(&one, &eight), None, "8 threads");
        let (again, said) = run(&[]);
        assert!(said.contains(&format!("{what}: reused")), "{said}");
        assert_eq!(difference(&one, &again), None, "from its record");
    }

    /// The program, set up for this project, from a folder that is not the project's.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
        command.arg("--root").arg(self.path()).args(arguments).current_dir("/");
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Ran {
        Ran::of(&self.command(arguments).output().expect("the built program"))
    }

    /// Every file under `folder`, by its path in the project.
    pub(crate) fn files(&self, folder: &str) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut files = BTreeMap::new();
        collect(&self.path().join(folder), self.path(), &mut files);
        files
    }
}

fn collect(folder: &Path, root: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.map(|entry| entry.expect("an entry").path()) {
        if path.is_dir() {
            collect(&path, root, files);
        } else {
            let name = path.strip_prefix(root).expect("below the root").to_path_buf();
            files.insert(name, fs::read(&path).expect("a readable file"));
        }
    }
}

/// How a run ended and what it said.
#[derive(Debug)]
pub(crate) struct Ran {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Ran {
    fn of(output: &Output) -> Self {
        Self {
            code: output.status.code(),
            out: String::from_utf8_lossy(&output.stdout).into_owned(),
            err: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }
}

/// The first difference between two sets of files, in words.
pub(crate) fn difference(
    left: &BTreeMap<PathBuf, Vec<u8>>,
    right: &BTreeMap<PathBuf, Vec<u8>>,
) -> Option<String> {
    let names: Vec<_> = left.keys().chain(right.keys()).collect();
    names
        .into_iter()
        .find(|name| left.get(*name) != right.get(*name))
        .map(|name| format!("{} differs or is on one side only", name.display()))
}
