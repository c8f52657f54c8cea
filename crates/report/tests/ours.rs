//! Our own methods, which are given the task, beside the solvers: in the section across all experiments and in
//! a figure of work and precision.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

use record::{CaseRow, FigureRow, StudyRow, Summary};
use report::render;
use std::collections::BTreeMap;

fn rendered(summaries: &[Summary]) -> BTreeMap<String, String> {
    let outputs = render(summaries).unwrap().into_iter();
    outputs.map(|output| (output.path, String::from_utf8(output.bytes).unwrap())).collect()
}

/// A run on the only study, whose corners no solver is told of.
fn run(
    (solver, library): (&str, &str),
    control: (&str, f64),
    error: Option<f64>,
    evaluations: u64,
) -> CaseRow {
    CaseRow {
        study: "slip".to_owned(),
        solver: solver.to_owned(),
        library: library.to_owned(),
        control: control.0.to_owned(),
        value: control.1,
        corners: "ignore".to_owned(),
        status: if error.is_some() { "solved" } else { "step too small" }.to_owned(),
        error_max: error,
        evaluations,
        ..CaseRow::default()
    }
}

/// Runs of a library, of our own fixed step, and of our own methods: exact, adaptive, and one that failed.
fn with_ours() -> Summary {
    let study = StudyRow {
        study: "slip".to_owned(),
        reference: "exact".to_owned(),
        response: "displacement q".to_owned(),
        budget: 1000,
        reference_error: Some(1e-9),
        ..StudyRow::default()
    };
    let own = |solver, control, error, evaluations| CaseRow {
        corners: "restart".to_owned(),
        ..run((solver, "own"), control, error, evaluations)
    };
    let (bdf, rk4) = (("bdf", "diffsol"), ("rk4", "own"));
    let cases = vec![
        run(bdf, ("rtol", 1e-6), Some(0.000_99), 40),
        run(bdf, ("rtol", 1e-13), Some(0.9e-9), 300),
        run(rk4, ("step", 129.0), Some(5e-4), 20),
        own("exact-slip-plant", ("none", 0.0), Some(0.0), 150),
        own("radau-located", ("rtol", 1e-3), Some(4e-4), 10),
        own("radau-located", ("rtol", 1e-6), None, 5),
    ];
    Summary { name: "staircase".to_owned(), studies: vec![study], cases, ..Summary::default() }
}

/// The cells of the row of a Markdown table that begins with this one.
fn row<'a>(text: &'a str, first: &str) -> Vec<&'a str> {
    let start = format!("| {first} |");
    let line = text.lines().find(|line| line.starts_with(&start));
    let line = line.unwrap_or_else(|| panic!("no row {first}"));
    line.trim_matches('|').split('|').map(str::trim).collect()
}

#[test]
fn our_own_methods_are_held_against_the_best_library_and_not_against_our_fixed_steps() {
    let files = rendered(&[with_ours()]);
    let front = &files["README.md"];
    let table = front.split("Ours and the best library solver").nth(1).unwrap();
    let cells = row(table, "slip<br>staircase");
    assert_eq!(cells[1], "radau-located 10<br>bdf 40<br>0.25\u{202f}×");
    assert_eq!(cells[2], "exact-slip-plant 150<br>bdf 300<br>0.50\u{202f}×");
    assert!(front.contains("an exact one holds on 1 and an adaptive one on 1 of the 1 problems"));
    assert!(front.contains("Of their 3 runs 1 (radau-located 1) failed."));
    assert!(front.contains(
        "at 10⁻³ in the middle 0.25\u{202f}× (0.25\u{202f}× to 0.25\u{202f}×), below 1 on 1"
    ));
    // Who is cheapest among the solvers does not change by what is given more.
    let table = front.split("The cheapest solver of each problem").nth(1).unwrap();
    assert!(row(table, "slip<br>staircase")[1].starts_with("rk4 20<br>"));
    assert_eq!(row(front, "exact-slip-plant")[1..4], ["1/1", "1/1", "1/1"]);
    assert_eq!(row(front, "radau-located")[1..4], ["1/2", "1/1", "0/1"]);
    assert_eq!(row(front, "radau-located")[5], "0.5\u{202f}×");
    let svg = &files["solvers.svg"];
    assert!(svg.contains(">ours</text>") && svg.contains(">exact</text>"));
    let mut without = with_ours();
    without.cases.retain(|case| ["bdf", "rk4"].contains(&case.solver.as_str()));
    assert!(!rendered(&[without])["README.md"].contains("Of our own methods"));
}

#[test]
fn a_work_precision_figure_shows_ours_where_every_solver_ignores_the_corners() {
    let mut summary = with_ours();
    summary.figures = vec![FigureRow {
        figure: "work".to_owned(),
        kind: "work_precision".to_owned(),
        study: "slip".to_owned(),
        ..FigureRow::default()
    }];
    let files = rendered(&[summary]);
    let csv = &files["staircase/work.csv"];
    let panel = "step control, corners ignored";
    for (series, at) in [("exact-slip-plant", "150"), ("radau-located", "10"), ("bdf", "40")] {
        let start = format!("\"{panel}\",{series},{at}");
        assert!(csv.contains(&start), "no {start} in {csv}");
    }
    assert!(files["staircase/work.svg"].contains("&lt;\u{202f}10"), "round-off has no tick");
}
