//! LuGre under an imposed motion: between the input's corners equation 18 is linear in x.
//!
//! With s = sgn u̇ and y = s x it is ẏ = a (r − y), a = |u̇|/r: y follows r at the rate a, be it slow or
//! faster than anything. Where the speed is constant that is an exponential. Elsewhere a panel of time is
//! solved by collocation at Radau's points, implicit and thus as long as y is smooth, whatever a is; the
//! last coefficients of its Chebyshev series tell the error, and the series is what is delivered.

mod panel;
mod rule;

use crate::{Delivered, NotHere, Own, Solves, Task};
use duhem::{FrictionModel, Input, LuGre, closed_form::lugre::advance, sgn};
use integrate::{Failure, Limits, Outcome, Work};
use panel::{Driven, LANES};
use rule::{N, Rule};
use std::sync::LazyLock;

/// LuGre under any imposed motion.
pub(super) const METHOD: Own = Own {
    name: "lugre-linear",
    holds: "LuGre under any imposed motion",
    build: |task| Ok(Box::new(LugreLinear::new(task)?)),
};

/// The share of the tolerance that the last coefficients may be.
const SAFETY: f64 = 0.2;

/// The Stribeck curve is seen where neighbouring points of a panel differ by less than this [v_S], unless
/// both are faster than [`BEYOND`].
const SEEN: f64 = 0.6;

/// A speed [v_S] at which e^(−s²) is less than 1e-15.
const BEYOND: f64 = 6.0;

/// The error of a panel on which it is not seen, in units of what is allowed.
const UNSEEN: f64 = 1e4;

/// The nodes and their matrices are the same for every task: computed once.
static RULE: LazyLock<Rule> = LazyLock::new(Rule::new);

#[derive(Debug)]
struct LugreLinear {
    lugre: LuGre,
    input: Input,
    x0: f64,
    span: (f64, f64),
    rule: &'static Rule,
}

impl LugreLinear {
    fn new(task: &Task) -> Result<Self, NotHere> {
        let refuse = |found: String, expected| NotHere { method: "lugre-linear", found, expected };
        if task.model.name != "lugre" {
            return Err(refuse(format!("the model {}", task.model.name), "lugre"));
        }
        let lugre = LuGre::new(&task.parameters)
            .map_err(|error| refuse(error.to_string(), "the parameters of LuGre"))?;
        if task.plant.is_some() {
            return Err(refuse("a plant".to_owned(), "an imposed motion"));
        }
        let (start, end) = task.span;
        if !(start.is_finite() && end.is_finite() && start < end) {
            return Err(refuse(format!("the span [{start}, {end}] s"), "a finite span that rises"));
        }
        match task.y0[..] {
            [x0] if x0.is_finite() => {
                let (input, span) = (task.input.clone(), task.span);
                Ok(Self { lugre, input, x0, span, rule: &RULE })
            }
            _ => Err(refuse(format!("the initial state {:?}", task.y0), "one finite deflection")),
        }
    }
}

impl Solves for LugreLinear {
    fn deliver(&self, rtol: f64, limits: &Limits, grid: &[f64], states: &mut [f64]) -> Delivered {
        states.fill(f64::NAN);
        let atol = SAFETY * rtol * self.lugre.scale()[0];
        let work = Work { rejected: Some(0), ..Work::default() };
        let (t, x) = (self.span.0, self.x0);
        let mut run =
            Run { of: self, atol, most: limits.evaluations, t, x, grid, states, work, first: None };
        let end = if rtol > 0.0 && rtol.is_finite() {
            run.march()
        } else {
            Err(Failure::Stopped(format!("a tolerance must be positive, found {rtol}")))
        };
        let outcome = match end {
            Ok(()) => Outcome::Solved,
            Err(why) => Outcome::Failed { at: run.t, why },
        };
        Delivered { work: run.work, outcome }
    }
}

/// A panel that was tried.
#[derive(Debug)]
struct Panel {
    /// Chebyshev coefficients of y [m].
    series: [f64; N + 1],
    /// y [m] and the speed [m/s] at its end.
    end: f64,
    speed: f64,
    /// Its error in units of what is allowed.
    error: f64,
}

#[derive(Debug)]
struct Run<'a> {
    of: &'a LugreLinear,
    /// What the last coefficients may be [m].
    atol: f64,
    /// Most evaluations.
    most: u64,
    /// How far it has come [s], with the deflection there [m].
    t: f64,
    x: f64,
    /// The times not yet delivered [s], and their places.
    grid: &'a [f64],
    states: &'a mut [f64],
    work: Work,
    /// What the first panel of the arc before should have been [s].
    first: Option<f64>,
}

