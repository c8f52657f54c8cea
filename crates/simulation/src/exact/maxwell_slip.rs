//! Maxwell-slip under an imposed motion: the play operator of each element.

use super::imposed::{Imposed, model};
use crate::{Delivered, NotHere, Own, Solves, Task};
use duhem::{MaxwellSlip, closed_form::maxwell_slip::Play};
use integrate::Limits;

/// The Maxwell-slip model in the displacement domain.
pub(super) const METHOD: Own =
    Own { name: "exact-maxwell-slip", holds: "maxwell-slip under an imposed motion", build };

/// So many displacements are made at once, on the stack.
const TOGETHER: usize = 64;

fn build(task: &Task) -> Result<Box<dyn Solves>, NotHere> {
    let model = model(&METHOD, task, "maxwell-slip", MaxwellSlip::new)?;
    let n = model.k.len();
    Ok(Box::new(Imposed::new(&METHOD, task, model, n)?))
}

impl Solves for Imposed<MaxwellSlip> {
    fn deliver(&self, _: f64, limits: &Limits, grid: &[f64], states: &mut [f64]) -> Delivered {
        let n = self.x0.len();
        let mut play = Play::new(&self.model, &self.x0);
        let mut room = [0.0; TOGETHER];
        self.follow((limits, grid), states, |piece, travel, states| {
            play.turn(travel.from, travel.s >= 0.0);
            let rows = &mut states[n * piece.points.start..n * piece.points.end];
            let times = grid[piece.points.clone()].chunks(TOGETHER);
            for (times, rows) in times.zip(rows.chunks_mut(n * TOGETHER)) {
                let u = &mut room[..times.len()];
                u.copy_from_slice(times);
                self.input.displace(u);
                play.positions(u, rows);
            }
            play.stop_at(travel.to);
        })
    }
}
