//! The Dahl closed form: against its equation, the paper's Corollary 1, and physics.

use duhem::{
    Dahl, FrictionModel, Input, MODELS, Parameters,
    closed_form::{REFERENCES, Reference, dahl, semilinear},
};
use proptest::prelude::*;

fn model(gamma: f64) -> Dahl {
    Dahl { f_c: 0.75, sigma: 1.5, gamma }
}

/// Equation 11 over the displacement by RK4: dF/d|u| at u̇ = ±1, from `force`.
fn rk4(dahl: &Dahl, force: f64, delta_u: f64, steps: u32) -> f64 {
    let h = delta_u.abs() / f64::from(steps);
    let slope = |f: f64| {
        let mut out = [0.0];
        dahl.x_dot(&[f], 0.0, delta_u.signum(), &mut out);
        out[0]
    };
    (0..steps).fold(force, |f, _| {
        let a = slope(f);
        let b = slope(f + 0.5 * h * a);
        let c = slope(f + 0.5 * h * b);
        f + h / 6.0 * (a + 2.0 * b + 2.0 * c + slope(f + h * c))
    })
}

#[test]
fn advance_solves_equation_11() {
    // Short of saturation, where RK4 keeps its order.
    for gamma in [0.0, 0.25, 0.5, 0.999_999, 1.0, 1.000_001, 1.5, 2.0, 3.0] {
        for (force, delta_u) in [(0.0, 0.3), (-0.7, 0.5), (0.7, -0.5), (0.2, -0.3)] {
            let dahl = model(gamma);
            let (exact, tight) =
                (dahl::advance(&dahl, force, delta_u), rk4(&dahl, force, delta_u, 4000));
            let off = (exact - tight).abs();
            assert!(off < 2e-13, "γ = {gamma}: {exact} N, RK4 {tight} N, off by {off:.1e} N");
        }
    }
}

#[test]
fn a_force_beyond_f_c_comes_back_to_it_as_equation_11_has_it() {
    for gamma in [0.25, 1.0, 2.0] {
        for delta_u in [0.2, -0.2] {
            let dahl = model(gamma);
            let (exact, tight) =
                (dahl::advance(&dahl, 0.9, delta_u), rk4(&dahl, 0.9, delta_u, 4000));
            assert!((exact - tight).abs() < 1e-6, "γ = {gamma}: {exact} N, RK4 {tight} N");
        }
    }
}

#[test]
fn work_is_the_integral_of_the_force() {
    for gamma in [0.0, 0.25, 0.999_999, 1.0, 1.5, 1.999_999, 2.0, 2.000_001, 3.0] {
        for (force, delta_u) in [(0.0, 0.4), (-0.7, 0.5), (0.7, -0.5), (0.01, -0.02), (0.3, 1e-4)] {
            let dahl = model(gamma);
            // Simpson over 2000 pieces.
            let n = 2000;
            let at = |i: i32| dahl::advance(&dahl, force, delta_u * f64::from(i) / f64::from(n));
            let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
            let sum: f64 = (0..=n).map(|i| weight(i) * at(i)).sum();
            let simpson = sum * delta_u / f64::from(3 * n);
            let exact = dahl::work(&dahl, force, delta_u);
            // γ = 0.25 from 0.7 N saturates inside a piece.
            assert!(
                (exact - simpson).abs() < 1e-9 * delta_u.abs(),
                "γ = {gamma}: {exact} {simpson} J"
            );
        }
    }
}

#[test]
fn gamma_below_one_saturates_after_a_finite_travel_and_gamma_one_or_more_never() {
    for gamma in [0.0, 0.25, 0.9] {
        // ∫ dF/D₊ from −F_C to F_C by hand.
        let by_hand = 0.5 * 2.0_f64.powf(1.0 - gamma) / (1.0 - gamma);
        let travel = dahl::saturation_travel(&model(gamma)).unwrap();
        assert!((travel - by_hand).abs() < 1e-14 * by_hand, "γ = {gamma}: {travel} m");
        assert_eq!(dahl::advance(&model(gamma), -0.75, 1.000_001 * travel), 0.75);
        assert!(dahl::advance(&model(gamma), -0.75, 0.9 * travel) < 0.75);
    }
    for gamma in [1.0, 1.5, 2.0] {
        assert_eq!(dahl::saturation_travel(&model(gamma)), None);
        assert!(dahl::advance(&model(gamma), -0.74, 5.0) < 0.75, "γ = {gamma}");
    }
}

