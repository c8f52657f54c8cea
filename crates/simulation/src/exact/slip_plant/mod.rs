//! A plant with Maxwell-slip friction under a sine, solved exactly from event to event.
//!
//! Between two events the set of sticking elements does not change, and the plant is a mass on a spring
//! of the stiffness k_s + Σ kᵢ over them: a closed form. The events are an element that reaches its
//! deadband, moving outwards, and begins to slip, and a turn of the motion, where all slipping elements
//! stick again at once. Both are found to the last digit, and neither can be missed: the turn by bounds
//! on the motion, the slip because the displacement is monotone until the turn.

mod arc;
mod energy;
mod method;
mod sample;
mod turn;

use crate::{
    SimulationError,
    error::{check_span, deflections},
};
pub(super) use method::METHOD;

use arc::{Arc, Point};
use duhem::{Harmonic, Input, MaxwellSlip, Plant, sgn};
use turn::{crossing, first_turn};

/// The plant m q̈ + k_s q = w(t) − F with Maxwell-slip friction F; for the rig q is θ and m is I.
#[derive(Debug, Clone, PartialEq)]
pub struct SlipPlant {
    /// The friction.
    pub model: MaxwellSlip,
    /// Mass m [kg].
    pub mass: f64,
    /// Stiffness k_s of the spring [N/m].
    pub stiffness: f64,
    /// The force w(t) [N].
    pub drive: Harmonic,
}

/// What happens at an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// An element reaches its deadband and begins to slip.
    Slip {
        /// Which, counted from 0.
        element: usize,
    },
    /// The velocity changes its sign, and what slipped sticks.
    Turn {
        /// How many elements slipped until then.
        slipping: usize,
    },
}

/// An event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When [s].
    pub t: f64,
    /// What.
    pub kind: EventKind,
}

/// The motion between two events.
#[derive(Debug, Clone)]
struct Leg {
    start: f64,
    /// Until when it holds [s], counted from its start.
    length: f64,
    q: f64,
    /// Deflections at its start [m].
    z: Vec<f64>,
    /// Which elements slip.
    slips: Vec<bool>,
    arc: Arc,
}

/// The exact solution over a span.
#[derive(Debug, Clone)]
pub struct ExactSolution {
    plant: SlipPlant,
    legs: Vec<Leg>,
    events: Vec<Event>,
}

/// Most steps of a sixteenth period.
const MOST_STEPS: f64 = 5e7;

impl SlipPlant {
    /// The plant with this friction under this input.
    pub fn new(model: MaxwellSlip, plant: &Plant, input: &Input) -> Result<Self, SimulationError> {
        let Plant { mass, stiffness, gain, offset } = *plant;
        let Harmonic { amplitude, omega, phase, constant } =
            input.harmonic().ok_or(SimulationError::Drive)?;
        let (amplitude, constant) = (gain * amplitude, gain * constant + offset);
        let drive = Harmonic { amplitude, omega, phase, constant };
        Ok(Self { model, mass, stiffness, drive })
    }

    /// The solution from `y0` = [q, v, x₁ … x_N] at the start of the span [s].
    pub fn solve(&self, y0: &[f64], span: (f64, f64)) -> Result<ExactSolution, SimulationError> {
        self.check(span)?;
        let z = deflections(&self.model, y0)?;
        Ok(self.follow((y0[0], y0[1]), z, span))
    }

    /// The solution from q [m], v [m/s] and the deflections z [m], of a plant and a span that are checked.
    fn follow(&self, (q, v): (f64, f64), z: Vec<f64>, span: (f64, f64)) -> ExactSolution {
        let mut now = Now { t: span.0, q, v, z, s: sgn(v) };
        let (mut legs, mut events) = (Vec::new(), Vec::new());
        while now.t < span.1 {
            let mut leg = self.leg(&now);
            if now.s == 0.0 {
                now.s = direction(&leg.arc);
                leg = self.leg(&now);
            }
            let kind = now.advance(self, &mut leg, span.1);
            legs.push(leg);
            events.extend(kind.map(|kind| Event { t: now.t, kind }));
        }
        ExactSolution { plant: self.clone(), legs, events }
    }

    fn check(&self, (start, end): (f64, f64)) -> Result<(), SimulationError> {
        let plant = |key, found, expected| Err(SimulationError::Plant { key, found, expected });
        if !(self.mass.is_finite() && self.mass > 0.0) {
            return plant("mass", self.mass, "a positive mass [kg]");
        }
        if !(self.stiffness.is_finite() && self.stiffness >= 0.0) {
            return plant("stiffness", self.stiffness, "a stiffness [N/m] of 0 or more");
        }
        if !(self.drive.omega.is_finite() && self.drive.omega >= 0.0) {
            return plant("omega", self.drive.omega, "an angular frequency [rad/s] of 0 or more");
        }
        let Harmonic { amplitude, phase, constant, .. } = self.drive;
        if !(amplitude + phase + constant).is_finite() {
            return plant("drive", amplitude + phase + constant, "finite forces [N] and phase");
        }
        check_span((start, end))?;
        let stiffest = self.stiffness + self.model.k.iter().sum::<f64>();
        let fastest = (stiffest / self.mass).sqrt().max(self.drive.omega);
        let needed = (end - start) * fastest * 16.0 / std::f64::consts::TAU;
        if needed <= MOST_STEPS {
            return Ok(());
        }
        Err(SimulationError::TooLong { needed, most: MOST_STEPS })
    }

