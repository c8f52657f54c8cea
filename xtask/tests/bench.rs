//! `cargo xtask bench`, as a stranger would call it; few cases, because it is made for many.

mod common;

use common::{
    Project,
    saved::{row, run},
};
use serde_json::{Value, json};
use std::fs;

#[test]
fn the_properties_hold_on_a_few_cases_whatever_the_threads() {
    let project = Project::new(&[]);
    let told = |threads: &str| {
        let ran = project.run(&[
            "bench",
            "properties",
            "--cases",
            "7",
            "--seed",
            "3",
            "--threads",
            threads,
            "--json",
        ]);
        assert_eq!(ran.code, Some(0), "{ran:?}");
        serde_json::from_str::<Value>(&ran.out).expect("JSON")
    };
    let one = told("1");
    assert_eq!(one, told("3"));
    let rows = one["properties"].as_array().expect("a list");
    assert_eq!(rows.len(), simulation::properties::PROPERTIES.len());
    for row in rows {
        assert_eq!((&row["holds"], &row["cases"]), (&Value::Bool(true), &Value::from(7)), "{row}");
    }
}

#[test]
fn what_cannot_be_tried_is_a_mistake_of_usage() {
    let project = Project::new(&[]);
    for wrong in [
        &["bench"][..],
        &["bench", "propertys"],
        &["bench", "P7"],
        &["bench", "anchors", "p1"],
        &["bench", "anchors", "--native", "--portable"],
        &["bench", "anchors", "--save", "Not A Name"],
        &["bench", "anchors", "--save", "../escape"],
        &["bench", "anchors", "--refs", "/no/such/folder"],
        &["bench", "anchors", "--saved", "nothing"],
        &["bench", "anchors", "--saved", "a", "--quick"],
        &["bench", "anchors", "--patch", "diffsol"],
        &["bench", "anchors", "--patch", "polars=/tmp"],
        &["bench", "properties", "--cases", "0"],
        &["bench", "properties", "--cases", "many"],
        &["bench", "properties", "--seed", "-1"],
        &["bench", "properties", "--threads", "0"],
    ] {
        let ran = project.run(wrong);
        assert_eq!(ran.code, Some(2), "{wrong:?}: {ran:?}");
    }
}

/// A project with a run kept in it, and the table of that run.
fn shown(run: &Value, flags: &[&str]) -> common::Ran {
    let project = Project::new(&[]);
    let folder = project.path().join("target/duhem/bench");
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("kept.json"), run.to_string()).expect("a file");
    project.run(&[&["bench", "anchors", "--saved", "kept"], flags].concat())
}

#[test]
fn the_table_shows_the_cheapest_at_each_error_and_who_was_wrong_in_silence() {
    let with = |solver: &str, error: f64, time: f64| {
        let mut row = row(solver, 900, time);
        row["error"] = json!(error);
        row
    };
    let mut exact = with("our-exact", 1e-13, 5e-5);
    exact["control"] = Value::Null;
    let mut wrong = with("tr_bdf2", 5e-2, 1e-4);
    wrong["cpu_s"] = Value::Null;
    wrong["repeats_s"] = json!([]);
    let mut failed = with("tsit45", 1.0, 1e-4);
    failed["status"] = json!("too many evaluations");
    for key in ["cpu_s", "error"] {
        failed[key] = Value::Null;
    }
    let rows = [exact, with("bdf", 5e-4, 1e-3), with("dopri5", 9e-7, 2e-3), wrong, failed.clone()];
    let ran = shown(&run(&rows), &[]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let line = |start: &str| {
        let line = ran.out.lines().find(|line| line.trim_start().starts_with(start));
        line.unwrap_or_else(|| panic!("no `{start}` in {}", ran.out)).to_owned()
    };
    let at_3 = line("1e-3");
    assert!(at_3.contains("our-exact exact 50.0 µs"), "{at_3}");
    assert!(at_3.contains("bdf 1e-6 1.00 ms") && at_3.ends_with("20.00"), "{at_3}");
    assert!(line("1e-6").contains("dopri5 1e-6 2.00 ms") && line("1e-6").ends_with("40.00"));
    assert!(line("1e-8").contains("none") && line("1e-8").ends_with('–'), "{}", line("1e-8"));
    assert!(ran.out.contains("5 rows: 1 failed and said so, 1 solved and wrong"), "{}", ran.out);
    assert!(ran.out.contains("tr_bdf2 1e-6: error 5.0e-2"), "{}", ran.out);
    assert!(ran.out.contains("built for this processor (avx2)"), "{}", ran.out);
}

#[test]
fn rows_as_json_are_one_a_line() {
    let ran = shown(&run(&[row("bdf", 900, 1e-3), row("dopri5", 10, 1e-3)]), &["--json"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let rows: Vec<Value> =
        ran.out.lines().map(|line| serde_json::from_str(line).expect("a row")).collect();
    let first = ran.out.lines().next().unwrap_or_default();
    let design = "{\"problem\":\"P6\",\"parameter\":null,\"solver\":\"bdf\",\"ours\":false,";
    assert!(first.starts_with(design), "{first}");
    assert_eq!(rows, [row("bdf", 900, 1e-3), row("dopri5", 10, 1e-3)]);
}

#[test]
fn a_folder_that_is_not_the_library_is_no_patch() {
    let project = Project::new(&[]);
    let folder = project.path().join("changed");
    fs::create_dir_all(folder.join("src")).expect("a folder");
    let patch = format!("diffsol={}", folder.display());
    let refused = |words: &str| {
        let ran = project.run(&["bench", "anchors", "--patch", &patch]);
        assert_eq!(ran.code, Some(4), "{words}: {ran:?}");
        assert!(ran.err.contains(words), "{}", ran.err);
        assert!(!project.path().join("target").exists(), "something was written");
    };
    refused("Cargo.toml: No such file");
    for (manifest, words) in [
        ("[package", "Cargo.toml: "),
        ("[package]\nname = \"other\"\n", "package.name: found other, expected diffsol"),
        ("[package]\nname = \"diffsol\"\n", "package.version: found nothing, expected 0.18.0"),
        (
            "[package]\nname = \"diffsol\"\nversion = \"0.17.0\"\n",
            "package.version: found 0.17.0, expected 0.18.0",
        ),
    ] {
        fs::write(folder.join("Cargo.toml"), manifest).expect("a manifest");
        refused(words);
    }
    let ran = project.run(&["bench", "anchors", "--patch", "diffsol=/no/such/folder"]);
    assert_eq!(ran.code, Some(4), "{ran:?}");
}
