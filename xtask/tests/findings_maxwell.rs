//! What the Maxwell-slip experiment found, asserted as measured: the sentences of its captions, as tests.

mod common;

use common::run::{named, ours};
use record::{CaseRow, Summary};
use std::sync::OnceLock;

fn maxwell() -> &'static Summary {
    static TABLES: OnceLock<Summary> = OnceLock::new();
    TABLES.get_or_init(|| named("maxwell-slip-nonlocal-memory.toml"))
}

fn measure(id: &str) -> f64 {
    maxwell().measures.iter().find(|row| row.id == id).expect("a measure").value
}

const STUDIES: [&str; 2] = ["fig06a-amplitude-0.02", "fig06b"];
const EXPLICIT: [&str; 4] = ["explicit-euler", "heun", "rk4", "ode_solvers-rk4"];
const IMPLICIT: [&str; 3] = ["implicit-euler", "implicit-midpoint", "trapezoidal"];

fn cases(study: &'static str, solvers: &'static [&'static str]) -> Vec<&'static CaseRow> {
    let fits = move |row: &&CaseRow| row.study == study && solvers.contains(&row.solver.as_str());
    maxwell().cases.iter().filter(fits).collect()
}

#[test]
fn every_explicit_fixed_step_has_order_one_at_a_switch() {
    for row in maxwell().orders.iter().filter(|row| row.study == "fig06b") {
        if EXPLICIT.contains(&row.solver.as_str()) {
            let found = row.order.expect("an order");
            let name = format!("{}, {}", row.solver, row.corners);
            assert!((0.7..1.3).contains(&found), "{name}: order {found:.2}");
        }
    }
    for row in cases("fig06b", &EXPLICIT) {
        let error = row.error_max.expect("an error");
        assert!(
            row.status == "solved" && error > 1e-3,
            "{}, {}: {error:.1e}",
            row.solver,
            row.value
        );
    }
}

#[test]
fn newton_s_iteration_goes_back_and_forth_at_a_switch() {
    for study in STUDIES {
        let rows = cases(study, &IMPLICIT);
        let failed = rows.iter().filter(|row| row.status == "no convergence").count();
        assert!(rows.len() - failed <= 1, "{study}: {failed} of {} failed", rows.len());
    }
}

#[test]
fn below_a_thousandth_bdf_needs_the_fewest_evaluations() {
    for study in STUDIES {
        for error in [1e-3, 1e-4, 1e-5] {
            let reached = maxwell().cases.iter().filter(|row| {
                (row.study.as_str(), row.corners.as_str(), row.status.as_str())
                    == (study, "restart", "solved")
                    && row.error_max.is_some_and(|e| e <= error)
                    && !ours(row)
            });
            let best = reached.min_by_key(|row| row.evaluations + row.jacobians).expect("a case");
            assert_eq!(best.solver, "bdf", "{study}, {error:e}");
        }
    }
}

#[test]
fn step_control_is_at_least_ten_times_above_its_tolerance_at_a_switch() {
    for row in maxwell().cases.iter().filter(|row| row.study == "fig06b" && row.control == "rtol") {
        if let (Some(error), "solved") = (row.error_max, row.status.as_str()) {
            let over = error / row.value;
            let name = format!("{} at {:e}, {}", row.solver, row.value, row.corners);
            assert!((9.0..2000.0).contains(&over), "{name}: {over:.1} times");
        }
    }
}

#[test]
fn coarse_runs_are_drawn_above_the_largest_force_the_model_has() {
    let most = measure("fig06b.force-max");
    let drawn = |series: &str| {
        let fits = |row: &&record::CurveRow| row.figure == "overshoot" && row.series == series;
        maxwell().curves.iter().filter(fits).map(|row| row.y).fold(0.0, f64::max)
    };
    let exact = drawn("maxwell-slip");
    assert!((exact - most).abs() < 1e-12, "{exact} N of {most} N");
    for series in ["explicit-euler, 33 steps", "rk4, 33 steps"] {
        let force = drawn(series);
        assert!(force > 1.04 * most, "{series}: {force} N of {most} N");
    }
}

#[test]
fn what_the_paper_calls_lost_is_what_the_springs_give_back() {
    let returned = maxwell().claims.iter().find(|row| row.id == "maxwell.energy.returned");
    let returned = returned.and_then(|row| row.ours).expect("an energy");
    let printed = measure("fig06b.paper-formula");
    assert!((returned / printed - 1.0).abs() < 1e-12, "{returned} and {printed} J");
    assert!(measure("fig06b.area") > 1.28 * printed);
}

#[test]
fn the_minor_loops_lie_where_the_paper_says_upper_after_one_period() {
    for figure in ["fig07a", "fig07b"] {
        for side in ["plus", "minus"] {
            let at = |which: &str| measure(&format!("{figure}.{which}-at-{side}"));
            assert!(
                at("upper") > at("lower"),
                "{figure}, {side}: {} and {} N",
                at("upper"),
                at("lower")
            );
        }
        // Two histories that mirror each other: so do the loops.
        let ends = (
            measure(&format!("{figure}.upper-at-plus")),
            measure(&format!("{figure}.lower-at-minus")),
        );
        assert!((ends.0 + ends.1).abs() < 1e-15, "{figure}: {ends:?} N");
    }
}

#[test]
fn printed_things_that_exclude_each_other_have_no_answer() {
    for id in ["fig06a.axes", "fig06a.count", "fig10.axes"] {
        let row = maxwell().claims.iter().find(|row| row.id == id).expect("a claim");
        assert_eq!((row.verdict.as_str(), row.holds), ("under-specified", None), "{id}");
    }
}
