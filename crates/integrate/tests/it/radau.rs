//! Our own stiff method: its order, its stiffness, its events to the last digit, its failures.

use crate::common::slope;
use integrate::{Failure, Integration, Limits, Node, Outcome, Settings, System, radau};
use std::f64::consts::PI;

/// A system of N equations from closures, with an event function.
struct Closures<F, G, E> {
    f: F,
    jacobian: G,
    event: E,
}

impl<F, G, E, const N: usize> System<N> for Closures<F, G, E>
where
    F: Fn(f64, &[f64; N]) -> [f64; N],
    G: Fn(f64, &[f64; N]) -> [[f64; N]; N],
    E: Fn(&[f64; N]) -> f64,
{
    fn derivative(&mut self, t: f64, y: &[f64; N]) -> [f64; N] {
        (self.f)(t, y)
    }
    fn jacobian(&mut self, t: f64, y: &[f64; N]) -> [[f64; N]; N] {
        (self.jacobian)(t, y)
    }
    fn event(&self, _t: f64, y: &[f64; N]) -> f64 {
        (self.event)(y)
    }
}

fn settings<const N: usize>(rtol: f64) -> Settings<N> {
    Settings { rtol, atol: [rtol; N], dead_band: 1e-14, limits: Limits::default() }
}

fn nodes<S: System<N>, const N: usize>(
    mut system: S,
    span: (f64, f64),
    y0: [f64; N],
    settings: &Settings<N>,
) -> (Vec<Node<N>>, Integration) {
    let mut nodes = Vec::new();
    let end = radau(&mut system, span, y0, settings, &mut |node| nodes.push(*node));
    (nodes, end)
}

#[test]
fn its_order_is_five_on_a_smooth_forced_problem() {
    // y₁' = y₂ − (y₁² + y₁ − cos²t − cos t), y₂' = −y₁ − cos t sin t (y₂ + sin t): cos t and −sin t.
    let f = |t: f64, y: &[f64; 2]| {
        let (c, s) = (t.cos(), t.sin());
        [y[1] - (y[0] * y[0] + y[0] - c * c - c), -y[0] - c * s * (y[1] + s)]
    };
    let jacobian = |t: f64, y: &[f64; 2]| [[-2.0 * y[0] - 1.0, 1.0], [-1.0, -t.cos() * t.sin()]];
    let points: Vec<(f64, f64)> = (8..=20)
        .map(|half| {
            let system = Closures { f, jacobian, event: |_: &[f64; 2]| 1.0 };
            let settings = settings(10.0_f64.powf(-f64::from(half) / 2.0));
            let y0 = [0.5_f64.cos(), -0.5_f64.sin()];
            let (nodes, end) = nodes(system, (0.5, 40.5), y0, &settings);
            assert_eq!(end.outcome, Outcome::Solved);
            let error = |n: &Node<2>| (n.y[0] - n.t.cos()).abs().max((n.y[1] + n.t.sin()).abs());
            (end.work.accepted as f64, nodes.iter().map(error).fold(0.0, f64::max))
        })
        .filter(|(_, error)| *error > 1e-12)
        .collect();
    let least = points.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
    let points: Vec<_> = points.into_iter().filter(|p| p.1 <= 150.0 * least).collect();
    assert!(points.iter().any(|p| p.1 >= 50.0 * least), "no two decades: {points:?}");
    let order = -slope(&points);
    assert!((order - 5.0).abs() < 0.5, "order {order:.2}, expected 5");
}

