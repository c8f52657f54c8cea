//! States at the times asked for: each library's own dense output.

use crate::common::{Forced, Scalar};
use integrate::{
    Control, Corners, Dynamics, InitialValueProblem, Limits, Order, Outcome, SOLVERS, Sampling,
    Solver, deliver, solve,
};

fn adaptive() -> impl Iterator<Item = &'static Solver> {
    SOLVERS.iter().filter(|s| !matches!(s.order, Order::Fixed(_)))
}

fn even(count: u32, end: f64) -> Vec<f64> {
    (0..=count).map(|i| end * f64::from(i) / f64::from(count)).collect()
}

fn sampling(times: &[f64], rtol: f64, corners: Corners) -> Sampling<'_> {
    Sampling { control: Control::Tolerance { rtol }, corners, limits: Limits::default(), times }
}

fn forced(dynamics: &Forced) -> InitialValueProblem<'_> {
    let y0 = dynamics.exact(0.0).to_vec();
    InitialValueProblem { dynamics, start: 0.0, end: 20.0, y0, breakpoints: Vec::new() }
}

/// The largest error of states at times, each state in its own size.
fn worst(dynamics: &Forced, times: &[f64], states: &[f64]) -> f64 {
    let errors = times.iter().zip(states.chunks_exact(2)).map(|(t, y)| {
        let (exact, scale) = (dynamics.exact(*t), dynamics.scale());
        ((y[0] - exact[0]) / scale[0]).abs().max(((y[1] - exact[1]) / scale[1]).abs())
    });
    errors.fold(0.0, |worst, error| if error.is_nan() { error } else { error.max(worst) })
}

#[test]
fn between_the_steps_the_states_are_as_good_as_at_the_steps() {
    let dynamics = Forced { s: 1e-3 };
    let problem = forced(&dynamics);
    let times = even(2000, 20.0);
    let uneven: Vec<f64> = (0..=40).map(|i| 20.0 * (f64::from(i) / 40.0).powi(2)).collect();
    for solver in adaptive() {
        for rtol in [1e-4, 1e-7] {
            let control = Control::Tolerance { rtol };
            let run = solve(solver, &problem, &control, Corners::Ignore, &Limits::default());
            let at_steps = worst(&dynamics, &run.trajectory.t, &run.trajectory.y);
            for times in [&times, &uneven] {
                let mut states = vec![0.0; 2 * times.len()];
                let asked = sampling(times, rtol, Corners::Ignore);
                let (work, outcome) = deliver(solver, &problem, &asked, &mut states);
                assert_eq!(outcome, Outcome::Solved, "{} at {rtol:e}", solver.name);
                let between = worst(&dynamics, times, &states);
                // Dense output of order 7 between steps of order 8 is ten times worse at these; all
                // others are within a tenth.
                let factor = if solver.library == "ode_solvers" { 15.0 } else { 1.2 };
                assert!(
                    between <= factor * at_steps,
                    "{} at {rtol:e}: {between:.1e} between steps that are right to {at_steps:.1e}",
                    solver.name
                );
                if solver.library == "diffsol" || times.len() == 2001 {
                    let steps = (work.accepted, work.rejected, work.jacobians);
                    let alone = (run.work.accepted, run.work.rejected, run.work.jacobians);
                    assert_eq!(steps, alone, "{}: dense output changes the steps", solver.name);
                }
            }
        }
    }
}

/// y' = 1 before t = 1, −1 after it.
fn turning() -> impl Dynamics {
    let f = |t: f64, _: f64, piece: Option<usize>| {
        let before = piece.map_or(t < 1.0, |piece| piece == 0);
        if before { 1.0 } else { -1.0 }
    };
    Scalar { f, slope: |_, _, _| 0.0 }
}

#[test]
fn states_are_delivered_on_both_sides_of_a_corner_and_at_it() {
    let dynamics = turning();
    let problem = InitialValueProblem {
        dynamics: &dynamics,
        start: 0.0,
        end: 3.0,
        y0: vec![0.0],
        breakpoints: vec![1.0],
    };
    let with_corner = even(30, 3.0);
    // A rounding beyond the corner is the corner.
    let mut beyond = with_corner.clone();
    beyond[10] = 1.0_f64.next_up();
    let without = even(7, 3.0);
    for solver in adaptive() {
        for times in [&with_corner, &beyond, &without, &vec![3.0], &vec![0.5, 0.75]] {
            let mut states = vec![0.0; times.len()];
            let asked = sampling(times, 1e-6, Corners::Restart);
            let (_, outcome) = deliver(solver, &problem, &asked, &mut states);
            assert_eq!(outcome, Outcome::Solved, "{}", solver.name);
            for (t, y) in times.iter().zip(&states) {
                let error = (y - (1.0 - (t - 1.0).abs())).abs();
                assert!(error < 1e-12, "{}: off by {error:.1e} at t = {t}", solver.name);
            }
        }
    }
}

#[test]
fn what_a_failed_run_did_not_reach_is_not_a_number() {
    // y = 1/(1 − t), which no solver passes; a step may reach t = 1.
    let dynamics = Scalar { f: |_, y: f64, _| y * y, slope: |_, y: f64, _| 2.0 * y };
    let problem = InitialValueProblem {
        dynamics: &dynamics,
        start: 0.0,
        end: 2.0,
        y0: vec![1.0],
        breakpoints: Vec::new(),
    };
    let times = even(20, 2.0);
    for solver in adaptive() {
        let mut states = vec![0.0; times.len()];
        let asked = sampling(&times, 1e-6, Corners::Ignore);
        let (work, outcome) = deliver(solver, &problem, &asked, &mut states);
        assert!(matches!(outcome, Outcome::Failed { .. }), "{}: {outcome}", solver.name);
        assert!(work.evaluations > 0);
        assert!(states[11..].iter().all(|y| y.is_nan()), "{}: {states:?}", solver.name);
        assert_eq!(states[0], 1.0, "{}", solver.name);
    }
}

#[test]
fn a_grid_that_cannot_be_delivered_is_refused_in_words() {
    let dynamics = turning();
    let problem = InitialValueProblem {
        dynamics: &dynamics,
        start: 0.0,
        end: 3.0,
        y0: vec![0.0],
        breakpoints: Vec::new(),
    };
    let dopri5 = integrate::solver("dopri5").unwrap();
    let refused = |solver: &Solver, times: &[f64], room: usize| {
        let mut states = vec![0.0; room];
        let asked = sampling(times, 1e-6, Corners::Ignore);
        match deliver(solver, &problem, &asked, &mut states) {
            (_, Outcome::Failed { why, .. }) => why.to_string(),
            (_, Outcome::Solved) => panic!("{times:?} in {room} was accepted"),
        }
    };
    assert!(refused(dopri5, &[0.0, 1.0], 3).contains("3 numbers for 2 times"));
    assert!(refused(dopri5, &[1.0, 0.5], 2).contains("must rise"));
    assert!(refused(dopri5, &[1.0, 4.0], 2).contains("must rise and lie in the span"));
    assert!(refused(dopri5, &[1.0, f64::NAN], 2).contains("must rise"));
    let rk4 = integrate::solver("rk4").unwrap();
    assert!(refused(rk4, &[1.0, 2.0], 2).contains("rk4 has fixed steps"));
}