#[test]
fn the_loop_of_gamma_one_is_corollary_1_and_theorem_1() {
    for (f_c, sigma, (u_min, u_max)) in [(0.75, 1.5, (-1.0, 1.0)), (0.75, 7.5, (-2.0, 0.0))] {
        let dahl = Dahl { f_c, sigma, gamma: 1.0 };
        let settled = dahl::Loop::new(&dahl, (u_min, u_max));
        let theorem = semilinear::Semilinear::of_dahl(&dahl).unwrap();
        let theorem = semilinear::Loop::new(&theorem, (u_min, u_max)).unwrap();
        for i in 0..=40 {
            let u = u_min + (u_max - u_min) * f64::from(i) / 40.0;
            for rising in [true, false] {
                let found = settled.force(u, rising);
                let branch = if rising { dahl::rising } else { dahl::falling };
                let corollary = branch(&dahl, (u_min, u_max), u);
                assert!((found - corollary).abs() < 1e-14, "{found} N, corollary {corollary} N");
                let off = (found - theorem.y(u, rising)).abs();
                assert!(off < 1e-12, "theorem off by {off:.1e} N at u = {u} m");
            }
        }
    }
}

#[test]
fn the_loop_forgets_the_initial_force() {
    let input = Input::sine(1.0, 0.1).unwrap();
    let period = input.period().unwrap();
    for gamma in [0.25, 1.0, 2.0] {
        let settled = dahl::Loop::new(&model(gamma), input.range());
        for f0 in [-0.75, 0.0, 0.6] {
            let span = (0.0, 400.25 * period);
            let run = dahl::Trajectory::new(&model(gamma), &input, f0, span).unwrap();
            let off = (run.force(span.1) - settled.force_at_u_max).abs();
            assert!(off < 1e-13, "γ = {gamma}, F(0) = {f0} N: off by {off:.1e} N");
        }
    }
}

#[test]
fn figure_1_by_hand() {
    let settled = dahl::Loop::new(&model(1.0), (-1.0, 1.0));
    let tanh2 = 2.0_f64.tanh();
    assert!((settled.force_at_u_max - 0.75 * tanh2).abs() < 1e-15);
    // ∮F du = 2F_C(β − (F_C/σ) 2 tanh 2) and F = 0 after (F_C/σ) ln(1 + tanh 2).
    assert!((settled.area() - (3.0 - 1.5 * tanh2)).abs() < 1e-14);
    assert!((settled.lag() - 0.5 * tanh2.ln_1p()).abs() < 1e-15);
    // γ = 2: a root of a² + 2a/b = 1 with b = βσ/F_C = 4.
    let a = (1.0_f64 / 16.0 + 1.0).sqrt() - 0.25;
    assert!((dahl::Loop::new(&model(2.0), (-1.0, 1.0)).force_at_u_max - 0.75 * a).abs() < 1e-15);
    // γ = 0: the parallelogram of one Maxwell element, Δ = 1/2 m.
    let elastic = dahl::Loop::new(&model(0.0), (-1.0, 1.0));
    assert_eq!(elastic.force_at_u_max, 0.75);
    assert!((elastic.area() - 4.0 * 0.75 * 0.5).abs() < 1e-15);
    assert!((elastic.lag() - 0.5).abs() < 1e-15);
}

#[test]
fn small_loops_lose_the_third_power_of_their_width() {
    for gamma in [0.5, 1.0, 2.0, 3.0] {
        // a ≈ βσ/2F_C, area ≈ (F_C²/σ)(4/3)γa³.
        let beta = 1e-6;
        let area = dahl::Loop::new(&model(gamma), (0.0, beta)).area();
        let a: f64 = beta;
        let by_hand = 0.375 * 4.0 / 3.0 * gamma * a.powi(3);
        assert!(
            (area / by_hand - 1.0).abs() < 1e-10,
            "γ = {gamma}: {area:e} J, by hand {by_hand:e} J"
        );
    }
}

#[test]
fn first_period_work_is_the_sum_of_its_pieces() {
    let (dahl, input) = (model(1.0), Input::sine(1.0, 0.1).unwrap());
    let span = (0.0, input.period().unwrap());
    let up = dahl::advance(&dahl, 0.0, 1.0);
    let down = dahl::advance(&dahl, up, -2.0);
    let pieces =
        dahl::work(&dahl, 0.0, 1.0) + dahl::work(&dahl, up, -2.0) + dahl::work(&dahl, down, 1.0);
    assert!((dahl::work_over(&dahl, &input, 0.0, span) - pieces).abs() < 1e-14);
}

