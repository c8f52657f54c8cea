//! The anchors are the problems of the statement, their answers have two parents, and a wrong answer is
//! never timed.

use duhem::Parameter;
use integrate::{Limits, Outcome, Work};
use simulation::anchors::{
    Anchor, AnswerError, Contest, Row, RowControl, Timing, Verified, anchors, answer, contestants,
    error, run, table,
};
use simulation::{Delivered, Method, Own, Solves};
use std::f64::consts::PI;

fn anchor(problem: &str, parameter: Option<f64>) -> Anchor {
    let all = anchors().expect("the anchors");
    let found = all.into_iter().find(|a| a.problem == problem && a.parameter == parameter);
    found.expect("an anchor")
}

#[test]
fn there_are_twelve_anchors_on_their_grids() {
    let all = anchors().unwrap();
    let told: Vec<_> = all.iter().map(|a| (a.problem, a.parameter, a.grid.len())).collect();
    let p1 = [0.0, 0.25, 1.0, 2.0].map(|gamma| ("P1", Some(gamma), 601));
    let p2 = [10.0, 5.0, 1.0, 0.1].map(|omega| ("P2", Some(omega), 601));
    let rest = [("P3", None, 601), ("P4", None, 6284), ("P5", None, 6284), ("P6", None, 5001)];
    assert_eq!(told, [&p1[..], &p2, &rest].concat());
    for anchor in &all {
        assert_eq!(anchor.grid[0], 0.0);
        assert_eq!(anchor.grid.last(), Some(&anchor.task.span.1), "{}", anchor.problem);
        assert!(anchor.task.y0.iter().all(|y| *y == 0.0), "{} starts at rest", anchor.problem);
        let spacing = anchor.task.span.1 / (anchor.grid.len() - 1) as f64;
        assert!(anchor.grid.windows(2).all(|w| (w[1] - w[0] - spacing).abs() < 1e-9 * spacing));
    }
}

/// The right-hand side in the words of the statement, at a state no solution visits, so that every term
/// counts.
#[test]
fn the_right_hand_sides_are_those_of_the_statement() {
    let slope = |anchor: &Anchor, t: f64, y: &[f64]| {
        let mut dy = vec![0.0; y.len()];
        anchor.task.motion().unwrap().derivative(t, y, None, &mut dy);
        dy
    };
    let near = |found: f64, expected: f64, what: &str| {
        let apart = (found - expected).abs() / expected.abs();
        assert!(apart < 1e-13, "{what}: {found} instead of {expected}");
    };
    let t = 3.0_f64;
    // P1: Ḟ = σ |1 − s F/F_C|^γ sgn(1 − s F/F_C) u̇ with u̇ = 0.1 cos 0.1t.
    let u_dot = 0.1 * (0.1 * t).cos();
    for gamma in [0.0, 0.25, 1.0, 2.0] {
        let expected = 1.5 * (1.0 - 0.3 / 0.75_f64).powf(gamma) * u_dot;
        near(slope(&anchor("P1", Some(gamma)), t, &[0.3])[0], expected, "P1");
    }
    // P2: ẋ = v − |v|/r x, r = (F_C + (F_S − F_C) e^(−(v/v_S)²))/σ₀.
    let bristle = |v: f64, x: f64, (f_c, f_s, sigma_0): (f64, f64, f64)| {
        let r = (f_c + (f_s - f_c) * (-(v / 1e-3_f64).powi(2)).exp()) / sigma_0;
        v - v.abs() / r * x
    };
    for omega in [10.0, 5.0, 1.0, 0.1] {
        let v = 1e-4 * omega * (omega * t).cos();
        let expected = bristle(v, 4e-6, (1.0, 1.5, 1e5));
        near(slope(&anchor("P2", Some(omega)), t, &[4e-6])[0], expected, "P2");
    }
    // P3: element i of stiffness 1 + 0.8i and deadband 1.5e-3 + 0.9e-3 i slips where it is held.
    let p3 = anchor("P3", None);
    let (k, delta) = (&p3.task.parameters.0["k"], &p3.task.parameters.0["delta"]);
    let (Parameter::List(k), Parameter::List(delta)) = (k, delta) else { panic!("no lists") };
    for i in 0..10 {
        near(k[i], 1.0 + 0.8 * i as f64, "k");
        near(delta[i], 1.5e-3 + 0.9e-3 * i as f64, "Δ");
    }
    // u = 0.01 sin 0.3 = 2.955e-3: from x = 0 the first two are deflected by more than Δ, and rise.
    let rates = slope(&p3, t, &[0.0; 10]);
    assert_eq!(rates.iter().filter(|rate| **rate > 0.0).count(), 2, "{rates:?}");
    near(rates[0], 0.001 * (0.1 * t).cos(), "P3");
    // P4: q̈ = 5 sin 0.001t − 1.5q − F.
    let p4 = slope(&anchor("P4", None), t, &[0.2, 0.4, 0.3]);
    near(p4[1], 5.0 * (0.001 * t).sin() - 1.5 * 0.2 - 0.3, "P4 q̈");
    near(p4[2], 7.5 * 0.4 * (1.0 - 0.3 / 0.75), "P4 Ḟ");
    // P5: q̈ = 10 sin 0.001t − 2q − F, P6: I θ̈ = 16.5 · 0.05 sin 0.2πt − F − 4r²θ.
    let (v, x) = (2e-3, 5e-6);
    let x_dot = bristle(v, x, (1.0, 1.5, 1e5));
    let force = 1e5 * x + 1e5_f64.sqrt() * x_dot + 0.4 * v;
    let p5 = slope(&anchor("P5", None), t, &[0.2, v, x]);
    near(p5[1], 10.0 * (0.001 * t).sin() - 2.0 * 0.2 - force, "P5 q̈");
    near(p5[2], x_dot, "P5 ẋ");
    let x_dot = bristle(v, 4e-4, (0.6, 1.0, 1e3));
    let force = 1e3 * 4e-4 + 1e3_f64.sqrt() * x_dot + 1.3 * v;
    let drive = 16.5 * 0.05 * (0.2 * PI * t).sin();
    let p6 = slope(&anchor("P6", None), t, &[0.1, v, 4e-4]);
    near(p6[1], (drive - force - 4.0 * 0.0254_f64.powi(2) * 0.1) / 3e-4, "P6 θ̈");
}

