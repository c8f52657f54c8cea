//! Runs a solver over a problem and survives whatever it does.

use crate::segment::{Counter, GiveUp};
use crate::{
    Control, Corners, Failure, InitialValueProblem, Limits, Outcome, Recorder, Run, Segment,
    Solver, Work,
};
use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static SOLVING: Cell<bool> = const { Cell::new(false) };
}

/// True while this thread is inside [`solve`], where a panic becomes a row of a table: the
/// program's panic hook can then stay silent.
pub fn solving() -> bool {
    SOLVING.get()
}

/// Solves a problem with a solver. Never panics, and keeps what was computed before a failure.
///
/// Code that never returns and never asks for the right-hand side cannot be stopped from here.
pub fn solve(
    solver: &Solver,
    problem: &InitialValueProblem<'_>,
    control: &Control,
    corners: Corners,
    limits: &Limits,
) -> Run {
    let counter = Counter::new(limits.evaluations);
    let mut recorder = Recorder::new(problem.start, &problem.y0, &[]);
    let outer = SOLVING.replace(true);
    let end = catch_unwind(AssertUnwindSafe(|| {
        let scale = problem.dynamics.scale();
        problem.check(&scale)?;
        recorder = Recorder::new(problem.start, &problem.y0, &scale);
        for (start, end, piece) in problem.segments(corners) {
            let y0 = recorder.last_state().to_vec();
            let dynamics = problem.dynamics;
            let scale = &scale;
            let counter = &counter;
            let segment = Segment { dynamics, counter, piece, start, end, y0, scale };
            run_segment(solver, &segment, control, &mut recorder)?;
        }
        Ok(())
    }));
    SOLVING.set(outer);

    let end = end.unwrap_or_else(|payload| Err(failure_of(payload.as_ref())));
    let at = recorder.trajectory.t.last().copied().unwrap_or(problem.start);
    Run {
        work: Work {
            evaluations: counter.evaluations.get(),
            jacobians: counter.jacobians.get(),
            accepted: recorder.accepted,
            rejected: recorder.rejected,
        },
        trajectory: recorder.trajectory,
        outcome: match end {
            Ok(()) => Outcome::Solved,
            Err(why) => Outcome::Failed { at, why },
        },
    }
}

/// One segment. A solver's word that it has arrived is checked, and one that shrank its step
/// because the right-hand side was not finite is said to have met that.
fn run_segment(
    solver: &Solver,
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder,
) -> Result<(), Failure> {
    let result = (solver.run)(segment, control, recorder);
    match result {
        Err(Failure::StepTooSmall | Failure::NoConvergence)
            if !segment.last_derivative_was_finite() =>
        {
            Err(Failure::NotFinite)
        }
        Err(why) => Err(why),
        Ok(()) => match recorder.trajectory.t.last() {
            Some(&t) if t == segment.end => Ok(()),
            t => Err(Failure::Stopped(format!(
                "claims to be done at t = {}, but the end is {}",
                t.unwrap_or(&segment.start),
                segment.end
            ))),
        },
    }
}

fn failure_of(payload: &(dyn Any + Send)) -> Failure {
    match payload.downcast_ref() {
        Some(GiveUp::BudgetSpent) => return Failure::TooManyEvaluations,
        Some(GiveUp::NeverFinite) => return Failure::NotFinite,
        None => {}
    }
    let words = payload.downcast_ref::<String>().map(String::as_str);
    let words = words.or_else(|| payload.downcast_ref::<&str>().copied());
    Failure::Panicked(words.unwrap_or("without words").to_owned())
}
