//! `cargo xtask compare` on saved runs made by hand: what counts as worse, and what is refused.

mod common;

use common::{
    Project, Ran,
    saved::{repeats, row, run},
};
use serde_json::{Value, json};
use std::fs;

/// Compares two runs that are kept under the names a and b.
fn compared(a: &Value, b: &Value, flags: &[&str]) -> Ran {
    let project = Project::new(&[]);
    keep(&project, "a", &a.to_string());
    keep(&project, "b", &b.to_string());
    project.run(&[&["compare", "a", "b"], flags].concat())
}

fn keep(project: &Project, name: &str, text: &str) {
    let folder = project.path().join("target/duhem/bench");
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join(format!("{name}.json")), text).expect("a file");
}

fn one(evaluations: u64, time: f64) -> Value {
    run(&[row("bdf", evaluations, time), row("our-radau", 500, 1e-4)])
}

/// The run with another value under this key of its first row.
fn with(mut run: Value, key: &str, value: Value) -> Value {
    run["rows"][0][key] = value;
    run
}

#[test]
fn a_run_compared_with_itself_is_the_same() {
    for flags in [&[][..], &["--times"], &["--markdown"], &["--times", "--json"]] {
        let ran = compared(&one(900, 1e-3), &one(900, 1e-3), flags);
        assert_eq!(ran.code, Some(0), "{ran:?}");
    }
    let ran = compared(&one(900, 1e-3), &one(900, 1e-3), &["--times"]);
    assert!(ran.out.contains("2 rows compared: 0 worse, 0 otherwise changed"), "{}", ran.out);
    assert!(ran.out.contains("of 2 timed, 0 slower, 0 faster"), "{}", ran.out);
}

