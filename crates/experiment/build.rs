//! Hashes what computes a case (our sources, the locked dependencies, the compiler and its profile), so
//! that a record made by other code is never taken for one made by this.

use sha2::{Digest, Sha256};
use std::{env, error::Error, fmt::Write, fs, path::Path, process::Command};

/// The crates whose code decides the numbers of a case and the form of its record.
const COMPUTING: [&str; 5] = ["duhem", "integrate", "simulation", "record", "experiment"];

/// The crate that fits besides, and so decides the numbers of fits alone.
const FITTING: &str = "identify";

/// The crate that looks for what a model lacks besides, and so decides the numbers of searches alone.
const SEARCHING: &str = "discover";

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("../..");
    let mut hash = Sha256::new();
    for name in COMPUTING {
        add(&mut hash, &root, &format!("crates/{name}/src"))?;
        add(&mut hash, &root, &format!("crates/{name}/Cargo.toml"))?;
    }
    // Features and optimisation stand in the root manifest, versions in the lock file.
    add(&mut hash, &root, "Cargo.toml")?;
    add(&mut hash, &root, "Cargo.lock")?;
    hash.update(Command::new(env::var("RUSTC")?).arg("-vV").output()?.stdout);
    for name in ["TARGET", "PROFILE", "CARGO_ENCODED_RUSTFLAGS"] {
        hash.update(env::var(name).unwrap_or_default());
    }
    println!("cargo:rustc-env=DUHEM_SOURCES={}", text(hash.clone()));
    add(&mut hash, &root, &format!("crates/{FITTING}/src"))?;
    add(&mut hash, &root, &format!("crates/{FITTING}/Cargo.toml"))?;
    println!("cargo:rustc-env=DUHEM_FIT_SOURCES={}", text(hash.clone()));
    add(&mut hash, &root, &format!("crates/{SEARCHING}/src"))?;
    add(&mut hash, &root, &format!("crates/{SEARCHING}/Cargo.toml"))?;
    println!("cargo:rustc-env=DUHEM_SEARCH_SOURCES={}", text(hash));
    Ok(())
}

fn text(hash: Sha256) -> String {
    hash.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// Adds a file, or all files of a folder in the order of their names: name, length, content.
fn add(hash: &mut Sha256, root: &Path, name: &str) -> Result<(), Box<dyn Error>> {
    let path = root.join(name);
    println!("cargo:rerun-if-changed={}", path.display());
    if path.is_dir() {
        let mut inside = Vec::new();
        for entry in fs::read_dir(&path)? {
            inside.push(format!("{name}/{}", entry?.file_name().to_string_lossy()));
        }
        inside.sort();
        return inside.iter().try_for_each(|name| add(hash, root, name));
    }
    let bytes = fs::read(&path)?;
    hash.update(format!("{name}\n{}\n", bytes.len()));
    hash.update(bytes);
    Ok(())
}
