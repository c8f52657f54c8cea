//! Breakpoints, grids, sizes and sets.

use crate::common::{Scalar, run, slope};
use integrate::{
    Control, Corners, Dynamics, InitialValueProblem, Limits, Order, Outcome, SETS, SOLVERS,
    Trajectory, set, solve, solver,
};
use proptest::prelude::*;

const TURNS: [f64; 3] = [0.731_7, 1.618_03, 2.9];

/// The sign of piece k: + − + −.
fn sign(k: usize) -> f64 {
    if k.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// y' = s(t) − y, where s jumps between ±1 at the turns; y(0) = 0.
fn switched(dynamics: &dyn Dynamics) -> InitialValueProblem<'_> {
    let breakpoints = TURNS.to_vec();
    InitialValueProblem { dynamics, start: 0.0, end: 4.0, y0: vec![0.0], breakpoints }
}

fn piece_at(t: f64) -> usize {
    TURNS.iter().filter(|turn| t >= **turn).count()
}

fn derivative(t: f64, y: f64, piece: Option<usize>) -> f64 {
    sign(piece.unwrap_or_else(|| piece_at(t))) - y
}

fn exact(t: f64) -> f64 {
    let mut y = 0.0;
    let mut from = 0.0;
    for (k, to) in TURNS.iter().copied().chain([f64::INFINITY]).enumerate() {
        y = sign(k) + (y - sign(k)) * (from - to.min(t)).exp();
        if t <= to {
            break;
        }
        from = to;
    }
    y
}

fn worst(trajectory: &Trajectory) -> f64 {
    trajectory.t.iter().zip(&trajectory.y).map(|(t, y)| (y - exact(*t)).abs()).fold(0.0, f64::max)
}

#[test]
fn rk4_keeps_its_order_over_corners_only_if_it_restarts() {
    let dynamics = Scalar { f: derivative, slope: |_, _, _| -1.0 };
    for name in ["rk4", "ode_solvers-rk4"] {
        let rk4 = solver(name).unwrap();
        let order = |corners| {
            let steps = [0.1, 0.07, 0.05, 0.035, 0.025, 0.0175, 0.0125];
            let points = steps.map(|h| {
                let run = run(rk4, &switched(&dynamics), h, corners);
                assert_eq!(run.outcome, Outcome::Solved);
                (h, worst(&run.trajectory))
            });
            slope(&points)
        };
        let restart = order(Corners::Restart);
        let ignore = order(Corners::Ignore);
        assert!((3.8..=4.2).contains(&restart), "{name}: order {restart:.2} with restarts");
        assert!(ignore <= 2.0, "{name}: order {ignore:.2} without");
    }
}

#[test]
fn every_solver_restarts_at_the_exact_breakpoints_and_records_them_once() {
    let dynamics = Scalar { f: derivative, slope: |_, _, _| -1.0 };
    for solver in SOLVERS {
        let control = if matches!(solver.order, Order::Fixed(_)) { 1e-3 } else { 1e-8 };
        let run = run(solver, &switched(&dynamics), control, Corners::Restart);
        assert_eq!(run.outcome, Outcome::Solved, "{}", solver.name);
        let t = &run.trajectory.t;
        assert!(t.windows(2).all(|w| w[0] < w[1]), "{}: times do not rise", solver.name);
        for turn in TURNS.iter().chain([&0.0, &4.0]) {
            assert!(t.contains(turn), "{}: {turn} is missing", solver.name);
        }
        let error = worst(&run.trajectory);
        assert!(error < 1e-3, "{}: off by {error:.1e}", solver.name);
    }
}

#[test]
fn a_restarted_solver_asks_for_its_piece_and_an_ignorant_one_for_none() {
    for solver in SOLVERS {
        for corners in [Corners::Restart, Corners::Ignore] {
            let dynamics = Scalar {
                f: |t, y, piece: Option<usize>| {
                    assert_eq!(piece.is_some(), corners == Corners::Restart);
                    derivative(t, y, piece)
                },
                slope: |_, _, _| -1.0,
            };
            let control = if matches!(solver.order, Order::Fixed(_)) { 0.01 } else { 1e-4 };
            let run = run(solver, &switched(&dynamics), control, corners);
            assert_eq!(run.outcome, Outcome::Solved, "{} {corners:?}", solver.name);
        }
    }
}

