//! LuGre under an imposed motion by its linear equation agrees with the exact quadrature.

use duhem::{
    Input, InputError, LuGre, MODELS, Parameters, Plant,
    closed_form::{Reference, lugre::Trajectory},
};
use integrate::{Failure, Limits, Outcome};
use simulation::{NotHere, Solves, Task, adaptive::ADAPTIVE};
use std::f64::consts::PI;

const FIGURE_4: [(&str, f64); 6] = [
    ("f_c", 1.0),
    ("f_s", 1.5),
    ("v_s", 1e-3),
    ("sigma_0", 1e5),
    ("sigma_1", 316.227_766),
    ("sigma_2", 0.4),
];

fn the_method() -> &'static simulation::Own {
    ADAPTIVE.iter().find(|own| own.name == "lugre-linear").expect("it is in the list")
}

fn task(keys: &[(&str, f64)], input: Input, x0: f64, span: (f64, f64)) -> Task {
    let model = MODELS.iter().find(|entry| entry.name == "lugre").expect("a model of the list");
    let parameters: Parameters = keys.iter().copied().collect();
    Task { model, parameters, plant: None, input, y0: vec![x0], span }
}

fn linear(task: &Task) -> Box<dyn Solves> {
    (the_method().build)(task).expect("it holds for LuGre under an imposed motion")
}

fn times((start, end): (f64, f64), count: u32) -> Vec<f64> {
    let at = |i: u32| start + (end - start) * f64::from(i) / f64::from(count);
    (0..count).map(at).chain([end]).collect()
}

/// The exact deflections [m] and what rounding leaves of them.
fn exact(task: &Task, grid: &[f64]) -> (Vec<f64>, f64) {
    let lugre = LuGre::new(&task.parameters).expect("its parameters");
    let exact = Trajectory::new(&lugre, &task.input, task.y0[0], task.span).expect("an answer");
    (grid.iter().map(|t| exact.deflection(*t)).collect(), exact.error_bound())
}

/// The largest error in units of the natural size of x, with the rounding of the exact answer taken off.
fn error(task: &Task, rtol: f64, grid: &[f64], (exact, rounding): &(Vec<f64>, f64)) -> f64 {
    let mut x = vec![0.0; grid.len()];
    let delivered = linear(task).deliver(rtol, &Limits::default(), grid, &mut x);
    assert_eq!(delivered.outcome, Outcome::Solved, "{:?}", task.input);
    let worst = exact.iter().zip(&x).map(|(exact, x)| (x - exact).abs()).fold(0.0, f64::max);
    let lugre = LuGre::new(&task.parameters).expect("its parameters");
    let size = lugre.f_s.max(lugre.f_c) / lugre.sigma_0;
    (worst - rounding).max(0.0) / size.max(task.y0[0].abs())
}

/// The inputs an experiment can name, slow and fast, small and large.
fn inputs() -> Result<Vec<(Input, f64)>, InputError> {
    let sine = Input::sine;
    let steps = vec![0.0, 2e-5, -3e-5, 4e-4, 4e-4, 0.0];
    let sequence = vec![(sine(1e-4, 1.0)?, PI), (sine(2e-5, 3.0)?, PI), (sine(3e-3, 40.0)?, 0.1)];
    let noise: Vec<f64> = (0..200).map(|i| 3e-5 * (f64::from(i * i) * 0.7).sin()).collect();
    let t: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.01).collect();
    Ok(vec![
        (sine(1e-4, 0.1)?, 60.0 * PI),
        (sine(1e-4, 10.0)?, 0.6 * PI),
        (sine(1e-7, 10.0)?, 2.0),
        (sine(0.1, 1.0)?, 7.0),
        (sine(1e-3, 300.0)?, 0.1),
        (Input::cosine_offset(0.01, 0.01)?, 900.0),
        (Input::cosine_offset(2e-5, 70.0)?, 0.3),
        (Input::triangle(1e-4, 3.0)?, 7.0),
        (Input::staircase(steps, 0.3, 0.2)?, 4.0),
        (Input::sampled(t, noise)?, 2.5),
        (Input::sequence(sequence)?, 5.0),
    ])
}

#[test]
fn the_error_stays_below_the_tolerance_under_every_input() {
    for (input, end) in inputs().expect("inputs") {
        for x0 in [0.0, -1.2e-5, 4e-5] {
            let task = task(&FIGURE_4, input.clone(), x0, (0.0, end));
            let grid = times(task.span, 300);
            let exact = exact(&task, &grid);
            for k in 2..=12 {
                let rtol = 0.1_f64.powi(k);
                let error = error(&task, rtol, &grid, &exact);
                assert!(error <= rtol, "{input:?}, x0 = {x0} m: {error:e} at {rtol:e}");
            }
        }
    }
}

/// Numbers in [0, 1) that are the same everywhere.
fn draw(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 33) as f64 / f64::from(1_u32 << 31)
}

