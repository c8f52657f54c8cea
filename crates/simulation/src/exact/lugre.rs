//! LuGre under a motion of piecewise constant speed: an exponential on each leg.

use super::imposed::{Imposed, model, pieces, refuse, solved, too_many};
use crate::{Delivered, NotHere, Own, Solves, Task};
use duhem::{LuGre, closed_form::lugre::Leg};
use integrate::Limits;

/// The LuGre model on legs of constant speed.
pub(super) const METHOD: Own = Own {
    name: "exact-lugre",
    holds: "lugre under an imposed motion of piecewise constant speed",
    build,
};

fn build(task: &Task) -> Result<Box<dyn Solves>, NotHere> {
    let lugre = model(&METHOD, task, "lugre", LuGre::new)?;
    let imposed = Imposed::new(&METHOD, task, lugre, 1)?;
    if !task.input.piecewise_linear() {
        return Err(refuse(&METHOD, "an input whose speed changes between its corners"));
    }
    Ok(Box::new(imposed))
}

impl Solves for Imposed<LuGre> {
    fn deliver(&self, _: f64, limits: &Limits, grid: &[f64], states: &mut [f64]) -> Delivered {
        let times = self.times();
        let updates = (grid.len() + times.len() - 2) as u64;
        if updates > limits.evaluations {
            return too_many(self.span.0, states);
        }
        states.copy_from_slice(grid);
        let mut x = self.x0[0];
        for piece in pieces(&times, grid) {
            let u_dot = self.input.u_dot_on(piece.start, piece.end, piece.start);
            let leg = Leg::new(&self.model, x, piece.start, u_dot);
            leg.deflections(&mut states[piece.points]);
            x = leg.deflection(piece.end);
        }
        solved(updates)
    }
}
