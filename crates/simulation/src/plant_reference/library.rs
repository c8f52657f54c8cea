//! A driven plant by a solver of the list.

use crate::{DrivenPlant, Motion, Path};
use integrate::{Control, Corners, Dynamics, Failure, Limits, Outcome, Trajectory, solve, solver};

/// Evaluations a second way may take: more than an explicit method needs for the staircase.
const LIMITS: Limits = Limits { evaluations: 50_000_000 };

/// The accepted steps of a solver as a path, with the derivatives of the right-hand side.
pub fn along(motion: &DrivenPlant, trajectory: &Trajectory) -> Path {
    let mut path = Path::new(trajectory.n);
    let mut y_dot = vec![0.0; trajectory.n];
    for (i, t) in trajectory.t.iter().enumerate() {
        let y = trajectory.state(i);
        motion.derivative(*t, y, None, &mut y_dot);
        path.push(*t, y, &y_dot);
    }
    path
}

/// Solves `motion` from `y0` with the adaptive solver of this name.
pub(super) fn solve_by(name: &str, motion: &DrivenPlant, y0: &[f64], rtol: f64) -> (Path, Outcome) {
    let Some(solver) = solver(name) else {
        let why = Failure::Stopped(format!("no solver is called {name}"));
        return (Path::new(y0.len()), Outcome::Failed { at: motion.span().0, why });
    };
    let (problem, control) = (motion.problem(y0.to_vec()), Control::Tolerance { rtol });
    let run = solve(solver, &problem, &control, Corners::Restart, &LIMITS);
    (along(motion, &run.trajectory), run.outcome)
}
