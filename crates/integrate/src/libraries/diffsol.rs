//! Adapter to diffsol.
//!
//! What it works around, and why:
//! - `max_nonlinear_solver_failures` counts over the whole run and stops a long one: raised out of
//!   reach.
//! - `min_timestep` is 1e-13 whatever the unit of time, and also stops a short last step: lowered
//!   to what the clock resolves, where that is less.
//! - Forty rejections of one step in a row stop a run: kept, and called "step too small".
//! - The size in `h0` is ignored and only its sign used: the library guesses the first step itself.
//!   For the guess it looks ahead without regard to the stop time, past the end of a short segment.
//! - The error norm is joined by `max`, which drops a NaN, so a step to NaN is *accepted*: the
//!   recorder refuses it.
//! - A derivative that is not a number at the start makes the first step NaN, and Newton's method
//!   is then tried for ever; our wrapper gives up after a thousand such derivatives in a row.
//! - The Jacobian is asked for as products with the unit vectors, first to last: the matrix is
//!   evaluated for the first and kept for the others.

use crate::{Control, Failure, Recorder, Segment};
use diffsol::error::{DiffsolError, OdeSolverError};
use diffsol::{
    NalgebraContext, NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations,
    OdeEquationsImplicit, OdeSolverMethod, OdeSolverProblem, OdeSolverStopReason, VectorCommon,
};
use std::cell::RefCell;

type M = NalgebraMat<f64>;
type LU = NalgebraLU<f64>;
type V = NalgebraVec<f64>;

pub(crate) fn bdf(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let problem = problem(segment, control.rtol()?)?;
    drive(segment, recorder, problem.bdf::<LU>().map_err(in_our_words)?)
}

pub(crate) fn tr_bdf2(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let problem = problem(segment, control.rtol()?)?;
    drive(segment, recorder, problem.tr_bdf2::<LU>().map_err(in_our_words)?)
}

pub(crate) fn esdirk34(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let problem = problem(segment, control.rtol()?)?;
    drive(segment, recorder, problem.esdirk34::<LU>().map_err(in_our_words)?)
}

pub(crate) fn tsit45(
    segment: &Segment<'_>,
    control: &Control,
    recorder: &mut Recorder<'_>,
) -> Result<(), Failure> {
    let problem = problem(segment, control.rtol()?)?;
    drive(segment, recorder, problem.tsit45().map_err(in_our_words)?)
}

/// The segment as the library's problem.
fn problem<'a>(
    segment: &'a Segment<'a>,
    rtol: f64,
) -> Result<
    OdeSolverProblem<impl OdeEquationsImplicit<M = M, V = V, T = f64, C = NalgebraContext> + 'a>,
    Failure,
> {
    let n = segment.dimension();
    let jacobian = RefCell::new(vec![0.0; n * n]);
    let mut problem = OdeBuilder::<M>::new()
        .t0(segment.start)
        .rtol(rtol)
        .atol(segment.scale.iter().map(|scale| rtol * scale).collect::<Vec<_>>())
        .rhs_implicit(
            move |y: &[f64], _: &[f64], t: f64, dy: &mut [f64]| segment.derivative(t, y, dy),
            move |y: &[f64], _: &[f64], t: f64, v: &[f64], product: &mut [f64]| {
                let mut jacobian = jacobian.borrow_mut();
                if v[0] != 0.0 {
                    segment.jacobian(t, y, &mut jacobian);
                }
                for (product, row) in product.iter_mut().zip(jacobian.chunks(n)) {
                    *product = row.iter().zip(v).map(|(j, v)| j * v).sum();
                }
            },
        )
        .init(move |_: &[f64], _: f64, y: &mut [f64]| y.copy_from_slice(&segment.y0), n)
        .build()
        .map_err(in_our_words)?;
    let clock = 4.0 * f64::EPSILON * segment.start.abs().max(segment.end.abs());
    let options = &mut problem.ode_options;
    options.max_nonlinear_solver_failures = usize::MAX;
    options.min_timestep = options.min_timestep.min(clock);
    Ok(problem)
}

/// Steps to the end of the segment.
fn drive<'a, E, S>(
    segment: &Segment<'_>,
    recorder: &mut Recorder<'_>,
    mut solver: S,
) -> Result<(), Failure>
where
    E: OdeEquations<V = V, T = f64> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    solver.set_stop_time(segment.end).map_err(in_our_words)?;
    let mut rejected = 0;
    loop {
        let reason = solver.step();
        let statistics = solver.get_statistics();
        let attempts =
            statistics.number_of_error_test_failures + statistics.number_of_nonlinear_solver_fails;
        recorder.reject((attempts - rejected) as u64);
        rejected = attempts;
        let reason = reason.map_err(in_our_words)?;
        let t = solver.state().t;
        match reason {
            OdeSolverStopReason::TstopReached => {
                deliver(&solver, recorder, segment.end)?;
                return recorder.accept(segment.end, at_step(&solver));
            }
            OdeSolverStopReason::InternalTimestep => {
                deliver(&solver, recorder, t)?;
                recorder.accept(t, at_step(&solver))?;
            }
            OdeSolverStopReason::RootFound(..) => {
                return Err(Failure::Stopped("found a root nobody asked for".to_owned()));
            }
        }
    }
}

/// The state at the end of the last step.
fn at_step<'s, 'a, E, S>(solver: &'s S) -> &'s [f64]
where
    E: OdeEquations<V = V, T = f64> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    solver.state().y.inner().as_slice()
}

/// Delivers what is due up to the end `t` of the last step, between the steps by the dense output of the
/// library.
fn deliver<'a, E, S>(solver: &S, recorder: &mut Recorder<'_>, t: f64) -> Result<(), Failure>
where
    E: OdeEquations<V = V, T = f64> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    if recorder.due(t).is_none() {
        return Ok(());
    }
    let mut y = solver.state().y.clone();
    while let Some(due) = recorder.due(t) {
        // The library's clock may stop a rounding short of the end.
        if due >= solver.state().t {
            recorder.deliver(at_step(solver))?;
        } else {
            solver.interpolate_inplace(due, &mut y).map_err(in_our_words)?;
            recorder.deliver(y.inner().as_slice())?;
        }
    }
    Ok(())
}

#[expect(clippy::needless_pass_by_value, reason = "it stands in map_err")]
fn in_our_words(error: DiffsolError) -> Failure {
    match &error {
        DiffsolError::OdeSolverError(
            OdeSolverError::StepSizeTooSmall { .. }
            | OdeSolverError::TooManyErrorTestFailures { .. },
        ) => Failure::StepTooSmall,
        DiffsolError::OdeSolverError(OdeSolverError::TooManyNonlinearSolverFailures { .. })
        | DiffsolError::NonLinearSolverError(_) => Failure::NoConvergence,
        _ => Failure::Stopped(error.to_string()),
    }
}
