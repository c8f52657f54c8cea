//! A plant with rate-independent friction, a second way: friction is no state but a function of q.
//!
//! Since the last reversal F is a closed form of the displacement alone, for Dahl and for Maxwell-slip
//! alike, so only q and v are integrated, by the classic Runge–Kutta method at a fixed step. A step that
//! would pass a reversal or a kink of F(q) is taken again, shorter, so that it ends there to the last
//! digit; at a reversal what F remembers is renewed.

use crate::{
    Path, SimulationError,
    error::{check_span, deflections},
};
use duhem::{
    Dahl, FrictionModel, Input, MaxwellSlip, Plant,
    closed_form::{dahl, maxwell_slip},
    sgn,
};

/// Friction that is a function of the displacement since the last reversal.
#[derive(Debug, Clone, PartialEq)]
pub enum RateIndependent {
    /// The Dahl model; its state is F, within ±F_C.
    Dahl(Dahl),
    /// The Maxwell-slip model; its states are the positions x_i.
    MaxwellSlip(MaxwellSlip),
}

/// The plant m q̈ + k_s q = w(t) − F with such a friction.
#[derive(Debug, Clone, PartialEq)]
pub struct ByDisplacement {
    /// The friction.
    pub friction: RateIndependent,
    /// The plant.
    pub plant: Plant,
    /// What drives it.
    pub input: Input,
}

/// The steps of the integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Length of a step [s].
    pub h: f64,
    /// Of so many steps one becomes a node of the path; events always do.
    pub every: u32,
}

/// Most steps of a run.
const MOST_STEPS: f64 = 1e8;

impl ByDisplacement {
    /// The path from `y0` = [q, v, F] or [q, v, x₁ … x_N] over the span [s].
    pub fn solve(
        &self,
        y0: &[f64],
        span: (f64, f64),
        steps: Steps,
    ) -> Result<Path, SimulationError> {
        check_span(span)?;
        let needed = (span.1 - span.0) / steps.h;
        if !(steps.h > 0.0 && needed <= MOST_STEPS) {
            return Err(SimulationError::TooLong { needed, most: MOST_STEPS });
        }
        let memory = self.friction.remember(y0)?;
        let path = Path::new(y0.len());
        let (t, turned) = (span.0, f64::NEG_INFINITY);
        let mut run = Run { of: self, t, q: y0[0], v: y0[1], memory, turned, path };
        let s = sgn(run.v);
        run.memory.set_out(if s == 0.0 { sgn(run.acceleration()) } else { s }, run.q);
        run.node();
        let mut ends = self.input.corners(span.0, span.1);
        ends.push(span.1);
        for end in ends {
            run.to(end, steps);
        }
        Ok(run.path)
    }

    /// The path with steps that resolve the motion in time, [`Self::steps`], and at the speed it turns out
    /// to have also the way on which F(q) bends: for Dahl F_C/σ, and the shorter the larger γ is.
    pub fn resolve(&self, y0: &[f64], span: (f64, f64)) -> Result<Path, SimulationError> {
        // Four steps to a node, so that F between the nodes is as good as q.
        let steps = Steps { every: 4, ..self.steps() };
        let path = self.solve(y0, span, steps)?;
        let RateIndependent::Dahl(model) = &self.friction else { return Ok(path) };
        let fastest = (0..path.t().len()).map(|i| path.node(i)[1].abs()).fold(0.0, f64::max);
        let h = 0.025 * model.f_c / model.d_plus(-model.f_c) / fastest;
        if h < steps.h { self.solve(y0, span, Steps { h, ..steps }) } else { Ok(path) }
    }

    /// Steps that keep q to 1e-8 of its size over hundreds of periods, if F(q) is not too curved: an
    /// eightieth of a radian of the fastest motion each, sixteen to a node.
    pub fn steps(&self) -> Steps {
        Steps { h: 0.0125 / self.fastest(), every: 16 }
    }

    /// The angular frequency [rad/s] of the plant on its stiffest contact, which tells how long a step
    /// may be.
    pub fn fastest(&self) -> f64 {
        let contact = match &self.friction {
            // The steepest slope is D₊ at −F_C.
            RateIndependent::Dahl(dahl) => dahl.d_plus(-dahl.f_c),
            RateIndependent::MaxwellSlip(model) => model.k.iter().sum(),
        };
        ((self.plant.stiffness + contact) / self.plant.mass).sqrt()
    }
}

