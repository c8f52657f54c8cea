//! Every partial derivative of every model against central differences, away from the kinks.

use duhem::{FrictionModel, MODELS, Parameter, Slopes};

fn value(key: &str, gamma: f64) -> Parameter {
    match key {
        "f_c" => 1.0.into(),
        "v_s" => 0.01.into(),
        "f_s" | "sigma" => 1.5.into(),
        "gamma" => gamma.into(),
        "sigma_0" => 1e3.into(),
        "sigma_1" => 30.0.into(),
        "sigma_2" => 0.4.into(),
        "k" => vec![2.0, 3.0, 0.5].into(),
        "delta" => vec![0.1, 0.3, 0.2].into(),
        other => panic!("no value for a new key {other}: give it one here"),
    }
}

fn every_model() -> Vec<(String, Box<dyn FrictionModel>)> {
    let mut models = Vec::new();
    for entry in MODELS {
        for gamma in [0.0, 0.25, 1.0, 2.0] {
            let parameters = entry.keys.iter().map(|key| (*key, value(key, gamma)));
            let model = (entry.build)(&parameters.collect()).expect("the parameters of the test");
            models.push((format!("{} with gamma = {gamma}", entry.name), model));
        }
    }
    models
}

fn x_dot(model: &dyn FrictionModel, x: &[f64], u: f64, u_dot: f64) -> Vec<f64> {
    let mut out = vec![f64::NAN; model.states()];
    model.x_dot(x, u, u_dot, &mut out);
    out
}

/// Central difference of f at `at`, over a step in proportion to `size`.
fn difference(f: impl Fn(f64) -> f64, at: f64, size: f64) -> f64 {
    let h = 1e-5 * size;
    (f(at + h) - f(at - h)) / (2.0 * h)
}

fn close(what: &str, found: f64, expected: f64, size: f64) {
    let error = (found - expected).abs();
    assert!(error <= 1e-6 * (size + expected.abs()), "{what}: {found}, by difference {expected}");
}

fn check(name: &str, model: &dyn FrictionModel, x: &[f64], u: f64, u_dot: f64) {
    let n = model.states();
    let mut s = Slopes::new(n);
    model.slopes(x, u, u_dot, &mut s);
    let rates = x_dot(model, x, u, u_dot);
    let moved = |list: &[f64], j: usize, v: f64| {
        let mut list = list.to_vec();
        list[j] = v;
        list
    };
    let mut jacobian = vec![f64::NAN; n * n];
    model.jacobian(x, u, u_dot, &mut jacobian);
    for i in 0..n {
        let by_u = difference(|u| x_dot(model, x, u, u_dot)[i], u, 0.1);
        close(&format!("{name}: dx_dot/du"), s.x_dot_by_u[i], by_u, 1.0);
        let by_u_dot = difference(|v| x_dot(model, x, u, v)[i], u_dot, u_dot.abs());
        close(&format!("{name}: dx_dot/du_dot"), s.x_dot_by_u_dot[i], by_u_dot, 1.0);
        let by_x = difference(|v| model.force(&moved(x, i, v), &rates, u, u_dot), x[i], 0.1);
        close(&format!("{name}: dF/dx"), s.force_by_x[i], by_x, 1.0);
        let by_rate = difference(|v| model.force(x, &moved(&rates, i, v), u, u_dot), rates[i], 1.0);
        close(&format!("{name}: dF/dx_dot"), s.force_by_x_dot[i], by_rate, 1.0);
        for j in 0..n {
            let size = model.scale()[j];
            let expected = difference(|v| x_dot(model, &moved(x, j, v), u, u_dot)[i], x[j], size);
            close(&format!("{name}: dx_dot/dx"), jacobian[i * n + j], expected, 0.1);
        }
    }
    let by_u = difference(|u| model.force(x, &rates, u, u_dot), u, 0.1);
    close(&format!("{name}: dF/du"), s.force_by_u, by_u, 1.0);
    let by_u_dot = difference(|v| model.force(x, &rates, u, v), u_dot, u_dot.abs());
    close(&format!("{name}: dF/du_dot"), s.force_by_u_dot, by_u_dot, 1.0);
}

#[test]
fn slopes_are_what_differences_say() {
    for (name, model) in every_model() {
        for part in [-1.3, -0.6, 0.0, 0.35, 0.9, 1.2] {
            for u_dot in [-0.3, -0.008, -1e-3, 2e-3, 0.015, 0.4] {
                let u = 0.02;
                // The states of Maxwell-slip are positions: deflected by this part of the deadbands.
                let position = if name.starts_with("maxwell") { u } else { 0.0 };
                let x: Vec<f64> = model.scale().iter().map(|s| position - part * s).collect();
                check(&name, &*model, &x, u, u_dot);
            }
        }
    }
}

#[test]
fn slopes_are_finite_at_the_kinks() {
    for (name, model) in every_model() {
        for part in [-1.0, 0.0, 1.0] {
            for u_dot in [-0.1, 0.0, 0.1] {
                let x: Vec<f64> = model.scale().iter().map(|s| part * s).collect();
                let mut s = Slopes::new(model.states());
                model.slopes(&x, 0.0, u_dot, &mut s);
                let lists = [s.x_dot_by_u, s.x_dot_by_u_dot, s.force_by_x, s.force_by_x_dot];
                let rest = [s.force_by_u, s.force_by_u_dot];
                let all = lists.iter().flatten().chain(&rest);
                assert!(
                    all.clone().all(|s| s.is_finite()),
                    "{name}: {:?}",
                    all.collect::<Vec<_>>()
                );
            }
        }
    }
}
