//! A planted effect's plant, followed from event to event: samples, corners of the drive, reversals, break-aways.

use super::{LOAD_Q, LOAD_V, Planted, Q, V, Z};
use crate::{
    TwinError,
    driven::{root, root_up},
    hidden::Now,
    signal::Leg,
    wide::{MOST, Pace, State, step},
};

/// A plant on its way.
pub(crate) struct Followed<'a> {
    t: f64,
    pub(super) y: State,
    pub(super) plant: Planted<'a>,
    pace: Pace,
}

/// What displacements, speeds and an effect's states are at least, to be differenced over.
const TYPICAL: f64 = 1e-3;

impl<'a> Followed<'a> {
    /// A plant at rest in its contacts, at displacement q with speed v.
    pub(crate) fn new(mut plant: Planted<'a>, leg: Leg<'a>, start: (f64, f64), tol: f64) -> Self {
        plant.leg = leg;
        let (q, v) = if plant.balance.is_some() { start } else { leg.at(-plant.delay) };
        let mut y = [0.0; MOST];
        if plant.balance.is_some() {
            (y[Q], y[V]) = (q, v);
        }
        if plant.load.is_some() {
            (y[LOAD_Q], y[LOAD_V]) = (q, v);
        }
        let now = Now { q, v, load_q: q, load_v: v, level: plant.level, ..Now::default() };
        for placed in &plant.effects {
            placed.effect.start(&now, &mut y[placed.from..placed.to]);
        }
        if plant.remembers() && plant.balance.is_some() {
            let rests = v == 0.0 && plant.sticks();
            plant.turn(q, if rests { 0.0 } else { 1f64.copysign(v) });
        }
        let mut typical = [TYPICAL; MOST];
        typical[Z] = plant.grain;
        let mut pace = Pace::new(tol, typical);
        pace.saw(&y);
        Self { t: 0.0, y, plant, pace }
    }

    fn speed(&self, t: f64, y: &State) -> f64 {
        self.plant.motion(t, y).1
    }

    /// Follows the motion to `end`, along a leg on which the drive is smooth.
    pub(crate) fn follow(&mut self, leg: Leg<'a>, end: f64) -> Result<(), TwinError> {
        self.plant.leg = leg;
        if self.plant.balance.is_none() && self.plant.way == 0.0 && end > self.t {
            // An imposed motion starts relaxed, and then goes the way it is moved, once it is.
            let (from, to) = (leg.at(self.t).0, leg.at(f64::midpoint(self.t, end)).0);
            if to != from {
                self.plant.turn(from, (to - from).signum());
            }
        }
        let mut idle = 0;
        while self.t < end {
            if self.plant.stuck() {
                self.wait(end)?;
                continue;
            }
            let (h, next) = self.one(end)?;
            let back = self.plant.way * self.speed(self.t + h, &next) < 0.0;
            if self.plant.remembers() && back && idle < 2 {
                let reached = self.reversal(h);
                idle = if reached > 0.0 { 0 } else { idle + 1 };
                self.reverse(reached, end);
            } else {
                idle = 0;
                self.y = next;
                self.t = if h >= end - self.t { end } else { self.t + h };
            }
            self.pace.saw(&self.y);
        }
        Ok(())
    }

    fn one(&mut self, end: f64) -> Result<(f64, State), TwinError> {
        let reason = "its steps become too short";
        let motion = TwinError::Motion { time: self.t, reason };
        self.pace.step(&self.plant, self.t, &self.y, end).ok_or(motion)
    }

    /// The state after a step of h.
    fn after(&self, h: f64) -> Option<State> {
        Some(step(&self.plant, self.t, &self.y, h, &self.pace.size())?.0)
    }

    /// How long a step, shorter than h, ends where the speed is 0; 0 if there was no motion this way at all.
    fn reversal(&self, h: f64) -> f64 {
        let along = |h: f64, y: &State| self.plant.way * self.speed(self.t + h, y);
        let speed = |h: f64| {
            if h > 0.0 { self.after(h).map_or(0.0, |y| along(h, &y)) } else { 0.0 }
        };
        let mut forth = (0.0, along(0.0, &self.y));
        // It may start from rest: then some shorter step still goes forth, or none does.
        for halved in 1..40 {
            if forth.1 > 0.0 {
                break;
            }
            let shorter = h * 0.5f64.powi(halved);
            forth = (shorter, speed(shorter));
        }
        if forth.1 > 0.0 { root(speed, forth.0, h) } else { 0.0 }
    }

    /// Goes on to where the speed is 0, and lets the contacts reverse there, or stick.
    fn reverse(&mut self, h: f64, end: f64) {
        if let Some(next) = (h > 0.0).then(|| self.after(h)).flatten() {
            self.y = next;
        }
        self.t = (self.t + h).min(end);
        let q = self.plant.motion(self.t, &self.y).0;
        // A contact with bristles may have one that remembers beside it; its mass is then not at rest.
        self.y[V] = 0.0;
        let way = if self.plant.sticks() { 0.0 } else { -self.plant.way };
        self.plant.turn(q, way);
        if h == 0.0 && self.plant.sticks() {
            // It did not move at all: the pull is at the limit, and cannot be told from it before the next leg.
            let next = self.drift(end);
            (self.t, self.y) = (end, next);
        }
    }

    /// What the states of a stuck plant's load and effects become until `end`, in one step.
    fn drift(&self, end: f64) -> State {
        let h = end - self.t;
        (h > 0.0).then(|| self.after(h)).flatten().unwrap_or(self.y)
    }

    /// Stuck: goes on until the pull exceeds what holds, and starts that way.
    fn wait(&mut self, end: f64) -> Result<(), TwinError> {
        let (by, pull) = self.plant.excess(self.t, &self.y);
        if by > 0.0 {
            self.plant.turn(self.y[Q], 1f64.copysign(pull));
            return Ok(());
        }
        let (h, next) = self.one(end)?;
        if self.plant.excess(self.t + h, &next).0 > 0.0 {
            let excess = |h: f64| {
                let y = if h > 0.0 { self.after(h).unwrap_or(next) } else { self.y };
                self.plant.excess(self.t + h, &y).0
            };
            let h = root_up(excess, 0.0, h);
            self.y = self.after(h).unwrap_or(next);
            self.t = (self.t + h).min(end);
            let pull = self.plant.excess(self.t, &self.y).1;
            self.plant.turn(self.y[Q], 1f64.copysign(pull));
        } else {
            self.y = next;
            self.t = if h >= end - self.t { end } else { self.t + h };
        }
        self.pace.saw(&self.y);
        Ok(())
    }
}
