//! The Maxwell-slip closed form.

use duhem::{
    Dahl, FrictionModel, Input, MaxwellSlip,
    closed_form::{
        Reference, dahl,
        maxwell_slip::{
            Loop, Play, Trajectory, dissipation_as_printed, saturation_force, stop, work,
        },
    },
    measures::{self, Memory, Orientation},
};
use proptest::prelude::*;

/// Figure 6a.
fn two() -> MaxwellSlip {
    MaxwellSlip { k: vec![2.0, 3.0], delta: vec![2.5e-3, 15e-3] }
}

/// Figure 6b.
fn ten() -> MaxwellSlip {
    let delta = [1.5, 2.4, 3.3, 4.2, 5.1, 6.0, 6.9, 7.8, 8.7, 9.6];
    let k = [1.0, 1.8, 2.6, 3.4, 4.2, 5.0, 5.8, 6.6, 7.4, 8.2];
    MaxwellSlip { k: k.to_vec(), delta: delta.iter().map(|d| d * 1e-3).collect() }
}

fn rest(model: &MaxwellSlip) -> Vec<f64> {
    vec![0.0; model.k.len()]
}

#[test]
fn one_element_is_the_dahl_model_with_gamma_zero() {
    let element = MaxwellSlip { k: vec![2.0], delta: vec![0.25] };
    let twin = Dahl { f_c: 0.5, sigma: 2.0, gamma: 0.0 };
    let input = Input::sine(1.0, 0.1).unwrap();
    let a = Trajectory::new(&element, &input, &[0.0], (0.0, 200.0)).unwrap();
    let b = dahl::Trajectory::new(&twin, &input, 0.0, (0.0, 200.0)).unwrap();
    for i in 0..=1000 {
        let t = 0.2 * f64::from(i);
        let off = (a.force(t) - b.force(t)).abs();
        assert!(off < 1e-14, "off by {off:e} N at {t} s");
    }
}

#[test]
fn elements_that_slip_together_stop_and_start_together() {
    let model = MaxwellSlip { k: vec![1.0, 2.0, 3.0], delta: vec![0.3, 0.3, 0.3] };
    let input = Input::triangle(1.0, 1.0).unwrap();
    let run = Trajectory::new(&model, &input, &rest(&model), (0.0, 20.0)).unwrap();
    for i in 0..400 {
        let z = run.deflections(0.05 * f64::from(i));
        assert!(z[0] == z[1] && z[1] == z[2], "{z:?}");
    }
    let settled = Loop::new(&model, (-1.0, 1.0), 0.0, &rest(&model));
    // Three corners: the turn, one common slip, the turn.
    assert_eq!(settled.corners(true).len(), 3);
    assert!((settled.area() - 4.0 * 6.0 * 0.3 * 0.7).abs() < 1e-15);
}

#[test]
fn a_turn_exactly_at_break_away_slips_neither_before_nor_after() {
    let model = MaxwellSlip { k: vec![2.0], delta: vec![0.5] };
    let settled = Loop::new(&model, (-0.5, 0.5), 0.0, &[0.0]);
    assert_eq!((settled.area(), settled.force_at_u_max()), (0.0, 1.0));
    assert_eq!(settled.zero_force(true), Some(0.0));
}

#[test]
fn figure_6b_by_hand() {
    let model = ten();
    let settled = Loop::new(&model, (-0.01, 0.01), 0.0, &rest(&model));
    let by_hand: f64 =
        model.k.iter().zip(&model.delta).map(|(k, d)| 4.0 * k * d * (0.01 - d)).sum();
    assert!((settled.area() - by_hand).abs() < 1e-17, "{} J", settled.area());
    assert!((settled.force_at_u_max() - saturation_force(&model)).abs() < 1e-15);
    assert!((dissipation_as_printed(&model) - 2.4e-3).abs() < 0.05e-3);
    // The polygon through the corners encloses the same.
    let mut polygon = settled.corners(true);
    polygon.extend(settled.corners(false));
    let (u, f): (Vec<f64>, Vec<f64>) = polygon.into_iter().unzip();
    assert!((measures::area(&u, &f).value - by_hand).abs() < 1e-17);
    assert_eq!(measures::orientation(&u, &f), Orientation::Clockwise);
    assert!(
        (measures::width_at_zero_force(&u, &f).unwrap() - settled.width().unwrap()).abs() < 1e-16
    );
    assert!((settled.lag().unwrap() - (0.01 - settled.zero_force(false).unwrap())).abs() < 1e-17);
}

#[test]
fn an_element_with_half_the_width_in_its_deadband_does_not_slip_in_the_settled_loop() {
    // Figure 6a at the caption's 0.01 m: 15 mm never slip.
    let settled = Loop::new(&two(), (-0.01, 0.01), 0.0, &[0.0, 0.0]);
    assert!((settled.area() - 4.0 * 2.0 * 2.5e-3 * 7.5e-3).abs() < 1e-18);
    assert!((settled.force_at_u_max() - (2.0 * 2.5e-3 + 3.0 * 0.01)).abs() < 1e-16);
}

