//! What the LuGre experiment found, asserted as measured: the sentences of its captions, as tests.

mod common;

use common::run::{self, named};
use record::{CaseRow, ClaimRow, Summary};
use std::sync::OnceLock;

fn lugre() -> &'static Summary {
    static TABLES: OnceLock<Summary> = OnceLock::new();
    TABLES.get_or_init(|| named("lugre-rate-dependence.toml"))
}

fn order(study: &str, solver: &str, corners: &str) -> f64 {
    let names = (study, solver, corners);
    let fits = |row: &&record::OrderRow| {
        (row.study.as_str(), row.solver.as_str(), row.corners.as_str()) == names
    };
    lugre().orders.iter().find(fits).and_then(|row| row.order).expect("an order")
}

fn cases(
    study: &'static str,
    solver: &'static str,
    corners: &'static str,
) -> Vec<&'static CaseRow> {
    let fits = move |row: &&CaseRow| {
        (row.study.as_str(), row.solver.as_str(), row.corners.as_str()) == (study, solver, corners)
    };
    lugre().cases.iter().filter(fits).collect()
}

fn measure(id: &str) -> f64 {
    lugre().measures.iter().find(|row| row.id == id).expect("a measure").value
}

fn claim(id: &str) -> &'static ClaimRow {
    lugre().claims.iter().find(|row| row.id == id).expect("a claim")
}

const FIXED: [(&str, f64); 7] = [
    ("explicit-euler", 1.0),
    ("heun", 2.0),
    ("rk4", 4.0),
    ("implicit-euler", 1.0),
    ("implicit-midpoint", 2.0),
    ("trapezoidal", 2.0),
    ("ode_solvers-rk4", 4.0),
];

#[test]
fn a_kink_leaves_order_two_and_a_jump_of_the_velocity_order_one() {
    for (solver, declared) in FIXED {
        for study in ["fig04-omega-10", "fig04-omega-0.1", "triangle"] {
            let found = order(study, solver, "restart");
            assert!((found - declared).abs() < 0.25, "{study}, {solver}: order {found:.2}");
        }
        for study in ["fig04-omega-10", "fig04-omega-0.1"] {
            let found = order(study, solver, "ignore");
            assert!((found - declared.min(2.0)).abs() < 0.3, "{study}, {solver}: order {found:.2}");
        }
        for study in ["triangle", "sliding"] {
            let found = order(study, solver, "ignore");
            assert!(found < 1.15, "{study}, {solver}: order {found:.2}");
        }
    }
}

#[test]
fn explicit_methods_diverge_up_to_their_limit_and_implicit_ones_never_do() {
    for corners in ["restart", "ignore"] {
        for (solver, _) in FIXED {
            for row in cases("sliding", solver, corners) {
                // h |u̇|/r = 400/steps: stable below 2 for explicit Euler and Heun, below 2.79 for RK4.
                let explicit =
                    !["implicit-euler", "implicit-midpoint", "trapezoidal"].contains(&solver);
                let expected = if explicit && row.value < 144.0 { "diverged" } else { "solved" };
                assert_eq!(row.status, expected, "{solver}, {} steps, {corners}", row.value);
            }
        }
    }
    let error = |steps: f64| {
        let rows = cases("sliding", "implicit-euler", "restart");
        rows.iter().find(|row| row.value == steps).and_then(|row| row.error_max).expect("an error")
    };
    let (few, more) = (error(33.0), error(129.0));
    assert!(few < more, "implicit-euler: {few:.2e} with 33 steps, {more:.2e} with 129");
}

#[test]
fn told_of_the_reversals_the_explicit_pairs_deliver_what_was_asked_and_not_told_they_do_not() {
    for solver in ["dopri5", "tsit45", "dop853-autonomous"] {
        for row in cases("fig04-omega-10", solver, "restart") {
            let over = row.error_max.expect("an error") / row.value;
            assert!(over < 2.0, "{solver} at {:e}: {over:.1} times the tolerance", row.value);
        }
        for row in cases("fig04-omega-10", solver, "ignore") {
            let over = row.error_max.expect("an error") / row.value;
            // Ten times, to the digit.
            assert!(over > 9.5, "{solver} at {:e}: {over:.1} times the tolerance", row.value);
            assert_eq!(row.status, "solved");
        }
    }
    let high = cases("fig04-omega-10", "dop853-autonomous", "ignore");
    let worst = high.iter().map(|row| row.error_max.unwrap() / row.value).fold(0.0, f64::max);
    assert!(worst > 1e4, "dop853-autonomous: {worst:.1e} times the tolerance");
}

