//! Plants with LuGre, and with Dahl, by our stiff method: against the independent Radau IIA, against the
//! Dahl series, and with no slip missed at any tolerance.

use duhem::{Harmonic, Input, MODELS, Parameters, Plant};
use integrate::{Failure, Limits, Outcome};
use simulation::{
    Delivered, DrivenPlant, Ensemble, NotHere, Own, Task, adaptive::ADAPTIVE, anchors::anchors,
    best, plant_reference::solve_located,
};

fn method(name: &str) -> &'static Own {
    ADAPTIVE.iter().find(|own| own.name == name).expect("it is in the list")
}

fn task(model: &str, keys: &[(&str, f64)], plant: Plant, (input, end): (Input, f64)) -> Task {
    let model = MODELS.iter().find(|entry| entry.name == model).expect("a model of the list");
    let parameters: Parameters = keys.iter().copied().collect();
    Task { model, parameters, plant: Some(plant), input, y0: vec![0.0; 3], span: (0.0, end) }
}

fn deliver(name: &str, task: &Task, rtol: f64, grid: &[f64]) -> (Vec<f64>, Delivered) {
    let mut states = vec![0.0; 3 * grid.len()];
    let ready = (method(name).build)(task).expect("it holds");
    let delivered = ready.deliver(rtol, &Limits::default(), grid, &mut states);
    (states, delivered)
}

fn times(end: f64, count: u32) -> Vec<f64> {
    (0..=count).map(|i| end * f64::from(i) / f64::from(count)).collect()
}

/// The largest difference of q from the located Radau IIA at 1e-11, by the largest q.
fn off(task: &Task, grid: &[f64], states: &[f64]) -> f64 {
    let friction = task.friction().expect("a model");
    let plant = task.plant.expect("a plant");
    let motion = DrivenPlant::new(friction, plant, task.input.clone(), task.span);
    let located = solve_located(&motion, &task.y0, 1e-11);
    assert_eq!(located.outcome, Outcome::Solved);
    let right: Vec<f64> = grid.iter().map(|t| located.path.q(*t)).collect();
    let apart = states.iter().step_by(3).zip(&right).map(|(q, r)| (q - r).abs());
    apart.fold(0.0, f64::max) / right.iter().fold(0.0, |m: f64, q| m.max(q.abs()))
}

fn anchor(problem: &str) -> (Task, Vec<f64>) {
    let anchors = anchors().expect("the anchors");
    let found = anchors.into_iter().find(|anchor| anchor.problem == problem).expect("in the list");
    (found.task, found.grid)
}

#[test]
fn the_rig_is_delivered_about_as_closely_as_asked() {
    let (task, grid) = anchor("P6");
    for rtol in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8] {
        let (states, delivered) = deliver("radau-located", &task, rtol, &grid);
        assert_eq!(delivered.outcome, Outcome::Solved, "{rtol:e}");
        let error = off(&task, &grid, &states);
        assert!(error < 3.0 * rtol, "asked for {rtol:e}, off by {error:e}");
    }
}

/// Where q stands still for long: how many steps the staircase has, up and down.
fn steps(states: &[f64]) -> usize {
    let q: Vec<f64> = states.iter().step_by(3).copied().collect();
    let moves = |w: &[f64]| (w[1] - w[0]).abs() > 0.02;
    let moving: Vec<bool> = q.windows(2).map(moves).collect();
    moving.windows(2).filter(|w| !w[0] && w[1]).count()
}

#[test]
fn no_slip_of_the_staircase_is_missed_at_any_tolerance() {
    let (task, grid) = anchor("P5");
    let (states, _) = deliver("radau-located", &task, 1e-9, &grid);
    let right = steps(&states);
    assert!(right > 40, "{right} steps");
    for rtol in [1e-1, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7] {
        let (states, delivered) = deliver("radau-located", &task, rtol, &grid);
        assert_eq!(delivered.outcome, Outcome::Solved, "{rtol:e}");
        assert_eq!(steps(&states), right, "at {rtol:e}");
    }
}

#[test]
fn the_staircase_is_that_of_the_independent_method() {
    let (task, _) = anchor("P5");
    let task = Task { span: (0.0, 1500.0), ..task };
    let grid = times(1500.0, 1500);
    for (rtol, most) in [(1e-4, 3e-3), (1e-6, 1e-4), (1e-8, 3e-6), (1e-10, 1e-7)] {
        let (states, delivered) = deliver("radau-located", &task, rtol, &grid);
        assert_eq!(delivered.outcome, Outcome::Solved, "{rtol:e}");
        let error = off(&task, &grid, &states);
        assert!(error < most, "asked for {rtol:e}, off by {error:e}");
    }
}

#[test]
fn a_plant_with_dahl_is_that_of_its_power_series() {
    for gamma in [1.0, 1.5, 2.0] {
        let keys = [("f_c", 0.75), ("sigma", 7.5), ("gamma", gamma)];
        let drive = (Input::sine(2.0, 0.7).expect("a sine"), 60.0);
        let task = task("dahl", &keys, Plant::mass_spring(1.0, 1.5), drive);
        let grid = times(60.0, 600);
        let (series, _) = deliver("dahl-series", &task, 1e-12, &grid);
        let (states, delivered) = deliver("radau-located", &task, 1e-9, &grid);
        assert_eq!(delivered.outcome, Outcome::Solved);
        let largest = series.iter().step_by(3).fold(0.0_f64, |m, q| m.max(q.abs()));
        let apart = series.iter().zip(&states).step_by(3).map(|(a, b)| (a - b).abs());
        let worst = apart.fold(0.0, f64::max) / largest;
        assert!(worst < 1e-7, "γ = {gamma}: {worst:e} apart");
    }
}