#[test]
fn the_long_run_of_the_library_rk4_is_ours_to_rounding() {
    let dynamics = Scalar { f: |t: f64, y: f64, _| t.cos() - y, slope: |_, _, _| -1.0 };
    let problem = InitialValueProblem {
        dynamics: &dynamics,
        start: 0.0,
        end: 100.0,
        y0: vec![0.0],
        breakpoints: Vec::new(),
    };
    let [ours, theirs] = ["rk4", "ode_solvers-rk4"]
        .map(|name| run(solver(name).unwrap(), &problem, 0.01, Corners::Restart).trajectory);
    assert_eq!(ours.t, theirs.t);
    let apart = ours.y.iter().zip(&theirs.y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-12, "{apart:.1e} apart");
}

/// Decays of n states at different rates, the fastest given.
struct Decays {
    n: usize,
    fastest: f64,
}

impl Decays {
    fn rate(&self, i: usize) -> f64 {
        self.fastest / (i + 1) as f64
    }
}

impl Dynamics for Decays {
    fn dimension(&self) -> usize {
        self.n
    }
    fn derivative(&self, _: f64, y: &[f64], _: Option<usize>, dy: &mut [f64]) {
        for (i, dy) in dy.iter_mut().enumerate() {
            *dy = -self.rate(i) * y[i];
        }
    }
    fn jacobian(&self, _: f64, _: &[f64], _: Option<usize>, jacobian: &mut [f64]) {
        jacobian.fill(0.0);
        for i in 0..self.n {
            jacobian[i * self.n + i] = -self.rate(i);
        }
    }
    fn scale(&self) -> Vec<f64> {
        vec![1.0; self.n]
    }
}

fn decay<'a>(dynamics: &'a Decays, breakpoints: &[f64]) -> InitialValueProblem<'a> {
    let y0 = vec![1.0; dynamics.n];
    let breakpoints = breakpoints.to_vec();
    InitialValueProblem { dynamics, start: 0.0, end: 2.0, y0, breakpoints }
}

#[test]
fn every_solver_takes_any_number_of_states() {
    for n in 1..=12 {
        let decays = Decays { n, fastest: 3.0 };
        for solver in SOLVERS {
            let control = if matches!(solver.order, Order::Fixed(_)) { 1e-3 } else { 1e-8 };
            let run = run(solver, &decay(&decays, &[1.0]), control, Corners::Restart);
            assert_eq!(run.outcome, Outcome::Solved, "{} with {n} states", solver.name);
            let (_, y) = run.trajectory.last().unwrap();
            let errors = (0..n).map(|i| (y[i] - (-2.0 * decays.rate(i)).exp()).abs());
            let error = errors.fold(0.0, f64::max);
            assert!(error < 2e-3, "{} with {n} states: off by {error:.1e}", solver.name);
        }
    }
}

#[test]
fn stiffness_costs_explicit_methods_steps_but_does_not_stop_them() {
    let stiff = Decays { n: 2, fastest: 1e5 };
    for solver in set("@adaptive").unwrap() {
        let run = run(solver, &decay(&stiff, &[]), 1e-6, Corners::Restart);
        assert_eq!(run.outcome, Outcome::Solved, "{}", solver.name);
        let steps = run.work.accepted;
        assert_eq!(steps < 1000, solver.implicit, "{}: {steps} steps", solver.name);
    }
}

#[test]
fn the_sets_partition_the_list() {
    let size = |name| set(name).unwrap().len();
    assert_eq!(size("@all"), SOLVERS.len());
    assert_eq!(size("@fixed") + size("@adaptive"), SOLVERS.len());
    assert_eq!(size("@explicit") + size("@implicit"), SOLVERS.len());
    assert_eq!(size("@own") + size("@ode_solvers") + size("@diffsol"), SOLVERS.len());
    assert!(SETS.iter().all(|name| size(name) > 0));
    assert!(set("@unknown").is_none() && solver("unknown").is_none());
}

proptest! {
    #[test]
    fn equal_steps_land_on_the_end_and_are_not_longer_than_asked(
        start in -1e3..1e3_f64,
        length in 1e-3..1e3_f64,
        pieces in 1..2000_u32,
    ) {
        let dynamics = Scalar { f: |_, _, _| 1.0, slope: |_, _, _| 0.0 };
        let problem = InitialValueProblem {
            dynamics: &dynamics,
            start,
            end: start + length,
            y0: vec![0.0],
            breakpoints: Vec::new(),
        };
        let length = problem.end - problem.start;
        let step = Control::Step(length / f64::from(pieces));
        for name in ["explicit-euler", "ode_solvers-rk4"] {
            let solver = solver(name).unwrap();
            let run = solve(solver, &problem, &step, Corners::Restart, &Limits::default());
            prop_assert_eq!(&run.outcome, &Outcome::Solved);
            prop_assert_eq!(run.work.accepted, u64::from(pieces));
            prop_assert_eq!(run.trajectory.t.last(), Some(&problem.end));
        }
    }
}
