//! Runs a solver over a problem and survives whatever it does.

use crate::segment::{Counter, GiveUp};
use crate::{
    Control, Corners, Failure, InitialValueProblem, Limits, Order, Outcome, Recorder, Run, Segment,
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
    let mut recorder = Recorder::new(problem.start, &problem.y0);
    let sampling = Sampling { control: *control, corners, limits: *limits, times: &[] };
    let (work, outcome) = run(solver, problem, &sampling, &mut recorder);
    Run { trajectory: recorder.trajectory, work, outcome }
}

/// What is asked of a solver that delivers its states at given times.
#[derive(Debug, Clone, Copy)]
pub struct Sampling<'a> {
    /// How closely it is to solve.
    pub control: Control,
    /// What it does at the breakpoints.
    pub corners: Corners,
    /// Where it is stopped.
    pub limits: Limits,
    /// The times asked for, rising, from the start to the end of the problem's span.
    pub times: &'a [f64],
}

/// Solves a problem and writes the states at the times asked for into `states`, n for each time, by the
/// dense output of the solver's own library; a failed run leaves NaN where it did not get to. No step
/// is kept.
///
/// For adaptive solvers: one of fixed steps has no dense output and is refused.
pub fn deliver(
    solver: &Solver,
    problem: &InitialValueProblem<'_>,
    sampling: &Sampling<'_>,
    states: &mut [f64],
) -> (Work, Outcome) {
    let refuse = |words: String| {
        let why = Failure::Stopped(words);
        (Work::default(), Outcome::Failed { at: problem.start, why })
    };
    let times = sampling.times;
    let inside = |t: &f64| (problem.start..=problem.end).contains(t);
    if states.len() != times.len() * problem.y0.len() {
        return refuse(format!("{} numbers for {} times", states.len(), times.len()));
    }
    states.fill(f64::NAN);
    if matches!(solver.order, Order::Fixed(_)) {
        return refuse(format!("{} has fixed steps and no dense output", solver.name));
    }
    if !times.windows(2).all(|w| w[0] < w[1]) || !times.iter().all(inside) {
        return refuse("the times asked for must rise and lie in the span".to_owned());
    }
    let mut recorder = Recorder::on(problem.start, &problem.y0, times, states);
    run(solver, problem, sampling, &mut recorder)
}

/// Runs the solver over all segments, into the recorder.
fn run(
    solver: &Solver,
    problem: &InitialValueProblem<'_>,
    sampling: &Sampling<'_>,
    recorder: &mut Recorder<'_>,
) -> (Work, Outcome) {
    let counter = Counter::new(sampling.limits.evaluations);
    let outer = SOLVING.replace(true);
    let end = catch_unwind(AssertUnwindSafe(|| {
        let scale = problem.dynamics.scale();
        problem.check(&scale)?;
        recorder.diverged_above(&scale);
        if recorder.due(problem.start).is_some() {
            recorder.deliver(&problem.y0)?;
        }
        for (start, end, piece) in problem.segments(sampling.corners) {
            let y0 = recorder.last_state().to_vec();
            let dynamics = problem.dynamics;
            let scale = &scale;
            let counter = &counter;
            let segment = Segment { dynamics, counter, piece, start, end, y0, scale };
            run_segment(solver, &segment, &sampling.control, recorder)?;
        }
        Ok(())
    }));
    SOLVING.set(outer);

    let end = end.unwrap_or_else(|payload| Err(failure_of(payload.as_ref())));
    let at = recorder.trajectory.t.last().copied().unwrap_or(problem.start);
    let work = Work {
        evaluations: counter.evaluations.get(),
        jacobians: counter.jacobians.get(),
        accepted: recorder.accepted,
        rejected: recorder.rejected,
    };
    let outcome = match end {
        Ok(()) => Outcome::Solved,
        Err(why) => Outcome::Failed { at, why },
    };
    (work, outcome)
}

/// One segment. A solver's word that it has arrived is checked, and one that shrank its step
/// because the right-hand side was not finite is said to have met that.
fn run_segment(
    solver: &Solver,
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
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
            Some(&t) if t == segment.end && recorder.due(t).is_none() => Ok(()),
            Some(&t) if t == segment.end => {
                Err(Failure::Stopped(format!("did not deliver all up to t = {t}")))
            }
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
