//! The misfit of a model to a record, and how it changes with every free parameter.

use super::{
    binding::{Free, Scale, given, model},
    data::Data,
    displacement::Course,
    imposed::forces,
    weights::bend,
    window::{ONE_MASS, START, Window},
    work::Work,
};
pub use super::{
    piece::{Lead, Piece, Slopes},
    slopes::Along,
    weights::Weights,
};
use crate::{
    Rig,
    march::{Drive, Dual, Feedback, Model, Motion, Real, Start, Tolerance, march},
};
use std::{borrow::Cow, sync::Arc};

/// A record, a rig and what of it is free: the least-squares problem of the fit.
///
/// The state at each window's start is unknown, too. It follows the parameters along the straight line that
/// the last Jacobian gave, and its part of the misfit is projected out of the Jacobian: so the solver sees
/// the parameters alone, and takes the steps it would take if it saw both.
#[derive(Debug, Clone)]
pub struct Problem<'a> {
    /// The rig.
    pub rig: &'a Rig,
    /// The record.
    pub data: &'a Data,
    /// The largest speed of the record [m/s].
    pub speed: f64,
    /// What is free.
    pub free: Vec<Free>,
    /// The windows that are simulated.
    pub windows: Vec<Window>,
    /// Whether the controller is simulated, too.
    pub closed_loop: bool,
    /// The distance over which the nominal contact forgets where it was [m].
    pub memory: f64,
    /// By what the residuals of every sample are multiplied [1]: by 0 where it does not count; all by 1 if empty.
    pub shares: Vec<f64>,
    /// Free parameters that are held near a value [its unit], and how near, in the fit's variable.
    pub priors: Vec<(String, f64, f64)>,
    /// What a residual of each channel is divided by [its unit]: displacement, velocity, input, force, loads.
    pub weights: Weights,
    /// By how much more than by its noise a sample of the displacement, or of the force, may be off [its unit]; none if
    /// empty.
    pub spread: Cow<'a, [f64]>,
    /// The steps' tolerance, of the spans of displacement and velocity [1].
    pub tolerance: f64,
    /// The course of the whole record if its motion is imposed; else empty.
    pub course: Arc<Course>,
    /// That of the motion along which derivatives are taken [1]: shorter steps than this do not make them better.
    pub slopes: f64,
    /// Whether a velocity's time counts only where it bends: in windows that begin anew no break-away is off for long.
    pub bends: bool,
    /// What has been simulated for it and its clones.
    pub work: Work,
}

/// How well the time of a break-away is known, in sampling times; noise does not bend by more than so many times itself: its
/// second differences are √6 as large.
const TIMING: f64 = 0.1;
const BENDS: f64 = 8.0;

/// The residual of a sample without a motion, in standard deviations: far worse than any motion's.
const NO_MOTION: f64 = 1e4;

