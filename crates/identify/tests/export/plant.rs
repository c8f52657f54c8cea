//! The plant's step is of first order: beside our own simulation the error halves with the step.

use super::{friction, rig, run};
use duhem::{Dahl, FrictionModel, Input, LuGre, MODELS, MaxwellSlip, Parameter, Parameters, Plant};
use identify::Rig;
use integrate::{Limits, Outcome};
use simulation::{
    Task,
    adaptive::ADAPTIVE,
    displacement::{ByDisplacement, RateIndependent},
    exact::EXACT,
};
use std::f64::consts::PI;

/// Times of comparison in the span [s].
const POINTS: u32 = 40;

/// The largest difference of q from `right`, which holds it at [`POINTS`] times up to `end` [s], by the
/// largest q; with `n` steps from one to the next, the input that of each step's end.
fn off(rig: &Rig, input: &dyn Fn(f64) -> f64, (end, right): (f64, &[f64]), n: u32) -> f64 {
    let dt = end / f64::from(POINTS * n);
    let steps: Vec<_> = (1..=POINTS * n).map(|i| (input(dt * f64::from(i)), dt)).collect();
    let rows = run(rig, include_str!("plant.c"), &steps);
    let last = rows.iter().skip(n as usize - 1).step_by(n as usize).map(|row| row[0]);
    let largest = right.iter().fold(0.0, |m: f64, q| m.max(q.abs()));
    assert!(largest > 0.0, "it does not move");
    last.zip(right).map(|(q, right)| (q - right).abs()).fold(0.0, f64::max) / largest
}

/// Asserts first order from `n` steps between two points on, and that it comes near.
fn assert_first_order(
    rig: &Rig,
    input: &dyn Fn(f64) -> f64,
    right: (f64, &[f64]),
    (n, near): (u32, f64),
) {
    let errors = [n, 2 * n, 4 * n].map(|n| off(rig, input, right, n));
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((1.75..2.3).contains(&ratio), "{}: ratio {ratio} of {errors:?}", rig.title);
    }
    assert!(errors[2] < near, "{}: off by {errors:?} of the largest q", rig.title);
}

fn points(end: f64) -> Vec<f64> {
    (1..=POINTS).map(|i| end * f64::from(i) / f64::from(POINTS)).collect()
}

/// q at the points by a method of the lists of `simulation`, from rest.
fn simulated(name: &str, rig: &Rig, plant: Plant, input: &Input, end: f64) -> Vec<f64> {
    let own = EXACT.iter().chain(ADAPTIVE).find(|own| own.name == name).expect("a method");
    let model = MODELS.iter().find(|entry| entry.name == rig.friction.name).expect("a model");
    let parameters = rig.friction.parameters.clone();
    let n = 2 + (model.build)(&parameters).expect("a model").states();
    let (plant, input, y0) = (Some(plant), input.clone(), vec![0.0; n]);
    let task = Task { model, parameters, plant, input, y0, span: (0.0, end) };
    let grid = points(end);
    let mut states = vec![0.0; n * grid.len()];
    let ready = (own.build)(&task).expect("it holds");
    let delivered = ready.deliver(1e-10, &Limits::default(), &grid, &mut states);
    assert_eq!(delivered.outcome, Outcome::Solved, "{name}");
    states.iter().step_by(n).copied().collect()
}

/// The paper's drum, prestressed unequally, with a constant part of the friction.
const DRUM: [(&str, f64); 9] = [
    ("inertia", 3e-4),
    ("radius", 0.0254),
    ("k_1", 2.0),
    ("k_2", 2.5),
    ("f_10", 0.02),
    ("f_20", 0.01),
    ("motor_constant", 16.5),
    ("gear_ratio", 68.8),
    ("offset", -0.05),
];

/// The same as the paper's plant (41).
fn drum() -> Plant {
    let keys = DRUM[..8].iter().copied().collect();
    let plant = duhem::Rig::new(&keys).expect("a drum").plant();
    Plant { offset: plant.offset + 0.05, ..plant }
}

fn lugre() -> Parameters {
    let softer = [("f_c", 0.6), ("f_s", 0.65), ("v_s", 0.5), ("sigma_0", 20.0), ("sigma_1", 0.1)];
    softer.into_iter().chain([("sigma_2", 0.05)]).collect()
}

