//! The inputs: values, corners, and what is refused.

use duhem::{Input, InputError};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn waves() -> [Input; 3] {
    [Input::sine(2.0, 0.1), Input::triangle(2.0, 0.1), Input::cosine_offset(2.0, 0.1)]
        .map(Result::unwrap)
}

/// The ends of the arcs of `input` over the span.
fn bounds(input: &Input, start: f64, end: f64) -> Vec<f64> {
    let inner = input.corners(start, end);
    [start].into_iter().chain(inner).chain([end]).collect()
}

/// u̇ on every arc has the sign of its way, also at its ends.
fn monotone(input: &Input, start: f64, end: f64) {
    for arc in bounds(input, start, end).windows(2) {
        let way = input.u(arc[1]) - input.u(arc[0]);
        for i in 0..=20 {
            let t = arc[0] + (arc[1] - arc[0]) * f64::from(i) / 20.0;
            let speed = input.u_dot_on(arc[0], arc[1], t);
            assert!(speed * way >= 0.0, "{input:?}: {speed} m/s at {t} s, way {way} m");
        }
    }
}

#[test]
fn every_wave_turns_at_its_corners_and_is_monotone_between_them() {
    for wave in waves() {
        let end = 5.0 * wave.period().unwrap();
        monotone(&wave, 0.0, end);
        let corners = wave.corners(0.0, end);
        assert!((9..=10).contains(&corners.len()), "{wave:?}: {} corners", corners.len());
        let (low, high) = wave.range();
        for t in corners {
            let off = (wave.u(t) - low).abs().min((wave.u(t) - high).abs());
            assert!(off < 1e-14, "{wave:?} is {off:e} m off its extreme at {t} s");
        }
    }
}

#[test]
fn the_waves_have_the_values_of_their_formulas() {
    let [sine, triangle, cosine] = waves();
    for t in [0.0, 3.0, 20.0, 47.0, 100.0] {
        assert!((sine.u(t) - 2.0 * (0.1 * t).sin()).abs() < 1e-15);
        assert!((cosine.u(t) - 2.0 * ((0.1 * t).cos() - 1.0)).abs() < 2e-15);
        assert!((triangle.u(t) - 4.0 / PI * (0.1 * t).sin().asin()).abs() < 1e-14);
    }
    assert!((sine.u_dot(10.0) - 0.2 * 1.0_f64.cos()).abs() < 1e-16);
    assert!((cosine.u_dot(10.0) + 0.2 * 1.0_f64.sin()).abs() < 1e-16);
    assert!((triangle.u_dot(10.0) - 0.4 / PI).abs() < 1e-16);
    assert_eq!(cosine.range(), (-4.0, 0.0));
    assert_eq!(sine.period(), Some(TAU / 0.1));
}

#[test]
fn a_corner_takes_the_velocity_on_its_right_and_an_arc_its_own() {
    let triangle = Input::triangle(2.0, 0.25 * TAU).unwrap();
    assert_eq!([triangle.u(1.0), triangle.u_dot(1.0)], [2.0, -2.0]);
    assert_eq!(triangle.corners(0.0, 4.0), [1.0, 3.0]);
    assert_eq!(triangle.u_dot_on(0.0, 1.0, 1.0), 2.0);
    assert_eq!(triangle.u_dot_on(1.0, 3.0, 1.0), -2.0);
}

#[test]
fn a_corner_that_rounding_moves_off_the_end_is_the_end() {
    let cosine = Input::cosine_offset(1.0, 0.1).unwrap();
    for periods in 1..200 {
        let end = f64::from(periods) * cosine.period().unwrap();
        assert_eq!(cosine.corners(0.0, end).len(), 2 * usize::try_from(periods).unwrap() - 1);
    }
}

#[test]
fn a_staircase_holds_and_ramps() {
    let stairs = Input::staircase(vec![0.0, 1.0, -1.0], 0.5, 2.0).unwrap();
    assert_eq!(
        [0.0, 1.0, 2.25, 3.0, 4.75, 9.0].map(|t| stairs.u(t)),
        [0.0, 0.0, 0.5, 1.0, 0.0, -1.0]
    );
    assert_eq!([1.0, 2.0, 2.5, 4.6, 9.0].map(|t| stairs.u_dot(t)), [0.0, 2.0, 0.0, -4.0, 0.0]);
    assert_eq!(stairs.corners(0.0, 10.0), [2.0, 2.5, 4.5, 5.0]);
    assert_eq!((stairs.range(), stairs.period()), ((-1.0, 1.0), None));
    monotone(&stairs, 0.0, 10.0);
}

#[test]
fn samples_are_joined_by_lines_and_the_ends_held() {
    let line = Input::sampled(vec![1.0, 2.0, 4.0, 6.0], vec![0.0, 2.0, 6.0, 4.0]).unwrap();
    assert_eq!([0.0, 1.5, 3.0, 5.0, 9.0].map(|t| line.u(t)), [0.0, 1.0, 4.0, 5.0, 4.0]);
    // At t = 2 s the slope does not change.
    assert_eq!(line.corners(0.0, 9.0), [1.0, 4.0, 6.0]);
    assert_eq!(line.range_on(0.0, 2.0), (0.0, 2.0));
    monotone(&line, 0.0, 9.0);
}

