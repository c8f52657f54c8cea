//! What holds for every model of the list: the Duhem form, bounds, symmetry, rate dependence, loss.

use duhem::{Continuity, DuhemType, FrictionModel, MODELS, Parameter, Parameters, form};
use proptest::prelude::*;

/// Models with the paper's parameters; Dahl with each kind of γ.
fn every_model() -> Vec<(String, Box<dyn FrictionModel>)> {
    let mut models = Vec::new();
    for entry in MODELS {
        let shapes: &[f64] = if entry.name == "dahl" { &[0.0, 0.25, 1.0, 2.0] } else { &[1.0] };
        for gamma in shapes {
            let parameters = entry.keys.iter().map(|key| (*key, value(key, *gamma)));
            let model = (entry.build)(&parameters.collect()).expect("the paper's parameters");
            models.push((format!("{} with gamma = {gamma}", entry.name), model));
        }
    }
    models
}

fn value(key: &str, gamma: f64) -> Parameter {
    match key {
        "f_c" => 1.0.into(),
        "v_s" => 0.001.into(),
        "f_s" | "sigma" => 1.5.into(),
        "gamma" => gamma.into(),
        "sigma_0" => 1e5.into(),
        "sigma_1" => 1e5_f64.sqrt().into(),
        "sigma_2" => 0.4.into(),
        "k" => vec![2.0, 3.0, 0.5].into(),
        "delta" => vec![2.5e-3, 15e-3, 4e-3].into(),
        other => panic!("no value for a new key {other}: give it one here"),
    }
}

/// The state at `part` of its scale, positions of Maxwell-slip elements relative to u included.
fn state(model: &dyn FrictionModel, part: f64) -> Vec<f64> {
    model.scale().iter().map(|scale| part * scale).collect()
}

fn x_dot(model: &dyn FrictionModel, x: &[f64], u: f64, u_dot: f64) -> Vec<f64> {
    let mut out = vec![f64::NAN; model.states()];
    model.x_dot(x, u, u_dot, &mut out);
    out
}

#[test]
fn the_list_holds_the_models_of_the_paper() {
    let names: Vec<_> = MODELS.iter().map(|entry| entry.name).collect();
    assert_eq!(names, ["coulomb", "dahl", "lugre", "maxwell-slip"]);
}

#[test]
fn the_types_and_rates_are_those_of_table_1() {
    use DuhemType::{Generalized, Semilinear, Static};
    let types: Vec<_> = every_model()
        .iter()
        .map(|(_, model)| {
            let form = model.form().unwrap();
            (form.duhem_type(), form.rate_independent())
        })
        .collect();
    let dahl = [(Generalized, true), (Generalized, true), (Semilinear, true), (Generalized, true)];
    let others = [(Generalized, false), (Generalized, true)];
    assert_eq!(types, [&[(Static, true)], &dahl[..], &others[..]].concat());
}