#[test]
fn the_shipped_dop853_is_right_where_the_speed_is_constant_and_steps_over_its_jumps() {
    for study in ["triangle", "sliding"] {
        for row in cases(study, "dop853", "restart") {
            let over = row.error_max.expect("an error") / row.value;
            assert!(row.status == "solved" && over < 2.0, "{study} at {:e}: {over:.2}", row.value);
        }
    }
    for row in cases("triangle", "dop853", "ignore").into_iter().filter(|row| row.value <= 1e-7) {
        let error = row.error_max.expect("an error");
        assert!(row.status == "solved" && error > 0.01, "{:e}: off by {error:.1e}", row.value);
    }
    let sine = cases("fig04-omega-10", "dop853", "restart");
    assert!(sine.iter().any(|row| row.status == "too many evaluations"));
}

/// The fewest evaluations, Jacobians included, with which each solver reaches an error, with restart.
fn fewest(study: &str, error: f64) -> Vec<(u64, &'static str)> {
    run::fewest(lugre(), (study, ""), error)
}

#[test]
fn the_winners_are_those_that_the_captions_name() {
    for error in [1e-4, 1e-6] {
        assert_eq!(fewest("fig04-omega-10", error)[0].1, "bdf", "{error:e}");
    }
    for error in [1e-8, 1e-10] {
        assert_eq!(fewest("fig04-omega-10", error)[0].1, "dop853-autonomous", "{error:e}");
    }
    for error in [1e-4, 1e-6, 1e-8, 1e-10] {
        assert_eq!(fewest("sliding", error)[0].1, "bdf", "{error:e}");
    }
    let found = fewest("sliding", 1e-6);
    let pair = |(_, s): &&(u64, &str)| ["dopri5", "tsit45", "dop853-autonomous"].contains(s);
    let least = found.iter().find(pair).expect("an explicit pair");
    assert!(5 * found[0].0 < 2 * least.0, "{found:?}");
}

#[test]
fn the_areas_fall_with_the_frequency_and_the_slowest_is_the_map() {
    let area = |omega: &str| measure(&format!("fig04.omega={omega}.area"));
    assert!(area("10") < area("5") && area("5") < area("1") && area("1") < area("0.1"));
    let off = area("0.1") / measure("fig04.slow-limit.area") - 1.0;
    assert!((0.0..2e-4).contains(&off), "{off:e}");
}

#[test]
fn one_cycle_of_the_closed_motion_gives_back_a_millijoule() {
    let energy = measure("energy-back.energy");
    assert!((-1.3e-3..-1.1e-3).contains(&energy), "{energy} J");
    // Without the limit on |x| the speed is lower: 4σ₀(σ₁ + σ₂)/σ₁² r against 9/4 σ₀ r/(σ₁/2 − σ₂).
    let (any, reached) = (measure("lugre.dissipative-speed"), measure("lugre.returning-speed"));
    assert!(any < reached && reached < 0.0143, "{any} and {reached} m/s");
}

#[test]
fn figure_9_s_caption_and_axes_exclude_each_other() {
    for id in ["fig09.axes", "fig09.axes-velocity"] {
        assert_eq!(claim(id).verdict, "under-specified", "{id}");
        assert_eq!(claim(id).holds, None, "{id}");
    }
    // The input that fits the axes reaches both of their ends.
    assert!((measure("fig09.axes.largest-speed") - 1.5e-3).abs() < 1e-15);
    let drop = 1.0 - measure("fig09.axes.steady-at-largest-speed") / measure("fig09.force-max");
    assert!((0.29..0.31).contains(&drop), "{drop:.3} of the peak");
    let drop = 1.0 - measure("fig09.steady-at-largest-speed") / measure("fig09.force-max");
    assert!(drop < 0.005, "{drop:.4} of the peak");
}
