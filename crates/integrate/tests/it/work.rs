//! What a step costs, in evaluations of the right-hand side.

use crate::common::{Scalar, run};
use integrate::{Corners, InitialValueProblem, Order, Outcome, SOLVERS, Solver, Work};

/// Evaluations before the first step, per attempted step, and per accepted step on top; the range
/// of the middle one where it is the number of Newton iterations.
fn theory(solver: &Solver) -> (f64, [f64; 2], f64) {
    match solver.name {
        "explicit-euler" => (0.0, [1.0, 1.0], 0.0),
        "rk4" | "ode_solvers-rk4" => (0.0, [4.0, 4.0], 0.0),
        // For the implicit ones: the problem is linear, so one iteration of Newton's method solves
        // it and the next finds nothing left to do.
        "heun" | "implicit-euler" | "implicit-midpoint" => (0.0, [2.0, 2.0], 0.0),
        "trapezoidal" => (0.0, [3.0, 3.0], 0.0),
        // Two to guess the first step, one to begin it; then the last stage is the next first.
        "dopri5" => (3.0, [6.0, 6.0], 0.0),
        "dop853" | "dop853-autonomous" => (3.0, [11.0, 11.0], 1.0),
        // One to begin, one to guess the first step.
        "tsit45" => (2.0, [6.0, 6.0], 0.0),
        // The library's Newton stops at a fraction of the tolerance: an iteration or two a stage,
        // of which there are 1, 2 and 3.
        "bdf" => (2.0, [1.0, 2.0], 0.0),
        "tr_bdf2" => (2.0, [2.0, 4.0], 0.0),
        "esdirk34" => (2.0, [3.0, 6.0], 0.0),
        name => panic!("say here what a step of {name} costs"),
    }
}

fn work(solver: &Solver) -> Work {
    let dynamics =
        Scalar { f: |t: f64, y: f64, _| -2.0 * (y - t.cos()) - t.sin(), slope: |_, _, _| -2.0 };
    let problem = InitialValueProblem {
        dynamics: &dynamics,
        start: 0.0,
        end: 10.0,
        y0: vec![1.5],
        breakpoints: Vec::new(),
    };
    let control = if matches!(solver.order, Order::Fixed(_)) { 0.01 } else { 1e-6 };
    let run = run(solver, &problem, control, Corners::Restart);
    assert_eq!(run.outcome, Outcome::Solved, "{}", solver.name);
    assert_eq!(run.trajectory.len() as u64, run.work.accepted + 1, "{}", solver.name);
    run.work
}

#[test]
fn evaluations_per_step_are_what_theory_says() {
    for solver in SOLVERS {
        let work = work(solver);
        let (start, attempt, on_accept) = theory(solver);
        let attempts = (work.accepted + work.rejected.unwrap_or(0)) as f64;
        let spent = work.evaluations as f64 - start - on_accept * work.accepted as f64;
        let [least, most] = attempt.map(|cost| cost * attempts);
        let name = solver.name;
        assert!((least..=most).contains(&spent), "{name}: {spent} for {attempts} steps: {work:?}");
    }
}

#[test]
fn fixed_steps_are_never_rejected_and_adaptive_ones_are_counted() {
    for solver in SOLVERS {
        let work = work(solver);
        let fixed = matches!(solver.order, Order::Fixed(_));
        assert_eq!(work.rejected.is_none(), fixed, "{}: {work:?}", solver.name);
        if fixed {
            assert_eq!(work.accepted, 1000, "{}", solver.name);
        }
    }
}

#[test]
fn only_implicit_methods_ask_for_the_jacobian() {
    for solver in SOLVERS {
        let work = work(solver);
        assert_eq!(work.jacobians > 0, solver.implicit, "{}: {work:?}", solver.name);
        if solver.library == "diffsol" {
            assert!(work.jacobians * 4 < work.accepted, "{}: {work:?}", solver.name);
        }
    }
}
