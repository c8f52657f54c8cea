//! The second ways against the closed forms: LuGre by Runge-Kutta steps, Maxwell-slip by Masing's rule.

use duhem::{
    FrictionModel, Input, LuGre, MaxwellSlip,
    closed_form::{
        lugre::{self, second_way},
        masing,
        maxwell_slip::{self, Trajectory},
    },
};
use proptest::prelude::*;

fn lugre_of_the_paper() -> LuGre {
    LuGre { f_c: 1.0, f_s: 1.5, v_s: 0.001, sigma_0: 1e5, sigma_1: 1e5_f64.sqrt(), sigma_2: 0.4 }
}

fn ten() -> MaxwellSlip {
    let delta = [1.5, 2.4, 3.3, 4.2, 5.1, 6.0, 6.9, 7.8, 8.7, 9.6];
    let k = [1.0, 1.8, 2.6, 3.4, 4.2, 5.0, 5.8, 6.6, 7.4, 8.2];
    MaxwellSlip { k: k.to_vec(), delta: delta.iter().map(|d| d * 1e-3).collect() }
}

#[track_caller]
fn near(a: f64, b: f64, relative: f64, what: &str) {
    assert!((a - b).abs() <= relative * a.abs().max(b.abs()), "{what}: {a:e} and {b:e}");
}

#[test]
fn lugre_s_loops_agree_with_runge_kutta() {
    let model = lugre_of_the_paper();
    for input in [
        Input::sine(1e-4, 10.0).unwrap(),
        Input::sine(1e-4, 0.1).unwrap(),
        Input::triangle(1e-4, 5.0).unwrap(),
        Input::polyline(vec![0.0, 5e-5, 15.0, 25.0], vec![0.0, 5e-5, -1e-4, 0.0]).unwrap(),
    ] {
        let period = input.period().unwrap();
        let ours = lugre::settled(&model, &input).unwrap();
        let second = second_way::Path::settled(&model, &input, period);
        near(ours.work(), second.work, 1e-10, "area [J]");
        near(ours.largest_force(), second.largest_force(), 1e-11, "largest force [N]");
        let first = lugre::Trajectory::new(&model, &input, 0.0, (0.0, period)).unwrap();
        let again = second_way::Path::new(&model, &input, 0.0, (0.0, period));
        near(first.work(), again.work, 1e-10, "work from rest [J]");
    }
}

#[test]
fn the_work_at_constant_speed_is_the_sum_of_small_works() {
    let model = lugre_of_the_paper();
    let (n, way, speed) = (200_000, -8e-5, -2e-3);
    let whole = lugre::work(&model, 1.2e-5, way, speed);
    let force = |i: i32| {
        let x = [lugre::advance(&model, 1.2e-5, way * f64::from(i) / f64::from(n), speed)];
        let mut x_dot = [0.0];
        model.x_dot(&x, 0.0, speed, &mut x_dot);
        model.force(&x, &x_dot, 0.0, speed)
    };
    let sum: f64 = (0..n).map(|i| 0.5 * (force(i) + force(i + 1)) * way / f64::from(n)).sum();
    near(whole, sum, 1e-8, "work [J]");
}

#[test]
fn the_steady_curve_agrees_with_lambert_s_w_and_with_motion_at_constant_speed() {
    let model = lugre_of_the_paper();
    let (ours, second) =
        (lugre::steady_extrema(&model).unwrap(), second_way::steady_extrema(&model));
    near(ours.maximum, second.0, 1e-12, "speed of the maximum [m/s]");
    near(ours.minimum, second.1, 1e-12, "speed of the minimum [m/s]");
    for v in [1e-7, 1e-3, -2e-3, 0.1] {
        let second = second_way::steady_force(&model, v);
        near(model.steady_force(v), second, 1e-12, "steady force [N]");
    }
}

#[test]
fn the_speed_above_which_energy_can_come_back_agrees_with_the_smallest_dissipation() {
    let model = lugre_of_the_paper();
    let most = model.f_s / model.sigma_0;
    let ours = lugre::returning_speed(&model).unwrap();
    let second = second_way::returning_speed(&model, most, 1.0).unwrap();
    near(ours, second, 1e-10, "speed [m/s]");
    let any = lugre::dissipative_speed(&model);
    near(
        any,
        second_way::returning_speed(&model, 1e-3, 1.0).unwrap(),
        1e-7,
        "speed for any x [m/s]",
    );
    assert!(any < ours, "{any} and {ours} m/s");
    // Without a Stribeck effect motion from rest gives nothing back, at no speed.
    let flat = LuGre { f_s: 1.0, ..model };
    assert_eq!(lugre::returning_speed(&flat), None);
    assert_eq!(second_way::returning_speed(&flat, 1e-5, 1e3), None);
}

#[test]
fn a_repeated_polyline_is_its_first_period_again_and_turns_where_it_turns() {
    let input = Input::polyline(vec![1.0, 2.0, 4.0, 5.0], vec![0.0, 1.0, 1.0, 0.0]).unwrap();
    assert_eq!((input.period(), input.range()), (Some(4.0), (0.0, 1.0)));
    for t in [1.0, 1.25, 3.0, 4.5] {
        for copy in [-2.0, 1.0, 7.0] {
            assert_eq!(input.u(t + 4.0 * copy), input.u(t), "t = {t} s");
            assert_eq!(input.u_dot(t + 4.0 * copy), input.u_dot(t), "t = {t} s");
        }
    }
    assert_eq!(input.corners(0.0, 7.0), [1.0, 2.0, 4.0, 5.0, 6.0]);
    // A joint that does not bend is no corner.
    let bent_once = Input::polyline(vec![0.0, 1.0, 3.0, 4.0], vec![0.0, 1.0, -1.0, 0.0]).unwrap();
    assert_eq!(bent_once.corners(-0.5, 8.5), [1.0, 3.0, 5.0, 7.0]);
    assert!(Input::polyline(vec![0.0, 1.0], vec![0.0, 1.0]).is_err(), "an open period");
    assert!(Input::polyline(vec![0.0], vec![0.0]).is_err());
}

#[test]
fn maxwell_slip_agrees_with_masing_on_the_loops_of_figure_6() {
    let model = ten();
    let settled = maxwell_slip::Loop::new(&model, (-0.01, 0.01), 0.0, &[0.0; 10]);
    near(settled.area(), masing::area(&model, 0.02), 1e-13, "area [J]");
    near(settled.lag().unwrap(), masing::lag(&model, 0.02), 1e-12, "lag [m]");
    near(settled.force_at_u_max(), masing::virgin(&model, 0.01), 1e-13, "force at the turn [N]");
    near(settled.returned(), maxwell_slip::dissipation_as_printed(&model), 1e-13, "given back [J]");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_play_and_stop_elements_are_one_masing_memory(
        turns in proptest::collection::vec(-0.015..0.015_f64, 1..12),
    ) {
        let model = ten();
        let t: Vec<f64> = (0..=turns.len()).map(|i| i as f64).collect();
        let u: Vec<f64> = std::iter::once(0.0).chain(turns.iter().copied()).collect();
        let end = turns.len() as f64;
        let input = Input::sampled(t, u.clone()).unwrap();
        let run = Trajectory::new(&model, &input, &[0.0; 10], (0.0, end)).unwrap();
        let (ours, second) = (run.force(end), masing::force(&model, &u));
        prop_assert!((ours - second).abs() < 1e-14, "{} and {} N after {:?}", ours, second, u);
        let (ours, second) = (run.work(), masing::work(&model, &u));
        prop_assert!((ours - second).abs() < 1e-15, "{} and {} J after {:?}", ours, second, u);
    }
}
