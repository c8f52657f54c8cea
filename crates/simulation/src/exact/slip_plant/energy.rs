//! Where the energy of the exact solution goes.

use super::{ExactSolution, Leg};
use crate::Energy;

/// Nodes and weights of the Gauss–Legendre rule of order 10 on [−1, 1]; each node stands for two.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_22, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

impl ExactSolution {
    /// The energy account from the start to the end of the span.
    pub fn energy(&self) -> Energy {
        let (mut drive_work, mut dissipated, mut taken) = (0.0, 0.0, 0.0_f64);
        for leg in &self.legs {
            let (signed, absolute) = self.drive_work(leg);
            drive_work += signed;
            taken += absolute;
            dissipated += self.heat(leg);
        }
        let last = &self.legs[self.legs.len() - 1];
        let (start, end) = (self.stored(&self.legs[0], 0.0), self.stored(last, last.length));
        let scale = taken.max(start).max(end).max(dissipated);
        Energy { drive_work, stored: end - start, dissipated, scale }
    }

    /// ∫ w v dt over a leg, and ∫ |w v| dt, by quadrature of the closed form: a polynomial of degree 19
    /// on a sixteenth period is exact to rounding.
    fn drive_work(&self, leg: &Leg) -> (f64, f64) {
        let pieces = (leg.length / leg.arc.step(leg.length)).ceil().max(1.0);
        let half = 0.5 * leg.length / pieces;
        let power = |tau: f64| self.plant.drive.u(leg.start + tau) * leg.arc.at(tau).v;
        let (mut sum, mut absolute, mut n) = (0.0, 0.0, 0.0);
        while n < pieces {
            let middle = (2.0 * n + 1.0) * half;
            for (node, weight) in GAUSS {
                let (left, right) = (power(middle - node * half), power(middle + node * half));
                sum += weight * half * (left + right);
                absolute += weight * half * (left.abs() + right.abs());
            }
            n += 1.0;
        }
        (sum, absolute)
    }

    fn heat(&self, leg: &Leg) -> f64 {
        let way = leg.arc.at(leg.length).p.abs();
        let elements = self.plant.model.k.iter().zip(&self.plant.model.delta);
        let slipping = elements.zip(&leg.slips).filter(|(_, slips)| **slips);
        slipping.map(|((k, delta), _)| k * delta * way).sum()
    }

    fn stored(&self, leg: &Leg, tau: f64) -> f64 {
        let mut y = vec![0.0; self.plant.model.k.len() + 2];
        leg.state(tau, &mut y);
        self.plant.stored(&y)
    }
}

impl super::SlipPlant {
    /// ½mv² + ½k_s q² + ½Σ kᵢ(q − xᵢ)² [J] of the state y = [q, v, x₁ … x_N].
    pub fn stored(&self, y: &[f64]) -> f64 {
        let elements = self.model.k.iter().zip(&y[2..]);
        let springs: f64 = elements.map(|(k, x)| k * (y[0] - x) * (y[0] - x)).sum();
        0.5 * (self.mass * y[1] * y[1] + self.stiffness * y[0] * y[0] + springs)
    }
}
