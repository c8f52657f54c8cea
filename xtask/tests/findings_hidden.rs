//! What the searches for hidden effects found, asserted as measured: the sentences of their report, as tests.

mod common;

use common::{Project, run::named};
use record::{DiscoveryRow, GapRow, Summary};
use std::{fs, path::Path, sync::OnceLock};

fn found() -> &'static Summary {
    static TABLES: OnceLock<Summary> = OnceLock::new();
    TABLES.get_or_init(|| named("hidden-effect.toml"))
}

fn search(name: &str) -> &'static DiscoveryRow {
    let rows = &found().discoveries;
    rows.iter().find(|row| row.discovery == name).unwrap_or_else(|| panic!("no {name}"))
}

fn gaps(name: &str) -> Vec<&'static GapRow> {
    found().gaps.iter().filter(|row| row.discovery == name).collect()
}

/// The residual in units of the floor: as given, refitted, with what was named.
fn levels(name: &str) -> [f64; 3] {
    let row = search(name);
    [row.before, row.refit, row.after].map(|level| level.expect("a motion").sqrt())
}

#[test]
fn where_nothing_is_missing_and_where_a_parameter_is_wrong_no_effect_is_named() {
    for (name, verdict) in [("nothing", "nothing_missing"), ("parameter", "parameter")] {
        assert_eq!(
            (search(name).verdict.as_str(), search(name).truth.as_str()),
            (verdict, verdict)
        );
        let named = found().effects.iter().filter(|row| row.discovery == name).count();
        assert_eq!(named, 0, "{name}: effects were named");
        let [given, refitted, after] = levels(name);
        assert!(given > 2.0, "{name}: {given:.2} floors as given are no gap");
        assert!(refitted < 1.1 && after < 1.1, "{name}: {refitted:.3} and {after:.3} floors left");
    }
    let hidden = &search("parameter").hidden;
    assert!(
        search("parameter").names.split(';').any(|name| name == hidden),
        "{hidden} is not told"
    );
}

#[test]
fn a_drift_of_friction_is_named_with_its_value_and_closes_the_gap() {
    let own: Vec<_> = found().effects.iter().filter(|row| row.discovery == "effect").collect();
    assert!(own.iter().all(|row| row.effect == "friction_drift"), "{own:?}");
    assert_eq!(own.len(), 2, "an amount and a time");
    for row in own {
        let (truth, error) = (row.truth.expect("a truth"), row.standard_error.expect("an error"));
        let off = (row.value - truth).abs();
        // A share of the amount hangs on the floor of the force, which every parameter shares.
        let room = (4.0 * error).max(0.1 * truth.abs());
        assert!(off < room, "{}: {:.4e} of {truth:.4e} {}", row.key, row.value, row.unit);
    }
    let [given, refitted, after] = levels("effect");
    assert!(given > 10.0 && refitted > 2.0, "{given:.1} and {refitted:.1} floors are no gap");
    assert!(after < 1.1, "{after:.3} floors are left");
    for gap in gaps("effect") {
        let ratio = gap.after.expect("a motion") / gap.floor;
        assert!(ratio < 1.1, "{}: {ratio:.3} floors are left", gap.channel);
    }
}

#[test]
fn the_bias_of_the_rigs_current_is_named_and_with_it_the_model_comes_to_the_floor() {
    let own: Vec<_> = found().effects.iter().filter(|row| row.discovery == "rig").collect();
    let [bias] = own.as_slice() else { panic!("one value is expected: {own:?}") };
    assert_eq!((bias.effect.as_str(), bias.key.as_str()), ("current_bias", "bias"));
    // The monitor reads 0.032 A too little, says the scenario that the record was made with.
    assert!((bias.value / 0.032 - 1.0).abs() < 0.01, "{} A", bias.value);
    let [_, _, after] = levels("rig");
    assert!(after < 1.2, "{after:.3} floors are left");
}