fn elements() -> Parameters {
    let list = |values: &[f64]| Parameter::List(values.to_vec());
    [("k", list(&[3.0, 2.0, 1.0])), ("delta", list(&[0.05, 0.12, 0.3]))].into_iter().collect()
}

#[test]
fn a_drum_with_lugre_turns_as_our_stiff_method_has_it() {
    let input = Input::sine(0.06, 6.0).expect("a sine");
    let rig = rig("drum", &DRUM, friction("lugre", lugre(), 0.0));
    let right = simulated("radau-located", &rig, drum(), &input, 4.0);
    assert_first_order(&rig, &|t| input.u(t), (4.0, &right), (500, 2e-3));
}

#[test]
fn a_drum_with_maxwell_slip_turns_as_the_events_have_it() {
    let input = Input::sine(0.06, 6.0).expect("a sine");
    let rig = rig("drum", &DRUM, friction("maxwell-slip", elements(), 0.0));
    let plant = drum();
    let right = simulated("exact-slip-plant", &rig, plant, &input, 4.0);
    let model = MaxwellSlip::new(&elements()).expect("a model");
    assert_eq!(model.states(), 3);
    assert_first_order(&rig, &|t| input.u(t), (4.0, &right), (500, 2e-3));
}

#[test]
fn a_mass_on_a_spring_with_dahl_of_any_exponent_swings_as_the_displacement_has_it() {
    for gamma in [0.0, 0.5, 1.0, 2.0] {
        let parameters: Parameters =
            [("f_c", 0.75), ("sigma", 15.0), ("gamma", gamma)].into_iter().collect();
        let model = Dahl::new(&parameters).expect("a model");
        let (input, end) = (Input::sine(2.0, 1.3).expect("a sine"), 10.0);
        let plant = Plant { offset: -0.1, ..Plant::mass_spring(1.0, 2.0) };
        let friction_of = RateIndependent::Dahl(model);
        let by = ByDisplacement { friction: friction_of, plant, input: input.clone() };
        let path = by.resolve(&[0.0; 3], (0.0, end)).expect("a path");
        let right: Vec<f64> = points(end).iter().map(|t| path.q(*t)).collect();
        let keys = [("mass", 1.0), ("stiffness", 2.0), ("offset", 0.1)];
        let rig = rig("mass-spring", &keys, friction("dahl", parameters, 0.0));
        assert_first_order(&rig, &|t| input.u(t), (end, &right), (200, 2e-3));
    }
}

/// From rest under a constant force, half swings about (F_e ∓ F_C)/k_s until the spring no longer exceeds F_C.
fn half_swings(t: f64, (mass, stiffness): (f64, f64), drive: f64, f_c: f64) -> f64 {
    let omega = (stiffness / mass).sqrt();
    let (mut q, mut left, half) = (0.0, t, PI / omega);
    loop {
        let pull = drive - stiffness * q;
        if pull.abs() <= f_c {
            return q;
        }
        let centre = (drive - f_c * pull.signum()) / stiffness;
        if left < half {
            return centre + (q - centre) * (omega * left).cos();
        }
        (q, left) = (2.0 * centre - q, left - half);
    }
}

#[test]
fn a_mass_on_a_spring_with_coulomb_friction_swings_in_halves_and_sticks() {
    let keys = [("mass", 0.5), ("stiffness", 8.0)];
    let rig =
        rig("mass-spring", &keys, friction("coulomb", [("f_c", 0.5)].into_iter().collect(), 0.0));
    let swing = |t: &f64| half_swings(*t, (0.5, 8.0), 3.2, 0.5);
    let right: Vec<f64> = points(4.0).iter().map(swing).collect();
    assert_eq!(right[38], right[39], "it sticks at the end");
    assert_first_order(&rig, &|_| 3.2, (4.0, &right), (100, 2e-3));
    let rows = run(&rig, include_str!("plant.c"), &vec![(3.2, 1e-3); 4000]);
    let (before, last) = (&rows[3998], &rows[3999]);
    assert_eq!(before, last, "it moves");
    // What holds it is the spring's and the drive's balance, not F_C.
    let balance = 3.2 - 8.0 * last[0];
    assert!((last[2] - balance).abs() < 1e-12 && balance.abs() < 0.5, "{} N", last[2]);
}

