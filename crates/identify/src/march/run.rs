//! From sample to sample, with steps as short as the error asks for.

use super::{
    Drive, Dual, Model,
    course::{course, rate},
    plant::Stage,
    stage::{Base, Seek, velocity},
    tableau::{A, C, ERROR, GAMMA},
    tape::{Motion, Step, Tape},
};

/// The state at the first sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Start<D> {
    /// Displacement [m].
    pub q: D,
    /// Velocity [m/s].
    pub v: D,
    /// States of the contact.
    pub z: Vec<D>,
    /// What the velocity sensor shows there, if that was looked at.
    pub shown: Option<Shown>,
}

/// What the velocity sensor shows at the first sample: it may follow what was before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shown {
    /// The velocity [m/s].
    pub v: f64,
    /// A sensor that takes so long [s] begins half with this, half as if the motion had gone on as it does for long: what is
    /// shown is noisy, and a slower one remembers more.
    pub half: f64,
}

/// What a step may be wrong by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// In the displacement [m].
    pub q: f64,
    /// In the velocity [m/s].
    pub v: f64,
    /// In the states of the contact, of their natural size [1].
    pub z: f64,
    /// The largest number of steps.
    pub steps: usize,
}

/// Why there is no motion.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MotionError {
    /// No finite state follows, however short the step.
    #[error("no finite motion after {time} s")]
    NotFinite {
        /// The time [s].
        time: f64,
    },
    /// More steps than allowed.
    #[error("{steps} steps end at {time} s already")]
    TooManySteps {
        /// How many were taken.
        steps: usize,
        /// The time reached [s].
        time: f64,
    },
}

/// The last Newton step for a stage's velocity, of what the velocity may be wrong by: what it leaves is of its square.
const NEAR: f64 = 1e-3;

/// A stage begins at the velocity at which it would go on if that is more than so much of the one before.
const SLOWED: f64 = 0.5;

/// How slow the plant is where it turns, of the same.
const TURNED: f64 = 1e-5;

/// The shortest step, as a share of a sample interval; there the error is no longer asked for.
const SHORTEST: f64 = 1e-6;

/// Marches `model` through the samples at `time` [s] from `start`.
pub fn march(
    model: &Model<f64>,
    drive: &Drive<'_>,
    time: &[f64],
    start: &Start<f64>,
    tolerance: &Tolerance,
) -> Result<Motion, MotionError> {
    let mut walker = Walker::new(model, start, tolerance);
    let mut motion = Motion::default();
    let mut way = Vec::with_capacity(time.len());
    for (i, t) in time.iter().enumerate() {
        motion.q.push(model.displacement(walker.q, &walker.z));
        motion.v.push(walker.v);
        way.push(walker.q);
        let course = course(drive, i, &motion.q, model.delay().map(|delay| (delay, time)));
        motion.u.push(course.ends[0]);
        if let Some(next) = time.get(i + 1) {
            for ([from, to], ends) in course.parts(next - t) {
                let h = walker.h;
                walker.interval(t + from, to - from, ends, &mut motion.tape)?;
                // The first of two parts may be short, which says nothing of how long the steps of the other may be.
                if to < next - t {
                    walker.h = walker.h.max(h.min(next - t));
                }
            }
            motion.tape.until.push(motion.tape.steps.len());
        }
    }
    if !model.effects.is_empty() {
        seen(model, (drive, time, &way), start.shown, &mut motion);
    }
    Ok(motion)
}