#[test]
fn what_a_record_cannot_tell_apart_two_effects_and_what_is_in_no_library_are_called_so() {
    for name in ["set", "pair", "foreign"] {
        let row = search(name);
        assert_eq!(row.verdict, if name == "foreign" { "not_in_library" } else { "effect" });
    }
    let named = |name: &str| {
        let mut all: Vec<&str> =
            found().effects.iter().filter(|r| r.discovery == name).map(|r| &*r.effect).collect();
        all.dedup();
        all.len()
    };
    assert_eq!([named("set"), named("pair"), named("foreign")], [1, 2, 0]);
    for name in ["set", "pair"] {
        let [_, refitted, after] = levels(name);
        assert!(refitted > 2.0 && after < 1.1, "{name}: {refitted:.2}, then {after:.3} floors");
    }
    let [_, _, left] = levels("foreign");
    assert!(left > 2.0, "{left:.2} floors are left of what has no name");
}

#[test]
fn the_rig_without_bias_is_far_from_its_record_however_its_parameters_are_fitted() {
    let [given, refitted, _] = levels("rig");
    assert!(given > 100.0 && refitted > 5.0, "{given:.1} and {refitted:.1} floors");
    // The load cells tell of the springs without the drum's motion: these the fit finds.
    let cells: Vec<_> =
        gaps("rig").into_iter().filter(|gap| gap.channel.starts_with("force_")).collect();
    assert_eq!(cells.len(), 2, "two load cells");
    for gap in cells {
        let of = |gap_of: Option<f64>| gap_of.expect("a motion") / gap.floor;
        let (before, refit) = (of(gap.before), of(gap.refit));
        assert!(before > 20.0 && refit < 1.1, "{}: {before:.1}, {refit:.3} floors", gap.channel);
    }
}

/// A project with one search in a small record of this repository.
fn small() -> Project {
    let toml = r#"title = "small"
paper = "none"
text  = "A test."

[[discover]]
name   = "hidden"
title  = "A search"
record = "../record.parquet"
rig    = "../rig.toml"
truth  = "../key.toml"

[[figure]]
name        = "ladder"
kind        = "ladder"
study       = "hidden"
title       = "The ladder"
description = "The ladder."
caption     = "The ladder."
"#;
    let project = Project::new(&[("small.toml", toml)]);
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/hidden-effects");
    for (from, to) in [
        ("15.parquet", "record.parquet"),
        ("15-rig.toml", "rig.toml"),
        ("truth/15-key.toml", "key.toml"),
    ] {
        fs::copy(data.join(from), project.path().join(to)).expect("a file of the record");
    }
    project
}

#[test]
fn a_search_is_the_same_on_one_and_on_eight_threads_and_from_its_record() {
    small().same_on_threads_and_from_record("search hidden", "gaps.csv");
}

#[test]
fn the_answer_does_not_know_what_was_hidden() {
    let project = small();
    let answer = || {
        let ran = project.run(&["reproduce", "--quick", "--fresh"]);
        assert_eq!(ran.code, Some(0), "{ran:?}");
        let files = project.files("target/duhem/quick");
        let ranking = files.iter().find(|(path, _)| path.ends_with("small/ranking.csv"));
        ranking.expect("a ranking").1.clone()
    };
    let with = answer();
    let key = project.path().join("key.toml");
    fs::write(&key, "[key]\nverdict = \"nothing\"\n").expect("another key");
    assert_eq!(with, answer(), "the ranking changed with the key");
}

#[test]
fn what_a_search_cannot_use_is_said_with_its_line_and_key() {
    for (from, to, words) in [
        ("../record.parquet", "../no.parquet", "discover[0].record"),
        ("../rig.toml", "../no.toml", "discover[0].rig"),
        ("../rig.toml", "../key.toml", "discover[0].rig"),
        ("../key.toml", "../rig.toml", "discover[0].truth"),
        ("title  = \"A search\"", "titel = \"A search\"", "did you mean `title`?"),
        ("study       = \"hidden\"", "study = \"hiden\"", "figure[0]"),
    ] {
        let project = small();
        let path = project.path().join("experiments/small.toml");
        let text = fs::read_to_string(&path).expect("the experiment");
        assert!(text.contains(from), "no `{from}` to change");
        fs::write(&path, text.replace(from, to)).expect("a changed experiment");
        let ran = project.run(&["reproduce", "--quick"]);
        assert_eq!(ran.code, Some(4), "{to}: {ran:?}");
        assert!(ran.err.contains(words) && ran.err.contains("small.toml:"), "{to}: {}", ran.err);
    }
}