impl RateIndependent {
    fn remember(&self, y0: &[f64]) -> Result<Memory<'_>, SimulationError> {
        let x = match self {
            Self::MaxwellSlip(model) => deflections(model, y0)?,
            Self::Dahl(Dahl { f_c, .. }) => {
                let finite = y0.len() == 3 && y0.iter().all(|y| y.is_finite());
                if !finite || y0[2].abs() > *f_c {
                    let expected = format!("q, v and F, all finite, with |F| ≤ F_C = {f_c} N");
                    return Err(SimulationError::InitialState { found: y0.to_vec(), expected });
                }
                vec![y0[2]]
            }
        };
        Ok(Memory { of: self, q: y0[0], x, s: 0.0, kinks: Vec::new(), passed: 0.0 })
    }
}

/// What friction remembers: where the motion last turned, and its state there.
#[derive(Debug)]
struct Memory<'a> {
    of: &'a RateIndependent,
    /// Displacement at the last reversal [m].
    q: f64,
    /// Force [N] or deflections [m] there.
    x: Vec<f64>,
    /// Direction of motion since.
    s: f64,
    /// Distances [m] from there at which F(q) has its kinks, the next one last.
    kinks: Vec<f64>,
    /// Distance [m] at which the last one was.
    passed: f64,
}

impl Memory<'_> {
    /// Begins a new way at `q` in the direction `s`.
    fn set_out(&mut self, s: f64, q: f64) {
        let way = q - self.q;
        for i in 0..self.x.len() {
            self.x[i] = self.state(i, way);
        }
        (self.q, self.s, self.passed) = (q, s, 0.0);
        self.kinks = match self.of {
            RateIndependent::Dahl(model) if model.gamma < 1.0 => {
                dahl::travel(model, self.x[0], s * model.f_c).into_iter().map(f64::abs).collect()
            }
            RateIndependent::Dahl(_) => Vec::new(),
            RateIndependent::MaxwellSlip(model) => {
                self.x.iter().zip(&model.delta).map(|(z, delta)| delta - s * z).collect()
            }
        };
        self.kinks.retain(|way| *way > 0.0);
        self.kinks.sort_by(|a, b| b.total_cmp(a));
    }

    /// State i, F [N] or z_i [m], at the displacement `way` from the last reversal.
    fn state(&self, i: usize, way: f64) -> f64 {
        match self.of {
            // Beyond its only kink, at γ < 1, F is F_C to the last digit: w = 10⁻¹⁶ would be another branch.
            RateIndependent::Dahl(model) if self.passed > 0.0 => self.s * model.f_c,
            RateIndependent::Dahl(model) => dahl::advance(model, self.x[0], way),
            RateIndependent::MaxwellSlip(model) => {
                maxwell_slip::stop(self.x[i], way, model.delta[i])
            }
        }
    }

    fn force(&self, q: f64) -> f64 {
        let way = q - self.q;
        match self.of {
            RateIndependent::Dahl(_) => self.state(0, way),
            RateIndependent::MaxwellSlip(model) => {
                model.k.iter().enumerate().map(|(i, k)| k * self.state(i, way)).sum()
            }
        }
    }

    /// Whether the motion is over at `q`, `v`: beyond the next kink, or backwards.
    fn is_over(&self, (q, v): (f64, f64)) -> bool {
        let beyond = self.kinks.last().is_some_and(|kink| self.s * (q - self.q) > *kink);
        beyond || self.s * v < 0.0
    }

    /// Writes the model's states and their derivatives at `q`, `v`.
    fn write(&self, (q, v): (f64, f64), x: &mut [f64], x_dot: &mut [f64]) {
        let way = q - self.q;
        match self.of {
            RateIndependent::Dahl(model) => {
                x[0] = self.state(0, way);
                model.x_dot(x, q, v, x_dot);
            }
            RateIndependent::MaxwellSlip(model) => {
                for i in 0..x.len() {
                    x[i] = q - self.state(i, way);
                    let slips = model.delta[i] - self.s * self.x[i] <= self.passed;
                    x_dot[i] = if slips { v } else { 0.0 };
                }
            }
        }
    }
}

struct Run<'a> {
    of: &'a ByDisplacement,
    t: f64,
    q: f64,
    v: f64,
    memory: Memory<'a>,
    /// When the motion last turned [s].
    turned: f64,
    path: Path,
}

