//! `cargo xtask bench`, as a stranger would call it; few cases, because it is made for many.

mod common;

use common::Project;
use serde_json::Value;

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
        &["bench", "properties", "--cases", "0"],
        &["bench", "properties", "--cases", "many"],
        &["bench", "properties", "--seed", "-1"],
        &["bench", "properties", "--threads", "0"],
    ] {
        let ran = project.run(wrong);
        assert_eq!(ran.code, Some(2), "{wrong:?}: {ran:?}");
    }
}
