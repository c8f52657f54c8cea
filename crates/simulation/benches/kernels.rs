//! The exact methods: one update of each, and the problems P1 and P3 as they are delivered.

use criterion::{Criterion, criterion_group, criterion_main};
use duhem::{Input, MODELS, Parameter, Parameters, Plant};
use integrate::Limits;
use simulation::{Task, adaptive::ADAPTIVE, exact::EXACT};
use std::{f64::consts::PI, hint::black_box};

/// Three periods of Figure 1.
const SPAN: (f64, f64) = (0.0, 60.0 * PI);

fn task(model: &str, parameters: Parameters, input: Input, states: usize) -> Task {
    let model = MODELS.iter().find(|entry| entry.name == model).expect("a model of the list");
    Task { model, parameters, plant: None, input, y0: vec![0.0; states], span: SPAN }
}

fn sine(amplitude: f64) -> Input {
    Input::sine(amplitude, 0.1).expect("a sine")
}

/// P1.
fn dahl(gamma: f64) -> Task {
    let parameters = [("f_c", 0.75), ("sigma", 1.5), ("gamma", gamma)].into_iter().collect();
    task("dahl", parameters, sine(1.0), 1)
}

/// P3.
fn maxwell_slip() -> Task {
    let k = (0..10).map(|i| 1.0 + 0.8 * f64::from(i)).collect();
    let delta = (0..10).map(|i| 1.5e-3 + 0.9e-3 * f64::from(i)).collect();
    let parameters = [("k", Parameter::List(k)), ("delta", Parameter::List(delta))];
    task("maxwell-slip", parameters.into_iter().collect(), sine(0.01), 10)
}

/// LuGre of Figure 3 under a triangle.
fn lugre() -> Task {
    let values = [("f_c", 1.0), ("f_s", 1.5), ("v_s", 1e-3), ("sigma_0", 1e5), ("sigma_2", 0.4)];
    let parameters = values.into_iter().chain([("sigma_1", 1e5_f64.sqrt())]).collect();
    task("lugre", parameters, Input::triangle(1e-4, 0.1).expect("a triangle"), 1)
}

/// One Dahl element, γ = 0, on the mass and spring.
fn plant() -> Task {
    let plant = Some(Plant::mass_spring(1.0, 1.5));
    Task { plant, y0: vec![0.0; 3], input: Input::sine(2.0, 0.1).expect("a force"), ..dahl(0.0) }
}

fn bench(c: &mut Criterion, name: &str, method: &str, task: &Task, points: u32) {
    let own = EXACT.iter().chain(ADAPTIVE).find(|own| own.name == method);
    let own = own.expect("a method of the list");
    let solves = (own.build)(task).expect("a task it holds for");
    let at = |i: u32| task.span.1 * (f64::from(i) / f64::from(points));
    let grid: Vec<f64> = (1..=points).map(at).collect();
    let mut states = vec![0.0; grid.len() * task.y0.len()];
    c.bench_function(name, |b| {
        b.iter(|| solves.deliver(1e-6, &Limits::default(), black_box(&grid), &mut states));
    });
}

/// The end of the span alone: the updates at the events and one more.
fn ends(c: &mut Criterion) {
    for (method, task) in [
        ("exact-dahl", dahl(0.25)),
        ("exact-semilinear", dahl(1.0)),
        ("exact-maxwell-slip", maxwell_slip()),
        ("exact-lugre", lugre()),
        ("exact-slip-plant", plant()),
    ] {
        bench(c, &format!("to the end/{method}"), method, &task, 1);
    }
}

fn anchors(c: &mut Criterion) {
    for gamma in [0.0, 0.25, 1.0, 2.0] {
        bench(c, &format!("P1/gamma {gamma}"), "exact-dahl", &dahl(gamma), 600);
    }
    bench(c, "P1/gamma 1, semilinear", "exact-semilinear", &dahl(1.0), 600);
    bench(c, "P3", "exact-maxwell-slip", &maxwell_slip(), 600);
}

/// One run of each problem that only an adaptive method solves.
fn runs(c: &mut Criterion) {
    for (problem, method) in [
        ("P2", "lugre-linear"),
        ("P4", "dahl-series"),
        ("P5", "radau-located"),
        ("P6", "radau-located"),
    ] {
        let anchors = simulation::anchors::anchors().expect("the anchors");
        let anchor = anchors.iter().find(|anchor| anchor.problem == problem).expect("an anchor");
        let points = u32::try_from(anchor.grid.len()).expect("a few thousand") - 1;
        bench(c, &format!("{problem} at 1e-6"), method, &anchor.task, points);
    }
}

criterion_group!(kernels, ends, anchors, runs);
criterion_main!(kernels);
