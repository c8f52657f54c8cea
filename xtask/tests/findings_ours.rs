//! What our own methods do in the experiments, as the captions say it. An exact method is judged by the closed
//! form it follows, so that its error here is rounding; what is asserted of it is its cost.

mod common;

use common::run::{fewest, fewest_of_ours, named, ours};
use record::{CaseRow, Summary};

fn rows<'a>(tables: &'a Summary, study: &'a str, solver: &'a str) -> Vec<&'a CaseRow> {
    let fits = |row: &&CaseRow| row.study == study && row.solver == solver;
    let found: Vec<_> = tables.cases.iter().filter(fits).collect();
    assert!(!found.is_empty(), "{solver} was not run on {study}");
    found
}

/// The error of a run that says it solved.
fn solved(row: &CaseRow) -> f64 {
    assert_eq!(row.status, "solved", "{}, {}, {:e}", row.study, row.solver, row.value);
    row.error_max.expect("an error")
}

#[test]
fn an_exact_method_takes_one_update_a_time_and_is_at_round_off_at_every_exponent() {
    let tables = named("dahl-gamma-sweep.toml");
    let all = rows(&tables, "fig01", "exact-dahl");
    assert_eq!(all.len(), 6, "one case for each γ");
    let maxwell = named("maxwell-slip-nonlocal-memory.toml");
    let slips = ["fig06a-amplitude-0.02", "fig06b"]
        .map(|study| rows(&maxwell, study, "exact-maxwell-slip"))
        .concat();
    for row in all.iter().chain(&slips) {
        let error = solved(row);
        assert!(error < 1e-12, "{}, {}: {error:.1e}", row.study, row.point);
        // 200 times in each of three periods, the start, and what corners and arrivals add.
        let most = 601 + 30;
        assert!((601..most).contains(&row.evaluations), "{} evaluations", row.evaluations);
        assert_eq!((row.control.as_str(), row.value, row.accepted), ("none", 0.0, 0));
    }
    for row in tables.orders.iter().chain(&maxwell.orders) {
        assert!(!row.solver.starts_with("exact"), "an order of {} against nothing", row.solver);
    }
}

#[test]
fn lugre_as_a_linear_equation_takes_less_than_half_of_what_any_solver_takes() {
    let tables = named("lugre-rate-dependence.toml");
    for study in ["fig04-omega-10", "fig04-omega-0.1"] {
        for error in [1e-4, 1e-6, 1e-8, 1e-10] {
            let (own, best) = (
                fewest_of_ours(&tables, (study, ""), error)[0],
                fewest(&tables, (study, ""), error)[0],
            );
            assert_eq!(own.1, "lugre-linear");
            assert!(2 * own.0 < best.0, "{study}, {error:e}: {own:?} and {best:?}");
        }
    }
}

#[test]
fn the_dahl_series_is_within_its_tolerance_where_every_solver_of_a_library_misses_its_own() {
    for (file, study) in [("gearbox.toml", "fig18"), ("mass-spring-staircase.toml", "fig13")] {
        let tables = named(file);
        let own = tables.studies.iter().find(|row| row.study == study).expect("the study");
        let known = own.reference_error.expect("the reference's own error");
        for row in rows(&tables, study, "dahl-series") {
            let (error, most) = (solved(row), row.value.max(2.0 * known));
            assert!(error <= most, "{study} at {:e}: {error:.1e}", row.value);
        }
        let above = |row: &&CaseRow| !ours(row) && row.study == study && row.control == "rtol";
        for row in tables.cases.iter().filter(above) {
            let error = row.error_max.unwrap_or(f64::INFINITY);
            assert!(row.status != "solved" || error > row.value, "{}, {:e}", row.solver, row.value);
        }
    }
}

#[test]
fn on_the_lugre_plants_ours_alone_comes_to_the_small_errors_and_misses_no_slip() {
    let (staircase, gearbox) = (named("mass-spring-staircase.toml"), named("gearbox.toml"));
    for (tables, study, bound) in [(&staircase, "fig14", 1e-5), (&gearbox, "fig20", 1e-8)] {
        let below = |row: &&CaseRow| {
            let arrived = row.status == "solved" && row.error_max.is_some_and(|e| e < bound);
            row.study == study && arrived
        };
        let names: Vec<&str> =
            tables.cases.iter().filter(below).map(|row| row.solver.as_str()).collect();
        assert!(!names.is_empty(), "{study}: nobody below {bound:e}");
        assert!(names.iter().all(|name| *name == "radau-located"), "{study}: {names:?}");
    }
    let of = |id: &str| staircase.measures.iter().find(|m| m.id == id).expect("a measure").value;
    let step = of("fig15.slip1.rise") / of("fig15.q-max");
    for row in rows(&staircase, "fig14", "radau-located") {
        let error = solved(row);
        assert!(error < 0.3 * step, "at {:e}: {error:.1e}, a step is {step:.1e}", row.value);
    }
}

#[test]
fn from_event_to_event_costs_less_than_any_solver_that_is_right_to_a_hundredth() {
    let gearbox = named("gearbox.toml");
    let exact = rows(&gearbox, "fig22", "exact-slip-plant")[0];
    assert!(solved(exact) < 1e-9);
    let others = gearbox.cases.iter().filter(|row| {
        row.study == "fig22" && !ours(row) && row.error_max.is_some_and(|e| e < 1e-2)
    });
    let least = others.filter(|row| row.status == "solved").map(|row| row.evaluations).min();
    let least = least.expect("a solver that comes within a hundredth");
    assert!(exact.evaluations < least, "{} and {least}", exact.evaluations);
}
