//! The LuGre closed form at constant speeds.

use duhem::{
    Dahl, FrictionModel, Input, LuGre,
    closed_form::{Reference, ReferenceError, dahl, lugre},
};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn model() -> LuGre {
    LuGre { f_c: 1.0, f_s: 1.5, v_s: 0.001, sigma_0: 1e5, sigma_1: 1e5_f64.sqrt(), sigma_2: 0.4 }
}

#[test]
fn the_reference_solves_equation_18() {
    let (model, input) = (model(), Input::triangle(1e-4, 5.0).unwrap());
    let quarter = TAU / 5.0 / 4.0;
    let run = lugre::Trajectory::new(&model, &input, 0.0, (0.0, quarter)).unwrap();
    let (n, mut x) = (20_000, 0.0);
    let h = quarter / f64::from(n);
    let slope = |x: f64| {
        let mut out = [0.0];
        model.x_dot(&[x], 0.0, input.u_dot(0.0), &mut out);
        out[0]
    };
    for _ in 0..n {
        let a = slope(x);
        let b = slope(x + 0.5 * h * a);
        let c = slope(x + 0.5 * h * b);
        x += h / 6.0 * (a + 2.0 * b + 2.0 * c + slope(x + h * c));
    }
    let off = (run.deflection(quarter) - x).abs();
    assert!(off < 1e-17, "off by {off:e} m of {x:e} m");
    assert!(run.error_bound() < 2e-18);
}

#[test]
fn the_triangle_wave_settles_on_its_loop() {
    let (model, input) = (model(), Input::triangle(1e-5, 5.0).unwrap());
    let period = input.period().unwrap();
    let settled = lugre::settled_deflection(&model, input.u_dot(0.0), 2e-5);
    for x0 in [-1e-5, 0.0, 1.4e-5] {
        let run = lugre::Trajectory::new(&model, &input, x0, (0.0, 20.5 * period)).unwrap();
        let off = (run.deflection(20.25 * period) - settled).abs();
        assert!(off < run.error_bound(), "x(0) = {x0} m: off by {off:e} m of {settled:e} m");
    }
}

#[test]
fn under_a_sine_the_quadrature_solves_equation_18() {
    for omega in [10.0, 1.0, 0.1] {
        let (model, input) = (model(), Input::sine(1e-4, omega).unwrap());
        let end = 0.4 * input.period().unwrap();
        let run = lugre::Trajectory::new(&model, &input, 0.0, (0.0, end)).unwrap();
        let (n, mut x) = (40_000, 0.0);
        let h = end / f64::from(n);
        let turn = 0.25 * input.period().unwrap();
        // RK4 with a step that lands on the turn: 5/8 of the steps.
        let slope = |t: f64, x: f64, from: f64, to: f64| {
            let mut out = [0.0];
            model.x_dot(&[x], 0.0, input.u_dot_on(from, to, t), &mut out);
            out[0]
        };
        for i in 0..n {
            let (from, to) = if i < n / 8 * 5 { (0.0, turn) } else { (turn, end) };
            let t = h * f64::from(i);
            let a = slope(t, x, from, to);
            let b = slope(t + 0.5 * h, x + 0.5 * h * a, from, to);
            let c = slope(t + 0.5 * h, x + 0.5 * h * b, from, to);
            x += h / 6.0 * (a + 2.0 * b + 2.0 * c + slope(t + h, x + h * c, from, to));
        }
        let off = (run.deflection(end) - x).abs();
        assert!(off < 1e-17, "ω = {omega}: off by {off:e} m of {x:e} m");
        assert!(run.error_bound() < 5e-18, "{:e} m", run.error_bound());
    }
}

#[test]
fn the_settled_start_repeats_itself_and_needs_a_period() {
    for amplitude in [1e-4, 1e-6] {
        let (model, input) = (model(), Input::sine(amplitude, 5.0).unwrap());
        let period = input.period().unwrap();
        let x0 = lugre::settled_start(&model, &input).unwrap();
        let run = lugre::Trajectory::new(&model, &input, x0, (0.0, period)).unwrap();
        assert!((run.deflection(period) - x0).abs() < 1e-18, "{x0:e} m");
        assert!((run.deflection(0.5 * period) + x0).abs() < 1e-18, "{x0:e} m");
        assert!(run.work() > 0.0);
    }
    let line = Input::sampled(vec![0.0, 1.0], vec![0.0, 1.0]).unwrap();
    assert_eq!(lugre::settled_start(&model(), &line), Err(ReferenceError::NoPeriod));
}

#[test]
fn a_span_too_long_for_quadrature_is_refused() {
    let input = Input::sine(1.0, 1.0).unwrap();
    let refused = lugre::Trajectory::new(&model(), &input, 0.0, (0.0, 1e6));
    assert!(matches!(refused, Err(ReferenceError::TooLong { .. })));
}

