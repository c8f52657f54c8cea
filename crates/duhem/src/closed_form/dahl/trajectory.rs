//! The force over time.

use super::advance;
use crate::{
    Dahl, Input, Parameters,
    closed_form::{Arcs, Reference, ReferenceError, check},
};

/// The exact force of the Dahl model under an input.
#[derive(Debug, Clone)]
pub struct Trajectory {
    dahl: Dahl,
    arcs: Arcs,
    /// Force at the start of each arc [N].
    force: Vec<f64>,
}

impl Trajectory {
    /// The trajectory from `f0` [N] over the span [s].
    pub fn new(
        dahl: &Dahl,
        input: &Input,
        f0: f64,
        span: (f64, f64),
    ) -> Result<Self, ReferenceError> {
        check(&[f0], 1, span)?;
        let arcs = Arcs::new(input, span);
        let mut force = vec![f0];
        for k in 1..arcs.len() {
            force.push(advance(dahl, force[k - 1], arcs.travel(k - 1)));
        }
        Ok(Self { dahl: dahl.clone(), arcs, force })
    }

    /// The exact force at time `t` [s] of the span.
    pub fn force(&self, t: f64) -> f64 {
        let (k, so_far) = self.arcs.locate(t);
        advance(&self.dahl, self.force[k], so_far)
    }

    pub(crate) fn build(
        parameters: &Parameters,
        input: &Input,
        x0: &[f64],
        span: (f64, f64),
    ) -> Result<Box<dyn Reference>, ReferenceError> {
        let dahl = Dahl::new(parameters)?;
        check(x0, 1, span)?;
        Ok(Box::new(Self::new(&dahl, input, x0[0], span)?))
    }
}

impl Reference for Trajectory {
    fn state(&self, t: f64, x: &mut [f64]) {
        x[0] = self.force(t);
    }

    /// The flow contracts, so the roundings of the arcs add at most: in each of them that of u, times
    /// the steepest slope |D±| ≤ σ 2^γ, and that of the power, a few units of F_C.
    fn error_bound(&self) -> f64 {
        let arcs = self.arcs.len() as f64;
        let slope = self.dahl.sigma * 2.0_f64.powf(self.dahl.gamma);
        let power = 8.0 * (1.0 + self.dahl.gamma) * f64::EPSILON * self.dahl.f_c;
        arcs * (power + 2.0 * slope * self.arcs.rounding())
    }
}
