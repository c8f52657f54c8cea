//! The exact methods: against the closed forms, against solvers that know nothing of friction, and what
//! they refuse.

use duhem::{Input, MODELS, Parameter, Parameters, Plant, closed_form::REFERENCES};
use integrate::{Control, Corners, Failure, Limits, Outcome, solve, solver};
use simulation::{
    Delivered, Own, Task,
    displacement::{ByDisplacement, RateIndependent, Steps},
    exact::EXACT,
};
use std::f64::consts::{PI, TAU};

fn method(name: &str) -> &'static Own {
    EXACT.iter().find(|own| own.name == name).expect("a name of the list")
}

fn task(model: &str, parameters: Parameters, input: Input, y0: &[f64]) -> Task {
    let model = MODELS.iter().find(|entry| entry.name == model).expect("a model of the list");
    Task { model, parameters, plant: None, input, y0: y0.to_vec(), span: (0.0, 110.0) }
}

fn dahl(gamma: f64) -> Parameters {
    [("f_c", 0.75), ("sigma", 1.5), ("gamma", gamma)].into_iter().collect()
}

fn lugre() -> Parameters {
    let values = [("f_c", 1.0), ("f_s", 1.5), ("v_s", 0.05), ("sigma_0", 3.0), ("sigma_1", 1.0)];
    values.into_iter().chain([("sigma_2", 0.4)]).collect()
}

/// Ten elements, two of them alike.
fn ten() -> Parameters {
    let k = (0..10).map(|i| 1.0 + 0.8 * f64::from(i)).collect();
    let delta = (0..10).map(|i| 0.15 + 0.09 * f64::from(i - i / 9)).collect();
    [("k", Parameter::List(k)), ("delta", Parameter::List(delta))].into_iter().collect()
}

fn sine() -> Input {
    Input::sine(1.0, 0.1).expect("the input of Figure 1")
}

fn straight() -> [Input; 4] {
    let samples = || (vec![0.0, 20.0, 33.0, 60.0, 100.0], vec![0.0, 0.9, -0.4, 1.3, 0.0]);
    [
        Input::triangle(1.0, 0.1),
        Input::staircase(vec![0.0, 0.5, -0.2, 0.9], 10.0, 15.0),
        Input::sampled(samples().0, samples().1),
        Input::polyline(samples().0, samples().1),
    ]
    .map(|input| input.expect("an input"))
}

/// A sine in a quick one, then straight on: corners of all kinds.
fn mixed() -> Input {
    let quick = Input::sine(0.3, 0.8).expect("a sine");
    let samples = Input::sampled(vec![0.0, 15.0], vec![0.0, 0.8]).expect("samples");
    Input::sequence(vec![(quick, PI / 0.8 * 6.0), (samples, 100.0)]).expect("a sequence")
}

/// Tasks under an imposed motion, with the method that solves each exactly.
fn imposed() -> Vec<(&'static Own, Task)> {
    let mut cases = Vec::new();
    let curved = [sine(), Input::cosine_offset(0.8, 0.1).expect("a cosine"), mixed()];
    for input in curved.iter().chain(&straight()) {
        // Also from beyond ±F_C, on either side.
        for (gamma, f0) in
            [(0.0, 0.1), (0.25, 0.0), (0.9, -1.1), (1.0, 1.2), (1.5, 0.75), (2.0, -0.3)]
        {
            cases.push(("exact-dahl", task("dahl", dahl(gamma), input.clone(), &[f0])));
        }
        cases.push(("exact-semilinear", task("dahl", dahl(1.0), input.clone(), &[-0.2])));
        let mut x0 = [0.0; 10];
        (x0[0], x0[7]) = (-0.1, 0.2);
        cases.push(("exact-maxwell-slip", task("maxwell-slip", ten(), input.clone(), &x0)));
    }
    for input in straight() {
        cases.push(("exact-lugre", task("lugre", lugre(), input, &[0.05])));
    }
    cases.into_iter().map(|(name, task)| (method(name), task)).collect()
}

/// The mass and spring, with Maxwell-slip and with Dahl, γ = 0.
fn plants() -> Vec<(&'static Own, Task)> {
    let plant = Some(Plant::mass_spring(1.0, 1.5));
    let input = Input::sine(2.0, 0.9).expect("a force");
    let elements = [("k", vec![2.0, 3.0, 1.0]), ("delta", vec![0.1, 0.25, 0.1])];
    let slip = task("maxwell-slip", elements.into_iter().collect(), input.clone(), &[0.0; 5]);
    let block = task("dahl", dahl(0.0), input, &[0.4, -0.1, 0.3]);
    let plant = |task| (method("exact-slip-plant"), Task { plant, span: (0.0, 40.0), ..task });
    vec![plant(slip), plant(block)]
}