    /// The leg that begins now, with those elements slipping that are at their limit in the direction s.
    fn leg(&self, now: &Now) -> Leg {
        let MaxwellSlip { k, delta } = &self.model;
        let slips: Vec<bool> =
            now.z.iter().zip(delta).map(|(z, d)| now.s != 0.0 && now.s * z >= *d).collect();
        let held = k.iter().zip(&slips).filter(|(_, slips)| !**slips).map(|(k, _)| k);
        let stiffness = self.stiffness + held.sum::<f64>();
        let friction: f64 = k.iter().zip(&now.z).map(|(k, z)| k * z).sum();
        let Harmonic { amplitude, omega, phase, constant } = self.drive;
        let (sin, cos) = (omega * now.t + phase).sin_cos();
        let arc = Arc {
            mass: self.mass,
            stiffness,
            natural: (stiffness / self.mass).sqrt(),
            omega,
            drive: (amplitude * cos, amplitude * sin),
            constant: constant - self.stiffness * now.q - friction,
            v0: now.v,
        };
        Leg { start: now.t, length: 0.0, q: now.q, z: now.z.clone(), slips, arc }
    }
}

/// The direction in which a plant that stands sets out: the sign of the first derivative of v that is not
/// 0; 0 if it stays.
fn direction(arc: &Arc) -> f64 {
    let Point { a, j, .. } = arc.at(0.0);
    let snap = -arc.omega * arc.omega * arc.drive.1;
    [a, j, snap].into_iter().map(sgn).find(|s| *s != 0.0).unwrap_or(0.0)
}

/// The state on the way.
struct Now {
    t: f64,
    q: f64,
    v: f64,
    /// Deflections [m].
    z: Vec<f64>,
    /// Direction of motion; 0 before it is known, and at rest for ever.
    s: f64,
}

impl Now {
    /// Goes to the next event on the leg, or to `end`, and says which event it is.
    fn advance(&mut self, plant: &SlipPlant, leg: &mut Leg, end: f64) -> Option<EventKind> {
        if self.s == 0.0 {
            (leg.length, self.t) = (end - self.t, end);
            return None;
        }
        let (element, way) = self.next_slip(plant, leg);
        let (tau, turns, slips) = march(&leg.arc, self.s, way, end - self.t);
        leg.length = tau;
        let reached = !turns && !slips;
        self.t = if reached { end } else { self.t + tau };
        let Point { p, v, .. } = leg.arc.at(tau);
        (self.q, self.v) = (self.q + p, if turns { 0.0 } else { v });
        for (i, z) in self.z.iter_mut().enumerate() {
            let delta = plant.model.delta[i];
            *z = if leg.slips[i] { self.s * delta } else { (*z + p).clamp(-delta, delta) };
        }
        if slips {
            let element = element?;
            self.z[element] = self.s * plant.model.delta[element];
            return Some(EventKind::Slip { element });
        }
        if turns {
            self.s = -self.s;
            return Some(EventKind::Turn { slipping: leg.slips.iter().filter(|s| **s).count() });
        }
        None
    }

    /// Which element slips next, and how far away that is [m]; ∞ if all slip.
    fn next_slip(&self, plant: &SlipPlant, leg: &Leg) -> (Option<usize>, f64) {
        let mut next = (None, f64::INFINITY);
        for (i, (z, delta)) in self.z.iter().zip(&plant.model.delta).enumerate() {
            let way = delta - self.s * z;
            if !leg.slips[i] && way < next.1 {
                next = (Some(i), way);
            }
        }
        next
    }
}

/// Follows the arc until it turns, has gone the `way` [m], or is `horizon` [s] long: the time [s],
/// whether it turns there, and whether it has gone the way.
fn march(arc: &Arc, s: f64, way: f64, horizon: f64) -> (f64, bool, bool) {
    let step = arc.step(horizon);
    let (mut a, mut n) = (arc.at(0.0), 0.0);
    loop {
        n += 1.0;
        let b = arc.at((n * step).min(horizon));
        let turn = first_turn(arc, s, a, b);
        let last = turn.map_or(b, |tau| arc.at(tau));
        if s * last.p >= way {
            // Up to the turn the displacement is monotone: the way is reached once.
            let tau = crossing(a.tau, last.tau, |tau| way - s * arc.at(tau).p);
            return (tau, false, true);
        }
        if turn.is_some() || b.tau >= horizon {
            return (last.tau, turn.is_some(), false);
        }
        a = b;
    }
}

impl ExactSolution {
    /// The plant.
    pub fn plant(&self) -> &SlipPlant {
        &self.plant
    }

    /// The events in order.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// The span [s].
    pub fn span(&self) -> (f64, f64) {
        let last = &self.legs[self.legs.len() - 1];
        (self.legs[0].start, last.start + last.length)
    }

    /// Writes the exact state [q, v, x₁ … x_N] at the time `t` [s].
    pub fn state(&self, t: f64, y: &mut [f64]) {
        let k = self.legs.partition_point(|leg| leg.start <= t).max(1) - 1;
        self.legs[k].state(t - self.legs[k].start, y);
    }
}

impl Leg {
    /// Writes the state at `tau` [s] after the start of the leg.
    fn state(&self, tau: f64, y: &mut [f64]) {
        let Point { p, v, .. } = self.arc.at(tau);
        (y[0], y[1]) = (self.q + p, v);
        for (i, x) in y[2..].iter_mut().enumerate() {
            *x = if self.slips[i] { self.q - self.z[i] + p } else { self.q - self.z[i] };
        }
    }
}