impl Run<'_> {
    /// Integrates to the time `end`, which a step is made to meet.
    fn to(&mut self, end: f64, steps: Steps) {
        // Times are counted from the last event, so that the rounding of t does not add up.
        let (mut from, mut count) = (self.t, 0_u32);
        while self.t < end {
            let left = end - self.t;
            let whole = steps.h < left * (1.0 - 1e-9);
            let h = if whole { steps.h } else { left };
            let next = self.step(h);
            if self.memory.is_over(next) {
                self.event(h);
                (from, count) = (self.t, 0);
                continue;
            }
            count += 1;
            self.t = if whole { from + f64::from(count) * h } else { end };
            (self.q, self.v) = next;
            if self.memory.s == 0.0 && self.v != 0.0 {
                self.memory.s = sgn(self.v);
                self.memory.set_out(self.memory.s, self.q);
            }
            if !whole || count.is_multiple_of(steps.every.max(1)) {
                self.node();
            }
        }
    }

    /// The end of a classic Runge–Kutta step of the length `h`.
    fn step(&self, h: f64) -> (f64, f64) {
        let (t, q, v) = (self.t, self.q, self.v);
        let drive = [t, t + 0.5 * h, t + h].map(|t| self.drive(t));
        let a = |q: f64, drive: f64| self.of.plant.acceleration(q, drive, self.memory.force(q));
        let (v1, a1) = (v, a(q, drive[0]));
        let (v2, a2) = (v + 0.5 * h * a1, a(q + 0.5 * h * v1, drive[1]));
        let (v3, a3) = (v + 0.5 * h * a2, a(q + 0.5 * h * v2, drive[1]));
        let (v4, a4) = (v + h * a3, a(q + h * v3, drive[2]));
        let mean = |k1: f64, k2: f64, k3: f64, k4: f64| (k1 + 2.0 * (k2 + k3) + k4) / 6.0;
        (q + h * mean(v1, v2, v3, v4), v + h * mean(a1, a2, a3, a4))
    }

    /// Goes to the end of the motion that lies within `h`, by bisection on the length of the step.
    fn event(&mut self, h: f64) {
        let (mut low, mut high) = (0.0, h);
        loop {
            let middle = low + 0.5 * (high - low);
            // Where the time itself has no digit between them any more the event is found.
            if middle <= low || middle >= high || self.t + low == self.t + high {
                break;
            }
            if self.memory.is_over(self.step(middle)) {
                high = middle;
            } else {
                low = middle;
            }
        }
        let end = self.step(high);
        let turns = self.memory.s * end.1 < 0.0;
        if turns && self.path.end().is_some_and(|(t, _)| t == self.turned) {
            // Between two turns a node shows which way the motion went.
            self.node_at(if self.t == self.turned { 0.5 * high } else { 0.0 });
        }
        (self.q, self.v) = if turns { (end.0, 0.0) } else { end };
        self.t += high;
        self.node();
        if turns {
            // Where v only touches 0 the force still drives the old way, and nothing turns.
            let pull = sgn(self.acceleration());
            let s = if pull == 0.0 { -self.memory.s } else { pull };
            if s != self.memory.s {
                self.turned = self.t;
                self.memory.set_out(s, self.q);
            }
        } else if let Some(kink) = self.memory.kinks.pop() {
            self.memory.passed = kink;
            self.node();
        }
    }

    fn drive(&self, t: f64) -> f64 {
        self.of.plant.drive(self.of.input.u(t))
    }

    fn acceleration(&self) -> f64 {
        self.of.plant.acceleration(self.q, self.drive(self.t), self.memory.force(self.q))
    }

    fn node(&mut self) {
        self.node_at(0.0);
    }

    /// Writes the node at `h` [s] after the present time, this side of the next event.
    fn node_at(&mut self, h: f64) {
        let (mut y, mut y_dot) = (vec![0.0; self.path.states()], vec![0.0; self.path.states()]);
        let (t, (q, v)) = (self.t + h, if h > 0.0 { self.step(h) } else { (self.q, self.v) });
        (y[0], y[1]) = (q, v);
        let friction = self.memory.force(q);
        (y_dot[0], y_dot[1]) = (v, self.of.plant.acceleration(q, self.drive(t), friction));
        self.memory.write((q, v), &mut y[2..], &mut y_dot[2..]);
        self.path.push(t, &y, &y_dot);
    }
}