/// Turns displacement and velocity into what the sensors show of them, where the mass itself went along the `way` [m].
fn seen(
    model: &Model<f64>,
    (drive, time, way): (&Drive<'_>, &[f64], &[f64]),
    shown: Option<Shown>,
    motion: &mut Motion,
) {
    let mut memory = vec![0.0; model.effects.len()];
    let mut last = motion.v[0];
    for i in 0..motion.q.len() {
        let (q, v) = (motion.q[i], motion.v[i]);
        let dt = if i == 0 { 0.0 } else { time[i] - time[i - 1] };
        let rate = model.balance.gain * rate(drive, time, i);
        let slope = match (i, motion.v.get(1)) {
            (0, Some(next)) => (next - v) / (time[1] - time[0]),
            (0, None) => 0.0,
            _ => (v - last) / dt,
        };
        let (slope, bend) = match (i, motion.v.get(2)) {
            (0, Some(third)) => begun([v, motion.v[1], *third], time[1] - time[0]),
            _ => (slope, 0.0),
        };
        let bulge = if i == 0 { 0.0 } else { bulge(way[i] - way[i - 1], [last, v], dt) };
        let now = [q, v, bulge, slope, bend];
        let shown = shown.filter(|_| i == 0);
        [motion.q[i], motion.v[i]] = model.senses(now, ([rate, dt], shown), &mut memory);
        last = v;
    }
}

/// By how much a velocity was more in the mean than along the line between its ends, where the mass came so far in `dt` [s].
pub(super) fn bulge<D: super::Real>(far: D, [from, to]: [D; 2], dt: f64) -> D {
    far / dt - (from + to) * 0.5
}

/// How fast a velocity changes at the first of three samples `dt` [s] apart, and how fast that does, by the parabola
/// through them.
pub(super) fn begun<D: super::Real>([first, second, third]: [D; 3], dt: f64) -> (D, D) {
    let bend = (third - second * 2.0 + first) / (dt * dt);
    ((second - first) / dt - bend * (0.5 * dt), bend)
}

struct Walker<'a> {
    model: &'a Model<f64>,
    probe: Model<Dual<1>>,
    /// The probe's mass [kg].
    mass: Dual<1>,
    tolerance: &'a Tolerance,
    /// What a step may be wrong by in each state of contact and effects.
    allowed: Vec<f64>,
    q: f64,
    v: f64,
    /// How fast the velocity changed last [m/s²].
    v_dot: f64,
    z: Vec<f64>,
    h: f64,
    /// Derivatives of the states of the contact in the three stages, and scratch.
    z_dot: [Vec<f64>; 3],
    z_stage: Vec<f64>,
    base: Base<Dual<1>>,
    z_probe: Vec<Dual<1>>,
}

/// What a step leads to.
struct Attempt {
    step: Step,
    q: f64,
    v: f64,
    v_dot: f64,
    error: f64,
}

impl<'a> Walker<'a> {
    fn new(model: &'a Model<f64>, start: &Start<f64>, tolerance: &'a Tolerance) -> Self {
        let n = model.states();
        let none = vec![Dual::from(0.0); n];
        let probe = model.map(Dual::from);
        Self {
            model,
            mass: probe.mass(),
            probe,
            tolerance,
            allowed: model.allowed(tolerance),
            q: start.q,
            v: start.v,
            v_dot: 0.0,
            z: start.z.clone(),
            h: f64::INFINITY,
            z_dot: std::array::from_fn(|_| vec![0.0; n]),
            z_stage: vec![0.0; n],
            base: Base { q: Dual::from(0.0), v: Dual::from(0.0), z: none.clone() },
            z_probe: none,
        }
    }

    /// Goes through one interval of length `dt` [s] from the time `t`, with the input at its two `ends`.
    fn interval(
        &mut self,
        t: f64,
        dt: f64,
        ends: [f64; 2],
        tape: &mut Tape,
    ) -> Result<(), MotionError> {
        let mut from = 0.0;
        while from < dt {
            let left = dt - from;
            let mut h = match self.h {
                h if h >= left => left,
                h if 2.0 * h > left => 0.5 * left,
                h => h,
            };
            loop {
                let span = [from, h, dt, t];
                let attempt = self.attempt(span, ends, None);
                let attempt = self.turned(attempt, span, ends);
                let enough = attempt.as_ref().is_some_and(|a| a.error <= 1.0);
                let shortest = h <= SHORTEST * dt;
                let taken = attempt.as_ref().is_some_and(|a| a.error.is_finite()) && shortest;
                let grows = attempt.as_ref().map_or(0.2, |a| growth(a.error));
                match attempt {
                    Some(attempt) if enough || taken => {
                        from = if attempt.step.h == left { dt } else { from + attempt.step.h };
                        self.take(&attempt, tape);
                        self.h = h * grows;
                        break;
                    }
                    _ if shortest => return Err(MotionError::NotFinite { time: t + from }),
                    _ => h *= grows.min(0.5),
                }
            }
            if tape.steps.len() > self.tolerance.steps {
                return Err(MotionError::TooManySteps { steps: tape.steps.len(), time: t + from });
            }
        }
        Ok(())
    }

    fn take(&mut self, attempt: &Attempt, tape: &mut Tape) {
        (self.q, self.v, self.v_dot) = (attempt.q, attempt.v, attempt.v_dot);
        self.z.copy_from_slice(&self.z_stage);
        tape.steps.push(attempt.step);
    }

