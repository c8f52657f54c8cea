//! The benchmark built with a changed library: in a copy of the workspace, so that the project's own
//! Cargo.lock is never touched.

use super::built::{self, Built};
use crate::{
    exit::{Exit, Failure},
    saved::Patched,
};
use anyhow::{Context, anyhow};
use record::{sha256, write_whole};
use std::{
    collections::BTreeMap,
    fmt::Write,
    fs,
    path::{Path, PathBuf},
};

/// Builds the program with the library that `asked` names, as `diffsol=PATH`, from its folder.
pub(super) fn build(root: &Path, asked: &str, native: bool) -> Result<(Built, Patched), Failure> {
    let (library, folder) = library(asked)?;
    let patched = patched(library, &folder)?;
    let copy = root.join("target/duhem/patched");
    copy_workspace(root, &copy)?;
    let manifest = copy.join("Cargo.toml");
    let mut text = read(&manifest)?;
    let path = toml::Value::from(folder.display().to_string());
    let _ = write!(text, "\n[patch.crates-io]\n{library} = {{ path = {path} }}\n");
    write_whole(&manifest, text.as_bytes())?;
    let built = built::build(
        (&copy, "simulation", "anchors"),
        &root.join("target/duhem/bench"),
        native,
        false,
    )?;
    confirm(library, &folder, &built.packages)?;
    Ok((built, patched))
}

/// The library and its folder.
fn library(asked: &str) -> Result<(&'static str, PathBuf), Failure> {
    let known: Vec<&'static str> =
        integrate::versions().into_iter().map(|(name, _)| name).collect();
    let usage = |found: String| {
        let words = format!("--patch {asked}: {found}; expected {}=PATH", known.join("=PATH or "));
        Failure::usage(words)
    };
    let (name, path) = asked.split_once('=').ok_or_else(|| usage("no path".to_owned()))?;
    let library = known.iter().find(|known| **known == name);
    let library = *library.ok_or_else(|| usage(format!("no library is called {name}")))?;
    let folder = fs::canonicalize(path).map_err(|why| input(asked, &why.to_string()))?;
    Ok((library, folder))
}

fn input(what: &str, why: &str) -> Failure {
    Failure { exit: Exit::Input, error: anyhow!("{what}: {why}") }
}

/// What the folder holds, if it is this library in the version that is pinned.
fn patched(library: &str, folder: &Path) -> Result<Patched, Failure> {
    let manifest = folder.join("Cargo.toml");
    let shown = manifest.display().to_string();
    let text = fs::read_to_string(&manifest).map_err(|why| input(&shown, &why.to_string()))?;
    let table: toml::Table = toml::from_str(&text).map_err(|why| input(&shown, why.message()))?;
    let key = |key: &str| table.get("package").and_then(|package| package.get(key)?.as_str());
    let pinned = integrate::versions().into_iter().find(|(name, _)| *name == library);
    let pinned = pinned.map_or("", |(_, version)| version);
    for (name, expected) in [("name", library), ("version", pinned)] {
        let found = key(name).unwrap_or("nothing");
        if found != expected {
            let why = format!("package.{name}: found {found}, expected {expected}");
            return Err(input(&shown, &why));
        }
    }
    let sources = sources(folder)?;
    Ok(Patched { library: library.to_owned(), version: pinned.to_owned(), sources })
}

/// The SHA-256 over the manifest and the sources below `src`, with their names.
fn sources(folder: &Path) -> Result<String, Failure> {
    let mut files = BTreeMap::new();
    collect(&folder.join("src"), &mut files)?;
    let manifest = folder.join("Cargo.toml");
    files.insert(manifest.clone(), fs::read(&manifest).map_err(Failure::environment)?);
    let mut all = Vec::new();
    for (path, bytes) in files {
        let name = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
        all.extend(format!("{name} {}\n", bytes.len()).into_bytes());
        all.extend(bytes);
    }
    Ok(sha256(&all))
}

fn collect(folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) -> Result<(), Failure> {
    let told = || folder.display().to_string();
    let entries = fs::read_dir(folder).with_context(told).map_err(Failure::environment)?;
    for entry in entries {
        let path = entry.map_err(Failure::environment)?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else {
            let bytes = fs::read(&path).with_context(told).map_err(Failure::environment)?;
            files.insert(path, bytes);
        }
    }
    Ok(())
}

/// The manifests and the sources, and nothing left of an earlier copy.
fn copy_workspace(root: &Path, copy: &Path) -> Result<(), Failure> {
    let mut files = BTreeMap::new();
    for part in ["crates", "xtask"] {
        collect(&root.join(part), &mut files)?;
        let old = copy.join(part);
        if old.exists() {
            fs::remove_dir_all(old).map_err(Failure::environment)?;
        }
    }
    for name in ["Cargo.toml", "Cargo.lock"] {
        let path = root.join(name);
        files.insert(path.clone(), read(&path)?.into_bytes());
    }
    for (path, bytes) in files {
        let name = path.strip_prefix(root).unwrap_or(&path);
        write_whole(&copy.join(name), &bytes)?;
    }
    Ok(())
}

fn read(path: &Path) -> Result<String, Failure> {
    let told = || path.display().to_string();
    fs::read_to_string(path).with_context(told).map_err(Failure::environment)
}

/// Whether what cargo built is the library of this folder and no other.
fn confirm(library: &str, folder: &Path, packages: &[String]) -> Result<(), Failure> {
    let from = format!("path+file://{}#", folder.display());
    let registry =
        |id: &&String| id.starts_with("registry+") && id.contains(&format!("#{library}@"));
    let other = packages.iter().find(registry);
    if packages.iter().any(|id| id.starts_with(&from)) && other.is_none() {
        return Ok(());
    }
    let other = other.map_or("no such library", String::as_str);
    Err(Failure::environment(anyhow!(
        "cargo did not build {library} from {}: it took {other}",
        folder.display()
    )))
}

#[cfg(test)]
mod tests {
    use super::confirm;
    use std::path::Path;

    #[test]
    fn a_build_that_took_the_registrys_library_is_no_patched_one() {
        let folder = Path::new("/changed/diffsol");
        let told = |ids: &[&str]| {
            let ids: Vec<String> = ids.iter().map(|id| (*id).to_owned()).collect();
            confirm("diffsol", folder, &ids).map_err(|failure| failure.exit as u8)
        };
        let ours = "path+file:///changed/diffsol#0.18.0";
        let registry = "registry+https://github.com/rust-lang/crates.io-index#diffsol@0.18.0";
        let beside = "registry+https://github.com/rust-lang/crates.io-index#diffsol-la@0.3.0";
        assert_eq!(told(&[ours, beside]), Ok(()));
        assert_eq!(told(&[registry]), Err(6));
        assert_eq!(told(&[ours, registry]), Err(6));
        assert_eq!(told(&["path+file:///changed/diffsol-2#diffsol@0.18.0"]), Err(6));
    }
}
