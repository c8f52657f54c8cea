//! `--check` holds on another processor: the C library is made to choose its code without FMA and AVX2.
//!
//! Where the C library is not glibc the variable means nothing, and the test shows only that a fresh run
//! on the same processor passes.

mod common;

use common::Project;
use std::{fs, path::Path};

#[test]
fn the_tables_of_one_processor_pass_the_check_on_another() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments");
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).expect("experiments/") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "toml") {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            all.push((name, fs::read_to_string(&path).expect("an experiment")));
        }
    }
    let all: Vec<(&str, &str)> = all.iter().map(|(n, t)| (n.as_str(), t.as_str())).collect();
    let project = Project::new(&all);
    // The records and rigs of the fits.
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data");
    copy(&data, &project.path().join("data"));
    let ran = project.run(&["reproduce"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let output = project
        .command(&["reproduce", "--check", "--fresh"])
        .env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F")
        .output()
        .expect("the built program");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Copies a folder and all that is in it.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder to copy") {
        let path = entry.expect("an entry").path();
        let there = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &there);
        } else {
            fs::copy(&path, &there).expect("a copy");
        }
    }
}
