//! Theorem 1 with two states: against the equation, the print, and where the print has no answer.

use duhem::closed_form::semilinear::{Branch, Loop, Semilinear, SemilinearError};

/// Equation 6 over the displacement by RK4, `delta_u` signed.
fn rk4(model: &Semilinear, mut x: Vec<f64>, u0: f64, delta_u: f64) -> Vec<f64> {
    let n = 4000;
    let (s, h) = (delta_u.signum(), delta_u.abs() / f64::from(n));
    for i in 0..n {
        let u = u0 + s * h * f64::from(i);
        let at = |slope: &[f64], part: f64| -> Vec<f64> {
            let moved: Vec<f64> = x.iter().zip(slope).map(|(x, k)| x + part * h * k).collect();
            model.x_dot(&moved, u + s * part * h, s)
        };
        let a = at(&[0.0, 0.0], 0.0);
        let b = at(&a, 0.5);
        let c = at(&b, 0.5);
        let d = at(&c, 1.0);
        for j in 0..2 {
            x[j] += h / 6.0 * (a[j] + 2.0 * b[j] + 2.0 * c[j] + d[j]);
        }
    }
    x
}

fn settles_on_its_loop(model: &Semilinear, (u_min, u_max): (f64, f64)) {
    let settled = Loop::new(model, (u_min, u_max)).expect("a contracting model");
    let mut x = vec![3.0, -2.0];
    for _ in 0..60 {
        x = rk4(model, x, u_min, u_max - u_min);
        x = rk4(model, x, u_max, u_min - u_max);
    }
    assert!((settled.y(u_min, true) - model.y(&x, u_min)).abs() < 1e-11);
    assert!((settled.y(u_min, true) - settled.y(u_min, false)).abs() < 1e-11);
    let half = 0.4 * (u_max - u_min);
    let middle = rk4(model, x.clone(), u_min, half);
    assert!((settled.y(u_min + half, true) - model.y(&middle, u_min + half)).abs() < 1e-11);
    let top = rk4(model, x, u_min, u_max - u_min);
    let middle = rk4(model, top, u_max, -half);
    assert!((settled.y(u_max - half, false) - model.y(&middle, u_max - half)).abs() < 1e-11);
}

/// Along a way of several cells and back, at points that lie in no pattern.
fn follows_equation_6(model: &Semilinear) {
    let mut x = vec![0.4, -0.3];
    for (from, to) in [(-0.7, 1.1), (1.1, -0.7)] {
        assert!(model.cells((from, to)) > 3.0, "{} cells", model.cells((from, to)));
        let (start, way) = (x.clone(), to - from);
        let u: Vec<f64> = [0.0, 0.123, 0.5, 0.877, 1.0].map(|part| from + part * way).to_vec();
        let mut states = vec![f64::NAN; 2 * u.len()];
        model.follow(&mut x, (from, to), &u, &mut states);
        for (u, found) in u.iter().zip(states.chunks_exact(2)) {
            let expected = rk4(model, start.clone(), from, u - from);
            let off = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
            assert!(off < 1e-12, "off by {off:e} at u = {u} m");
        }
        let end = &states[2 * u.len() - 2..];
        let off = (x[0] - end[0]).abs().max((x[1] - end[1]).abs());
        assert!(off < 1e-14, "off by {off:e} at the end");
    }
}

#[test]
fn two_coupled_states_settle_on_the_loop_of_theorem_1() {
    let plus = Branch { a: &[-1.0, 0.3, -0.2, -2.0], b: &[0.5, -0.1], e: &[1.0, 0.2] };
    let minus = Branch { a: &[1.5, 0.1, 0.4, 0.8], b: &[0.2, 0.3], e: &[0.7, -1.0] };
    let model = Semilinear::new(plus, minus, &[1.0, -0.5], 0.25).unwrap();
    settles_on_its_loop(&model, (-0.7, 1.1));
    follows_equation_6(&model);
}

#[test]
fn a_singular_a_has_a_loop_though_the_print_divides_by_it() {
    let plus = Branch { a: &[-1.0, 0.0, 0.0, 0.0], b: &[0.5, 0.0], e: &[1.0, 0.2] };
    let minus = Branch { a: &[1.0, 0.0, 0.0, 0.9], b: &[0.0, 0.3], e: &[0.7, -1.0] };
    let model = Semilinear::new(plus, minus, &[1.0, 1.0], 0.0).unwrap();
    settles_on_its_loop(&model, (-0.7, 1.1));
    follows_equation_6(&model);
}

#[test]
fn a_loop_that_does_not_contract_is_refused() {
    let plus = Branch { a: &[1.0], b: &[0.0], e: &[1.0] };
    let minus = Branch { a: &[0.5], b: &[0.0], e: &[1.0] };
    let model = Semilinear::new(plus, minus, &[1.0], 0.0).unwrap();
    let refused = Loop::new(&model, (0.0, 2.0)).unwrap_err();
    let SemilinearError::NotContracting { rho } = refused else { panic!("{refused}") };
    assert!((rho - 1.0_f64.exp()).abs() < 1e-14, "{rho}");
    assert!(Loop::new(&model, (0.0, 0.0)).is_err());
}

#[test]
fn wrong_sizes_are_refused() {
    let good = Branch { a: &[1.0], b: &[0.0], e: &[1.0] };
    assert!(Semilinear::new(good, good, &[1.0, 2.0], 0.0).is_err());
    assert!(Semilinear::new(Branch { b: &[f64::NAN], ..good }, good, &[1.0], 0.0).is_err());
}
