//! A plant with Dahl friction by power series agrees with two independent methods.

use duhem::{Dahl, Input, MODELS, Parameters, Plant, Rig, closed_form::Reference};
use integrate::{Dynamics, Failure, Limits, Outcome};
use simulation::{
    DrivenPlant, NotHere, PLANT_REFERENCES, Path, Solves, Task,
    adaptive::ADAPTIVE,
    energy::{Contact, account},
};

fn the_method() -> &'static simulation::Own {
    ADAPTIVE.iter().find(|own| own.name == "dahl-series").expect("it is in the list")
}

fn task(keys: &[(&str, f64)], plant: Plant, input: Input, y0: [f64; 3], end: f64) -> Task {
    let model = MODELS.iter().find(|entry| entry.name == "dahl").expect("a model of the list");
    let parameters: Parameters = keys.iter().copied().collect();
    Task { model, parameters, plant: Some(plant), input, y0: y0.to_vec(), span: (0.0, end) }
}

/// The plant of Figure 13 up to this time [s].
fn figure_13(end: f64) -> Task {
    let keys = [("f_c", 0.75), ("sigma", 7.5), ("gamma", 1.0)];
    task(
        &keys,
        Plant::mass_spring(1.0, 1.5),
        Input::sine(5.0, 1e-3).expect("a sine"),
        [0.0; 3],
        end,
    )
}

fn series(task: &Task) -> Box<dyn Solves> {
    (the_method().build)(task).expect("it holds for a plant with Dahl friction")
}

fn times(end: f64, count: u32) -> Vec<f64> {
    (0..count).map(|i| end * f64::from(i) / f64::from(count)).chain([end]).collect()
}

fn delivered(task: &Task, rtol: f64, grid: &[f64]) -> Vec<f64> {
    let mut states = vec![0.0; 3 * grid.len()];
    let delivered = series(task).deliver(rtol, &Limits::default(), grid, &mut states);
    assert_eq!(delivered.outcome, Outcome::Solved, "{task:?}");
    states
}

/// The largest difference of q at these times [m], and the largest q.
fn apart(states: &[f64], other: &[f64]) -> (f64, f64) {
    let pairs = states.iter().step_by(3).zip(other.iter().step_by(3));
    pairs.fold((0.0, 0.0), |(apart, size): (f64, f64), (a, b)| {
        (apart.max((a - b).abs()), size.max(b.abs()))
    })
}

/// The answer at these times, and what its two ways are apart [m].
fn reference(task: &Task, grid: &[f64]) -> (Vec<f64>, f64) {
    let entry = PLANT_REFERENCES.iter().find(|entry| entry.name == "dahl").expect("an entry");
    let plant = task.plant.expect("a plant");
    let answer = (entry.build)(&task.parameters, &plant, &task.input, &task.y0, task.span);
    let answer = answer.expect("an answer");
    let mut states = vec![0.0; 3 * grid.len()];
    for (t, y) in grid.iter().zip(states.chunks_exact_mut(3)) {
        answer.state(*t, y);
    }
    (states, answer.error_bound())
}

#[test]
fn figure_13_is_that_of_radau_and_of_closed_forms_over_q() {
    let task = figure_13(6283.185);
    let grid = times(6283.185, 6283);
    let (exact, known) = reference(&task, &grid);
    assert!(known < 1e-7, "the references are {known:e} m apart");
    let (apart, _) = apart(&delivered(&task, 1e-12, &grid), &exact);
    assert!(apart < 2.0 * known, "{apart:e} m apart, the references {known:e} m");
}

#[test]
fn the_error_follows_the_tolerance_over_eleven_decades() {
    // Creep that touches v = 0 again and again, then sliding, the turn at the top, and creep back.
    let task = figure_13(2500.0);
    let grid = times(2500.0, 2500);
    let exact = delivered(&task, 1e-14, &grid);
    let mut before = f64::INFINITY;
    for k in 1..=12 {
        let rtol = 0.1_f64.powi(k);
        let (apart, size) = apart(&delivered(&task, rtol, &grid), &exact);
        assert!(apart <= rtol * size, "{apart:e} m of {size} m at {rtol:e}");
        assert!(apart <= before, "{apart:e} m at {rtol:e} after {before:e} m");
        before = 2.0 * apart;
    }
}

/// Numbers in [0, 1) that are the same everywhere.
fn draw(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 33) as f64 / f64::from(1_u32 << 31)
}

#[test]
fn plants_drawn_at_random_are_those_of_the_references() {
    let mut seed = 7;
    for case in 0..72 {
        let mut between = |low: f64, high: f64| low * (high / low).powf(draw(&mut seed));
        let gamma = [1.0, 2.0, 1.5, 3.0][case % 4];
        let (f_c, sigma) = (between(0.2, 2.0), between(1.0, 50.0));
        let keys = [("f_c", f_c), ("sigma", sigma), ("gamma", gamma)];
        let plant = Plant::mass_spring(between(0.2, 5.0), between(0.3, 5.0));
        let (force, omega) = (between(0.3, 6.0), between(0.05, 4.0));
        let input = match case % 3 {
            0 => Input::sine(force, omega),
            1 => Input::cosine_offset(force, omega),
            _ => Input::staircase(vec![force], 1.0, 1.0),
        };
        let moving = [0.4 * between(0.1, 1.0), -between(0.1, 2.0), 0.7 * f_c];
        let y0 = if case % 2 == 0 { [0.0; 3] } else { moving };
        let task = task(&keys, plant, input.unwrap(), y0, 60.0);
        let grid = times(60.0, 600);
        let (exact, known) = reference(&task, &grid);
        let size = task.motion().expect("a motion").scale()[0];
        for rtol in [1e-2, 1e-4, 1e-8, 1e-12] {
            let (apart, largest) = apart(&delivered(&task, rtol, &grid), &exact);
            let most = 2.0 * known + rtol * size.max(largest);
            assert!(apart <= most, "{apart:e} m at {rtol:e}, {known:e} m known: {task:?}");
        }
    }
}

