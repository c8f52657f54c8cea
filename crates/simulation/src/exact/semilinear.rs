//! Semilinear Duhem models under an imposed motion: the exponential of A±, as its action on the state.
//!
//! Of the models Dahl with γ = 1 is one. LuGre is not, because it depends on the rate, and a Maxwell-slip
//! element is not, because its right-hand side jumps.

use super::imposed::{Imposed, model, pieces, refuse, solved, too_many};
use crate::{Delivered, NotHere, Own, Solves, Task};
use duhem::{Dahl, closed_form::semilinear::Semilinear};
use integrate::Limits;

/// Any semilinear model in the displacement domain.
pub(super) const METHOD: Own = Own {
    name: "exact-semilinear",
    holds: "a semilinear model (dahl with γ = 1) under an imposed motion",
    build,
};

fn build(task: &Task) -> Result<Box<dyn Solves>, NotHere> {
    let dahl = model(&METHOD, task, "dahl", Dahl::new)?;
    if dahl.gamma != 1.0 {
        return Err(refuse(&METHOD, format!("dahl with γ = {}", dahl.gamma)));
    }
    let model = Semilinear::of_dahl(&dahl).map_err(|error| refuse(&METHOD, error.to_string()))?;
    let n = model.states();
    Ok(Box::new(Imposed::new(&METHOD, task, model, n)?))
}

impl Solves for Imposed<Semilinear> {
    /// The cells between two turns count as updates too.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the count is positive, and one beyond u64 saturates and meets the limit"
    )]
    fn deliver(&self, _: f64, limits: &Limits, grid: &[f64], states: &mut [f64]) -> Delivered {
        let times = self.times();
        let mut turns = times.clone();
        self.input.displace(&mut turns);
        let cells: f64 = turns.windows(2).map(|u| self.model.cells((u[0], u[1])) - 1.0).sum();
        let updates = (grid.len() + times.len() - 2) as u64 + cells as u64;
        if updates > limits.evaluations {
            return too_many(self.span.0, states);
        }
        let mut u = grid.to_vec();
        self.input.displace(&mut u);
        let (mut x, n) = (self.x0.clone(), self.x0.len());
        for (piece, ends) in pieces(&times, grid).zip(turns.windows(2)) {
            let rows = &mut states[n * piece.points.start..n * piece.points.end];
            self.model.follow(&mut x, (ends[0], ends[1]), &u[piece.points], rows);
        }
        solved(updates)
    }
}