#[test]
fn slow_motion_loses_what_dahl_with_f_s_loses() {
    let (model, input) = (model(), Input::sine(1e-4, 1e-4).unwrap());
    let x0 = lugre::settled_start(&model, &input).unwrap();
    let span = (0.0, input.period().unwrap());
    let work = lugre::Trajectory::new(&model, &input, x0, span).unwrap().work();
    let twin = Dahl { f_c: 1.5, sigma: 1e5, gamma: 1.0 };
    let limit = dahl::Loop::new(&twin, (-1e-4, 1e-4)).area();
    assert!((work / limit - 1.0).abs() < 1e-6, "{work} J, limit {limit} J");
}

#[test]
fn the_steady_force_falls_between_its_extrema_and_rises_outside() {
    let model = model();
    let found = lugre::steady_extrema(&model).unwrap();
    let slope = |v: f64| model.steady_force(v + 1e-8) - model.steady_force(v - 1e-8);
    for (v, sign) in [(found.maximum, -1.0), (found.minimum, 1.0)] {
        assert!(slope(1.1 * v) * sign > 0.0 && slope(0.9 * v) * sign < 0.0, "{v} m/s");
    }
    // Far below v_S: the force begins to fall at 2s ≈ σ₂v_S/(F_S − F_C).
    assert!((found.maximum / 4e-7 - 1.0).abs() < 1e-6, "{} m/s", found.maximum);
    assert_eq!(lugre::steady_extrema(&LuGre { f_s: 1.0, ..model.clone() }), None);
    assert_eq!(lugre::steady_extrema(&LuGre { sigma_2: 1e4, ..model }), None);
}

#[test]
fn without_stribeck_effect_and_damping_lugre_is_dahl_with_sigma_0_and_not_with_sigma_1_n_per_m() {
    let model = LuGre { f_s: 1.0, sigma_1: 0.0, sigma_2: 0.0, ..model() };
    let input = Input::triangle(1e-4, 5.0).unwrap();
    let run = lugre::Trajectory::new(&model, &input, 0.0, (0.0, 3.0)).unwrap();
    let dahl = |sigma| Dahl { f_c: 1.0, sigma, gamma: 1.0 };
    let twin = |sigma| dahl::Trajectory::new(&dahl(sigma), &input, 0.0, (0.0, 3.0)).unwrap();
    for i in 0..=300 {
        let t = 0.01 * f64::from(i);
        let force = 1e5 * run.deflection(t);
        assert!((force - twin(1e5).force(t)).abs() < 1e-12);
    }
    let off = (1e5 * run.deflection(0.3) - twin(1.0).force(0.3)).abs();
    assert!(off > 0.9, "with σ = 1 N/m it is off by {off} N");
    assert!(model.form().unwrap().rate_independent());
}

proptest! {
    #[test]
    fn the_deflection_stays_within_f_s_over_sigma_0(
        part in -1.0..=1.0_f64, way in 0.0..1e-3_f64, u_dot in -0.1..0.1_f64,
    ) {
        let x = lugre::advance(&model(), 1.5e-5 * part, way, u_dot);
        prop_assert!(x.abs() <= 1.5e-5 * (1.0 + f64::EPSILON), "{} m", x);
    }

    #[test]
    fn a_settled_triangle_loses_energy_under_the_passivity_condition(
        omega in 0.01..100.0_f64, beta in 1e-6..1e-3_f64,
    ) {
        // σ₁ < 4σ₀ r/v at the speed here: the loop of F = σ₀x + σ₁ẋ + σ₂u̇ by quadrature.
        let (model, speed) = (model(), beta * omega / std::f64::consts::PI);
        prop_assume!(model.sigma_1 * speed < 4.0 * model.sigma_0 * model.r(speed));
        let x0 = -lugre::settled_deflection(&model, speed, beta);
        let n = 2000;
        let force = |i: i32| {
            let x = [lugre::advance(&model, x0, beta * f64::from(i) / f64::from(n), speed)];
            let mut x_dot = [0.0];
            model.x_dot(&x, 0.0, speed, &mut x_dot);
            model.force(&x, &x_dot, 0.0, speed)
        };
        let sum: f64 = (0..n).map(|i| 0.5 * (force(i) + force(i + 1))).sum();
        prop_assert!(sum >= 0.0, "{} J", 2.0 * sum * beta / f64::from(n));
    }
}

#[test]
fn a_leg_of_constant_speed_is_the_update_at_each_time() {
    let model = model();
    for u_dot in [-0.3, -1e-4, 0.0, 2e-6, 1e-3] {
        for x in [-2e-5, 0.0, 1e-5] {
            let mut found = [3.0, 3.0 + 1e-9, 3.01, 4.0, 300.0];
            let times = found;
            lugre::Leg::new(&model, x, 3.0, u_dot).deflections(&mut found);
            for (t, found) in times.iter().zip(found) {
                let expected = lugre::advance(&model, x, u_dot * (t - 3.0), u_dot);
                let off = (found - expected).abs();
                assert!(off <= 1e-20, "{found} m, expected {expected} m at {t} s, {u_dot} m/s");
            }
        }
    }
}