/// Values of `ref.cpp` in the folder of the peers: RKF7(8) in 80 bits, restarted at every reversal.
#[test]
fn the_answers_are_those_of_an_independent_method_in_long_arithmetic() {
    let known = [
        ("P2", Some(10.0), 1, 0.518_723_763_044_138_4),
        ("P2", Some(10.0), 4, 0.883_260_950_468_215),
        ("P2", Some(1.0), 3, 0.715_189_276_934_075),
        ("P2", Some(0.1), 4, 0.850_903_578_851_950_9),
    ];
    for (problem, parameter, i, expected) in known {
        let answer = answer(&anchor(problem, parameter)).unwrap();
        let apart = (answer.values[i] - expected).abs();
        assert!(apart < 1e-13, "{problem} {parameter:?}: {apart:.1e} N at point {i}");
        assert!(answer.error.unwrap() < 1e-11, "{answer:?}");
    }
    // P1, γ = 1, first quarter: F = F_C (1 − e^(−σu/F_C)). γ = 0: F = min(σu, F_C).
    let u = (0.1_f64 * 0.1 * PI * 20.0).sin();
    let gamma_1 = answer(&anchor("P1", Some(1.0))).unwrap();
    assert!((gamma_1.values[20] - 0.75 * (1.0 - (-1.5 * u / 0.75_f64).exp())).abs() < 1e-14);
    let gamma_0 = answer(&anchor("P1", Some(0.0))).unwrap();
    assert!((gamma_0.values[10] - 1.5 * (0.1 * PI).sin()).abs() < 1e-14);
    assert_eq!(gamma_0.values[45], 0.75);
    // P3, first quarter: each element holds k_i min(u, Δ_i).
    let p3 = answer(&anchor("P3", None)).unwrap();
    let u = 0.01 * (0.1 * p3_time(30)).sin();
    let held = (0..10).map(|i| {
        let i = f64::from(i);
        (1.0 + 0.8 * i) * u.min(1.5e-3 + 0.9e-3 * i)
    });
    assert!((p3.values[30] - held.sum::<f64>()).abs() < 1e-14);
}

