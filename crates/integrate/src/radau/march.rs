//! Step after step to the end: which step is accepted and how long the next one is.

use super::{
    Integration, Node, Settings, System,
    event::Crossing,
    step::{Base, Method, NoStages, Step, plus},
};
use crate::{Failure, Outcome};

/// A step grows by no more than this and shrinks by no more than the other.
const GROWTH: f64 = 8.0;
const SHRINKAGE: f64 = 0.2;
const SAFETY: f64 = 0.9;

/// Solves y' = f(t, y) from `start` to `end`, which is later, by the Radau IIA method of order 5 with
/// adaptive steps, and shows `observe` the start and every accepted step. Where the event function
/// changes sign a step ends, to the last digit of the time, and the next one starts afresh.
///
/// Whatever goes wrong is the outcome; the nodes up to there have been shown.
pub fn radau<S: System<N>, const N: usize>(
    system: &mut S,
    span: (f64, f64),
    y0: [f64; N],
    settings: &Settings<N>,
    observe: &mut dyn FnMut(&Node<N>),
) -> Integration {
    let mut march = March {
        method: Method::new(system, settings),
        dead_band: settings.dead_band,
        side: 0.0,
        events: 0,
        at: span.0,
        controller: Controller::default(),
    };
    let end = march.run(span, y0, observe);
    Integration {
        work: march.method.work,
        events: march.events,
        outcome: match end {
            Ok(()) => Outcome::Solved,
            Err(why) => Outcome::Failed { at: march.at, why },
        },
    }
}

struct March<'a, S, const N: usize> {
    method: Method<'a, S, N>,
    dead_band: f64,
    /// The side of zero on which the event function was last seen; 0 after an event.
    side: f64,
    events: u64,
    at: f64,
    controller: Controller,
}

/// What an attempt came to.
enum Attempt<const N: usize> {
    Accepted {
        step: Step<N>,
        event: bool,
        next: f64,
    },
    /// To be tried again with this length.
    Rejected(f64),
}

impl<S: System<N>, const N: usize> March<'_, S, N> {
    fn run(
        &mut self,
        (start, end): (f64, f64),
        y0: [f64; N],
        observe: &mut dyn FnMut(&Node<N>),
    ) -> Result<(), Failure> {
        let mut base = self.method.base(start, y0)?;
        observe(&Node { t: start, y: y0, y_dot: base.y_dot, event: false });
        let mut h = self.first_step(&base, end - start);
        let mut last: Option<Step<N>> = None;
        while base.t < end {
            let left = end - base.t;
            let arrives = h >= left * (1.0 - 1e-12);
            // Two equal steps rather than a whole one and a splinter, and a length the clock resolves.
            let wanted = if arrives {
                left
            } else if h > 0.5 * left {
                0.5 * left
            } else {
                h
            };
            h = if arrives { left } else { (base.t + wanted) - base.t };
            if h <= 4.0 * f64::EPSILON * base.t.abs() || h <= f64::MIN_POSITIVE {
                let finite = self.method.last_was_finite;
                return Err(if finite { Failure::StepTooSmall } else { Failure::NotFinite });
            }
            match self.attempt(&base, h, last.as_ref())? {
                Attempt::Rejected(next) => {
                    h = next;
                    *self.method.work.rejected.get_or_insert(0) += 1;
                }
                Attempt::Accepted { step, event, next } => {
                    let t = if arrives && step.h == h { end } else { base.t + step.h };
                    let mut y = plus(&base.y, &step.z[2]);
                    if event {
                        self.method.system.land(&mut y);
                        self.events += 1;
                    }
                    base = self.method.base(t, y)?;
                    observe(&Node { t, y, y_dot: base.y_dot, event });
                    self.method.work.accepted += 1;
                    self.at = t;
                    h = next;
                    last = (!event).then_some(step);
                }
            }
        }
        Ok(())
    }

    /// A hundredth of the time in which the state changes by its size, or of the span.
    fn first_step(&self, base: &Base<N>, span: f64) -> f64 {
        let rate = self.method.rtol * self.method.norm(&base.y, &base.y_dot);
        if rate * span > 1.0 { 0.01 / rate } else { 0.01 * span }
    }

    fn attempt(
        &mut self,
        base: &Base<N>,
        h: f64,
        last: Option<&Step<N>>,
    ) -> Result<Attempt<N>, Failure> {
        let guess = last.map_or([[0.0; N]; 3], |last| self.method.extrapolate(last, h));
        let step = match self.method.stages(base, h, guess, 1.0) {
            Ok(step) => step,
            Err(NoStages::Diverges) => return Ok(Attempt::Rejected(0.5 * h)),
            Err(NoStages::Spent) => return Err(Failure::TooManyEvaluations),
        };
        let error = self.method.error(base, &step);
        if !error.is_finite() {
            return Ok(Attempt::Rejected(SHRINKAGE * h));
        }
        if error >= 1.0 {
            return Ok(Attempt::Rejected(h * factor(error, step.iterations).min(1.0)));
        }
        match self.method.crossing(base, &step, self.side, self.dead_band) {
            Crossing::None(side) => {
                self.side = side;
                let next = self.controller.next(&step, error);
                Ok(Attempt::Accepted { step, event: false, next })
            }
            Crossing::Inside(part) => Ok(Attempt::Rejected(part * h)),
            Crossing::AtEnd { after, g } => match self.method.locate(base, &step, (after, g)) {
                Ok(step) => {
                    self.side = 0.0;
                    self.controller = Controller::default();
                    Ok(Attempt::Accepted { step, event: true, next: h })
                }
                Err(NoStages::Diverges) => Ok(Attempt::Rejected(0.5 * h)),
                Err(NoStages::Spent) => Err(Failure::TooManyEvaluations),
            },
        }
    }
}

/// How much longer a step of this estimated error could have been; many iterations make it cautious.
fn factor(error: f64, iterations: i32) -> f64 {
    let cautious = SAFETY * 25.0 / (f64::from(iterations) + 24.0);
    (cautious / error.max(1e-30).powf(0.25)).clamp(SHRINKAGE, GROWTH)
}

/// The predictive controller of Gustafsson: it sees in which way the error went in the last two steps.
#[derive(Debug, Clone, Copy, Default)]
struct Controller {
    /// Length and error of the last accepted step; none after a restart.
    last: Option<(f64, f64)>,
}

impl Controller {
    fn next<const N: usize>(&mut self, step: &Step<N>, error: f64) -> f64 {
        let mut grows = factor(error, step.iterations);
        if let Some((h, before)) = self.last {
            let trend = SAFETY * step.h / h * (before / (error * error).max(1e-30)).powf(0.25);
            grows = grows.min(trend.clamp(SHRINKAGE, GROWTH));
        }
        self.last = Some((step.h, error.max(1e-2)));
        step.h * grows
    }
}