#[test]
fn the_minor_loops_of_figure_7_remember_where_they_came_from() {
    let (large, small) = (Input::sine(0.025, 0.1).unwrap(), Input::sine(0.005, 0.1).unwrap());
    let period = large.period().unwrap();
    let after = |periods: f64| {
        let join = periods * period;
        let input = Input::sequence(vec![(large.clone(), join), (small.clone(), period)]).unwrap();
        let end = join + 2.0 * period;
        let run = Trajectory::new(&two(), &input, &[0.0, 0.0], (0.0, end)).unwrap();
        let mut x = [0.0; 2];
        run.state(join, &mut x);
        let settled = Loop::new(&two(), (-0.005, 0.005), 0.0, &x);
        let off = (run.force(end - 0.75 * period) - settled.force_at_u_max()).abs();
        assert!(off < 1e-15, "off by {off:e} N");
        settled
    };
    let (upper, lower) = (after(1.0), after(1.5));
    // The first element forgets, ±2 · 2.5 mN; the second keeps 3 · (±10 ± 5) mN.
    let corners = |l: &Loop| [l.force(0.005, true), l.force(-0.005, true)];
    for (found, by_hand) in [(corners(&upper), [0.05, 0.01]), (corners(&lower), [-0.01, -0.05])] {
        assert!((found[0] - by_hand[0]).abs() + (found[1] - by_hand[1]).abs() < 1e-15, "{found:?}");
    }
    assert!((upper.area() - lower.area()).abs() < 1e-18);
    assert_eq!(upper.zero_force(false), None);
    let sampled = |l: &Loop| [l.force(0.0, true), l.force(0.0, false)];
    assert_eq!(measures::memory(&sampled(&upper), &sampled(&lower), 1e-9), Memory::Nonlocal);
}

#[test]
fn the_reference_solves_equation_24() {
    let (model, input) = (ten(), Input::sine(0.01, 0.1).unwrap());
    let span = (0.0, 130.0);
    let run = Trajectory::new(&model, &input, &rest(&model), span).unwrap();
    let (mut x, mut x_dot) = (rest(&model), rest(&model));
    let n = 400_000;
    let h = span.1 / f64::from(n);
    let mut worst: f64 = 0.0;
    for i in 0..n {
        let t = h * f64::from(i);
        let (u, u_dot) = (input.u(t), (input.u(t + h) - input.u(t)) / h);
        let mut exact = rest(&model);
        run.state(t, &mut exact);
        let off = x.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        worst = worst.max(off);
        model.x_dot(&x, u, u_dot, &mut x_dot);
        x.iter_mut().zip(&x_dot).for_each(|(x, x_dot)| *x += h * x_dot);
    }
    // Explicit Euler overshoots each break-away by less than one step, and then never corrects it.
    assert!(worst < 3.0 * 0.001 * h, "off by {worst:.1e} m, step {:.1e} m", 0.001 * h);
    assert!(run.error_bound() < 1e-15);
}

proptest! {
    #[test]
    fn the_force_is_bounded_odd_and_blind_to_the_step(
        x0 in -2e-3..2e-3_f64, way in -0.05..0.05_f64, part in 0.0..1.0_f64,
    ) {
        let model = ten();
        for delta in &model.delta {
            let whole = stop(x0, way, *delta);
            prop_assert!(whole.abs() <= delta.max(x0.abs()));
            prop_assert_eq!(whole, -stop(-x0, -way, *delta));
            let twice = stop(stop(x0, part * way, *delta), (1.0 - part) * way, *delta);
            prop_assert!((twice - whole).abs() < 1e-16, "{} and {} m", twice, whole);
        }
    }

    #[test]
    fn stretching_time_changes_nothing(stretch in 0.01..100.0_f64, phase in 0.0..3.0_f64) {
        let run = |omega: f64| {
            let input = Input::sine(0.01, omega).unwrap();
            let period = input.period().unwrap();
            Trajectory::new(&ten(), &input, &rest(&ten()), (0.0, 4.0 * period)).unwrap().force(phase * period)
        };
        let (a, b) = (run(0.1), run(0.1 * stretch));
        prop_assert!((a - b).abs() < 1e-14, "{} N and {} N", a, b);
    }

    #[test]
    fn work_is_the_loops_area_over_a_settled_period_and_never_negative(beta in 1e-4..0.05_f64) {
        let model = ten();
        let settled = Loop::new(&model, (0.0, beta), 0.0, &rest(&model));
        let cycle = work(&model, &settled.z_at_u_min, beta) + work(&model, &settled.z_at_u_max, -beta);
        // Rounding, relative to the work of all elements slipping all the way.
        let most: f64 = model.k.iter().zip(&model.delta).map(|(k, delta)| 2.0 * k * delta * beta).sum();
        let error = (cycle - settled.area()).abs();
        prop_assert!(error < 8.0 * f64::EPSILON * most, "{} J and {} J", cycle, settled.area());
        prop_assert!(settled.area() >= 0.0);
    }
}

proptest! {
    /// The play operator and the stop operator are one, also where an element starts beyond its deadband.
    #[test]
    fn the_positions_are_where_the_deflections_put_them(
        x0 in prop::collection::vec(-0.05..0.05, 10),
        turns in prop::collection::vec(-0.03..0.03, 2..8),
    ) {
        let model = ten();
        let mut play = Play::new(&model, &x0);
        let mut z: Vec<f64> = x0.iter().map(|x| turns[0] - x).collect();
        for way in turns.windows(2) {
            play.turn(way[0], way[1] >= way[0]);
            let u = [0.0, 0.3, 0.9, 1.0].map(|part| way[0] + part * (way[1] - way[0]));
            let mut x = [f64::NAN; 40];
            play.positions(&u, &mut x);
            play.stop_at(way[1]);
            for (u, x) in u.iter().zip(x.chunks_exact(10)) {
                for (i, x) in x.iter().enumerate() {
                    let expected = u - stop(z[i], u - way[0], model.delta[i]);
                    prop_assert!((x - expected).abs() < 1e-16 * 64.0, "{x} m, expected {expected} m");
                }
            }
            for (z, delta) in z.iter_mut().zip(&model.delta) {
                *z = stop(*z, way[1] - way[0], *delta);
            }
        }
    }
}
