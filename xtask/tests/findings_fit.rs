//! What the fit of the synthetic record found, asserted as measured: the sentences of its report, as tests.

mod common;

use common::{Project, run::named};
use record::{ModelRow, ParameterRow, Summary};
use std::{fs, path::Path, sync::OnceLock};

fn fitted() -> &'static Summary {
    static TABLES: OnceLock<Summary> = OnceLock::new();
    TABLES.get_or_init(|| named("gearbox-fit.toml"))
}

fn parameter(name: &str) -> &'static ParameterRow {
    let rows = &fitted().parameters;
    rows.iter().find(|row| row.parameter == name).unwrap_or_else(|| panic!("no {name}"))
}

fn model(name: &str) -> &'static ModelRow {
    let rows = &fitted().models;
    rows.iter().find(|row| row.model.starts_with(name)).unwrap_or_else(|| panic!("no {name}"))
}

fn measure(id: &str) -> (f64, f64) {
    let found = fitted().measures.iter().find(|m| m.id == id);
    found.map_or_else(|| panic!("no {id}"), |m| (m.value, m.error))
}

#[test]
fn the_fit_leaves_the_values_tuned_by_hand_and_comes_to_the_truth() {
    assert_eq!(fitted().fits[0].end, "converged");
    for row in &fitted().parameters {
        let truth = row.truth.expect("a truth");
        let off = (row.found - truth).abs();
        // F_C and σ₂ miss by parts in a hundred thousand what their standard errors would allow.
        let room = (3.0 * row.standard_error).max(1e-4 * truth.abs());
        let told = format!("{}: {:.5e} of {truth:.5e} {}", row.parameter, row.found, row.unit);
        assert!(off < room, "{told}");
        assert!((row.given - truth).abs() > room, "{told}: it started there");
        let ends = (row.low.expect("an end"), row.high.expect("an end"));
        let beyond = (ends.0 - truth).max(truth - ends.1);
        assert!(row.identified && beyond < 1e-4 * truth.abs(), "{told}: {beyond:.1e} outside");
    }
    let inside = measure("rig.intervals-with-truth").0;
    assert!(inside >= 9.0, "{inside} of 11 intervals hold the truth");
    let height = |of: &str| measure(&format!("fig26.height.{of}")).0;
    let off = |of: &str| (height(of) / height("record") - 1.0).abs();
    assert!(off("given") > 0.1, "the loop tuned by hand is only {:.3} off", off("given"));
    assert!(off("fitted") < 2e-3, "the fitted loop is {:.1e} off", off("fitted"));
}

#[test]
fn the_springs_of_the_fit_are_those_of_a_straight_line_through_the_load_cells() {
    for (id, name) in [("fig24.spring-1", "k_1"), ("fig24.spring-2", "k_2")] {
        let (line, fit) = (measure(id).0, parameter(name));
        let off = (line - fit.found).abs();
        assert!(off < 0.5 * fit.standard_error, "{name}: {line:.5} and {:.5} N/m", fit.found);
    }
}

#[test]
fn the_bias_of_the_torque_is_the_monitors() {
    let (mean, _) = measure("fig25.torque-bias");
    let offset = parameter("offset");
    assert!((mean - offset.found).abs() < 1e-4, "{mean:.5} and {:.5} N·m", offset.found);
    assert!((offset.truth.expect("a truth") + 0.528).abs() < 1e-12, "{:?} N·m", offset.truth);
}

#[test]
fn of_five_friction_models_the_one_that_made_the_record_is_best_on_held_out_blocks() {
    let lugre = model("lugre");
    for name in ["coulomb", "coulomb + viscous", "dahl", "maxwell-slip"] {
        let other = model(name);
        assert!(
            other.held_out > lugre.held_out && other.trained > lugre.trained,
            "{name}: {:.2} and {:.2} of the noise, LuGre {:.2} and {:.2}",
            other.held_out,
            other.trained,
            lugre.held_out,
            lugre.trained
        );
    }
}

/// The record and its files in a project of their own, two parameters free.
fn small() -> Project {
    let toml = r#"title = "small"
paper = "none"
text  = "A test."

[[fit]]
name   = "rig"
title  = "The rig"
record = "../record.parquet"
rig    = "../rig.toml"
starts = 0
models = false
"#;
    let project = Project::new(&[("small.toml", toml)]);
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data");
    let rig = fs::read_to_string(data.join("gearbox-rig.toml")).expect("the rig");
    let free = rig.find("free = [").expect("what is free");
    let end = free + rig[free..].find(']').expect("its end");
    let rig = format!("{}free = [\"f_c\", \"offset\"{}", &rig[..free], &rig[end..]);
    fs::write(project.path().join("rig.toml"), rig).expect("a rig");
    let record = project.path().join("record.parquet");
    fs::copy(data.join("gearbox-synthetic.parquet"), record).expect("a record");
    project
}

#[test]
fn a_fit_is_the_same_on_one_and_on_eight_threads_and_from_its_record() {
    small().same_on_threads_and_from_record("fit rig", "parameters.csv");
}

#[test]
fn what_a_fit_cannot_use_is_said_with_its_line_and_key() {
    for (from, to, words) in [
        ("../record.parquet", "../no.parquet", "fit[0].record"),
        ("../rig.toml", "../no.toml", "fit[0].rig"),
        ("../rig.toml", "small.toml", "fit[0].rig"),
        ("starts = 0", "start = 0", "did you mean `starts`?"),
        ("starts = 0", "truth = \"../rig.toml\"", "fit[0].truth"),
        ("starts = 0", "window = -1.0", "fit[0].window"),
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