/// The statement's own recursion, all 601 points: from turn to turn w = 1 − sF/F_C with
/// w^(1−γ) = w₀^(1−γ) − (1−γ) σ|Δu|/F_C.
#[test]
fn the_answers_of_dahl_are_those_of_the_recursion_in_w() {
    for gamma in [0.0, 0.25, 1.0, 2.0_f64] {
        let anchor = anchor("P1", Some(gamma));
        let answer = answer(&anchor).unwrap();
        let advance = |force: f64, from: f64, to: f64| {
            let (s, way) = ((to - from).signum(), (to - from).abs() * 1.5 / 0.75);
            let w = 1.0 - s * force / 0.75;
            let w = if gamma == 1.0 {
                w * (-way).exp()
            } else {
                let z = w.powf(1.0 - gamma) - (1.0 - gamma) * way;
                (if gamma < 1.0 { z.max(0.0) } else { z }).powf(1.0 / (1.0 - gamma))
            };
            s * 0.75 * (1.0 - w)
        };
        // u, F at the last turn; the turns are points 50, 150, …, where u = ±1.
        let (mut turn, mut force) = (0.0, 0.0);
        let u = |i: usize| (0.1 * anchor.grid[i]).sin();
        let mut worst = 0.0_f64;
        for i in 1..=600 {
            worst = worst.max((answer.values[i] - advance(force, turn, u(i))).abs());
            if i % 100 == 50 {
                (force, turn) = (advance(force, turn, u(i)), u(i));
            }
        }
        assert!(worst < 1e-13, "γ = {gamma}: {worst:.1e} N apart");
    }
}

/// x_i is drawn along by the band u ± Δ_i, all 601 points.
#[test]
fn the_answers_of_maxwell_slip_are_those_of_the_clipped_positions() {
    let anchor = anchor("P3", None);
    let answer = answer(&anchor).unwrap();
    let mut x = [0.0_f64; 10];
    let mut worst = 0.0_f64;
    for (i, t) in anchor.grid.iter().enumerate() {
        let u = 0.01 * (0.1 * t).sin();
        let mut force = 0.0;
        for (j, x) in x.iter_mut().enumerate() {
            let (k, delta) = (1.0 + 0.8 * j as f64, 1.5e-3 + 0.9e-3 * j as f64);
            *x = x.clamp(u - delta, u + delta);
            force += k * (u - *x);
        }
        worst = worst.max((answer.values[i] - force).abs());
    }
    assert!(worst < 1e-14, "{worst:.1e} N apart");
}

/// Displacements [m] at points of the grid.
const P4_END: [(usize, f64); 3] =
    [(1000, 2.305_177_419_646_976), (3141, 0.501_644_243_058_042), (6283, -0.500_009_706_852_356)];
const P5_END: [(usize, f64); 3] =
    [(1000, 3.750_147_797_576_227), (3141, 0.403_669_945_470_826), (6283, -0.417_881_796_468_142)];

fn p3_time(i: usize) -> f64 {
    anchor("P3", None).grid[i]
}

/// Further values of `ref.cpp`; the error of ours is what the two ways differ by.
#[test]
fn the_plants_have_two_ways_that_agree_with_the_long_arithmetic() {
    let ends = [("P4", P4_END, 1e-10, 1e-10), ("P5", P5_END, 1e-10, 1e-8)];
    for (problem, expected, allowed, stated) in ends {
        let answer = answer(&anchor(problem, None)).unwrap();
        for (i, expected) in expected {
            let apart = (answer.values[i] - expected).abs();
            assert!(apart < allowed, "{problem}: {apart:.1e} m at point {i}");
        }
        assert!(answer.error.unwrap() < stated, "{problem}: the ways differ by {:?}", answer.error);
    }
    let p6 = anchor("P6", None);
    let answer = answer(&p6).unwrap();
    for (i, expected) in [(1, 7.124_209_361_175_932e-7), (4, 8.768_752_196_050_034e-6)] {
        let apart = (answer.values[i] - expected).abs();
        assert!(apart < 1e-12, "{apart:.1e} rad at point {i}");
    }
    assert!(answer.error.unwrap() < 1e-7, "the two ways differ by {:?}", answer.error);
}

#[test]
fn an_error_is_relative_to_the_largest_and_a_hole_is_not_a_number() {
    assert_eq!(error(&[1.0, 2.5], &[1.0, -2.0]), 2.25);
    assert!(error(&[f64::NAN, 2.0], &[1.0, 2.0]).is_nan());
    assert!(error(&[1.0, 2.0, f64::NAN], &[0.0, 2.0, 1.0]).is_nan());
}