#[test]
fn a_sequence_runs_its_parts_in_their_own_time() {
    // Figure 7: the major loop for one and a half periods, then the minor one.
    let (large, small) = (Input::sine(0.025, 0.1).unwrap(), Input::sine(0.005, 0.1).unwrap());
    let (period, join) = (TAU / 0.1, 1.5 * TAU / 0.1);
    let input = Input::sequence(vec![(large, join), (small, 3.0 * period)]).unwrap();
    assert!((input.u(FRAC_PI_2 / 0.1) - 0.025).abs() < 1e-17);
    assert!((input.u(join + FRAC_PI_2 / 0.1) - 0.005).abs() < 1e-17);
    assert!(input.u(join).abs() < 1e-16);
    // Falling before the join, rising after it.
    assert!(input.u_dot_on(1.25 * period, join, join) < 0.0 && input.u_dot(join) > 0.0);
    assert_eq!(input.corners(0.0, 2.5 * period).len(), 3 + 1 + 2);
    assert_eq!((input.range(), input.period()), ((-0.025, 0.025), Some(period)));
    monotone(&input, 0.0, 4.0 * period);
}

#[test]
fn a_sequence_that_joins_at_a_turn_has_one_corner_there() {
    let up = Input::sine(1.0, 1.0).unwrap();
    let down = Input::cosine_offset(0.5, 1.0).unwrap();
    let from_one = Input::sampled(vec![0.0, 1.0], vec![1.0, 2.0]).unwrap();
    let input = Input::sequence(vec![(up, FRAC_PI_2), (from_one, 5.0)]).unwrap();
    assert_eq!(input.corners(0.0, 9.0), [FRAC_PI_2, FRAC_PI_2 + 1.0]);
    let input = Input::sequence(vec![(down.clone(), TAU), (down, TAU)]).unwrap();
    assert_eq!(input.corners(0.0, 2.0 * TAU), [PI, TAU, TAU + PI]);
}

#[test]
fn a_sequence_that_jumps_is_refused_with_both_values() {
    let sine = Input::sine(1.0, 1.0).unwrap();
    let refused = Input::sequence(vec![(sine.clone(), 1.0), (sine, 1.0)]).unwrap_err();
    assert!(matches!(refused, InputError::Jump { index: 1, found: 0.0, .. }), "{refused}");
    assert!(refused.to_string().contains("0.84147"), "{refused}");
}

#[test]
fn hostile_numbers_are_refused_with_their_key() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let message = Input::sine(bad, 1.0).unwrap_err().to_string();
        assert!(message.starts_with("amplitude = "), "{message}");
        let message = Input::triangle(1.0, bad).unwrap_err().to_string();
        assert!(message.starts_with("omega = "), "{message}");
        assert!(Input::staircase(vec![0.0, 1.0], bad, 1.0).is_err());
        let sine = Input::sine(1.0, 1.0).unwrap();
        assert!(Input::sequence(vec![(sine, bad)]).is_err());
    }
    assert!(Input::sequence(vec![]).is_err());
    assert!(Input::staircase(vec![], 1.0, 1.0).is_err());
    assert!(Input::staircase(vec![f64::NAN], 1.0, 1.0).is_err());
    assert!(Input::sampled(vec![0.0], vec![0.0]).is_err());
    assert!(Input::sampled(vec![0.0, 1.0], vec![0.0]).is_err());
    let refused = Input::sampled(vec![0.0, 1.0, 1.0], vec![0.0; 3]).unwrap_err();
    assert!(matches!(refused, InputError::Order { index: 2, .. }), "{refused}");
}

#[test]
fn many_displacements_at_once_are_those_one_by_one() {
    let [sine, triangle, cosine] = waves();
    let samples = (vec![0.0, 7.0, 9.0, 30.0], vec![0.0, 1.5, -0.5, 0.0]);
    let sampled = Input::sampled(samples.0.clone(), samples.1.clone()).unwrap();
    let polyline = Input::polyline(samples.0, samples.1).unwrap();
    let parts = [&sine, &triangle, &sampled].map(|part| (part.clone(), 20.0 * PI));
    let late = Input::sequence(parts.to_vec()).unwrap();
    for input in [sine, triangle, cosine, sampled, polyline, late] {
        let times: Vec<f64> = (0..2000).map(|i| -20.0 + 0.137 * f64::from(i)).collect();
        let mut u = times.clone();
        input.displace(&mut u);
        let off = times.iter().zip(&u).map(|(t, u)| (input.u(*t) - u).abs()).fold(0.0, f64::max);
        assert!(off < 2e-15, "{input:?} is off by {off:e} m");
        // What the others are asked does not matter.
        let mut alone = [times[777]];
        input.displace(&mut alone);
        assert_eq!(alone[0], u[777]);
    }
}

#[test]
fn only_straight_pieces_are_of_constant_speed() {
    let [sine, triangle, cosine] = waves();
    let stairs = Input::staircase(vec![0.0, 1.0], 1.0, 2.0).unwrap();
    assert!(triangle.piecewise_linear() && stairs.piecewise_linear());
    assert!(!sine.piecewise_linear() && !cosine.piecewise_linear());
    let both = |last| Input::sequence(vec![(triangle.clone(), 20.0 * PI), (last, 1.0)]).unwrap();
    assert!(both(triangle.clone()).piecewise_linear() && !both(sine.clone()).piecewise_linear());
}
