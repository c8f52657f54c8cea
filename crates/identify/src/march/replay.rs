//! The same steps once more, with derivatives.

use super::{
    Drive, Dual, Model, Real, Start, Tape,
    course::{Course, course, errors, rate, unit},
    plant::Stage,
    run::{begun, bulge},
    stage::{Base, excess},
    tableau::{A, C, GAMMA},
    tape::Step,
};
use crate::Hold;

/// Goes over the steps of `tape` with numbers that carry derivatives in their first P − 1 places; the last one
/// belongs to the stages. Calls `see(i, q, v, u)` at every sample.
///
/// With G(v, p) = 0 the balance of a stage, ∂v/∂p = −(∂G/∂p)/(∂G/∂v).
pub fn replay<const P: usize>(
    model: &Model<Dual<P>>,
    (drive, time): (&Drive<'_>, &[f64]),
    tape: &Tape,
    start: &Start<Dual<P>>,
    see: &mut dyn FnMut(usize, Dual<P>, Dual<P>, Dual<P>),
) {
    let samples = tape.until.len() + 1;
    let mut state = start.clone();
    let mut seen = Vec::with_capacity(3);
    let mut walker = Again::new(model);
    let mut memory = vec![Dual::<P>::from(0.0); model.effects.len()];
    let mut sensed = |i: usize, now: [Dual<P>; 4], before: [Dual<P>; 4], (slope, bend)| {
        let dt = if i == 0 { 0.0 } else { time[i] - time[i - 1] };
        let rate = model.balance.gain.re() * rate(drive, time, i);
        let shown = start.shown.filter(|_| i == 0);
        let bulge =
            if i == 0 { 0.0.into() } else { bulge(now[3] - before[3], [before[1], now[1]], dt) };
        let now_seen = [now[0], now[1], bulge, slope, bend];
        let [q, v] = model.senses(now_seen, ([rate, dt], shown), &mut memory);
        see(i, q, v, now[2]);
    };
    let zero = Dual::<P>::from(0.0);
    let line = |i: usize, now: &[Dual<P>; 4], before: &[Dual<P>; 4]| {
        ((now[1] - before[1]) / (time[i] - time[i - 1]), zero)
    };
    // How fast the velocity changes at first is told by those that follow.
    let mut first: Vec<[Dual<P>; 4]> = Vec::with_capacity(3);
    let mut before = [zero; 4];
    let mut next = 0;
    for i in 0..samples {
        if seen.len() == 3 {
            seen.remove(0);
        }
        let shown = model.displacement(state.q, &state.z);
        seen.push(shown);
        let course = course(drive, i, &seen, model.delay().map(|delay| (delay, time)));
        let now = [shown, state.v, course.ends[0], state.q];
        if i < 3 {
            first.push(now);
        }
        if i == 2 || i < 2 && i + 1 == samples {
            let begins = match first.as_slice() {
                [a, b, c] => begun([a[1], b[1], c[1]], time[1] - time[0]),
                [a, b] => line(1, b, a),
                _ => (zero, zero),
            };
            sensed(0, first[0], first[0], begins);
            for (i, pair) in (1..).zip(first.windows(2)) {
                sensed(i, pair[1], pair[0], line(i, &pair[1], &pair[0]));
            }
        } else if i > 2 {
            sensed(i, now, before, line(i, &now, &before));
        }
        before = now;
        if i + 1 < samples {
            walker.interval(
                &mut state,
                &tape.steps[next..tape.until[i]],
                [time[i], time[i + 1]],
                &course,
            );
            next = tape.until[i];
        }
    }
}

/// How the deviations of a motion go on from one sample to the next, a small one of the states s by A, one of the input's
/// w by g: s⁺ = A s + Σ g w; and what is seen of them there, y⁺ = C s + Σ d w, y being what the sensors show of displacement
/// and velocity, over the errors of so many samples of the input as [`errors`] says. The states are displacement, velocity,
/// those of contact and effects, and the sensors' memories.
#[derive(Debug, Clone)]
pub struct Passage<const P: usize> {
    /// The new states, each with its derivatives by the old ones and, after them, by the errors, the oldest first.
    pub states: Vec<[f64; P]>,
    /// The same of displacement and velocity as they are seen.
    pub seen: [[f64; P]; 2],
}

/// How many states [`passages`] has of a model.
pub fn deviations<D: Real>(model: &Model<D>) -> usize {
    2 + model.states() + model.effects.len()
}

/// Goes over the steps of `tape` with derivatives from sample to sample alone. There has to be a place more than for
/// [`deviations`] and [`errors`].
pub fn passages<const P: usize>(
    model: &Model<f64>,
    (drive, time): (&Drive<'_>, &[f64]),
    tape: &Tape,
    start: &Start<f64>,
    see: &mut dyn FnMut(Passage<P>),
) {
    let model = model.map(Dual::<P>::from);
    let mut walker = Again::new(&model);
    let zero = Dual::<P>::from(0.0);
    let n = model.states();
    let mut memory = vec![zero; model.effects.len()];
    let mut state = Start {
        q: Dual::from(start.q),
        v: Dual::from(start.v),
        z: start.z.iter().copied().map(Dual::from).collect(),
        shown: start.shown,
    };
    let hold = match drive {
        Drive::Recorded { hold, .. } => *hold,
        Drive::Controlled(_) => Hold::ZeroOrder,
    };
    let of = errors(hold, model.delay().is_some());
    let place = |place: usize, number: &Dual<P>| Dual::variable(number.re, place);
    let mut next = 0;
    for i in 0..tape.until.len() {
        (state.q, state.v) = (place(0, &state.q), place(1, &state.v));
        for (k, z) in state.z.iter_mut().enumerate() {
            *z = place(2 + k, z);
        }
        for (k, own) in memory.iter_mut().enumerate() {
            *own = place(2 + n + k, own);
        }
        let before = [model.displacement(state.q, &state.z), state.v, state.q];
        let delay = model.delay().map(|delay| (delay, time));
        let first = 2 + n + memory.len();
        let noise: Vec<Dual<P>> = (0..of).map(|k| Dual::variable(0.0, first + k)).collect();
        let dt = time[i + 1] - time[i];
        let share = model.delay().map(|delay| (delay.re / dt).rem_euclid(1.0));
        let course = course(drive, i, &[before[0]], delay).raised(&noise, |k| unit(k, hold, share));
        walker.interval(
            &mut state,
            &tape.steps[next..tape.until[i]],
            [time[i], time[i + 1]],
            &course,
        );
        next = tape.until[i];
        let shown = model.displacement(state.q, &state.z);
        let slope = (state.v - before[1]) / dt;
        let rate = |i: usize| model.balance.gain.re() * rate(drive, time, i);
        if i == 0 {
            model.senses(
                [before[0], before[1], zero, slope, zero],
                ([rate(0), 0.0], start.shown),
                &mut memory,
            );
        }
        let bulge = bulge(state.q - before[2], [before[1], state.v], dt);
        let now = [shown, state.v, bulge, slope, zero];
        let seen = model.senses(now, ([rate(i + 1), dt], None), &mut memory);
        let states = [state.q, state.v].into_iter().chain(state.z.iter().copied());
        let states = states.chain(memory.iter().copied()).map(|s| s.eps).collect();
        see(Passage { states, seen: seen.map(|y| y.eps) });
    }
}

/// The lengths of the steps of a part come to it but for so much.
const ROUNDING: f64 = 1e-9;

struct Again<'a, const P: usize> {
    model: &'a Model<Dual<P>>,
    /// The model's mass [kg].
    mass: Dual<P>,
    base: Base<Dual<P>>,
    z_dot: [Vec<Dual<P>>; 3],
    z: Vec<Dual<P>>,
}

impl<'a, const P: usize> Again<'a, P> {
    fn new(model: &'a Model<Dual<P>>) -> Self {
        let zero = Dual::<P>::from(0.0);
        let none = vec![zero; model.states()];
        Self {
            model,
            mass: model.mass(),
            base: Base { q: zero, v: zero, z: none.clone() },
            z_dot: std::array::from_fn(|_| none.clone()),
            z: none,
        }
    }

    /// The steps of an interval from one time to the other [s].
    fn interval(
        &mut self,
        state: &mut Start<Dual<P>>,
        mut steps: &[Step],
        [t, end]: [f64; 2],
        course: &Course<Dual<P>>,
    ) {
        let dt = end - t;
        // Where the input jumps the force does. When it does moves with the parameters, and with it the velocity after it.
        let kick = course.knot.map(|knot| {
            let [before, after] = knot.sides.map(|u| self.model.driving(u).re);
            let when = Dual { re: 0.0, eps: knot.share.eps };
            when * (dt * (before - after) / self.mass.re)
        });
        let mut parts = course.parts(dt).peekable();
        while let Some(([from, to], ends)) = parts.next() {
            // The last part begins where it jumps, which may be where the interval does.
            if let (Some(kick), None) = (kick, parts.peek()) {
                state.v += kick;
            }
            let mut long = 0.0;
            let many = steps.iter().take_while(|step| {
                let own = long < (to - from) * (1.0 - ROUNDING);
                long += if own { step.h } else { 0.0 };
                own
            });
            let many = if parts.peek().is_some() { many.count() } else { steps.len() };
            let long: f64 = steps[..many].iter().map(|step| step.h).sum();
            for step in &steps[..many] {
                self.step(state, step, [long, t + from], ends);
            }
            steps = &steps[many..];
        }
    }

    fn step(
        &mut self,
        state: &mut Start<Dual<P>>,
        step: &Step,
        [dt, t]: [f64; 2],
        ends: [Dual<P>; 2],
    ) {
        let (h, gh) = (step.h, GAMMA * step.h);
        let zero = Dual::<P>::from(0.0);
        let (mut q_dot, mut v_dot) = ([zero; 3], [zero; 3]);
        for s in 0..3 {
            (self.base.q, self.base.v) = (state.q, state.v);
            self.base.z.copy_from_slice(&state.z);
            for j in 0..s {
                self.base.q += q_dot[j] * (h * A[s][j]);
                self.base.v += v_dot[j] * (h * A[s][j]);
                for (z, z_dot) in self.base.z.iter_mut().zip(&self.z_dot[j]) {
                    *z += *z_dot * (h * A[s][j]);
                }
            }
            let u = ends[0] + (ends[1] - ends[0]) * (step.from + C[s] * h / dt);
            let at = [t + step.from * dt + C[s] * h, gh];
            let stage = Stage::moving(self.mass, self.model, at, u);
            let v = self.velocity(&stage, [step.v[s], step.way[s]]);
            (q_dot[s], v_dot[s]) = (v, (v - self.base.v) / gh);
            for (i, z) in self.z.iter().enumerate() {
                self.z_dot[s][i] = (*z - self.base.z[i]) / gh;
            }
        }
        state.q = self.base.q + q_dot[2] * gh;
        // Where the motion turns the velocity is zero, but the time of it moves with the parameters, and with it
        // the velocity after it.
        state.v = if step.turn == 1.0 { q_dot[2] } else { (q_dot[2] - q_dot[2].re()) * step.turn };
        state.z.copy_from_slice(&self.z);
    }

    /// The velocity of a stage with its derivatives; leaves the stage's states in `self.z`.
    fn velocity(&mut self, stage: &Stage<Dual<P>>, [v, way]: [f64; 2]) -> Dual<P> {
        let sticks = self.model.sticks();
        if sticks && way == 0.0 {
            // What is beside the mass may move on.
            let held = Dual::from(0.0);
            excess(self.model, &self.base, stage, (held, 0.0), &mut self.z);
            return held;
        }
        let alone = Dual::<P>::variable(v, P - 1);
        let way = if sticks { way } else { 0.0 };
        let balance = excess(self.model, &self.base, stage, (alone, way), &mut self.z);
        let slope = -balance.eps[P - 1].recip();
        let mut by = balance.eps.map(|e| e * slope);
        by[P - 1] = 0.0;
        for z in &mut self.z {
            let follows = z.eps[P - 1];
            for (eps, by) in z.eps.iter_mut().zip(by) {
                *eps += by * follows;
            }
            z.eps[P - 1] = 0.0;
        }
        Dual { re: v, eps: by }
    }
}
