//! `cargo xtask record`, and the synthetic record that is committed.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

fn xtask(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    command.current_dir(folder).arg("record").args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn data() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")
}

fn toml_at(path: &Path) -> toml::Table {
    toml::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn the_committed_gearbox_record_is_what_its_truth_and_its_seed_make() {
    let truth = toml_at(&data().join("truth/gearbox-synthetic.toml"));
    let seed = u64::try_from(truth["seed"].as_integer().unwrap()).unwrap();
    let text = toml::to_string(&truth["scenario"]).unwrap();
    let scenario = twin::Scenario::parse(&text).unwrap();
    assert_eq!(scenario, twin::scenario("gearbox").unwrap(), "the truth is not the named scenario");
    let made = twin::make(&scenario, seed).unwrap();
    let sheet = record::read_sheet(&data().join("gearbox-synthetic.parquet")).unwrap();
    assert_eq!(sheet.columns.len(), made.columns.len(), "columns");
    for (name, values) in &made.columns {
        let committed = sheet.column(name).unwrap();
        assert_eq!(committed.len(), values.len(), "rows of {name}");
        let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let off = values.iter().zip(committed).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off <= 1e-9 * largest, "{name}: off by {off:.1e} of {largest:.1e}");
    }
}

#[test]
fn the_card_names_every_column_and_tells_nothing_of_the_truth() {
    let card = fs::read_to_string(data().join("gearbox-synthetic.toml")).unwrap();
    let table: toml::Table = toml::from_str(&card).unwrap();
    let columns = table["column"].as_array().unwrap();
    let names: Vec<&str> = columns.iter().map(|c| c["name"].as_str().unwrap()).collect();
    let made = twin::make(&twin::scenario("gearbox").unwrap(), 24).unwrap();
    let expected: Vec<&str> = made.columns.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, expected);
    for secret in ["f_c", "sigma", "k_1", "-0.032", "0.58"] {
        assert!(!card.contains(secret), "the card holds `{secret}`");
    }
}

#[test]
fn the_record_looks_as_figures_24_and_25_do() {
    let sheet = record::read_sheet(&data().join("gearbox-synthetic.parquet")).unwrap();
    let span = |name: &str| {
        let values = sheet.column(name).unwrap();
        (
            values.iter().copied().fold(f64::INFINITY, f64::min),
            values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        )
    };
    let (low, high) = span("current_a");
    assert!((-1.45..-1.3).contains(&(16.5 * low)), "lowest torque {} N·m", 16.5 * low);
    assert!((0.35..0.45).contains(&(16.5 * high)), "highest torque {} N·m", 16.5 * high);
    let (low, high) = span("angle_rad");
    assert!((-0.11..-0.09).contains(&low), "lowest angle {low} rad");
    assert!((0.65..0.8).contains(&high), "highest angle {high} rad");
    for name in ["force1_n", "force2_n"] {
        let (low, high) = span(name);
        assert!(low > 0.0 && (0.01..0.025).contains(&high), "{name}: {low} to {high} N");
    }
}

#[test]
fn one_seed_makes_one_record_byte_for_byte_and_another_seed_another() {
    let folder = tempfile::tempdir().unwrap();
    for (out, seed) in [("a.parquet", "5"), ("b.parquet", "5"), ("c.parquet", "6")] {
        let output = xtask(folder.path(), &["prescribed", "--out", out, "--seed", seed]);
        assert!(output.status.success(), "{}", said(&output));
    }
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("a.parquet"), bytes("b.parquet"));
    assert_ne!(bytes("a.parquet"), bytes("c.parquet"));
}

#[test]
fn a_scenario_file_makes_the_record_that_its_name_makes_and_stays_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let (_, text) = twin::SCENARIOS.iter().find(|(name, _)| *name == "axis").unwrap();
    let scenario = folder.path().join("mine.toml");
    fs::write(&scenario, text).unwrap();
    let by_file = ["--scenario", "mine.toml", "--out", "file.csv", "--truth", "keys/file.toml"];
    for arguments in [&by_file[..], &["axis", "--out", "name.csv"]] {
        let output = xtask(folder.path(), arguments);
        assert!(output.status.success(), "{}", said(&output));
    }
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("file.csv"), read("name.csv"));
    assert_eq!(read("mine.toml"), *text);
    assert_eq!(toml_at(&folder.path().join("file.toml"))["truth"].as_str(), Some("keys/file.toml"));
    assert_eq!(toml_at(&folder.path().join("keys/file.toml"))["seed"].as_integer(), Some(1));
    // Its card would fall onto the scenario.
    let output = xtask(folder.path(), &["--scenario", "mine.toml", "--out", "mine.csv"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert_eq!(read("mine.toml"), *text);
}

#[test]
fn a_file_that_is_no_synthetic_record_is_never_written_over_and_one_that_is_may_be() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("measured.csv"), "t,f\n0,1\n").unwrap();
    let output = xtask(folder.path(), &["axis", "--out", "measured.csv"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    let kept = fs::read_to_string(folder.path().join("measured.csv")).unwrap();
    assert_eq!(kept, "t,f\n0,1\n");
    for seed in ["1", "2"] {
        let output = xtask(folder.path(), &["axis", "--out", "made.csv", "--seed", seed]);
        assert!(output.status.success(), "{}", said(&output));
    }
}

#[test]
fn what_cannot_be_made_is_refused_in_words_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.toml"), "title = 'x'\nrate = 'fast'\n").unwrap();
    for (arguments, code, words) in [
        (&["gear", "--out", "a.csv"][..], 2, "there are axis, gearbox"),
        (&["gearbox", "--out", "a.txt"], 2, "ends in .parquet or .csv"),
        (&["gearbox"], 2, "--out FILE"),
        (&["--out", "a.csv"], 2, "--scenario FILE"),
        (&["--scenario", "none.toml", "--out", "a.csv"], 4, "none.toml"),
        (&["--scenario", ".", "--out", "a.csv"], 4, "expected a scenario"),
        (&["--scenario", "bad.toml", "--out", "a.csv"], 4, "bad.toml: the scenario cannot be read"),
    ] {
        let output = xtask(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains(words), "{arguments:?}: {}", said(&output));
    }
    let left = fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left, 1, "files beside the bad scenario");
}

#[test]
fn the_list_names_every_scenario_as_text_and_as_json() {
    let folder = tempfile::tempdir().unwrap();
    let text = String::from_utf8(xtask(folder.path(), &["--list"]).stdout).unwrap();
    let json = xtask(folder.path(), &["--list", "--json"]).stdout;
    let json: serde_json::Value = serde_json::from_slice(&json).unwrap();
    assert_eq!(json["scenarios"].as_array().unwrap().len(), twin::SCENARIOS.len());
    for (name, _) in twin::SCENARIOS {
        assert!(text.contains(name), "{text}");
    }
}