#[test]
fn a_table_of_another_grid_is_refused_with_its_line() {
    let p2 = anchor("P2", Some(1.0));
    let line = |(i, t): (usize, &f64)| format!("{t:.17} {i} 0\n");
    let right: String = p2.grid.iter().enumerate().map(line).collect();
    let read = table(&p2, &right).unwrap();
    assert_eq!((read.values[0], read.values[600]), (0.0, 600.0));
    let refused = |text: &str| match table(&p2, text) {
        Err(AnswerError::Table { line, .. }) => line,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(&right.replacen(" 7 ", " x ", 1)), 8);
    assert_eq!(refused(&right.replacen(" 7 ", " NaN ", 1)), 8);
    assert_eq!(refused(&right.replacen("0.00000000000000000 0", "0.1 0", 1)), 1);
    assert_eq!(refused("0 1 2\n"), 1);
    assert_eq!(refused(""), 0);
}

/// A clock that is a second later at each look.
fn ticking() -> impl FnMut() -> f64 {
    let mut now = 0.0;
    move || {
        now += 1.0;
        now
    }
}

fn small(rtols: &[f64], evaluations: u64) -> Contest {
    let timing = Timing { least: 2, most: 4, share_s: 2.5, batch_s: 1.0 };
    Contest { rtols: rtols.to_vec(), limits: Limits { evaluations }, timing }
}

#[test]
fn every_method_is_looked_at_and_only_a_right_answer_is_timed() {
    let p1 = anchor("P1", Some(1.0));
    let reference = answer(&p1).unwrap().values;
    let rows = run(&p1, &reference, &small(&[1e-3, 1e-6], 100_000), &mut ticking()).unwrap();
    let libraries: Vec<&Row> = rows.iter().filter(|row| !row.ours).collect();
    assert_eq!(
        libraries.len(),
        7 * 2 * 2,
        "seven adaptive solvers, two tolerances, restart or not"
    );
    for row in &rows {
        assert!(row.right(), "{}: {row:?}", row.key());
        // A tick to warm up and one for each repeat, until 2.5 s are spent.
        assert_eq!(row.repeats_s, [1.0, 1.0], "{}", row.key());
        assert_eq!(row.cpu_s, Some(1.0));
        assert!(row.evaluations > 0 && (row.ours || row.accepted > 0), "{}", row.key());
    }
    let dopri5 = |rtol: f64, restart: bool| {
        let at = |row: &&&Row| {
            row.solver == "dopri5"
                && row.restart == restart
                && row.control == Some(RowControl { rtol })
        };
        libraries.iter().find(at).unwrap().error.unwrap()
    };
    assert!(dopri5(1e-6, true) < 1e-5, "{:.1e}", dopri5(1e-6, true));
    assert!(dopri5(1e-6, true) < dopri5(1e-3, true));

    // The same against a wrong reference, and with a budget nobody keeps: no times.
    let wrong: Vec<f64> = reference.iter().map(|value| 2.0 * value).collect();
    for row in run(&p1, &wrong, &small(&[1e-6], 100_000), &mut ticking()).unwrap() {
        assert_eq!((row.cpu_s, row.repeats_s.len()), (None, 0), "{}", row.key());
        assert!(row.silent_failure() || row.status != "solved", "{}", row.key());
    }
    for row in run(&p1, &reference, &small(&[1e-6], 20), &mut ticking()).unwrap() {
        if !row.ours {
            assert_eq!(row.status, "too many evaluations", "{}", row.key());
            assert_eq!((row.error, row.cpu_s), (None, None), "{}", row.key());
        }
    }
}

#[test]
fn nothing_known_beforehand_is_restarted_from_on_a_plant() {
    let p6 = anchor("P6", None);
    let rows = run(&p6, &vec![1.0; 5001], &small(&[1e-3], 1_000), &mut ticking()).unwrap();
    assert!(rows.iter().all(|row| !row.restart || row.ours), "a library restarted on P6");
    assert_eq!(rows.iter().filter(|row| !row.ours).count(), 7);
}