#[test]
fn a_free_axis_with_viscous_friction_speeds_up_by_the_exponential_law() {
    let keys = [("inertia", 95.0), ("gain", 35.0), ("offset", -3.0)];
    let rig = rig("axis", &keys, friction("none", Parameters::default(), 200.0));
    // M v' = 35 · 2 + 3 − 200 v
    let (terminal, tau) = (73.0 / 200.0, 95.0 / 200.0);
    let place = |t: &f64| terminal * (t - tau * (1.0 - (-t / tau).exp()));
    let right: Vec<f64> = points(2.0).iter().map(place).collect();
    assert_first_order(&rig, &|_| 2.0, (2.0, &right), (20, 2e-3));
}

#[test]
fn an_axis_with_lugre_moves_as_our_stiff_method_has_it() {
    let input = Input::sine(0.9, 3.0).expect("a sine");
    let keys = [("inertia", 3e-2), ("offset", 0.05)];
    let rig = rig("axis", &keys, friction("lugre", lugre(), 0.0));
    let plant = Plant { mass: 3e-2, stiffness: 0.0, gain: 1.0, offset: -0.05 };
    let right = simulated("radau-located", &rig, plant, &input, 6.0);
    assert_first_order(&rig, &|t| input.u(t), (6.0, &right), (200, 2e-3));
}

/// q of the pendulum at the points, by the classic Runge–Kutta method at a thousandth of the time between them.
fn swung(keys: &[(&str, f64)], model: &LuGre, input: &dyn Fn(f64) -> f64, end: f64) -> Vec<f64> {
    let key = |name: &str| keys.iter().find(|(key, _)| *key == name).expect("a key").1;
    let (torque, resistance) = (key("torque_constant"), key("resistance"));
    let weight = key("mass") * 9.81 * key("length");
    let slope = |t: f64, [q, v, z]: [f64; 3]| {
        let mut z_dot = [0.0];
        model.x_dot(&[z], q, v, &mut z_dot);
        let motor = torque * (input(t) - torque * v) / resistance;
        let contact = model.force(&[z], &z_dot, q, v) + key("offset");
        [v, (motor - weight * q.sin() - contact) / key("inertia"), z_dot[0]]
    };
    let along = |y: [f64; 3], h: f64, k: [f64; 3]| [0, 1, 2].map(|i| y[i] + h * k[i]);
    let (parts, mut y, mut right) = (1000_u32, [0.0; 3], Vec::new());
    let h = end / f64::from(POINTS * parts);
    for step in 0..POINTS * parts {
        let t = h * f64::from(step);
        let k1 = slope(t, y);
        let k2 = slope(t + 0.5 * h, along(y, 0.5 * h, k1));
        let k3 = slope(t + 0.5 * h, along(y, 0.5 * h, k2));
        let k4 = slope(t + h, along(y, h, k3));
        y = [0, 1, 2].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        if (step + 1) % parts == 0 {
            right.push(y[0]);
        }
    }
    right
}

#[test]
fn a_pendulum_with_lugre_swings_as_runge_and_kutta_have_it() {
    let keys = [
        ("inertia", 2e-2),
        ("mass", 0.3),
        ("length", 0.25),
        ("torque_constant", 0.4),
        ("resistance", 2.0),
        ("offset", 0.02),
    ];
    let model = LuGre::new(&lugre()).expect("a model");
    let input = |t: f64| 6.0 * (4.0 * t).sin();
    let right = swung(&keys, &model, &input, 5.0);
    let largest = right.iter().fold(0.0, |m: f64, q| m.max(q.abs()));
    assert!(largest > 0.5, "sin q is nearly q: {largest} rad");
    let rig = rig("pendulum", &keys, friction("lugre", lugre(), 0.0));
    assert_first_order(&rig, &input, (5.0, &right), (250, 2e-3));
}

#[test]
fn stiff_bristles_at_a_controllers_step_cost_no_accuracy() {
    let paper = [("f_c", 0.6), ("f_s", 1.0), ("v_s", 1e-3), ("sigma_0", 1e3), ("sigma_1", 31.6)];
    let parameters: Parameters = paper.into_iter().chain([("sigma_2", 1.3)]).collect();
    let (rig, input) =
        (rig("drum", &DRUM, friction("lugre", parameters, 0.0)), Input::sine(0.05, 0.2 * PI));
    let (input, end) = (input.expect("a sine"), 50.0);
    let right = simulated("radau-located", &rig, drum(), &input, end);
    // From 10 ms on, where the contact rings at 1800 rad/s and its damping settles it in 10 µs.
    assert_first_order(&rig, &|t| input.u(t), (end, &right), (125, 5e-4));
}