#[test]
fn a_drive_with_corners_is_restarted_at_them() {
    let keys = [
        ("f_c", 0.6),
        ("f_s", 1.0),
        ("v_s", 0.001),
        ("sigma_0", 1e3),
        ("sigma_1", 31.6),
        ("sigma_2", 1.3),
    ];
    let drive = Input::triangle(1.2, 0.2 * std::f64::consts::PI).expect("a triangle");
    assert_eq!(drive.harmonic(), None::<Harmonic>);
    let task = task("lugre", &keys, Plant::mass_spring(3e-4, 0.01), (drive, 20.0));
    let grid = times(20.0, 400);
    let (states, delivered) = deliver("radau-located", &task, 1e-8, &grid);
    assert_eq!(delivered.outcome, Outcome::Solved);
    let error = off(&task, &grid, &states);
    assert!(error < 1e-6, "off by {error:e}");
}

#[test]
fn a_step_that_misses_a_corner_by_less_than_the_clock_resolves_arrives_there() {
    let (staircase, _) = anchor("P5");
    let omega = 0.001;
    let period = 2.0 * std::f64::consts::PI / omega;
    let t: Vec<f64> = (0..=200).map(|i| period * f64::from(i) / 100.0).collect();
    let span = (0.0, 2.0 * period);
    let grid = times(2.0 * period, 100);
    for i in 0..25 {
        let amplitude = 5.0 + 0.2 * f64::from(i);
        let u = t.iter().map(|t| amplitude * (omega * t).sin()).collect();
        let input = Input::sampled(t.clone(), u).expect("a record");
        let task = Task { input, span, ..staircase.clone() };
        let (_, delivered) = deliver("radau-located", &task, 1e-6, &grid);
        assert_eq!(delivered.outcome, Outcome::Solved, "{amplitude} N");
    }
}

#[test]
fn what_it_does_not_hold_for_it_refuses_in_words() {
    let refused = |task: &Task| match (method("radau-located").build)(task) {
        Ok(_) => panic!("it took {task:?}"),
        Err(NotHere { found, .. }) => found,
    };
    let (rig, _) = anchor("P6");
    assert_eq!(refused(&Task { plant: None, ..rig.clone() }), "an imposed motion");
    assert_eq!(refused(&Task { y0: vec![0.0; 2], ..rig }), "2 initial values");
    let keys = [("f_c", 0.75), ("sigma", 7.5), ("gamma", 0.5)];
    let drive = (Input::sine(2.0, 0.7).expect("a sine"), 60.0);
    let dahl = task("dahl", &keys, Plant::mass_spring(1.0, 1.5), drive.clone());
    assert_eq!(refused(&dahl), "Dahl with γ = 0.5");
    let coulomb = task("coulomb", &[("f_c", 1.0)], Plant::mass_spring(1.0, 1.5), drive);
    assert_eq!(refused(&coulomb), "a plant with coulomb");
}

#[test]
fn a_spent_budget_is_told_and_what_was_not_reached_is_no_number() {
    let (task, grid) = anchor("P6");
    let mut states = vec![0.0; 3 * grid.len()];
    let ready = (method("radau-located").build)(&task).expect("it holds");
    let delivered = ready.deliver(1e-6, &Limits { evaluations: 5000 }, &grid, &mut states);
    let Outcome::Failed { at, why } = delivered.outcome else { panic!("solved") };
    assert_eq!(why, Failure::TooManyEvaluations);
    for (t, state) in grid.iter().zip(states.chunks(3)) {
        assert_eq!(state.iter().all(|y| y.is_nan()), *t > at, "at {t} s of {at} s");
    }
}

/// The rig with all parameters off by up to 30 %, the n-th such.
fn rig(n: u32) -> Task {
    // Fractions of multiples of irrational numbers: spread evenly, and the same everywhere.
    let off = |k: f64| 0.7 + 0.6 * (f64::from(n) * k.sqrt()).fract();
    let keys = [
        ("f_c", 0.6 * off(2.0)),
        ("f_s", 1.0 * off(3.0)),
        ("v_s", 0.001 * off(5.0)),
        ("sigma_0", 1e3 * off(7.0)),
        ("sigma_1", 31.6 * off(11.0)),
        ("sigma_2", 1.3 * off(13.0)),
    ];
    let (task, _) = anchor("P6");
    Task { parameters: keys.into_iter().collect(), ..task }
}

#[test]
fn an_ensemble_tells_of_every_run_and_does_not_depend_on_the_threads() {
    let mut tasks: Vec<Task> = (1..=24).map(rig).filter(|t| t.friction().is_ok()).collect();
    let good = tasks.len();
    let imposed = Task { plant: None, y0: vec![0.0; 2], ..rig(1) };
    tasks.push(imposed);
    let (_, grid) = anchor("P6");
    let run = |threads| {
        let asked = Ensemble { rtol: 1e-6, limits: Limits::default(), grid: &grid, threads };
        asked.run(&tasks, |_, states| states.to_vec()).expect("threads")
    };
    let (one, two) = (run(1), run(2));
    assert_eq!(one.len(), tasks.len());
    for (i, (one, two)) in one.iter().zip(&two).enumerate().take(good) {
        let ((delivered, states), (_, other)) =
            (one.as_ref().expect("it holds"), two.as_ref().expect("it holds"));
        assert_eq!(delivered.outcome, Outcome::Solved, "run {i}");
        assert_eq!(states, other, "run {i} depends on the threads");
        if i % 8 == 0 {
            let error = off(&tasks[i], &grid, states);
            assert!(error < 1e-4, "run {i}: off by {error:e}");
        }
    }
    assert!(one[good].is_err(), "a task of no method is told");
    assert!(best(&tasks[0]).is_ok_and(|(own, _)| own.name == "radau-located"));
}