#[test]
fn models_and_motions_drawn_at_random_are_those_of_the_quadrature() {
    let mut seed = 11;
    for case in 0..120 {
        let mut between = |low: f64, high: f64| low * (high / low).powf(draw(&mut seed));
        let keys = [
            ("f_c", between(0.1, 3.0)),
            ("f_s", between(0.1, 3.0)),
            ("v_s", between(1e-4, 1e-1)),
            ("sigma_0", between(1e2, 1e6)),
            ("sigma_1", 0.0),
            ("sigma_2", 0.0),
        ];
        // From a hundredth of r to a thousand of them, from far below v_S to far above.
        let r = keys[0].1.min(keys[1].1) / keys[3].1;
        let amplitude = r * between(1e-2, 1e3);
        let omega = keys[2].1 * between(1e-2, 1e3) / amplitude;
        let input = match case % 3 {
            0 => Input::sine(amplitude, omega),
            1 => Input::cosine_offset(amplitude, omega),
            _ => Input::triangle(amplitude, omega),
        };
        let (start, x0) = (between(0.1, 10.0) / omega, r * (2.0 * between(0.1, 1.0) - 1.0));
        let task = task(&keys, input.expect("an input"), x0, (start, start + 15.0 / omega));
        let grid = times(task.span, 200);
        let exact = exact(&task, &grid);
        for rtol in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
            let error = error(&task, rtol, &grid, &exact);
            assert!(error <= rtol, "{error:e} at {rtol:e}: {task:?}");
        }
    }
}

#[test]
fn however_fast_the_motion_the_panels_stay_few() {
    // 1 m at up to 1000 m/s over bristles of 1e-5 m: |u̇|/r is 1e8/s.
    let task = task(&FIGURE_4, Input::sine(1.0, 1e3).expect("a sine"), 0.0, (0.0, 0.02));
    let (grid, mut x) = (times(task.span, 100), vec![0.0; 101]);
    let delivered = linear(&task).deliver(1e-8, &Limits::default(), &grid, &mut x);
    assert_eq!(delivered.outcome, Outcome::Solved);
    let panels = delivered.work.accepted;
    assert!(panels < 600, "{panels} panels for seven arcs");
    // Far from the turns it slides at r = F_C/σ₀ but for what is left to approach.
    for (t, x) in grid.iter().zip(&x).filter(|(t, _)| (1e3 * *t).cos().abs() > 0.3) {
        let slides = 1e-5 * (1e3 * t).cos().signum();
        assert!(*t == 0.0 || (x - slides).abs() < 1e-13, "{x} m at {t} s");
    }
}

#[test]
fn what_it_does_not_solve_is_refused_in_words() {
    let input = || Input::sine(1e-4, 1.0).unwrap();
    let refused = |task: Task| match (the_method().build)(&task) {
        Ok(_) => panic!("{task:?} is none of its own"),
        Err(NotHere { found, .. }) => found,
    };
    let good = task(&FIGURE_4, input(), 0.0, (0.0, 1.0));
    let plant = Some(Plant::mass_spring(1.0, 1.0));
    assert_eq!(refused(Task { plant, ..good.clone() }), "a plant");
    let dahl = MODELS.iter().find(|entry| entry.name == "dahl").expect("a model of the list");
    assert_eq!(refused(Task { model: dahl, ..good.clone() }), "the model dahl");
    assert_eq!(refused(Task { y0: vec![], ..good.clone() }), "the initial state []");
    assert_eq!(refused(Task { span: (1.0, 1.0), ..good }), "the span [1, 1] s");
    let words = refused(task(&FIGURE_4[1..], input(), 0.0, (0.0, 1.0)));
    assert!(words.starts_with("f_c is missing"), "{words}");
}

#[test]
fn a_spent_budget_is_reported_and_leaves_nothing_delivered_beyond() {
    let task = task(&FIGURE_4, Input::sine(1e-4, 1.0).unwrap(), 0.0, (0.0, 6.0 * PI));
    let (grid, mut x) = (times(task.span, 600), vec![0.0; 601]);
    let limits = Limits { evaluations: 100 };
    let delivered = linear(&task).deliver(1e-9, &limits, &grid, &mut x);
    let Outcome::Failed { at, why: Failure::TooManyEvaluations } = delivered.outcome else {
        panic!("{:?}", delivered.outcome)
    };
    assert!(at > 0.0 && at < 6.0 * PI, "stopped at {at} s");
    for (t, x) in grid.iter().zip(&x) {
        assert_eq!(x.is_nan(), *t > at, "{x} m at {t} s");
    }
    for rtol in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let delivered = linear(&task).deliver(rtol, &Limits::default(), &grid, &mut x);
        assert!(matches!(delivered.outcome, Outcome::Failed { .. }) && x[0].is_nan(), "{rtol}");
    }
}