impl Problem<'_> {
    /// The number of residuals of a window.
    pub(super) fn rows(&self, window: &Window) -> usize {
        window.len() * self.channels() + self.starts()
    }

    /// How many numbers of a window's start are unknown.
    pub(super) fn starts(&self) -> usize {
        match self.data.force {
            Some(_) => 0,
            None if self.rig.two_masses() => START,
            None => ONE_MASS,
        }
    }

    /// How many residuals a sample has.
    pub fn channels(&self) -> usize {
        if self.data.force.is_some() {
            return 1;
        }
        1 + usize::from(self.data.velocity.is_some()) + usize::from(self.closed_loop)
    }

    /// The value of free parameter `i` [its unit] at the variables `x`.
    pub fn value(&self, i: usize, x: &[f64]) -> f64 {
        let own = self.free[i].value(x[i]);
        if !matches!(self.free[i].scale, Scale::Above(_)) {
            return own;
        }
        let below = self.free.iter().position(|f| f.name == "f_c");
        own + below.map_or_else(|| given(self.rig, "f_c"), |j| self.free[j].value(x[j]))
    }

    /// The course of the imposed motion in a window.
    pub(super) fn course(&self, window: &Window) -> Cow<'_, Course> {
        if window.len() == self.data.time.len() {
            return Cow::Borrowed(&self.course);
        }
        let range = window.first..window.end;
        Cow::Owned(Course::of(&self.data.time[range.clone()], &self.data.input[range]))
    }

    /// The model at the variables `x`.
    pub fn model(&self, x: &[f64]) -> Model<f64> {
        self.model_of(&|i| self.free[i].value(x[i]))
    }

    /// The model with derivatives by the variables from `first` on in its first places.
    pub(super) fn model_with<const P: usize>(&self, x: &[f64], first: usize) -> Model<Dual<P>> {
        self.model_of(&|i| {
            let value = self.free[i].value(x[i]);
            match i.checked_sub(first) {
                Some(place) if place < P - 1 => {
                    let mut number = Dual::from(value);
                    number.eps[place] = self.free[i].slope(value);
                    number
                }
                _ => Dual::from(value),
            }
        })
    }

    fn model_of<D: Real>(&self, value: &dyn Fn(usize) -> D) -> Model<D> {
        let find = |name: &str| self.free.iter().position(|f| f.name == name);
        model(self.rig, &|name| {
            let i = find(name)?;
            if !matches!(self.free[i].scale, Scale::Above(_)) {
                return Some(value(i));
            }
            let below = find("f_c").map_or_else(|| D::from(given(self.rig, "f_c")), value);
            Some(below + value(i))
        })
    }

    pub(super) fn drive(&self, window: &Window) -> Drive<'_> {
        let range = window.first..window.end;
        match (&self.rig.controller, self.closed_loop) {
            (Some(c), true) => Drive::Controlled(Feedback {
                kp: c.kp,
                kv: c.kv,
                limit: c.limit,
                sample_time: c.sample_time,
                reference: &self.data.reference[range.clone()],
                added: self.data.added.get(range).unwrap_or(&[]),
            }),
            _ => Drive::Recorded {
                values: &self.data.input[..window.end],
                first: window.first,
                hold: self.data.hold,
            },
        }
    }

    /// Simulates one window from `start` at the variables `x`.
    pub fn piece(&self, x: &[f64], window: &Window, start: [f64; START]) -> Piece {
        let model = self.model(x);
        let mut residuals = Vec::with_capacity(self.rows(window));
        let range = window.first..window.end;
        if let Some(force) = &self.data.force {
            let mut motion = Motion::default();
            self.work.add(window.len());
            forces(
                &model,
                (&self.data.time[range.clone()], &self.data.input[range], &self.course(window)),
                force.values[window.first],
                &mut |i, f| {
                    motion.q.push(f);
                    let i = window.first + i;
                    residuals.push((f - force.values[i]) / self.first_weight(i));
                },
            );
            self.finished(window, &mut residuals);
            return Piece { start, motion, residuals };
        }
        let state = self.state(&model, window, start);
        let motion = self.marched(&model, window, &state, self.tolerance).unwrap_or_default();
        for i in 0..window.len() {
            self.sample(window.first + i, &motion, i, &mut residuals);
        }
        self.finished(window, &mut residuals);
        for (i, spread) in window.spread.iter().enumerate().take(self.starts()) {
            residuals.push((start[i] - window.start[i]) / spread);
        }
        Piece { start, motion, residuals }
    }

    /// The motion of a window from the state `from`, in steps of this tolerance; none if there is no finite one.
    pub(super) fn marched(
        &self,
        model: &Model<f64>,
        window: &Window,
        from: &Start<f64>,
        tolerance: f64,
    ) -> Option<Motion> {
        let spans = self.spans(window, tolerance);
        let time = &self.data.time[window.first..window.end];
        let motion = march(model, &self.drive(window), time, from, &spans).ok();
        let steps = motion.as_ref().map_or(0, |motion| motion.tape.steps());
        self.work.add(steps.max(window.len()));
        motion
    }

    /// Makes a window's residuals independent of each other, and multiplies them by their shares.
    fn finished(&self, window: &Window, residuals: &mut [f64]) {
        if let Some(whitening) = &window.whitening {
            whitening.apply(residuals);
        }
        let shares = self.shares.get(window.first..window.end).unwrap_or_default();
        for (rows, share) in residuals.chunks_mut(self.channels()).zip(shares) {
            for residual in rows {
                *residual *= share;
            }
        }
    }

    /// The residuals of sample `i`, of the `motion` at place `at`; one without a motion is far off.
    fn sample(&self, i: usize, motion: &Motion, at: usize, out: &mut Vec<f64>) {
        let mut push = |values: &[f64], seen: f64, weight: f64| {
            let residual = values.get(at).map_or(NO_MOTION, |value| (value - seen) / weight);
            out.push(if residual.is_finite() { residual } else { NO_MOTION });
        };
        if let Some(seen) = &self.data.displacement {
            push(&motion.q, seen.values[i], self.first_weight(i));
        }
        if let Some(seen) = &self.data.velocity {
            push(&motion.v, seen.values[i], self.velocity_weight(&seen.values, i));
        }
        if self.closed_loop {
            push(&motion.u, self.data.input[i], self.weights.input);
        }
    }

    /// The standard deviation of a sample of the velocity: noise, and what it is off by for a share of a sample, by how it
    /// changes or, in windows, by how it bends.
    ///
    /// A sample in a break-away is worth what its time is: without this a few of them would decide the fit.
    pub(super) fn velocity_weight(&self, values: &[f64], i: usize) -> f64 {
        let noise = self.weights.velocity;
        let (before, after) = (i.saturating_sub(1), (i + 1).min(values.len() - 1));
        let bends = || (bend(values, i) - BENDS * noise).max(0.0);
        let by = if self.bends { bends() } else { 0.5 * (values[after] - values[before]) };
        noise.hypot(TIMING * by)
    }

    /// The standard deviation of a sample of the displacement, or of the force.
    pub(super) fn first_weight(&self, i: usize) -> f64 {
        let imposed = self.data.force.is_some();
        let own = if imposed { self.weights.force } else { self.weights.displacement };
        self.spread.get(i).map_or(own, |more| own.hypot(*more))
    }

    /// What the residuals of sample `i` are divided by: displacement, and velocity if it is seen.
    pub(super) fn weights_at(&self, i: usize) -> [f64; 2] {
        let seen = self.data.velocity.as_ref();
        let velocity = seen.map_or(1.0, |seen| self.velocity_weight(&seen.values, i));
        [self.first_weight(i), velocity]
    }

    /// What a step may be wrong by, and how many a window may take: what is lost in a short one is not sought for long.
    pub(super) fn spans(&self, window: &Window, tolerance: f64) -> Tolerance {
        let q = self.data.displacement.as_ref().map_or(1.0, |d| d.span.max(d.noise));
        let (v, n) = (self.speed.max(1e-12), window.len());
        // A step of order 3 gets shorter with the cube root of what it may be wrong by.
        let finer = (1e-5 / tolerance).cbrt().max(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within usize")]
        let steps = (finer * (64 * n + 1000).min(8 * n + 10_000) as f64) as usize;
        Tolerance { q: tolerance * q, v: tolerance * v, z: tolerance, steps }
    }
}