#[test]
fn the_reference_of_the_list_refuses_what_it_cannot_start_from() {
    let entry = REFERENCES.iter().find(|entry| entry.name == "dahl").unwrap();
    let parameters: Parameters =
        [("f_c", 0.75), ("sigma", 1.5), ("gamma", 1.0)].into_iter().collect();
    let input = Input::sine(1.0, 0.1).unwrap();
    let reference = (entry.build)(&parameters, &input, &[0.0], (0.0, 100.0)).unwrap();
    let mut force = [f64::NAN];
    reference.state(10.0, &mut force);
    assert!((force[0] - dahl::advance(&model(1.0), 0.0, 1.0_f64.sin())).abs() < 1e-15);
    assert!(reference.error_bound() < 1e-12, "{:e} N", reference.error_bound());
    assert!((entry.build)(&parameters, &input, &[], (0.0, 1.0)).is_err());
    assert!((entry.build)(&parameters, &input, &[f64::NAN], (0.0, 1.0)).is_err());
    assert!((entry.build)(&parameters, &input, &[0.0], (1.0, 1.0)).is_err());
    assert!((entry.build)(&Parameters::default(), &input, &[0.0], (0.0, 1.0)).is_err());
    assert!(REFERENCES.iter().all(|r| MODELS.iter().any(|m| m.name == r.name)));
}

proptest! {
    #[test]
    fn the_force_stays_within_f_c(
        gamma in 0.0..4.0_f64, part in -1.0..=1.0_f64, delta_u in -10.0..10.0_f64,
    ) {
        let force = dahl::advance(&model(gamma), 0.75 * part, delta_u);
        prop_assert!(force.abs() <= 0.75, "{} N", force);
    }

    #[test]
    fn the_closed_form_is_odd(
        gamma in 0.0..4.0_f64, force in -0.75..0.75_f64, delta_u in -10.0..10.0_f64,
    ) {
        let dahl = model(gamma);
        prop_assert_eq!(dahl::advance(&dahl, force, delta_u), -dahl::advance(&dahl, -force, -delta_u));
        prop_assert_eq!(dahl::work(&dahl, force, delta_u), dahl::work(&dahl, -force, -delta_u));
    }

    #[test]
    fn two_steps_are_one(
        gamma in 0.0..4.0_f64, force in -0.74..0.74_f64, first in 0.0..1.0_f64, second in 0.0..1.0_f64,
    ) {
        let dahl = model(gamma);
        let middle = dahl::advance(&dahl, force, first);
        let (twice, once) = (dahl::advance(&dahl, middle, second), dahl::advance(&dahl, force, first + second));
        prop_assert!((twice - once).abs() < 1e-14, "{} N and {} N", twice, once);
        let sum = dahl::work(&dahl, force, first) + dahl::work(&dahl, middle, second);
        let whole = dahl::work(&dahl, force, first + second);
        prop_assert!((sum - whole).abs() < 1e-14, "{} J and {} J", sum, whole);
    }

    #[test]
    fn travel_undoes_advance(gamma in 0.0..4.0_f64, from in -0.74..0.74_f64, to in -0.74..0.74_f64) {
        let dahl = model(gamma);
        let travel = dahl::travel(&dahl, from, to).unwrap();
        let there = dahl::advance(&dahl, from, travel);
        prop_assert!((there - to).abs() < 1e-13, "{} N, wanted {} N", there, to);
    }

    #[test]
    fn stretching_time_changes_nothing(gamma in 0.0..3.0_f64, stretch in 0.01..100.0_f64, phase in 0.0..3.0_f64) {
        let run = |omega: f64| {
            let input = Input::sine(1.0, omega).unwrap();
            let period = input.period().unwrap();
            let run = dahl::Trajectory::new(&model(gamma), &input, 0.0, (0.0, 4.0 * period)).unwrap();
            run.force(phase * period)
        };
        let (a, b) = (run(0.1), run(0.1 * stretch));
        prop_assert!((a - b).abs() < 1e-13, "{} N and {} N", a, b);
    }

    #[test]
    fn a_closed_loop_never_gains_energy(gamma in 0.0..4.0_f64, beta in 1e-6..20.0_f64) {
        let area = dahl::Loop::new(&model(gamma), (0.0, beta)).area();
        prop_assert!(area >= 0.0, "{} J", area);
    }

    #[test]
    fn the_error_bound_covers_a_change_of_the_last_digit_of_time(gamma in 0.0..3.0_f64, t in 0.0..300.0_f64) {
        let input = Input::sine(1.0, 0.1).unwrap();
        let run = dahl::Trajectory::new(&model(gamma), &input, 0.1, (0.0, 300.0)).unwrap();
        let off = (run.force(t.next_up()) - run.force(t.next_down())).abs();
        prop_assert!(off <= 2.0 * run.error_bound(), "{} N", off);
    }
}