#[test]
fn one_evaluation_more_is_a_regression_and_one_less_is_told() {
    let ran = compared(&one(900, 1e-3), &one(901, 1e-3), &[]);
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(ran.out.contains("P6 bdf 1e-6: evaluations 900 → 901 (+0.1 %)"), "{}", ran.out);
    let ran = compared(&one(901, 1e-3), &one(900, 1e-3), &[]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(ran.out.contains("evaluations 901 → 900"), "{}", ran.out);
    for (key, more) in [("jacobians", 8), ("accepted", 101), ("rejected", 4)] {
        let ran = compared(&one(900, 1e-3), &with(one(900, 1e-3), key, json!(more)), &[]);
        assert_eq!(ran.code, Some(3), "one more of {key}: {ran:?}");
    }
}

#[test]
fn a_right_answer_that_is_lost_is_a_regression() {
    let failed = with(one(10, 1e-3), "status", json!("no convergence"));
    let ran = compared(&one(900, 1e-3), &failed, &[]);
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(ran.out.contains("solved → no convergence"), "{}", ran.out);
    // Won back it is none, whatever it costs.
    let ran = compared(&failed, &one(900, 1e-3), &[]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let wrong = with(one(10, 1e-3), "error", json!(0.5));
    let ran = compared(&one(900, 1e-3), &wrong, &[]);
    assert_eq!(ran.code, Some(3), "less work for a wrong answer: {ran:?}");
    assert!(ran.out.contains("no longer right, error 2.00e-6 → 5.00e-1"), "{}", ran.out);
    let ran = compared(&failed, &with(failed.clone(), "evaluations", json!(99)), &[]);
    assert_eq!(ran.code, Some(0), "how far a failed run got is no measure of work: {ran:?}");
}

#[test]
fn times_count_only_when_asked_for_and_only_beyond_doubt() {
    let (before, slower) = (one(900, 1e-3), one(900, 1.3e-3));
    assert_eq!(compared(&before, &slower, &[]).code, Some(0));
    let ran = compared(&before, &slower, &["--times"]);
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(ran.out.contains("P6 bdf 1e-6: 1.30 times"), "{}", ran.out);
    let ran = compared(&slower, &before, &["--times"]);
    assert_eq!((ran.code, ran.out.contains("faster (1)")), (Some(0), true), "{ran:?}");
    // Slower in the middle, but scattered over what it was before.
    let scattered: Vec<f64> = (0..15).map(|i| 1e-3 * (0.7 + 0.1 * f64::from(i % 10))).collect();
    let ran = compared(&before, &with(slower, "repeats_s", json!(scattered)), &["--times"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    // Nor a tenth, which two runs of one build can differ by.
    assert_eq!(compared(&before, &one(900, 1.09e-3), &["--times"]).code, Some(0));
    // Three repeats tell nothing.
    let few = with(one(900, 1.3e-3), "repeats_s", json!(&repeats(1.3e-3)[..3]));
    let ran = compared(&before, &few, &["--times"]);
    assert_eq!((ran.code, ran.out.contains("of 1 timed")), (Some(0), true), "{ran:?}");
}

#[test]
fn an_interval_is_the_same_each_time_and_holds_the_ratio() {
    let told = || {
        let ran = compared(&one(900, 1e-3), &one(900, 1.3e-3), &["--times", "--json"]);
        serde_json::from_str::<Value>(&ran.out).expect("JSON")
    };
    let first = told();
    assert_eq!(first, told());
    let number = |value: &Value| value.as_f64().expect("a number");
    let bdf = &first["times"][0];
    let (low, high) = (number(&bdf["interval"][0]), number(&bdf["interval"][1]));
    assert!((number(&bdf["ratio"]) - 1.3).abs() < 1e-9, "{bdf}");
    assert!((1.28..=1.3).contains(&low) && (1.3..1.32).contains(&high), "{bdf}");
    assert_eq!(first["regression"], Value::Bool(true));
}

#[test]
fn on_another_processor_counts_are_told_and_fail_nothing() {
    for (key, value, words) in [
        ("processor", json!("Another"), "not the same processor: Some CPU (model 2), then Another"),
        ("target_features", json!([]), "not the same features used: avx2, then"),
    ] {
        let mut other = one(2000, 9e-3);
        other["machine"][key] = value;
        let ran = compared(&one(900, 1e-3), &other, &["--times"]);
        assert_eq!(ran.code, Some(0), "{ran:?}");
        assert!(
            ran.out.contains(words) && ran.out.contains("evaluations 900 → 2000"),
            "{}",
            ran.out
        );
    }
    let mut quick = one(2000, 1e-3);
    quick["quick"] = json!(true);
    assert_eq!(compared(&one(900, 1e-3), &quick, &[]).code, Some(0));
}

#[test]
fn claims_and_measures_that_moved_are_told() {
    let (before, mut after) = (one(900, 1e-3), one(900, 1e-3));
    after["claims"][0]["verdict"] = json!("reproduced");
    after["measures"][0]["value"] = json!(1.554_000_1);
    let ran = compared(&before, &after, &[]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(ran.out.contains("dahl.energy: contradicted → reproduced"), "{}", ran.out);
    assert!(ran.out.contains("fig01.area: 1.554e0 → 1.5540001e0 J"), "{}", ran.out);
    // Within the errors of both.
    after["claims"][0]["verdict"] = json!("contradicted");
    after["measures"][0]["value"] = json!(1.554_000_001);
    let ran = compared(&before, &after, &[]);
    assert!(ran.out.contains("0 claims and 0 measures changed"), "{}", ran.out);
    // A run without reports has no claims to compare.
    let mut without = after.clone();
    (without["claims"], without["measures"]) = (json!([]), json!([]));
    let ran = compared(&before, &without, &[]);
    assert!(ran.out.contains("0 claims and 0 measures changed"), "{}", ran.out);
    after["measures"].as_array_mut().expect("a list").push(before["measures"][0].clone());
    after["measures"][0]["id"] = json!("fig02.area");
    let ran = compared(&before, &after, &[]);
    assert!(ran.out.contains("fig02.area: new") && !ran.out.contains("fig01"), "{ran:?}");
    let ran = compared(&after, &before, &[]);
    assert!(ran.out.contains("fig02.area: gone"), "{ran:?}");
}

#[test]
fn rows_of_one_run_only_are_counted_and_a_patch_is_named() {
    let (before, mut after) = (one(900, 1e-3), run(&[row("bdf", 900, 1e-3)]));
    after["patch"] = json!({"library": "diffsol", "version": "0.18.0", "sources": "abcdef"});
    let ran = compared(&before, &after, &[]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(ran.out.contains("1 rows compared") && ran.out.contains("1 rows stand in the first"));
    assert!(ran.out.contains("built with a changed diffsol 0.18.0, sources abcdef"), "{}", ran.out);
}

#[test]
fn the_table_for_a_pull_request_holds_what_changed() {
    let after = with(one(950, 1.3e-3), "status", json!("stopped | `x`\n| y"));
    let ran = compared(&one(900, 1e-3), &after, &["--times", "--markdown"]);
    assert_eq!(ran.code, Some(3), "{ran:?}");
    let rows: Vec<&str> = ran.out.lines().filter(|line| line.starts_with('|')).collect();
    assert!(rows.iter().any(|row| row.starts_with("| P6 bdf 1e-6 | 907 | 957 |")), "{}", ran.out);
    assert!(rows.iter().any(|row| row.contains("**worse**")), "{}", ran.out);
    let columns = |row: &str| row.replace("\\|", "").matches('|').count();
    assert!(
        rows.iter().all(|row| columns(row) == columns(rows[0]) || columns(row) == 4),
        "{rows:?}"
    );
}

#[test]
fn a_damaged_or_foreign_file_is_refused_with_its_key() {
    let project = Project::new(&[]);
    keep(&project, "right", &one(900, 1e-3).to_string());
    let broken = |change: fn(&mut Value)| {
        let mut run = one(900, 1e-3);
        change(&mut run);
        run.to_string()
    };
    let cases: [(String, &str); 9] = [
        ("{".to_owned(), "no JSON"),
        ("[]".to_owned(), "no object"),
        (json!({"kind": "another"}).to_string(), "kind: expected `duhem benchmark`"),
        (broken(|run| run["format"] = json!(2)), "format: expected 1, found 2"),
        (broken(|run| run["rows"][1]["evaluations"] = json!(-1)), "rows[1]: "),
        (broken(|run| run["rows"][1] = run["rows"][0].clone()), "rows[1]: `P6 bdf 1e-6` stands"),
        (broken(|run| run["rows"][0]["repeats_s"] = json!([0.0])), "rows[0].repeats_s"),
        (broken(|run| run["more"] = json!(1)), "more: unknown key"),
        (broken(|run| run["machine"]["processor"] = json!(7)), "machine: "),
    ];
    for (text, words) in cases {
        keep(&project, "wrong", &text);
        for runs in [["right", "wrong"], ["wrong", "right"]] {
            let ran = project.run(&["compare", runs[0], runs[1]]);
            assert_eq!(ran.code, Some(4), "{words}: {ran:?}");
            assert!(ran.err.contains("wrong.json: ") && ran.err.contains(words), "{}", ran.err);
        }
    }
}

#[test]
fn a_run_that_is_not_there_is_a_mistake_of_usage_that_names_those_that_are() {
    let project = Project::new(&[]);
    let ran = project.run(&["compare", "a", "b"]);
    assert_eq!((ran.code, ran.err.contains("none is saved")), (Some(2), true), "{ran:?}");
    keep(&project, "before", &one(900, 1e-3).to_string());
    let ran = project.run(&["compare", "before", "after"]);
    assert_eq!((ran.code, ran.err.contains("known: before")), (Some(2), true), "{ran:?}");
    for wrong in [&["compare", "before"][..], &["compare", "Be Fore", "before"]] {
        assert_eq!(project.run(wrong).code, Some(2), "{wrong:?}");
    }
    // By the path of its file.
    let path = project.path().join("target/duhem/bench/before.json");
    let path = path.to_str().expect("text");
    assert_eq!(project.run(&["compare", path, "before"]).code, Some(0));
}