#[test]
fn a_row_is_written_as_the_design_says() {
    let row = Row {
        problem: "P1".to_owned(),
        parameter: Some(0.25),
        solver: "dopri5".to_owned(),
        ours: false,
        control: Some(RowControl { rtol: 1e-6 }),
        restart: true,
        error: Some(2e-6),
        cpu_s: Some(1e-4),
        evaluations: 123,
        status: "solved".to_owned(),
        jacobians: 0,
        accepted: 20,
        rejected: Some(1),
        repeats_s: vec![1e-4],
    };
    let text = serde_json::to_string(&row).unwrap();
    let design = "{\"problem\":\"P1\",\"parameter\":0.25,\"solver\":\"dopri5\",\"ours\":false,\
                  \"control\":{\"rtol\":1e-6},\"restart\":true,\"error\":2e-6,\"cpu_s\":0.0001,\
                  \"evaluations\":123,\"status\":\"solved\",";
    assert!(text.starts_with(design), "{text}");
    assert_eq!(serde_json::from_str::<Row>(&text).unwrap(), row);
    assert_eq!(row.key(), "P1 0.25 dopri5 1e-6 restart");
    let exact = Row { control: None, restart: false, parameter: None, ..row.clone() };
    assert!(serde_json::to_string(&exact).unwrap().contains("\"control\":null"));
    assert_eq!(exact.key(), "P1 dopri5 exact");

    let with = |error: f64, rtol: f64| Row {
        error: Some(error),
        control: Some(RowControl { rtol }),
        ..row.clone()
    };
    assert!(!with(9e-4, 1e-9).silent_failure(), "below 1e-3");
    assert!(with(2e-3, 1e-9).silent_failure());
    assert!(!with(2e-2, 1e-4).silent_failure(), "within a thousand tolerances");
    assert!(with(2e-1, 1e-4).silent_failure() && !with(2e-1, 1e-4).right());
    assert!(!Row { status: "diverged".to_owned(), ..with(2.0, 1e-9) }.silent_failure());
}

/// A method that takes the reference for its answer, and one that is off by a fifth and does not say so.
#[derive(Debug)]
struct Knows(Vec<f64>);

impl Solves for Knows {
    fn deliver(&self, rtol: f64, _: &Limits, grid: &[f64], states: &mut [f64]) -> Delivered {
        assert_eq!(grid.len(), states.len());
        for (state, value) in states.iter_mut().zip(&self.0) {
            *state = if rtol > 1e-4 { 1.2 * value } else { *value };
        }
        let work = Work { evaluations: 5, ..Work::default() };
        Delivered { work, outcome: Outcome::Solved }
    }
}

static KNOWS: Own = Own {
    name: "knows",
    holds: "in this test",
    build: |_| Ok(Box::new(Knows(answer(&anchor("P1", Some(1.0))).expect("an answer").values))),
};

#[test]
fn an_exact_method_of_ours_is_one_row_and_an_adaptive_one_a_row_for_each_tolerance() {
    let p1 = anchor("P1", Some(1.0));
    let (reference, motion) = (answer(&p1).unwrap().values, p1.task.motion().unwrap());
    let problem = motion.problem(p1.task.y0.clone());
    let ready = || (KNOWS.build)(&p1.task).unwrap();
    let own = [(Method::Exact(&KNOWS), ready()), (Method::Adaptive(&KNOWS), ready())];
    let contest = small(&[1e-3, 1e-6], 100_000);
    let mut states = vec![0.0; 601];
    let on = (&p1, motion.as_ref());
    let rows: Vec<Row> = contestants(&own, &problem, &contest.rtols)
        .into_iter()
        .map(|one| Verified::new(one, on, &reference, &contest.limits, &mut states).row)
        .filter(|row| row.ours)
        .collect();
    let told: Vec<_> = rows.iter().map(|row| (row.control, row.right())).collect();
    let rtol = |rtol| Some(RowControl { rtol });
    assert_eq!(told, [(None, false), (rtol(1e-3), false), (rtol(1e-6), true)], "{rows:?}");
    assert_eq!(rows[2].error, Some(0.0));
    assert!((rows[1].error.unwrap() - 0.2).abs() < 1e-12 && !rows[1].silent_failure());
    assert!(rows[0].silent_failure(), "an exact method may be off by 1e-3 at most");
    assert!(rows.iter().all(|row| row.restart && row.evaluations == 5));
}
