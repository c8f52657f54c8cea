//! The force over time.

use super::{advance, travel};
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

    /// Where F arrives at ±F_C, for γ < 1: there the slope drops to zero, at once for γ = 0.
    fn kinks(&self) -> Vec<f64> {
        let arrival = |k: usize| {
            let whole = self.arcs.travel(k);
            let way = travel(&self.dahl, self.force[k], self.dahl.f_c.copysign(whole))?;
            (way != 0.0 && way.abs() < whole.abs()).then(|| self.arcs.time_at(k, way))
        };
        (0..self.arcs.len()).filter_map(arrival).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Dahl, Input, Reference, Trajectory};

    #[test]
    fn the_force_arrives_at_coulomb_where_the_rest_stiffness_takes_it() {
        // γ = 0: from F = 0 at u = 0 the force is σu and arrives at F_C at u = 0.5 m; from −F_C or F_C it
        // takes 1 m, from the turn at ±1 m to u = 0.
        let dahl = Dahl { f_c: 0.75, sigma: 1.5, gamma: 0.0 };
        let input = Input::sine(1.0, 0.1).unwrap();
        let period = input.period().unwrap();
        let kinks = Trajectory::new(&dahl, &input, 0.0, (0.0, period)).unwrap().kinks();
        let expected = [0.5_f64.asin() / 0.1, 0.5 * period];
        assert_eq!(kinks.len(), 2, "{kinks:?}");
        for (kink, expected) in kinks.iter().zip(expected) {
            assert!((kink - expected).abs() < 1e-12, "arrives at {kink} s, expected {expected} s");
        }
        let gentle = Dahl { gamma: 1.0, ..dahl };
        assert!(Trajectory::new(&gentle, &input, 0.0, (0.0, period)).unwrap().kinks().is_empty());
    }
}
