//! Every solver of the list converges with its declared order on a smooth, forced problem.

use crate::common::{Forced, Scalar, run, slope};
use integrate::{Corners, Dynamics, InitialValueProblem, Order, Outcome, SOLVERS, Solver};

/// Largest error over all accepted steps, relative to scale, and the number of steps.
fn error(
    solver: &Solver,
    dynamics: &dyn Dynamics,
    exact: &dyn Fn(f64) -> Vec<f64>,
    control: f64,
) -> (f64, f64) {
    let scale = dynamics.scale();
    let problem =
        InitialValueProblem { dynamics, start: 0.5, end: 8.5, y0: exact(0.5), breakpoints: vec![] };
    let run = run(solver, &problem, control, Corners::Restart);
    assert_eq!(run.outcome, Outcome::Solved, "{} at {control:e}", solver.name);
    let trajectory = &run.trajectory;
    let worst = (0..trajectory.len())
        .flat_map(|i| {
            let errors = exact(trajectory.t[i]);
            let y = trajectory.state(i);
            (0..y.len()).map(|j| (y[j] - errors[j]).abs() / scale[j]).collect::<Vec<_>>()
        })
        .fold(0.0, f64::max);
    (worst, run.work.accepted as f64)
}

fn measure(solver: &Solver, dynamics: &dyn Dynamics, exact: &dyn Fn(f64) -> Vec<f64>, name: &str) {
    match solver.order {
        Order::Fixed(order) => {
            let points: Vec<_> = [0.04_f64, 0.02, 0.01, 0.005]
                .map(|h| (h, error(solver, dynamics, exact, h).0))
                .into_iter()
                .filter(|p| p.1 > 1e-12)
                .collect();
            let found = slope(&points);
            assert!(
                (found - f64::from(order)).abs() <= 0.2,
                "{} on {name}: order {found:.2} instead of {order}: {points:?}",
                solver.name
            );
        }
        Order::Adaptive(_) | Order::Variable => {}
    }
}

#[test]
fn every_solver_shows_its_order_on_a_forced_problem() {
    let one =
        Scalar { f: |t: f64, y: f64, _| -2.0 * (y - t.cos()) - t.sin(), slope: |_, _, _| -2.0 };
    let two = Forced { s: 1e-3 };
    for solver in SOLVERS {
        measure(solver, &one, &|t| vec![t.cos() + (-2.0 * t).exp()], "one state");
        measure(solver, &two, &|t| two.exact(t).to_vec(), "two states");
    }
}