    /// One step of length `h` from `from` in an interval of length `dt`; none if a stage has no velocity.
    /// Coulomb friction slides the given `way`, or as it will.
    fn attempt(
        &mut self,
        [from, h, dt, t]: [f64; 4],
        ends: [f64; 2],
        way: Option<f64>,
    ) -> Option<Attempt> {
        let gh = GAMMA * h;
        let mut step = Step { from: from / dt, h, v: [0.0; 3], way: [0.0; 3], turn: 1.0 };
        let (mut v_dot, mut v, mut q) = ([0.0; 3], self.v, self.q);
        for s in 0..3 {
            let mut base = [self.q, self.v];
            for j in 0..s {
                base[0] += h * A[s][j] * step.v[j];
                base[1] += h * A[s][j] * v_dot[j];
            }
            for (i, z) in self.z.iter().enumerate() {
                let mut sum = *z;
                for (a, z_dot) in A[s].iter().zip(&self.z_dot).take(s) {
                    sum += h * a * z_dot[i];
                }
                self.base.z[i] = Dual::from(sum);
            }
            (self.base.q, self.base.v) = (Dual::from(base[0]), Dual::from(base[1]));
            let u = ends[0] + (ends[1] - ends[0]) * ((from + C[s] * h) / dt);
            let at = [t + from + C[s] * h, gh];
            let stage = Stage::moving(self.mass, &self.probe, at, Dual::from(u));
            // As fast as it would be if it went on to gain speed as in the stage before. Where that leads near to rest a
            // bristle in its Stribeck zone could stick as well as slide: there it goes on from where it is.
            let on = base[1] + gh * if s == 0 { self.v_dot } else { v_dot[s - 1] };
            let guess = if v == 0.0 || on / v > SLOWED { on } else { v };
            let seek = Seek { guess, close: NEAR * self.tolerance.v, way };
            let (root, way) = velocity(&self.probe, &self.base, &stage, seek, &mut self.z_probe)?;
            v = root;
            (step.v[s], step.way[s]) = (v, way);
            v_dot[s] = (v - base[1]) / gh;
            q = base[0] + gh * v;
            for (i, z) in self.z_probe.iter().enumerate() {
                self.z_stage[i] = z.re;
                self.z_dot[s][i] = (z.re - self.base.z[i].re) / gh;
            }
        }
        let error = self.error(h, [step.v, v_dot]);
        (q.is_finite() && v.is_finite()).then_some(Attempt { step, q, v, v_dot: v_dot[2], error })
    }

    /// The attempt itself, or, where Coulomb friction turns or stops the motion in it, the step up to there.
    ///
    /// The stages alone would not see a turn before the first of them, nor would derivatives over fixed steps
    /// see that its time moves.
    fn turned(
        &mut self,
        attempt: Option<Attempt>,
        [from, h, dt, t]: [f64; 4],
        ends: [f64; 2],
    ) -> Option<Attempt> {
        let Some(found) = &attempt else { return attempt };
        if !self.model.sticks() {
            return attempt;
        }
        let way = if self.v == 0.0 { found.step.way[0] } else { self.v.signum() };
        if way == 0.0 || found.step.way.iter().all(|w| *w == way) {
            return attempt;
        }
        let (mut short, mut long) = (0.0, h);
        let mut h = h;
        for _ in 0..60 {
            let mut there = self.attempt([from, h, dt, t], ends, Some(way))?;
            let slope = (there.v - self.v) / h;
            if there.v.abs() <= TURNED * self.tolerance.v || long - short <= f64::EPSILON * long {
                let u = ends[0] + (ends[1] - ends[0]) * ((from + h) / dt);
                let stage = Stage::of(self.model, [t + from + h, 0.0], u);
                let [before, after] = [way, -way].map(|way| self.pull(&stage, there.q, way));
                let sticks = before * way <= 0.0 && after * way >= 0.0;
                there.step.turn = if sticks || before == 0.0 { 0.0 } else { after / before };
                there.v = 0.0;
                return Some(there);
            }
            if there.v * way > 0.0 {
                short = h;
            } else {
                long = h;
            }
            let next = h - there.v / slope;
            h = if next > short && next < long { next } else { 0.5 * (short + long) };
        }
        None
    }

    /// The force on the mass [N] at rest where Coulomb friction slides in the direction `way`.
    fn pull(&mut self, stage: &Stage<f64>, q: f64, way: f64) -> f64 {
        let z = self.z_stage.clone();
        let mut scratch = z.clone();
        self.model.force(stage, &z, (q, 0.0, way), &mut scratch)
    }

    /// The estimated error of a step, of what is allowed.
    fn error(&self, h: f64, [q_dot, v_dot]: [[f64; 3]; 2]) -> f64 {
        let weighed = |rates: [f64; 3]| h * (0..3).map(|s| ERROR[s] * rates[s]).sum::<f64>().abs();
        let mut worst = (weighed(q_dot) / self.tolerance.q).max(weighed(v_dot) / self.tolerance.v);
        for (i, allowed) in self.allowed.iter().enumerate() {
            worst = worst.max(weighed(std::array::from_fn(|s| self.z_dot[s][i])) / allowed);
        }
        worst
    }
}

fn growth(error: f64) -> f64 {
    if error.is_finite() { (0.9 * error.powf(-1.0 / 3.0)).clamp(0.2, 4.0) } else { 0.2 }
}
