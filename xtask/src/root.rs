//! The project's folder, and the experiments in it.

use crate::exit::{Exit, Failure};
use std::{
    env, fs,
    path::{Path, PathBuf},
};

/// The folder given, or the nearest one above the current one that looks like the project, or where this
/// program was built.
pub(crate) fn find(given: Option<&Path>) -> Result<PathBuf, Failure> {
    if let Some(root) = given {
        if !root.join("experiments").is_dir() {
            let message =
                format!("--root {}: expected a folder with experiments/ in it", root.display());
            return Err(Failure::usage(message));
        }
        return Ok(root.to_path_buf());
    }
    let here = env::current_dir().map_err(Failure::environment)?;
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("/"));
    let looks_right = |folder: &&Path| {
        folder.join("experiments").is_dir() && folder.join("xtask/Cargo.toml").is_file()
    };
    here.ancestors()
        .chain([built])
        .find(looks_right)
        .map(Path::to_path_buf)
        .ok_or_else(|| Failure::usage("found no project here; give its folder with --root DIR"))
}

/// The names of all experiments, sorted.
pub(crate) fn experiments(root: &Path) -> Result<Vec<String>, Failure> {
    let folder = root.join("experiments");
    let mut names = Vec::new();
    for entry in fs::read_dir(&folder).map_err(Failure::environment)? {
        let path = entry.map_err(Failure::environment)?.path();
        if path.extension().is_some_and(|e| e == "toml") {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            if !plain(&name) || !path.is_file() {
                let shown = path.file_name().unwrap_or_default();
                let found = format!("experiments/{}", shown.to_string_lossy().escape_debug());
                return Err(Failure {
                    exit: Exit::Input,
                    error: anyhow::anyhow!(
                        "{found}: expected a file whose name is lower case letters, digits and dashes"
                    ),
                });
            }
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

/// Whether a text can name an experiment, its folder and its place in the page.
pub(crate) fn plain(name: &str) -> bool {
    let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    (1..=64).contains(&name.len()) && name.chars().all(allowed) && !name.starts_with('-')
}

/// The experiments of these names, or all; an unknown name is a usage error with the near miss.
pub(crate) fn chosen(root: &Path, names: &[String]) -> Result<Vec<String>, Failure> {
    let all = experiments(root)?;
    for name in names {
        if !all.contains(name) {
            let near = all.iter().min_by_key(|known| strsim::damerau_levenshtein(name, known));
            let near = near
                .filter(|known| strsim::damerau_levenshtein(name, known) <= 1 + known.len() / 4)
                .map_or(String::new(), |known| format!(" (did you mean `{known}`?)"));
            return Err(Failure::usage(format!(
                "`{name}` is no experiment; expected one of {}{near}",
                all.join(", ")
            )));
        }
    }
    Ok(if names.is_empty() { all } else { all.into_iter().filter(|n| names.contains(n)).collect() })
}

/// The TOML of an experiment, as a reader would name it: relative to the current folder where it lies below.
pub(crate) fn toml(root: &Path, name: &str) -> PathBuf {
    let path = root.join("experiments").join(format!("{name}.toml"));
    env::current_dir()
        .ok()
        .and_then(|here| path.strip_prefix(here).ok().map(Path::to_path_buf))
        .unwrap_or(path)
}
