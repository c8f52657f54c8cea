//! Scaffolding.

use crate::{
    cli::New,
    exit::{Exit, Failure},
    output, root,
};
use std::path::Path;

/// A small experiment that runs as it stands.
const TEMPLATE: &str = r#"title = "NAME"
paper = "which figures and equations"
text  = """What is asked."""

[[study]]
name      = "first"
title     = "What the reader sees first"
text      = """The physics, with its equation."""
model     = { name = "dahl", f_c = 0.75, sigma = 1.5, gamma = 1.0 } # N, N/m
input     = { shape = "sine", amplitude = 1.0, omega = 0.1 }        # m, rad/s
periods   = 3
solvers   = ["rk4", "dopri5"]
steps     = [33, 65, 129]
rtol      = [1e-3, 1e-6, 1e-9]
corners   = ["restart", "ignore"]
reference = "dahl"

[[figure]]
name        = "work"
kind        = "work_precision"
study       = "first"
title       = "Error against work"
description = "For a reader who cannot see it."
caption     = "What to see in it."
"#;

/// Writes the new file, and never over an old one.
pub(crate) fn new(root: &Path, what: &New) -> Result<Exit, Failure> {
    let New::Experiment { name } = what;
    if !root::plain(name) {
        let message = format!("`{name}`: expected lower case letters, digits and dashes");
        return Err(Failure::usage(message));
    }
    if root::experiments(root)?.contains(name) {
        return Err(Failure::usage(format!("experiments/{name}.toml is there already")));
    }
    let path = root.join("experiments").join(format!("{name}.toml"));
    record::write_whole(&path, TEMPLATE.replace("NAME", name).as_bytes())?;
    output::line(&format!("wrote experiments/{name}.toml; now: cargo xtask reproduce {name}"));
    Ok(Exit::Done)
}
