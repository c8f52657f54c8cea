//! Our fast stiff method: how its error follows the tolerance, its kinks, its failures.

use integrate::collocation::{
    Closeness, Collocation, General, Kink, Kinked, Observer, Piece, Stages, collocate,
};
use integrate::{Failure, Limits, Outcome};
use std::f64::consts::PI;

/// What is seen of a run: states at times, and the ends of the steps.
struct Seen<const N: usize> {
    times: Vec<f64>,
    states: Vec<[f64; N]>,
    ends: Vec<f64>,
    kinks: Vec<(f64, [f64; N])>,
}

impl<const N: usize> Observer<N> for Seen<N> {
    fn see<const S: usize>(&mut self, piece: &Piece<N, S>) {
        while let Some(t) = self.times.get(self.states.len()).filter(|t| **t <= piece.end) {
            self.states.push(piece.at(*t));
        }
        self.ends.push(piece.end);
        if piece.at_kink {
            self.kinks.push((piece.end, piece.y_end));
        }
    }
}

fn solve<T: Kinked<N>, const N: usize>(
    mut system: T,
    (end, y0): (f64, [f64; N]),
    (stages, rtol): (Stages, f64),
    budget: u64,
) -> (Seen<N>, Collocation) {
    let times = (0..=200).map(|i| end * f64::from(i) / 200.0).collect();
    let mut seen = Seen { times, states: Vec::new(), ends: Vec::new(), kinks: Vec::new() };
    let limits = Limits { evaluations: budget };
    let closeness = Closeness { rtol, atol: [rtol; N], stages, limits };
    let run = collocate(&mut system, (0.0, end), y0, &closeness, &mut seen);
    (seen, run)
}

/// y' = λ(y − cos t) − sin t, of which cos t is a solution, as stiff as λ.
struct Tracking {
    lambda: f64,
    t: f64,
}

impl Kinked<1> for Tracking {
    type Matrix<const B: usize> = General<1, B>;

    fn start_at(&mut self, t: f64) {
        self.t = t;
    }
    fn forcing<const W: usize>(&self, h: f64, c: &[f64; W]) -> [f64; W] {
        c.map(|c| self.t + c * h)
    }
    fn derivatives<const W: usize>(&self, t: &[f64; W], y: &[[f64; W]; 1]) -> [[f64; W]; 1] {
        [std::array::from_fn(|i| self.lambda * (y[0][i] - t[i].cos()) - t[i].sin())]
    }
    fn jacobian(&self, _y: &[f64; 1]) -> [[f64; 1]; 1] {
        [[self.lambda]]
    }
}

/// Two uncoupled rotations, of which the second is driven by the first: four states.
struct Rotations;

impl Kinked<4> for Rotations {
    type Matrix<const B: usize> = General<4, B>;

    fn start_at(&mut self, _t: f64) {}
    fn forcing<const W: usize>(&self, _h: f64, _c: &[f64; W]) -> [f64; W] {
        [0.0; W]
    }
    /// With |(a, b)| = 1 the second pair turns as fast again as that says: nonlinear, and exact.
    fn derivatives<const W: usize>(&self, _u: &[f64; W], y: &[[f64; W]; 4]) -> [[f64; W]; 4] {
        let [a, b, c, d] = y;
        let fast: [f64; W] = std::array::from_fn(|i| 2.0 * (a[i] * a[i] + b[i] * b[i]));
        [
            b.map(|b| -b),
            *a,
            std::array::from_fn(|i| -fast[i] * d[i]),
            std::array::from_fn(|i| fast[i] * c[i]),
        ]
    }
    fn jacobian(&self, y: &[f64; 4]) -> [[f64; 4]; 4] {
        let [a, b, c, d] = *y;
        let fast = 2.0 * (a * a + b * b);
        [
            [0.0, -1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [-4.0 * a * d, -4.0 * b * d, 0.0, -fast],
            [4.0 * a * c, 4.0 * b * c, fast, 0.0],
        ]
    }
}

#[test]
fn the_error_follows_the_tolerance_however_stiff_the_system_is() {
    for stages in [Stages::Three, Stages::Seven] {
        for lambda in [-1.0, -1e3, -1e7] {
            let mut last = f64::INFINITY;
            for rtol in [1e-3, 1e-5, 1e-7, 1e-9] {
                let system = Tracking { lambda, t: 0.0 };
                let (seen, run) = solve(system, (20.0, [1.0]), (stages, rtol), 1_000_000);
                assert_eq!(run.outcome, Outcome::Solved, "{run:?}");
                let off = |(t, y): (&f64, &[f64; 1])| (y[0] - t.cos()).abs();
                let worst = seen.times.iter().zip(&seen.states).map(off).fold(0.0, f64::max);
                assert!(worst < 30.0 * rtol, "λ = {lambda}, {stages:?}, {rtol:e}: {worst:e}");
                assert!(worst < last.max(1e-12), "{worst:e} is no better than {last:e}");
                last = worst;
            }
        }
    }
}

#[test]
fn seven_stages_reach_round_off_with_far_fewer_steps_than_three() {
    let steps = |stages, rtol| {
        let (seen, run) =
            solve(Rotations, (4.0 * PI, [1.0, 0.0, 0.0, 1.0]), (stages, rtol), 10_000_000);
        assert_eq!(run.outcome, Outcome::Solved, "{run:?}");
        let off = |(t, y): (&f64, &[f64; 4])| {
            let right = [t.cos(), t.sin(), -(2.0 * t).sin(), (2.0 * t).cos()];
            (0..4).map(|i| (y[i] - right[i]).abs()).fold(0.0, f64::max)
        };
        let worst = seen.times.iter().zip(&seen.states).map(off).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{stages:?} at {rtol:e}: {worst:e}");
        run.work.accepted
    };
    let (three, seven) = (steps(Stages::Three, 1e-11), steps(Stages::Seven, 1e-10));
    assert!(5 * seven < three, "{seven} steps with seven stages, {three} with three");
}

/// q'' = −q − μ sgn q': a mass on a spring that slides, by halves of harmonic swings around ±μ.
struct Sliding {
    mu: f64,
    side: f64,
}

impl Kinked<2> for Sliding {
    type Matrix<const B: usize> = General<2, B>;