#[test]
fn the_rig_of_figure_18_is_that_of_the_references() {
    let keys = [("f_c", 0.84), ("sigma", 7.5), ("gamma", 1.0)];
    let input = Input::sine(0.05, 0.2 * std::f64::consts::PI).unwrap();
    let task = task(&keys, Rig::PAPER.plant(), input, [0.0; 3], 50.0);
    let grid = times(50.0, 5000);
    let (exact, known) = reference(&task, &grid);
    let (apart, size) = apart(&delivered(&task, 1e-12, &grid), &exact);
    assert!(apart < 2.0 * known + 1e-10 * size, "{apart:e} rad, known to {known:e} rad");
}

#[test]
fn the_work_of_the_drive_goes_into_store_and_heat() {
    let task = figure_13(400.0);
    let (plant, dahl) = (task.plant.expect("a plant"), Dahl::new(&task.parameters).unwrap());
    let motion = DrivenPlant::new(Box::new(dahl.clone()), plant, task.input.clone(), task.span);
    let grid = times(400.0, 40_000);
    let states = delivered(&task, 1e-12, &grid);
    let mut path = Path::new(3);
    for (t, y) in grid.iter().zip(states.chunks_exact(3)) {
        let mut y_dot = [0.0; 3];
        motion.derivative(*t, y, None, &mut y_dot);
        path.push(*t, y, &y_dot);
    }
    let (energy, _) = account(&path, &Contact::Dahl(dahl), &plant, &task.input);
    let open = energy.residue() / energy.scale;
    assert!(open.abs() < 1e-9, "{open:e} of {} J are lost", energy.scale);
    assert!(energy.dissipated > 0.1, "{} J of heat", energy.dissipated);
}

#[test]
fn forces_that_balance_hold_the_mass_for_ever() {
    let keys = [("f_c", 1.0), ("sigma", 5.0), ("gamma", 2.0)];
    let constant = Input::staircase(vec![0.75], 1.0, 1.0).unwrap();
    // 0.75 N = 2 N/m · 0.125 m + 0.5 N.
    let task = task(&keys, Plant::mass_spring(1.0, 2.0), constant, [0.125, 0.0, 0.5], 10.0);
    for y in delivered(&task, 1e-6, &times(10.0, 20)).chunks_exact(3) {
        assert_eq!(y, [0.125, 0.0, 0.5]);
    }
}

#[test]
fn what_it_does_not_solve_is_refused_in_words() {
    let refused = |task: Task| match (the_method().build)(&task) {
        Ok(_) => panic!("{task:?} is none of its own"),
        Err(NotHere { found, .. }) => found,
    };
    let good = figure_13(1.0);
    assert_eq!(refused(Task { plant: None, ..good.clone() }), "an imposed motion");
    let flat: Parameters = [("f_c", 1.0), ("sigma", 1.0), ("gamma", 0.5)].into_iter().collect();
    assert_eq!(refused(Task { parameters: flat, ..good.clone() }), "γ = 0.5");
    let triangle = Input::triangle(1.0, 1.0).unwrap();
    assert_eq!(refused(Task { input: triangle, ..good.clone() }), "a drive that is no sine");
    let y0 = vec![0.0, 0.0, 0.8];
    assert_eq!(refused(Task { y0, ..good.clone() }), "the initial state [0.0, 0.0, 0.8]");
    assert_eq!(refused(Task { span: (1.0, 0.0), ..good.clone() }), "the span [1, 0] s");
    let lugre = MODELS.iter().find(|entry| entry.name == "lugre").expect("a model of the list");
    assert_eq!(refused(Task { model: lugre, ..good }), "the model lugre");
}

#[test]
fn a_spent_budget_is_reported_and_leaves_nothing_delivered_beyond() {
    let task = figure_13(600.0);
    let (grid, mut states) = (times(600.0, 600), vec![0.0; 1803]);
    let limits = Limits { evaluations: 3000 };
    let delivered = series(&task).deliver(1e-6, &limits, &grid, &mut states);
    let Outcome::Failed { at, why: Failure::TooManyEvaluations } = delivered.outcome else {
        panic!("{:?}", delivered.outcome)
    };
    assert!(at > 0.0 && at < 600.0, "stopped at {at} s");
    for (t, y) in grid.iter().zip(states.chunks_exact(3)) {
        assert!(y.iter().all(|y| y.is_nan() == (*t > at)), "{y:?} at {t} s");
    }
    for rtol in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let delivered = series(&task).deliver(rtol, &Limits::default(), &grid, &mut states);
        assert!(matches!(delivered.outcome, Outcome::Failed { .. }), "{rtol}");
    }
}
