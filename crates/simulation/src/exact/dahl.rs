//! Dahl under an imposed motion: one update of the closed form for each time asked for.

use super::imposed::{Imposed, model};
use crate::{Delivered, NotHere, Own, Solves, Task};
use duhem::{Dahl, closed_form::dahl::Piece};
use integrate::Limits;

/// The Dahl model in the displacement domain.
pub(super) const METHOD: Own =
    Own { name: "exact-dahl", holds: "dahl, every γ, under an imposed motion", build };

fn build(task: &Task) -> Result<Box<dyn Solves>, NotHere> {
    let dahl = model(&METHOD, task, "dahl", Dahl::new)?;
    Ok(Box::new(Imposed::new(&METHOD, task, dahl, 1)?))
}

impl Solves for Imposed<Dahl> {
    fn deliver(&self, _: f64, limits: &Limits, grid: &[f64], states: &mut [f64]) -> Delivered {
        states.copy_from_slice(grid);
        self.input.displace(states);
        let mut force = self.x0[0];
        self.follow((limits, grid), states, |piece, travel, states| {
            let law = Piece::new(&self.model, force, travel.from, travel.s);
            law.forces(&mut states[piece.points.clone()]);
            force = law.force(travel.to);
        })
    }
}
