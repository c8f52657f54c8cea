//! The house rules hold here, and a house that breaks them is told so.

mod common;

use common::{Project, small};
use std::{fs, path::Path, process::Command};

#[test]
fn every_house_rule_holds_in_this_repository() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let output =
        Command::new(env!("CARGO_BIN_EXE_xtask")).arg("--root").arg(root).arg("tidy").output();
    let output = output.expect("the built program");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}

/// A copy of this repository's text, with one thing changed, and what tidy says of it.
fn with(change: impl Fn(&Path), expected: &str) {
    let project = Project::new(&[("small.toml", &small("\"rk4\""))]);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for name in ["crates", "xtask", "data", "reports", ".ci"] {
        copy(&root.join(name), &project.path().join(name));
    }
    for name in
        ["Cargo.toml", "Cargo.lock", "CITATION.cff", "LICENSE-APACHE", "LICENSE-MIT", "README.md"]
    {
        fs::copy(root.join(name), project.path().join(name)).expect(name);
    }
    copy(&root.join("experiments"), &project.path().join("experiments"));
    fs::remove_file(project.path().join("experiments/small.toml")).expect("small.toml");
    assert_eq!(project.run(&["tidy"]).code, Some(0), "{}", project.run(&["tidy"]).out);
    change(project.path());
    let ran = project.run(&["tidy"]);
    assert_eq!(ran.code, Some(1), "{expected}: {ran:?}");
    assert!(ran.out.contains(expected), "no `{expected}` in {}", ran.out);
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder").map(|e| e.expect("an entry").path()) {
        let target = to.join(entry.file_name().expect("a name"));
        if entry.is_dir() {
            copy(&entry, &target);
        } else {
            fs::copy(&entry, &target).expect("a file");
        }
    }
}

fn add(path: &Path, text: &str) {
    let old = fs::read_to_string(path).unwrap_or_default();
    let section = "[dependencies]\n";
    let new = match old.split_once(section) {
        Some((head, tail)) => format!("{head}{section}{text}{tail}"),
        None => old + text,
    };
    fs::write(path, new).expect("a file");
}

fn replace(path: &Path, old: &str, new: &str) {
    let text = fs::read_to_string(path).expect("a file");
    assert!(text.contains(old), "no `{old}` in {}", path.display());
    fs::write(path, text.replace(old, new)).expect("a file");
}

/// The plants' equations, if they are not there yet: with them the index of equations is asked for.
fn plants(root: &Path) {
    let index = || {
        let root = root.to_str().expect("a path");
        let ran = Command::new(env!("CARGO_BIN_EXE_xtask"))
            .args(["--root", root, "tidy", "--equations"])
            .output()
            .expect("the built program");
        assert!(ran.status.success(), "{ran:?}");
        String::from_utf8(ran.stdout).expect("text")
    };
    let known = index();
    let line = |n: u32| format!("/// a = b   ({n})\npub fn plant_{n}() {{}}\n");
    let missing = (27..=41).filter(|n| !known.contains(&format!("| ({n}) |")));
    let new = missing.map(line).collect::<Vec<_>>().concat();
    fs::write(root.join("crates/duhem/src/more.rs"), new).expect("a file");
    let readme = root.join("README.md");
    if !fs::read_to_string(&readme).expect("README").contains(&known) {
        add(&readme, &index());
    }
}

#[test]
fn an_index_of_equations_that_is_not_the_sources_or_not_whole_is_told() {
    let lost = |root: &Path, number: u32| {
        plants(root);
        let file = root.join("crates/duhem/src/models/maxwell_slip.rs");
        let text = fs::read_to_string(&file).expect("a file");
        let end = format!("({number})");
        let kept = text.lines().filter(|line| !line.ends_with(&end)).collect::<Vec<_>>();
        assert!(kept.len() < text.lines().count(), "no equation {number}");
        fs::write(&file, kept.join("\n")).expect("a file");
    };
    with(|root| lost(root, 24), "equation (24) has neither a function nor an alias");
    with(|root| lost(root, 26), "its index of equations is not what");
    let other = |root: &Path| {
        plants(root);
        replace(&root.join("README.md"), "| (25) |", "| (5) |");
    };
    with(other, "README.md: its index of equations is not what");
    let nameless = |root: &Path| add(&root.join("crates/duhem/src/lib.rs"), "/// F = 1   (43)\n");
    with(nameless, "equation (43) stands above no function");
    with(nameless, "(43) is no equation of the paper");
}

#[test]
fn a_breach_of_each_rule_is_told() {
    let file =
        |name: &'static str, text: &'static str| move |root: &Path| add(&root.join(name), text);
    with(file("notes.txt", "x"), "notes.txt: the root holds only");
    let other =
        |root: &Path| replace(&root.join("README.md"), "| `tach_bias` |", "| `tacho_bias` |");
    with(other, "its table of effects is not what");
    with(
        file("crates/report/Cargo.toml", "duhem.workspace = true\n"),
        "report may not depend on duhem",
    );
    with(
        file("crates/duhem/Cargo.toml", "rayon.workspace = true\n"),
        "rayon has no place in duhem",
    );
    with(
        file("crates/duhem/Cargo.toml", "csv = \"1\"\n"),
        "versions and features stand in the root",
    );
    with(file("crates/duhem/src/models/stribeck.rs", "//! x\n"), "stribeck.rs: is not in MODELS");
    with(file("crates/integrate/src/solvers/ab2.rs", "//! x\n"), "ab2.rs: is not in SOLVERS");
    with(file("crates/simulation/src/exact/coulomb.rs", "//! x\n"), "coulomb.rs: is not in EXACT");
    with(
        file("crates/simulation/src/adaptive/euler.rs", "//! x\n"),
        "euler.rs: is not in ADAPTIVE",
    );
    with(file("crates/duhem/src/lib.rs", "/// F = 1   (19)\n"), "equation (19) stands at");
    let mark = ["// TO", "DO\n"].concat();
    with(|root| add(&root.join("crates/duhem/src/lib.rs"), &mark), "an unfinished mark");
    with(
        |root| add(&root.join("crates/duhem/src/lib.rs"), &"// x\n".repeat(400)),
        "a file stays below",
    );
    with(
        |root| fs::write(root.join("README.md"), "").expect("README"),
        "does not stand in its first",
    );
    let picture = "](reports/dahl-gamma-sweep/collapse.svg)";
    with(
        |root| replace(&root.join("README.md"), picture, "](x)"),
        "no picture of dahl-gamma-sweep",
    );
    with(|root| fs::remove_file(root.join("LICENSE-MIT")).expect("MIT"), "LICENSE-MIT: is missing");
}
