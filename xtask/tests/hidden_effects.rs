//! The committed records in which something is hidden, as `cargo xtask bench hidden-effects --from` answers them.

mod common;

use common::Project;
use serde_json::Value;
use std::path::Path;

/// Where they are; made by the command that stands in each card.
const RECORDS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/hidden-effects");

/// Seeds of records that are not answered rightly yet: a list to be worked down. One that is fails the test until it
/// is struck off.
///
/// 2 hides a `quadratic_drag` of 21 standard errors, told by t = 2.15 on the 16 judging blocks that its 15 s had when none was too
/// short; on the twelve of 0.6 s it is a wrong σ₂.
const NOT_YET: &[u64] = &[2];

#[test]
fn what_is_hidden_in_the_committed_records_is_found() {
    let project = Project::new(&[]);
    let ran = project.run(&["bench", "hidden-effects", "--from", RECORDS, "--json"]);
    assert!(matches!(ran.code, Some(0 | 1)), "{ran:?}");
    let told: Value = serde_json::from_str(&ran.out).expect("JSON");
    let records = told["records"].as_array().expect("a list");
    assert!((6..=12).contains(&records.len()), "{} records", records.len());
    for record in records {
        let seed = record["seed"].as_u64().expect("a seed");
        let listed = NOT_YET.contains(&seed);
        assert_eq!(record["right"], !listed, "answered so: {record:#}");
    }
    let kinds = ["nothing", "parameter", "single", "foreign", "pair"];
    for kind in kinds {
        assert!(records.iter().any(|record| record["kind"] == kind), "no record of kind {kind}");
    }
}

#[test]
fn a_table_with_gaps_is_not_kept() {
    let project = Project::new(&[]);
    let ran = project.run(&["bench", "hidden-effects", "--from", RECORDS, "--save"]);
    assert_eq!(ran.code, Some(4), "{ran:?}");
    assert!(ran.err.contains("2 is followed by 7"), "{}", ran.err);
}

#[test]
fn the_committed_records_are_few_and_small() {
    let files = std::fs::read_dir(Path::new(RECORDS)).expect("the folder").flatten();
    let bytes: u64 = files.map(|file| file.metadata().expect("a file").len()).sum();
    assert!(bytes < 5_000_000, "{bytes} bytes");
}