impl Run<'_> {
    fn march(&mut self) -> Result<(), Failure> {
        let (start, end) = self.of.span;
        let corners = self.of.input.corners(start, end);
        let here = self.count(start);
        self.fill(here, |_| self.of.x0);
        for to in corners.into_iter().chain([end]) {
            self.arc(to)?;
        }
        Ok(())
    }

    /// To the next corner `to`.
    fn arc(&mut self, to: f64) -> Result<(), Failure> {
        let (of, from) = (self.of, self.t);
        let velocity = |t: f64| of.input.u_dot_on(from, to, t);
        let (start, middle, end) =
            (velocity(from), velocity(from + 0.5 * (to - from)), velocity(to));
        if start == middle && middle == end {
            return self.at_constant_speed(middle, to);
        }
        let s = sgn(middle);
        let mut h = self.first.unwrap_or(to - from).min(to - from);
        let (mut begun, mut speed) = (false, (s * start).max(0.0));
        while self.t < to {
            let left = to - self.t;
            let rest = (left / h * (1.0 - 1e-6)).ceil().max(1.0);
            h = left / rest;
            let tried = self.attempt((s, speed), h, velocity)?;
            // The error goes with the power N + 1 of the length.
            let next = h * (0.9 * tried.error.powf(-1.0 / (N + 1) as f64)).clamp(0.1, 4.0);
            if tried.error <= 1.0 {
                let until = if rest == 1.0 { to } else { self.t + h };
                self.accept(&tried.series, s, (h, until));
                (self.x, speed) = (s * tried.end, tried.speed);
                if !begun {
                    (self.first, begun) = (Some(next), true);
                }
            } else {
                self.work.rejected = self.work.rejected.map(|count| count + 1);
                if self.t + next <= self.t {
                    return Err(Failure::StepTooSmall);
                }
            }
            h = next;
        }
        Ok(())
    }

    /// The panel of length `h` that starts here in the direction `s`, with the speed there.
    fn attempt(
        &mut self,
        (s, start): (f64, f64),
        h: f64,
        velocity: impl Fn(f64) -> f64,
    ) -> Result<Panel, Failure> {
        self.spend(N as u64)?;
        let (of, half) = (self.of, 0.5 * h);
        let speed = of.rule.nodes.map(|node| (s * velocity(self.t + half * (1.0 + node))).max(0.0));
        let r = speed.map(|speed| of.lugre.r(speed));
        let mut rate = [0.0; N];
        for (rate, (speed, r)) in rate.iter_mut().zip(speed.iter().zip(&r)) {
            *rate = half * speed / r;
        }
        let (series, end) = panel::series(of.rule, &Driven { r, rate }, s * self.x);
        if !(end.is_finite() && series[N].is_finite()) {
            return Err(Failure::NotFinite);
        }
        let mut error = tail(&series) / self.atol;
        let mut before = start;
        for speed in speed {
            let slow = speed.min(before) < BEYOND * of.lugre.v_s;
            if slow && (speed - before).abs() > SEEN * of.lugre.v_s {
                error = error.max(UNSEEN);
            }
            before = speed;
        }
        Ok(Panel { series, end, speed: before, error })
    }

    /// Goes to the end of the panel and delivers what lies on it.
    fn accept(&mut self, c: &[f64; N + 1], s: f64, (h, until): (f64, f64)) {
        self.work.accepted += 1;
        let (from, scale) = (self.t, 2.0 / h);
        let mut ahead = self.count(until);
        while ahead > 0 {
            let now = ahead.min(LANES);
            let mut x = [0.0; LANES];
            for (x, t) in x.iter_mut().zip(&self.grid[..now]) {
                *x = (t - from) * scale - 1.0;
            }
            let y = panel::at(c, &x);
            let (head, tail) = std::mem::take(&mut self.states).split_at_mut(now);
            for (state, y) in head.iter_mut().zip(y) {
                *state = s * y;
            }
            (self.states, self.grid) = (tail, &self.grid[now..]);
            ahead -= now;
        }
        self.t = until;
    }

    fn at_constant_speed(&mut self, u_dot: f64, to: f64) -> Result<(), Failure> {
        self.spend(1)?;
        let (from, x) = (self.t, self.x);
        let on = |t: f64| advance(&self.of.lugre, x, u_dot * (t - from), u_dot);
        let here = self.count(to);
        self.fill(here, on);
        self.work.accepted += 1;
        (self.t, self.x) = (to, on(to));
        Ok(())
    }

    /// How many times of the grid are not later than `until`.
    fn count(&self, until: f64) -> usize {
        self.grid.partition_point(|t| *t <= until)
    }

    fn fill(&mut self, count: usize, at: impl Fn(f64) -> f64) {
        let (head, tail) = std::mem::take(&mut self.states).split_at_mut(count);
        for (state, t) in head.iter_mut().zip(self.grid) {
            *state = at(*t);
        }
        (self.states, self.grid) = (tail, &self.grid[count..]);
    }

    fn spend(&mut self, evaluations: u64) -> Result<(), Failure> {
        self.work.evaluations += evaluations;
        if self.work.evaluations > self.most {
            return Err(Failure::TooManyEvaluations);
        }
        Ok(())
    }
}

/// What the coefficients behind the last may add up to: six places on they are less by the same factor
/// again.
fn tail(series: &[f64; N + 1]) -> f64 {
    let largest = |c: &[f64]| c.iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
    let (before, last) = (largest(&series[N - 8..N - 5]), largest(&series[N - 2..]));
    let factor = (last / before.max(f64::MIN_POSITIVE)).min(0.9);
    last * (1.0 + 6.0 * factor / (1.0 - factor))
}
