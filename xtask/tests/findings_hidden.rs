//! A search for hidden effects as a part of an experiment: the same on any number of threads, blind to the truth.

mod common;

use common::Project;
use std::{fs, path::Path};

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