/// Start, end, corners, and times between them that lie in no pattern.
fn grid(task: &Task) -> Vec<f64> {
    let (start, end) = task.span;
    let mut grid = task.input.corners(start, end);
    grid.extend((1..200).map(|i| start + (end - start) * (0.618_034 * f64::from(i)).fract()));
    grid.extend([start, end]);
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

fn deliver(own: &Own, task: &Task, grid: &[f64]) -> (Delivered, Vec<f64>) {
    let mut states = vec![f64::NAN; grid.len() * task.y0.len()];
    let solves = (own.build)(task).expect("a task it holds for");
    (solves.deliver(1e-6, &Limits::default(), grid, &mut states), states)
}

fn apart(one: &[f64], other: &[f64]) -> f64 {
    one.iter()
        .zip(other)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, |most, d| if d <= most { most } else { d })
}

#[test]
fn every_exact_method_delivers_the_closed_form_at_every_time() {
    for (own, task) in imposed() {
        let (grid, n) = (grid(&task), task.y0.len());
        let (delivered, states) = deliver(own, &task, &grid);
        assert_eq!(delivered.outcome, Outcome::Solved);
        let entry = REFERENCES.iter().find(|entry| entry.name == task.model.name).unwrap();
        let reference = (entry.build)(&task.parameters, &task.input, &task.y0, task.span).unwrap();
        let (mut exact, bound) = (vec![0.0; n], reference.error_bound());
        for (t, y) in grid.iter().zip(states.chunks_exact(n)) {
            reference.state(*t, &mut exact);
            let off = apart(y, &exact);
            assert!(
                off <= bound,
                "{}, {task:?}: off by {off:e}, {bound:e} allowed, at {t} s",
                own.name
            );
        }
    }
}

#[test]
fn the_exact_plant_is_that_of_the_second_way() {
    for (own, task) in plants() {
        let friction = match task.model.name {
            "dahl" => RateIndependent::Dahl(duhem::Dahl::new(&task.parameters).unwrap()),
            _ => RateIndependent::MaxwellSlip(duhem::MaxwellSlip::new(&task.parameters).unwrap()),
        };
        let way =
            ByDisplacement { friction, plant: task.plant.unwrap(), input: task.input.clone() };
        // Every step is a node: between two of them the path is a cubic.
        let steps = Steps { every: 1, ..way.steps() };
        let path = way.solve(&task.y0, task.span, steps).unwrap();
        let (grid, n) = (grid(&task), task.y0.len());
        let (_, states) = deliver(own, &task, &grid);
        let mut second = vec![0.0; n];
        for (t, y) in grid.iter().zip(states.chunks_exact(n)) {
            path.state(*t, &mut second);
            let off = apart(y, &second);
            assert!(off < 1e-7, "{}: off by {off:e} at {t} s", task.model.name);
        }
    }
}

#[test]
fn a_solver_that_knows_nothing_of_friction_converges_to_every_exact_method() {
    let rk4 = solver("rk4").unwrap();
    for (own, task) in imposed().into_iter().chain(plants()) {
        let motion = task.motion().unwrap();
        let scale = motion.scale();
        let off = |h: f64| {
            let problem = motion.problem(task.y0.clone());
            let run = solve(rk4, &problem, &Control::Step(h), Corners::Restart, &Limits::default());
            assert_eq!(run.outcome, Outcome::Solved, "{task:?}");
            let (_, exact) = deliver(own, &task, &run.trajectory.t);
            let errors = exact.iter().zip(&run.trajectory.y).map(|(a, b)| (a - b).abs());
            errors.zip(scale.iter().cycle()).map(|(off, scale)| off / scale).fold(0.0, f64::max)
        };
        // A hundred times finer: at a kink RK4 is of first order, and where in the step it falls is chance.
        let length = task.span.1 - task.span.0;
        let (coarse, fine) = (off(length / 4e3), off(length / 4e5));
        let near = fine < 1e-13_f64.max(coarse / 20.0);
        assert!(near, "{}, {task:?}: off by {coarse:e}, then {fine:e} of the scale", own.name);
    }
}

#[test]
fn what_is_delivered_at_a_time_does_not_depend_on_the_other_times() {
    for (own, task) in imposed().into_iter().chain(plants()) {
        let (grid, n) = (grid(&task), task.y0.len());
        let (_, states) = deliver(own, &task, &grid);
        for (t, y) in grid.iter().zip(states.chunks_exact(n)) {
            assert_eq!(deliver(own, &task, &[*t]).1, y, "{} alone at {t} s", own.name);
        }
        assert_eq!(apart(&states[..n], &task.y0), 0.0, "{} starts where it is told to", own.name);
        assert_eq!(deliver(own, &task, &[]).0.outcome, Outcome::Solved, "{}: no time", own.name);
    }
}

