//! The exact solution delivered on a grid.

use super::{ExactSolution, Leg, SlipPlant};
use crate::{
    Delivered, NotHere, Own, Solves, Task,
    error::deflections,
    exact::imposed::{check_start, model, refuse, solved, too_many},
};
use duhem::{Dahl, MaxwellSlip};
use integrate::Limits;

/// The plant from event to event.
pub(in crate::exact) const METHOD: Own = Own {
    name: "exact-slip-plant",
    holds: "maxwell-slip, or dahl with γ = 0 from within ±F_C, on a plant under a sine",
    build,
};

/// A plant ready to be solved.
#[derive(Debug)]
struct FromEventToEvent {
    plant: SlipPlant,
    q: f64,
    v: f64,
    /// Deflections at the start [m].
    z: Vec<f64>,
    span: (f64, f64),
    /// Whether the state is the force, as Dahl's is, and not a position.
    force: bool,
}

fn build(task: &Task) -> Result<Box<dyn Solves>, NotHere> {
    let force = task.model.name == "dahl";
    let friction = if force { element(task)? } else { elements(task)? };
    let words = |error: crate::SimulationError| refuse(&METHOD, error.to_string());
    let plant = task.plant.as_ref().ok_or_else(|| refuse(&METHOD, "no plant"))?;
    let plant = SlipPlant::new(friction, plant, &task.input).map_err(words)?;
    check_start(&METHOD, task, plant.model.k.len() + 2)?;
    plant.check(task.span).map_err(words)?;
    let (q, v) = (task.y0[0], task.y0[1]);
    let z = if force {
        vec![within(task.y0[2], &plant.model)?]
    } else {
        deflections(&plant.model, &task.y0).map_err(words)?
    };
    Ok(Box::new(FromEventToEvent { plant, q, v, z, span: task.span, force }))
}

fn elements(task: &Task) -> Result<MaxwellSlip, NotHere> {
    model(&METHOD, task, "maxwell-slip", MaxwellSlip::new)
}

/// Dahl with γ = 0 as the one element that it is: k = σ, Δ = F_C/σ, F = k z.
fn element(task: &Task) -> Result<MaxwellSlip, NotHere> {
    let Dahl { f_c, sigma, gamma } = model(&METHOD, task, "dahl", Dahl::new)?;
    if gamma == 0.0 {
        return Ok(MaxwellSlip { k: vec![sigma], delta: vec![f_c / sigma] });
    }
    Err(refuse(&METHOD, format!("dahl with γ = {gamma}")))
}

/// The deflection [m] of the one element at a `force` [N] within ±F_C, but for its rounding.
fn within(force: f64, MaxwellSlip { k, delta }: &MaxwellSlip) -> Result<f64, NotHere> {
    let z = force / k[0];
    if z.abs() <= delta[0] * (1.0 + 1e-12) {
        return Ok(z.clamp(-delta[0], delta[0]));
    }
    Err(refuse(&METHOD, format!("F = {force} N at the start, beyond F_C = {} N", k[0] * delta[0])))
}

impl Solves for FromEventToEvent {
    fn deliver(&self, _: f64, limits: &Limits, grid: &[f64], states: &mut [f64]) -> Delivered {
        let solution = self.plant.follow((self.q, self.v), self.z.clone(), self.span);
        let updates = grid.len() + solution.events.len();
        if updates as u64 > limits.evaluations {
            return too_many(self.span.0, states);
        }
        let ExactSolution { legs, .. } = &solution;
        let mut k = 0;
        for (t, y) in grid.iter().zip(states.chunks_exact_mut(self.z.len() + 2)) {
            while legs.get(k + 1).is_some_and(|next| next.start <= *t) {
                k += 1;
            }
            let leg = &legs[k];
            leg.state(t - leg.start, y);
            if self.force {
                y[2] = self.plant.model.k[0] * leg.deflection(y[0]);
            }
        }
        solved(updates as u64)
    }
}

impl Leg {
    /// The deflection [m] of the first element when the plant is at `q` [m].
    fn deflection(&self, q: f64) -> f64 {
        if self.slips[0] { self.z[0] } else { self.z[0] + (q - self.q) }
    }
}