/// The largest jump of f over ±h around the state `part` of the scale, u = 0.
fn jump(model: &dyn FrictionModel, part: f64, h: f64) -> f64 {
    let form = model.form().expect("a Duhem model");
    let f = |part: f64| {
        let mut f = vec![0.0; form.states() * form.columns()];
        form.f(&state(model, part), 0.0, &mut f);
        f
    };
    let differences = f(part - h).into_iter().zip(f(part + h)).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn the_smoothness_is_that_of_table_1_and_measured() {
    for (name, model) in every_model().into_iter().filter(|(_, model)| model.states() > 0) {
        // At the edge of the states, where every model has its kink.
        let jumps = [1e-4, 1e-8, 1e-12].map(|h| jump(&*model, 1.0, h) / jump(&*model, 1.0, 1e-2));
        let measured = if jumps[2] == 1.0 {
            Continuity::Discontinuous
        } else if jumps[1] / jumps[2] < 9e3 {
            Continuity::NotLipschitz
        } else {
            Continuity::Lipschitz
        };
        assert_eq!(model.form().unwrap().continuity(), measured, "{name}: {jumps:?}");
    }
}

#[test]
fn a_wrong_parameter_is_named_with_what_was_expected() {
    for entry in MODELS {
        let good: Parameters = entry.keys.iter().map(|key| (*key, value(key, 1.0))).collect();
        let fails = |p: &Parameters| (entry.build)(p).unwrap_err();
        for key in entry.keys {
            let mut missing = good.clone();
            missing.0.remove(*key);
            assert_eq!(fails(&missing).key(), *key);
            for bad in [f64::NAN, f64::INFINITY, -0.75] {
                let mut wrong = good.clone();
                wrong.0.insert((*key).to_owned(), Parameter::Scalar(bad));
                let error = fails(&wrong);
                assert_eq!(error.key(), *key);
                assert!(
                    error.to_string().starts_with(&format!("{key} = {bad}: expected a")),
                    "{error}"
                );
                wrong.0.insert((*key).to_owned(), Parameter::List(vec![bad]));
                assert_eq!(fails(&wrong).key(), *key);
            }
        }
        let mut more = good.clone();
        more.0.insert("mass".to_owned(), Parameter::Scalar(1.0));
        let message = fails(&more).to_string();
        assert!(
            message.contains("unknown key mass") && message.contains(entry.keys[0]),
            "{message}"
        );
    }
}

#[test]
fn messages_carry_value_and_unit() {
    let parameters: Parameters = [("f_c", -0.75)].into_iter().collect();
    let message = (MODELS[0].build)(&parameters).unwrap_err().to_string();
    assert_eq!(message, "f_c = -0.75: expected a positive, finite force [N], from 1e-60 to 1e60");
    let lists = [("k", vec![1.0, 2.0]), ("delta", vec![1.0])];
    let message = (MODELS[3].build)(&lists.into_iter().collect()).unwrap_err().to_string();
    assert_eq!(
        message,
        "delta = [1.0]: expected one deadband [m] for each of the 2 stiffnesses in k"
    );
}

#[test]
fn jacobians_are_finite_at_the_kinks() {
    for (name, model) in every_model() {
        let n = model.states();
        for part in [-1.0, 0.0, 1.0] {
            for u_dot in [-0.1, 0.0, 0.1] {
                let mut jacobian = vec![f64::NAN; n * n];
                model.jacobian(&state(&*model, part), 0.0, u_dot, &mut jacobian);
                assert!(jacobian.iter().all(|j| j.is_finite()), "{name}: {jacobian:?}");
            }
        }
    }
}

proptest! {
    #[test]
    fn f_times_g_is_x_dot(part in -1.5..1.5_f64, u in -0.02..0.02_f64, u_dot in -0.5..0.5_f64) {
        for (name, model) in every_model() {
            let x = state(&*model, part);
            let (product, direct) =
                (form::x_dot(model.form().unwrap(), &x, u, u_dot), x_dot(&*model, &x, u, u_dot));
            for (a, b) in product.iter().zip(&direct) {
                // LuGre subtracts: an error relative to the terms, not to their difference.
                let size = u_dot.abs() * (1.0 + if name.starts_with("lugre") { part.abs() * 1.5 } else { b.abs() });
                prop_assert!((a - b).abs() <= 8.0 * f64::EPSILON * size, "{}: {} and {}", name, a, b);
            }
        }
    }

    #[test]
    fn at_rest_every_state_is_an_equilibrium(part in -1.5..1.5_f64, u in -0.02..0.02_f64) {
        for (name, model) in every_model() {
            let x_dot = x_dot(&*model, &state(&*model, part), u, 0.0);
            prop_assert!(x_dot.iter().all(|v| *v == 0.0), "{}: {:?}", name, x_dot);
        }
    }

    #[test]
    fn the_mirror_image_of_a_motion_meets_the_mirror_image_of_the_force(
        part in -1.5..1.5_f64, u in -0.02..0.02_f64, u_dot in -0.5..0.5_f64,
    ) {
        for (name, model) in every_model() {
            let (x, mirrored) = (state(&*model, part), state(&*model, -part));
            let (a, b) = (x_dot(&*model, &x, u, u_dot), x_dot(&*model, &mirrored, -u, -u_dot));
            prop_assert!(a.iter().zip(&b).all(|(a, b)| *a == -b), "{}: {:?} {:?}", name, a, b);
            let f = model.force(&x, &a, u, u_dot);
            prop_assert_eq!(f, -model.force(&mirrored, &b, -u, -u_dot), "{}", name);
        }
    }

    #[test]
    fn twice_the_speed_is_twice_the_rate_in_rate_independent_models_only(
        part in -0.99..0.99_f64, u_dot in 1e-3..0.5_f64,
    ) {
        for (name, model) in every_model() {
            let x = state(&*model, part);
            let (once, twice) =
                (x_dot(&*model, &x, 0.0, u_dot), x_dot(&*model, &x, 0.0, 2.0 * u_dot));
            let same = once.iter().zip(&twice).all(|(a, b)| 2.0 * a == *b);
            if model.form().unwrap().rate_independent() {
                prop_assert!(same, "{}: {:?} and {:?}", name, once, twice);
            } else if part.abs() > 0.01 && u_dot < 3e-3 {
                prop_assert!(!same, "{} does not feel the speed {} m/s", name, u_dot);
            }
        }
    }

    #[test]
    fn the_jacobian_is_the_slope_of_x_dot(part in -0.9..0.9_f64, u_dot in -0.5..0.5_f64) {
        for (name, model) in every_model() {
            let (n, scale) = (model.states(), model.scale());
            let x = state(&*model, part);
            let mut jacobian = vec![0.0; n * n];
            model.jacobian(&x, 0.0, u_dot, &mut jacobian);
            for j in 0..n {
                let h = 1e-6 * scale[j];
                let (mut left, mut right) = (x.clone(), x.clone());
                (left[j], right[j]) = (x[j] - h, x[j] + h);
                let (a, b) = (x_dot(&*model, &left, 0.0, u_dot), x_dot(&*model, &right, 0.0, u_dot));
                for i in 0..n {
                    let (slope, exact) = ((b[i] - a[i]) / (2.0 * h), jacobian[i * n + j]);
                    let size = exact.abs() + u_dot.abs() / scale[j];
                    prop_assert!((slope - exact).abs() < 1e-6 * size, "{}: {} {}", name, slope, exact);
                }
            }
        }
    }
}

#[test]
fn every_parameter_has_its_unit() {
    for entry in MODELS {
        assert_eq!(entry.keys.len(), entry.units.len(), "{}", entry.name);
    }
}

#[test]
fn the_jacobian_is_zero_at_the_kink_where_no_slope_exists() {
    for gamma in [0.0, 0.25, 0.5] {
        let dahl = duhem::Dahl { f_c: 0.75, sigma: 1.5, gamma };
        for (force, u_dot) in [(0.75, 0.1), (-0.75, -0.1)] {
            let mut slope = [f64::NAN];
            dahl.jacobian(&[force], 0.0, u_dot, &mut slope);
            assert!(slope[0] == 0.0, "γ = {gamma}: slope {} at F = {force} N", slope[0]);
        }
    }
}
