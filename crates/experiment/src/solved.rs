//! One run of a solver on a study, outside the table of cases: for a figure or a check that shows what a
//! solver does, and not how far it is off.

use crate::plan::{Point, Study, control};
use integrate::{Corners, Limits, Run, Solver};
use simulation::{Motion, PrescribedMotion};

/// The displacements [m], velocities [m/s] and forces [N] at the accepted steps, and the run itself.
#[derive(Debug)]
pub(crate) struct Solved {
    /// (u, u̇, F) at each accepted step.
    pub(crate) path: Vec<(f64, f64, f64)>,
    /// How it went.
    pub(crate) run: Run,
}

/// Runs `solver` with `value` steps per period, or at that relative tolerance.
pub(crate) fn solved(
    study: &Study,
    point: &Point,
    (solver, value): (&'static Solver, f64),
    corners: Corners,
) -> Result<Solved, String> {
    let motion =
        PrescribedMotion::new(study.model_at(point)?, study.input.clone(), (0.0, study.span));
    let problem = motion.problem(study.initial.clone());
    let control = control(study, solver, value);
    let limits = Limits { evaluations: study.budget };
    let run = integrate::solve(solver, &problem, &control, corners, &limits);
    let (t, y, n) = (&run.trajectory.t, &run.trajectory.y, run.trajectory.n);
    let at = |(i, t): (usize, &f64)| {
        let x = &y[i * n..(i + 1) * n];
        (study.input.u(*t), study.input.u_dot(*t), motion.force(*t, x))
    };
    let path = t.iter().enumerate().map(at).collect();
    Ok(Solved { path, run })
}
