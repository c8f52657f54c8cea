//! Hashes what computes a case (our sources, the locked dependencies, the compiler and its profile), so
//! that a record made by other code is never taken for one made by this.

use sha2::{Digest, Sha256};
use std::{env, error::Error, fmt::Write, fs, path::Path, process::Command};

/// The crates whose code decides the numbers of a case and the form of its record.
const COMPUTING: [&str; 5] = ["duhem", "integrate", "simulation", "record", "experiment"];

fn main() -> Result<(), Box<dyn Error>> {
    let crates = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("..");
    let mut hash = Sha256::new();
    for name in COMPUTING {
        let folder = crates.join(name).join("src");
        println!("cargo:rerun-if-changed={}", folder.display());
        add(&mut hash, &folder)?;
    }
    let lock = crates.join("../Cargo.lock");
    println!("cargo:rerun-if-changed={}", lock.display());
    hash.update(fs::read(lock)?);
    hash.update(Command::new(env::var("RUSTC")?).arg("-vV").output()?.stdout);
    for name in ["TARGET", "PROFILE", "CARGO_ENCODED_RUSTFLAGS"] {
        hash.update(env::var(name).unwrap_or_default());
    }
    let text = hash.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    });
    println!("cargo:rustc-env=DUHEM_SOURCES={text}");
    Ok(())
}

fn add(hash: &mut Sha256, path: &Path) -> Result<(), Box<dyn Error>> {
    if path.is_dir() {
        let mut inside = fs::read_dir(path)?
            .map(|entry| entry.map(|e| e.path()))
            .collect::<Result<Vec<_>, _>>()?;
        inside.sort();
        for path in inside {
            add(hash, &path)?;
        }
    } else {
        hash.update(path.file_name().unwrap_or_default().as_encoded_bytes());
        hash.update(fs::read(path)?);
    }
    Ok(())
}