    fn start_at(&mut self, _t: f64) {}
    fn forcing<const W: usize>(&self, _h: f64, _c: &[f64; W]) -> [f64; W] {
        [0.0; W]
    }
    fn derivatives<const W: usize>(&self, _u: &[f64; W], y: &[[f64; W]; 2]) -> [[f64; W]; 2] {
        [y[1], y[0].map(|q| -q - self.mu * self.side)]
    }
    fn jacobian(&self, _y: &[f64; 2]) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [-1.0, 0.0]]
    }
    fn kink(&self) -> Option<Kink> {
        Some(Kink { state: 1, zone: 0.0 })
    }
    fn take_side(&mut self, side: f64) {
        self.side = side;
    }
}

#[test]
fn a_sliding_mass_turns_where_its_half_swings_end_to_rounding() {
    let (mu, q0) = (0.1, 2.05);
    for stages in [Stages::Three, Stages::Seven] {
        let system = Sliding { mu, side: 1.0 };
        // Ten half swings, each shorter by 2μ at its end; at the last the spring holds no more than μ.
        let (seen, run) = solve(system, (9.5 * PI, [q0, 0.0]), (stages, 1e-9), 1_000_000);
        assert_eq!(run.outcome, Outcome::Solved, "{run:?}");
        assert_eq!(seen.kinks.len(), 9, "{:?}", seen.kinks);
        for (n, (t, y)) in (1..).zip(&seen.kinks) {
            let right = (q0 - 2.0 * mu * f64::from(n)) * if n % 2 == 0 { 1.0 } else { -1.0 };
            assert!((t - f64::from(n) * PI).abs() < 1e-7, "turn {n} at {t} s");
            assert!((y[0] - right).abs() < 1e-7, "turn {n} at {} m, not {right} m", y[0]);
            assert_eq!(y[1], 0.0, "a turn is at rest");
        }
    }
}

/// y' = y, which says that it grows.
struct Growing {
    grows: f64,
}

impl Kinked<1> for Growing {
    type Matrix<const B: usize> = General<1, B>;

    fn start_at(&mut self, _t: f64) {}
    fn forcing<const W: usize>(&self, _h: f64, _c: &[f64; W]) -> [f64; W] {
        [0.0; W]
    }
    fn derivatives<const W: usize>(&self, _u: &[f64; W], y: &[[f64; W]; 1]) -> [[f64; W]; 1] {
        *y
    }
    fn jacobian(&self, _y: &[f64; 1]) -> [[f64; 1]; 1] {
        [[1.0]]
    }
    fn admits(&self, y: &[f64; 1]) -> bool {
        y[0] < 1e6
    }
    fn growth(&self, _start: &[f64; 1], _end: &[f64; 1]) -> f64 {
        self.grows
    }
}

#[test]
fn no_step_is_longer_than_what_grows_in_it_allows() {
    let longest = |grows: f64| {
        let (seen, run) = solve(Growing { grows }, (10.0, [1e-3]), (Stages::Seven, 1e-2), 100_000);
        assert_eq!(run.outcome, Outcome::Solved);
        seen.ends.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max)
    };
    assert!(longest(0.0) > 1.0, "{} s", longest(0.0));
    assert!(longest(10.0) <= 0.15 + 1e-9, "{} s", longest(10.0));
}

#[test]
fn a_run_that_cannot_go_on_says_why_and_how_far_it_got() {
    let end = |run: &Collocation| match &run.outcome {
        Outcome::Failed { at, why } => (*at, why.clone()),
        Outcome::Solved => panic!("solved"),
    };
    // Beyond 1e6 there is nothing: e^t 1e-3 is there at 20.7 s.
    let (seen, run) =
        solve(Growing { grows: 0.0 }, (40.0, [1e-3]), (Stages::Three, 1e-6), 1_000_000);
    let (at, why) = end(&run);
    assert_eq!(why, Failure::StepTooSmall);
    assert!((at - 1e9_f64.ln()).abs() < 1e-3, "{at} s");
    assert_eq!(seen.ends.last(), Some(&at));
    let (_, run) =
        solve(Tracking { lambda: -1.0, t: 0.0 }, (20.0, [1.0]), (Stages::Three, 1e-9), 50);
    assert_eq!(end(&run).1, Failure::TooManyEvaluations);
    let nan = Tracking { lambda: f64::NAN, t: 0.0 };
    let (_, run) = solve(nan, (20.0, [1.0]), (Stages::Seven, 1e-6), 1000);
    assert_eq!(end(&run), (0.0, Failure::NotFinite));
}

#[test]
fn its_work_is_counted_stage_by_stage() {
    let system = Tracking { lambda: -10.0, t: 0.0 };
    let (seen, run) = solve(system, (20.0, [1.0]), (Stages::Three, 1e-6), 1_000_000);
    let work = run.work;
    assert_eq!(work.accepted, seen.ends.len() as u64);
    // One evaluation to begin with, three for each iteration.
    assert_eq!((work.evaluations - 1) % 3, 0, "{work:?}");
    assert_eq!(work.jacobians, work.accepted + work.rejected.unwrap_or(0), "{work:?}");
}
