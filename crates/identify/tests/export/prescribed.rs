//! Friction under an imposed motion of piecewise constant velocity is exact.

use super::{friction, rig, run};
use duhem::{Input, MODELS, Parameter, Parameters};
use integrate::{Limits, Outcome};
use simulation::{Task, exact::EXACT};

/// Turns, rests, creeps and long ways [s], [m].
fn motion() -> (Vec<f64>, Vec<f64>) {
    let t = vec![0.0, 0.5, 1.0, 1.75, 2.5, 3.0, 5.0, 5.5, 6.0, 9.0];
    let u = vec![0.0, 0.4, 0.4, -0.3, -0.2, 1.4, 1.3999, -1.8, -1.8, 0.9];
    (t, u)
}

/// How many steps each leg is walked in.
const PARTS: u32 = 5;

fn cases() -> Vec<(&'static str, &'static str, Parameters)> {
    let dahl = |gamma: f64| -> Parameters {
        [("f_c", 0.75), ("sigma", 1.5), ("gamma", gamma)].into_iter().collect()
    };
    let lugre = [("f_c", 1.0), ("f_s", 1.5), ("v_s", 0.05), ("sigma_0", 30.0), ("sigma_1", 1.0)];
    let k = Parameter::List((0..10).map(|i| 1.0 + 0.8 * f64::from(i)).collect());
    let delta = Parameter::List((0..10).map(|i| 0.15 + 0.09 * f64::from(i)).collect());
    let mut cases: Vec<_> = [0.0, 0.25, 0.9, 1.0 - 1e-9, 1.0, 1.5, 2.0, 3.0]
        .map(|gamma| ("dahl", "exact-dahl", dahl(gamma)))
        .into();
    cases.push(("lugre", "exact-lugre", lugre.into_iter().chain([("sigma_2", 0.4)]).collect()));
    let elements = [("k", k), ("delta", delta)].into_iter().collect();
    cases.push(("maxwell-slip", "exact-maxwell-slip", elements));
    cases.push(("coulomb", "", [("f_c", 0.75)].into_iter().collect()));
    cases.push(("none", "", Parameters::default()));
    cases
}

/// The force [N] at the times, without what every model has besides.
fn simulated(model: &str, method: &str, parameters: &Parameters, times: &[f64]) -> Vec<f64> {
    let (t, u) = motion();
    let input = Input::sampled(t, u).expect("an input");
    let Some(model) = MODELS.iter().find(|entry| entry.name == model) else {
        return vec![0.0; times.len()];
    };
    let n = (model.build)(parameters).expect("a model").states();
    let (parameters, y0) = (parameters.clone(), vec![0.0; n]);
    let task = Task { model, parameters, plant: None, input, y0, span: (0.0, 9.0) };
    let mut states = vec![0.0; n * times.len()];
    if let Some(own) = EXACT.iter().find(|own| own.name == method) {
        let ready = (own.build)(&task).expect("it holds");
        let delivered = ready.deliver(1e-9, &Limits::default(), times, &mut states);
        assert_eq!(delivered.outcome, Outcome::Solved);
    }
    let motion = task.motion().expect("a motion");
    let at = |i: usize| motion.force(times[i], &states[n * i..n * (i + 1)]);
    (0..times.len()).map(at).collect()
}

#[test]
fn every_friction_model_in_c_gives_the_exact_force_at_piecewise_constant_velocity() {
    let (t, u) = motion();
    let legs = t.windows(2).zip(u.windows(2));
    let mut steps = Vec::new();
    // The ends of steps inside a leg: at its end the velocity of the next begins.
    let (mut inner, mut times) = (Vec::new(), Vec::new());
    for (t, u) in legs {
        let dt = (t[1] - t[0]) / f64::from(PARTS);
        for part in 1..=PARTS {
            let velocity = (u[1] - u[0]) / (t[1] - t[0]);
            if part < PARTS {
                inner.push(steps.len());
                times.push(t[0] + dt * f64::from(part));
            }
            steps.push((velocity, dt));
        }
    }
    for (model, method, parameters) in cases() {
        let right = simulated(model, method, &parameters, &times);
        // LuGre has its viscous term among its parameters already.
        let sigma_2 = if model == "lugre" { 0.0 } else { 0.3 };
        let friction = friction(model, parameters.clone(), sigma_2);
        let rows = run(&rig("prescribed", &[("offset", -0.2)], friction), PROGRAM, &steps);
        for ((i, t), right) in inner.iter().zip(&times).zip(&right) {
            let (found, expected) = (rows[*i][0], right + sigma_2 * steps[*i].0 - 0.2);
            let off = (found - expected).abs();
            assert!(off < 1e-9, "{model} {parameters:?} at {t} s: {found} N for {expected} N");
        }
    }
}

const PROGRAM: &str = include_str!("friction.c");