#[test]
fn the_exponential_of_a_matrix_and_the_law_of_dahl_agree() {
    for input in [sine(), mixed()] {
        let task = task("dahl", dahl(1.0), input, &[0.4]);
        let grid = grid(&task);
        let (_, law) = deliver(method("exact-dahl"), &task, &grid);
        let (_, exponential) = deliver(method("exact-semilinear"), &task, &grid);
        let off = apart(&law, &exponential) / 0.75;
        assert!(off < 1e-14, "off by {off:e} of F_C");
    }
}

#[test]
fn the_work_is_one_update_for_each_time_and_each_event() {
    for (own, task) in imposed() {
        let (grid, corners) = (grid(&task), task.input.corners(task.span.0, task.span.1));
        let updates = (grid.len() + corners.len()) as u64;
        let (delivered, _) = deliver(own, &task, &grid);
        match own.name {
            "exact-semilinear" => assert!(delivered.work.evaluations > updates),
            name => assert_eq!(delivered.work.evaluations, updates, "{name}"),
        }
    }
}

#[test]
fn more_updates_than_the_limit_are_refused_and_nothing_is_delivered() {
    for (own, task) in imposed().into_iter().chain(plants()) {
        let grid = grid(&task);
        let mut states = vec![0.0; grid.len() * task.y0.len()];
        let limits = Limits { evaluations: grid.len() as u64 - 1 };
        let delivered = (own.build)(&task).unwrap().deliver(1e-6, &limits, &grid, &mut states);
        let outcome = Outcome::Failed { at: task.span.0, why: Failure::TooManyEvaluations };
        assert_eq!(delivered.outcome, outcome, "{}", own.name);
        assert!(states.iter().all(|y| y.is_nan()), "{}", own.name);
    }
}

#[test]
fn a_task_where_a_method_does_not_hold_is_refused_in_words() {
    let words = |name: &str, task: &Task| match (method(name).build)(task) {
        Ok(_) => "built".to_owned(),
        Err(error) => error.to_string(),
    };
    let (own, good) = imposed().swap_remove(0);
    let on_plant = Task { plant: Some(Plant::mass_spring(1.0, 1.5)), ..good.clone() };
    assert!(words(own.name, &on_plant).contains("exact-dahl does not hold here: a plant"));
    let short = Task { y0: vec![], ..good.clone() };
    assert!(words(own.name, &short).contains("y0 = [] for 1 states"));
    let wild = Task { y0: vec![f64::NAN], ..good.clone() };
    assert!(words(own.name, &wild).contains("NaN"));
    let nowhere = Task { span: (1.0, 1.0), ..good.clone() };
    assert!(words(own.name, &nowhere).contains("span = [1, 1] s"));
    let unknown = Task { parameters: lugre(), ..good.clone() };
    assert!(words(own.name, &unknown).contains("unknown key"));
    assert!(words("exact-semilinear", &good).contains("dahl with γ = 0"));
    let smooth = task("lugre", lugre(), sine(), &[0.0]);
    assert!(words("exact-lugre", &smooth).contains("speed changes between its corners"));
    assert!(words("exact-slip-plant", &good).contains("no plant"));
    let rounded = Task { parameters: dahl(0.5), ..on_plant.clone() };
    assert!(words("exact-slip-plant", &rounded).contains("dahl with γ = 0.5"));
    let beyond = Task { y0: vec![0.0, 0.0, 0.76], ..on_plant.clone() };
    assert!(words("exact-slip-plant", &beyond).contains("beyond F_C = 0.75 N"));
    let triangle = Input::triangle(1.0, 1.0).unwrap();
    let kinked = Task { input: triangle, y0: vec![0.0; 3], ..on_plant.clone() };
    assert!(words("exact-slip-plant", &kinked).contains("expected a sine"));
    for own in EXACT {
        let coulomb = [("f_c", 0.75)].into_iter().collect();
        let refused = words(own.name, &task("coulomb", coulomb, sine(), &[]));
        assert!(refused.contains("the model coulomb") && refused.contains(own.holds), "{refused}");
        assert!(imposed().iter().chain(&plants()).any(|case| case.0.name == own.name));
    }
}

#[test]
fn a_sine_without_end_is_delivered_late_too() {
    // The phase is 1e7 rad, beyond what the sine of many phases reduces itself.
    let span = (1e8, 1e8 + TAU / 0.1);
    let task = Task { span, ..task("dahl", dahl(1.0), sine(), &[0.1]) };
    let (delivered, states) = deliver(method("exact-dahl"), &task, &grid(&task));
    assert_eq!(delivered.outcome, Outcome::Solved);
    assert!(states.iter().all(|force| force.abs() <= 0.75), "within F_C");
}