#[test]
fn a_fast_decay_onto_a_slow_motion_costs_no_more_steps_the_faster_it_is() {
    // Prothero and Robinson: y' = λ(y − cos t) − sin t. The estimate is damped as the error is, and a
    // little more: at |λ|h of order 100 a few tolerances get through.
    for rtol in [1e-6, 1e-8, 1e-10] {
        let steps = [-1e3, -1e6, -1e9].map(|lambda| {
            let system = Closures {
                f: move |t: f64, y: &[f64; 1]| [lambda * (y[0] - t.cos()) - t.sin()],
                jacobian: move |_: f64, _: &[f64; 1]| [[lambda]],
                event: |_: &[f64; 1]| 1.0,
            };
            let (nodes, end) = nodes(system, (0.0, 10.0), [1.0], &settings(rtol));
            assert_eq!(end.outcome, Outcome::Solved);
            let worst = nodes.iter().map(|n| (n.y[0] - n.t.cos()).abs()).fold(0.0, f64::max);
            assert!(worst < 10.0 * rtol, "λ = {lambda:e} 1/s at {rtol:e}: off by {worst:e}");
            end.work.accepted
        });
        assert!(steps[2] <= steps[0] + 5, "{steps:?} steps at {rtol:e}");
    }
}

#[test]
fn van_der_pols_oscillator_ends_where_the_test_set_says() {
    // ε = 1e-6 from (2, 0) to t = 2: the reference solution of the *Test Set for IVP Solvers*.
    let e = 1e-6;
    let system = Closures {
        f: move |_: f64, y: &[f64; 2]| [y[1], ((1.0 - y[0] * y[0]) * y[1] - y[0]) / e],
        jacobian: move |_: f64, y: &[f64; 2]| {
            [[0.0, 1.0], [(-2.0 * y[0] * y[1] - 1.0) / e, (1.0 - y[0] * y[0]) / e]]
        },
        event: |_: &[f64; 2]| 1.0,
    };
    let (nodes, end) = nodes(system, (0.0, 2.0), [2.0, 0.0], &settings(1e-8));
    assert_eq!(end.outcome, Outcome::Solved);
    let y = nodes[nodes.len() - 1].y;
    let error = (y[0] - 1.706_167_732_170_483).abs().max((y[1] + 0.892_809_701_024_797_5).abs());
    assert!(error < 1e-9, "{y:?} is off by {error:e}");
    // An explicit method is held below 1e-6 by stability: a million steps.
    assert!(end.work.accepted < 5000, "{} steps", end.work.accepted);
}

/// q' = v, v' = −q − d|v|: damped one way, driven the other, so every half period is π/ω with
/// ω² = 1 − d²/4, and the turning points are 1 and −exp(dπ/2ω) in turn.
fn kinked(d: f64) -> impl System<2> {
    Closures {
        f: move |_: f64, y: &[f64; 2]| [y[1], -y[0] - d * y[1].abs()],
        jacobian: move |_: f64, y: &[f64; 2]| [[0.0, 1.0], [-1.0, -d * y[1].signum()]],
        event: |y: &[f64; 2]| y[1],
    }
}

#[test]
fn a_reversal_is_met_to_the_last_digits_and_the_order_survives_it() {
    let d = 0.6;
    let half = PI / (1.0_f64 - d * d / 4.0).sqrt();
    let far = -(0.5 * d * half).exp();
    let points = [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10].map(|rtol| {
        let (nodes, end) = nodes(kinked(d), (0.0, 20.5 * half), [1.0, 0.0], &settings(rtol));
        assert_eq!((&end.outcome, end.events), (&Outcome::Solved, 20), "at {rtol:e}");
        let turns: Vec<_> = nodes.iter().filter(|n| n.event).collect();
        let error = turns.iter().enumerate().map(|(k, n)| {
            assert!(n.y[1].abs() < 2e-14, "v = {:e} m/s at a reversal", n.y[1]);
            let q = if k % 2 == 0 { far } else { 1.0 };
            (n.t - (k + 1) as f64 * half).abs().max((n.y[0] - q).abs())
        });
        (end.work.accepted as f64, error.fold(0.0, f64::max))
    });
    let order = -slope(&points);
    assert!((order - 5.0).abs() < 0.7, "order {order:.2}, expected 5: {points:?}");
    assert!(points[5].1 < 1e-10, "off by {:e} at 1e-10", points[5].1);
}

