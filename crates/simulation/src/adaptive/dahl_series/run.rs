//! From reversal to reversal, a series at a time.

use super::{
    series::{Equations, LANES, Series, State},
    turn,
};
use duhem::{Harmonic, sgn};
use integrate::{Failure, Work};
use std::f64::consts::PI;

/// The share of the tolerance that the last coefficients may be.
const SAFETY: f64 = 0.06;

/// Forces that balance to this many units of rounding balance.
const BALANCED: f64 = 16.0 * f64::EPSILON;

/// The share of the tolerance that the force left to F_C may be while it is neglected.
const SLIDES: f64 = 1e-2;

/// A series that goes no further than this is expanded again in a unit of time that fits: its first
/// coefficients do not tell how large the velocity is.
const SHORT: f64 = 0.3;

#[derive(Debug)]
pub(super) struct Run<'a> {
    pub of: &'a Equations,
    pub rtol: f64,
    /// Most evaluations.
    pub most: u64,
    /// Last time [s].
    pub end: f64,
    pub series: Series,
    /// The times not yet delivered [s], and their places.
    pub grid: &'a [f64],
    pub states: &'a mut [f64],
    pub work: Work,
}

impl Run<'_> {
    /// From one state to the end of the span; a failure comes with its time.
    pub(super) fn march(&mut self, from: State) -> Result<(), (f64, Failure)> {
        self.rest(from, from.t);
        let mut at = if from.v == 0.0 { self.set_out(from) } else { Some(from) };
        let mut last = from;
        while let Some(moving) = at.filter(|at| at.t < self.end) {
            let (next, turns) = self.step(moving).map_err(|why| (moving.t, why))?;
            at = if turns { self.set_out(next) } else { Some(next) };
            last = next;
        }
        self.rest(last, self.end);
        Ok(())
    }

    /// One series, to where it ends or the motion turns; whether it turns.
    fn step(&mut self, at: State) -> Result<(State, bool), Failure> {
        if at.v == 0.0 {
            let Equations { dahl, plant, .. } = self.of;
            let contact = dahl.sigma * at.w.powf(dahl.gamma);
            let swing = PI / ((plant.stiffness + contact) / plant.mass).sqrt();
            self.series.h = self.series.h.min(swing);
        }
        let mut reach = self.expand(at)?;
        while reach < SHORT {
            self.work.rejected = self.work.rejected.map(|count| count + 1);
            self.series.h *= reach;
            if at.t + self.series.h <= at.t {
                return Err(Failure::StepTooSmall);
            }
            reach = self.expand(at)?;
        }
        let h = self.series.h;
        let left = (self.end - at.t) / h;
        let turn = turn::first(&self.series, reach.min(left));
        let mut next = self.series.at(turn.unwrap_or(reach.min(left)));
        if turn.is_some() {
            next.v = 0.0;
        } else if reach >= left {
            next.t = self.end;
        }
        if next.t <= at.t {
            return Err(Failure::StepTooSmall);
        }
        // The error may carry it beyond F_C, where it cannot come to.
        next.w = next.w.max(0.0);
        self.deliver(next.t);
        self.work.accepted += 1;
        self.series.h = h * reach;
        Ok((next, turn.is_some()))
    }

    /// The series from here in the present unit of time, and how far it goes in that.
    fn expand(&mut self, at: State) -> Result<f64, Failure> {
        self.work.evaluations += self.series.order as u64;
        if self.work.evaluations > self.most {
            return Err(Failure::TooManyEvaluations);
        }
        let Equations { dahl, plant, .. } = self.of;
        let inertia = plant.mass * at.v.abs() / self.series.h;
        let slides = dahl.f_c * at.w < SLIDES * self.rtol * inertia;
        self.series.expand(self.of, at, slides);
        if at.v == 0.0 && self.series.v[1] * at.s < 0.0 {
            // What is left of forces that balance is rounding.
            self.series.v[1] = 0.0;
        }
        self.reach()
    }

    /// How far the series goes in τ, for what is left out to be below the tolerance: of the velocity in
    /// units of its own size on the way, of the force in units of F_C.
    fn reach(&self) -> Result<f64, Failure> {
        let Series { order, v, w, .. } = &self.series;
        let order = *order;
        let size = v[..4].iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let last = |c: &[f64]| c[order].abs().max(c[order - 1].abs());
        let ratio = (last(v) / size).max(last(w)) / (SAFETY * self.rtol);
        if !ratio.is_finite() {
            return Err(Failure::NotFinite);
        }
        Ok(ratio.powf(-1.0 / order as f64).min(3.0))
    }

    /// The motion after a rest at v = 0: it goes where the forces drive it, or if they balance but for
    /// rounding where the drive goes on to; none if that rests too.
    fn set_out(&self, at: State) -> Option<State> {
        let (friction, plant) = (self.of.friction(&at), &self.of.plant);
        let [force, rate, curve] = self.of.drive(at.t);
        let spring = plant.stiffness * at.q;
        let left = force - spring - friction;
        let noise = BALANCED * (force.abs() + spring.abs() + friction.abs());
        let Harmonic { amplitude, omega, phase, .. } = self.of.drive;
        let turning = (plant.gain * amplitude * omega).abs() * (1.0 + (omega * at.t + phase).abs());
        let s = if left.abs() > noise {
            sgn(left)
        } else if rate.abs() > BALANCED * turning {
            sgn(rate)
        } else {
            sgn(curve)
        };
        let w = (1.0 - s * friction / self.of.dahl.f_c).max(0.0);
        (s != 0.0).then_some(State { s, w, v: 0.0, ..at })
    }

    /// Delivers what lies on the series up to the time `until` [s].
    fn deliver(&mut self, until: f64) {
        let mut ahead = self.grid.iter().take_while(|t| **t <= until).count();
        let (from, by_h) = (self.series.from, 1.0 / self.series.h);
        let f = from.s * self.of.dahl.f_c;
        while ahead > 0 {
            let now = ahead.min(LANES);
            let mut tau = [0.0; LANES];
            for (tau, t) in tau.iter_mut().zip(&self.grid[..now]) {
                *tau = (t - from.t) * by_h;
            }
            let [q, v, w] = self.series.states(&tau);
            let (head, tail) = std::mem::take(&mut self.states).split_at_mut(3 * now);
            for (i, y) in head.chunks_exact_mut(3).enumerate() {
                y.copy_from_slice(&[q[i], v[i], f * (1.0 - w[i])]);
            }
            (self.states, self.grid) = (tail, &self.grid[now..]);
            ahead -= now;
        }
    }

    /// Delivers the state `at` up to the time `until` [s].
    fn rest(&mut self, at: State, until: f64) {
        let ahead = self.grid.iter().take_while(|t| **t <= until).count();
        let (head, tail) = std::mem::take(&mut self.states).split_at_mut(3 * ahead);
        for y in head.chunks_exact_mut(3) {
            y.copy_from_slice(&[at.q, at.v, self.of.friction(&at)]);
        }
        (self.states, self.grid) = (tail, &self.grid[ahead..]);
    }
}
