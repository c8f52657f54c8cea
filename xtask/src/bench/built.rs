//! The benchmark program built, in a folder of its own, and run.

use crate::{
    exit::{Exit, Failure},
    output,
};
use anyhow::{Context, anyhow};
use serde_json::Value;
use std::{
    env,
    ffi::OsString,
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// The program, and what cargo built it from.
#[derive(Debug)]
pub(super) struct Built {
    /// The program.
    pub(super) program: PathBuf,
    /// The compiler.
    pub(super) rustc: String,
    /// The package ids of what was built or found built, as cargo gives them.
    pub(super) packages: Vec<String>,
}

/// Builds the bench `name` of the crate `package` in `folder`, for this processor or for any, into `target`.
/// `fixed` holds Cargo.lock as it is.
pub(super) fn build(
    (folder, package, name): (&Path, &str, &str),
    target: &Path,
    native: bool,
    fixed: bool,
) -> Result<Built, Failure> {
    let words = if native { "for this processor" } else { "portable" };
    output::note(&format!("building the benchmark, optimised and {words}"));
    let mut cargo = Command::new(tool("CARGO", "cargo"));
    cargo
        .args(["bench", "--quiet", "--no-run", "--package", package, "--bench", name])
        .args(["--message-format", "json-render-diagnostics"])
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", target)
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .stdin(Stdio::null())
        .stderr(Stdio::inherit());
    if fixed {
        cargo.arg("--locked");
    }
    let mut flags = env::var("RUSTFLAGS").unwrap_or_default();
    if native {
        flags.push_str(" -C target-cpu=native");
    }
    cargo.env("RUSTFLAGS", flags.trim());
    let ran = cargo.output().context("cannot run cargo").map_err(Failure::environment)?;
    if !ran.status.success() {
        return Err(Failure::environment(anyhow!("cargo could not build the benchmark")));
    }
    let messages = String::from_utf8_lossy(&ran.stdout);
    let artifacts: Vec<Value> = messages
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok())
        .filter(|message| message["reason"] == "compiler-artifact")
        .collect();
    let program = artifacts
        .iter()
        .filter(|artifact| artifact["target"]["name"] == name)
        .find_map(|artifact| artifact["executable"].as_str());
    let program = program.ok_or_else(|| Failure {
        exit: Exit::Bug,
        error: anyhow!("cargo built no benchmark named {name}"),
    })?;
    let id = |artifact: &Value| artifact["package_id"].as_str().map(ToOwned::to_owned);
    let packages = artifacts.iter().filter_map(id).collect();
    Ok(Built { program: PathBuf::from(program), rustc: rustc(folder)?, packages })
}

/// The compiler's name and version.
fn rustc(folder: &Path) -> Result<String, Failure> {
    let ran = Command::new(tool("RUSTC", "rustc")).arg("-V").current_dir(folder).output();
    let ran = ran.context("cannot run rustc").map_err(Failure::environment)?;
    Ok(String::from_utf8_lossy(&ran.stdout).trim().to_owned())
}

fn tool(variable: &str, name: &str) -> OsString {
    env::var_os(variable).unwrap_or_else(|| name.into())
}

/// Runs the program and hands on each thing it tells.
pub(super) fn run(
    program: &Path,
    arguments: &[OsString],
    mut told: impl FnMut(Value) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::piped());
    let mut child = command.spawn().context("cannot run it").map_err(Failure::environment)?;
    let bug = |words: String| Failure { exit: Exit::Bug, error: anyhow!(words) };
    let mut wrong = None;
    if let Some(out) = child.stdout.take() {
        for line in BufReader::new(out).lines() {
            let line = line.map_err(Failure::environment)?;
            let value: Value = serde_json::from_str(&line)
                .map_err(|why| bug(format!("the benchmark said `{line}`: {why}")))?;
            match value["wrong"].as_str() {
                Some(words) => wrong = Some(words.to_owned()),
                None => told(value)?,
            }
        }
    }
    let status = child.wait().map_err(Failure::environment)?;
    match (status.code(), wrong) {
        (Some(0), _) => Ok(()),
        (Some(4), Some(words)) => Err(Failure { exit: Exit::Input, error: anyhow!(words) }),
        (_, words) => {
            let words = words.unwrap_or_default();
            Err(bug(format!("the benchmark ended with {status} {words}").trim().to_owned()))
        }
    }
}