#[test]
fn without_the_event_the_same_tolerance_leaves_more_error() {
    let half = PI / (1.0_f64 - 0.09).sqrt();
    let error = |told: bool| {
        let system = Closures {
            f: |_: f64, y: &[f64; 2]| [y[1], -y[0] - 0.6 * y[1].abs()],
            jacobian: |_: f64, y: &[f64; 2]| [[0.0, 1.0], [-1.0, -0.6 * y[1].signum()]],
            event: move |y: &[f64; 2]| if told { y[1] } else { 1.0 },
        };
        let (nodes, end) = nodes(system, (0.0, 20.25 * half), [1.0, 0.0], &settings(1e-6));
        assert_eq!(end.outcome, Outcome::Solved);
        let (y, quarter) = (nodes[nodes.len() - 1].y, 0.25 * half);
        // The first quarter of the driven half period: e^(0.3 t) (cos ωt − 0.3/ω sin ωt).
        let omega = PI / half;
        let exact = (0.3 * quarter).exp()
            * ((omega * quarter).cos() - 0.3 / omega * (omega * quarter).sin());
        (y[0] - exact).abs()
    };
    let (told, untold) = (error(true), error(false));
    assert!(10.0 * told < untold, "{told:e} told, {untold:e} untold");
}

#[test]
fn a_motion_that_rings_down_comes_to_rest_in_few_steps() {
    // |v| ends in the dead band: after that no change of sign is an event.
    let system = Closures {
        f: |_: f64, y: &[f64; 2]| [y[1], -1e4 * y[0] - 20.0 * y[1]],
        jacobian: |_: f64, _: &[f64; 2]| [[0.0, 1.0], [-1e4, -20.0]],
        event: |y: &[f64; 2]| y[1],
    };
    let (nodes, end) = nodes(system, (0.0, 1e5), [1.0, 0.0], &settings(1e-8));
    assert_eq!(end.outcome, Outcome::Solved);
    // From 100 m/s to 1e-14 m/s at exp(−10 t): some 117 half periods.
    assert!((100..140).contains(&end.events), "{} reversals", end.events);
    assert!(end.work.accepted < 10_000, "{} steps", end.work.accepted);
    assert!(nodes[nodes.len() - 1].y[0].abs() < 1e-8);
}

#[test]
fn what_cannot_be_solved_is_said() {
    let blows = |rtol: f64, evaluations| {
        let system = Closures {
            f: |_: f64, y: &[f64; 1]| [y[0] * y[0]],
            jacobian: |_: f64, y: &[f64; 1]| [[2.0 * y[0]]],
            event: |_: &[f64; 1]| 1.0,
        };
        let settings = Settings { limits: Limits { evaluations }, ..settings(rtol) };
        let (nodes, end) = nodes(system, (0.0, 2.0), [1.0], &settings);
        let Outcome::Failed { at, why } = end.outcome else { panic!("solved a pole") };
        assert_eq!(at, nodes[nodes.len() - 1].t, "the last node is where it got to");
        assert!(at <= 1.0 + 1e-9, "got over the pole at 1 s to {at} s");
        why
    };
    assert!(matches!(blows(1e-8, 1_000_000), Failure::StepTooSmall | Failure::NotFinite));
    assert_eq!(blows(1e-8, 100), Failure::TooManyEvaluations);
    let nan = Closures {
        f: |t: f64, _: &[f64; 1]| [if t > 0.5 { f64::NAN } else { 1.0 }],
        jacobian: |_: f64, _: &[f64; 1]| [[0.0]],
        event: |_: &[f64; 1]| 1.0,
    };
    let (nodes, end) = nodes(nan, (0.0, 1.0), [0.0], &settings(1e-8));
    assert!(matches!(end.outcome, Outcome::Failed { why: Failure::NotFinite, .. }), "{end:?}");
    assert!(nodes[nodes.len() - 1].t > 0.49, "kept what it had");
}
