//! A model under an input is the model and the input, no more.

use duhem::{Dahl, FrictionModel, Input};
use integrate::{Control, Corners, Dynamics, Limits, Outcome, solve, solver};
use simulation::{Motion, PrescribedMotion};

fn dahl() -> Dahl {
    Dahl { f_c: 0.75, sigma: 1.5, gamma: 1.0 }
}

fn motion(input: &Input, end: f64) -> PrescribedMotion {
    PrescribedMotion::new(Box::new(dahl()), input.clone(), (0.0, end))
}

fn derivative(motion: &PrescribedMotion, t: f64, force: f64, piece: Option<usize>) -> f64 {
    let mut f_dot = [f64::NAN];
    motion.derivative(t, &[force], piece, &mut f_dot);
    f_dot[0]
}

#[test]
fn the_right_hand_side_is_the_models_at_the_inputs_speed() {
    let input = Input::sine(1.0, 0.1).unwrap();
    let motion = motion(&input, 100.0);
    for (t, force) in [(0.0, 0.0), (3.0, 0.4), (30.0, -0.2), (50.0, 0.7)] {
        let mut expected = [0.0];
        dahl().x_dot(&[force], input.u(t), input.u_dot(t), &mut expected);
        assert_eq!(derivative(&motion, t, force, None), expected[0], "at {t} s");
        assert_eq!(motion.force(t, &[force]), force, "Dahl's state is its force");
    }
}

#[test]
fn each_piece_has_its_own_speed_at_a_corner_of_a_triangle() {
    // Amplitude 1 m, period 4 s: ±1 m/s, with corners at 1 s and 3 s. From F = 0 the rate is ±σ.
    let input = Input::triangle(1.0, std::f64::consts::FRAC_PI_2).unwrap();
    let motion = motion(&input, 4.0);
    assert_eq!(motion.corners().len(), 2);
    let corner = motion.corners()[0];
    assert!((derivative(&motion, corner, 0.0, Some(0)) - 1.5).abs() < 1e-12, "from the left");
    assert!((derivative(&motion, corner, 0.0, Some(1)) + 1.5).abs() < 1e-12, "from the right");
    assert!((derivative(&motion, corner, 0.0, None) + 1.5).abs() < 1e-12, "untold: from the right");
}

#[test]
fn the_jacobian_is_the_slope_of_the_right_hand_side() {
    let input = Input::sine(1.0, 0.1).unwrap();
    let motion = motion(&input, 100.0);
    for (t, force) in [(1.0, 0.1), (20.0, -0.5), (50.0, 0.3)] {
        let mut slope = [f64::NAN];
        motion.jacobian(t, &[force], None, &mut slope);
        let h = 1e-4;
        let rate = |f| derivative(&motion, t, f, None);
        let difference = (rate(force + h) - rate(force - h)) / (2.0 * h);
        assert!((slope[0] - difference).abs() < 1e-9, "at {t} s: {} and {difference}", slope[0]);
    }
}

#[test]
fn the_problem_restarts_where_the_input_turns() {
    let input = Input::sine(1.0, 0.1).unwrap();
    let motion = motion(&input, 100.0);
    let problem = motion.problem(vec![0.25]);
    assert_eq!((problem.start, problem.end, problem.y0.as_slice()), (0.0, 100.0, &[0.25][..]));
    assert_eq!(problem.breakpoints, motion.corners());
    let rk4 = solver("rk4").unwrap();
    let run = solve(rk4, &problem, &Control::Step(0.5), Corners::Restart, &Limits::default());
    assert_eq!(run.outcome, Outcome::Solved);
    for corner in motion.corners() {
        assert!(run.trajectory.t.contains(corner), "no step ends at the corner {corner} s");
    }
}
