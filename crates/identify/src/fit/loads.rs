//! The load cells of a drum, which see the springs and no friction.

use super::problem::Problem;
use nalgebra::DMatrix;

impl Problem<'_> {
    /// Weighed residuals of the load cells against the measured angle, F₁ = F₁₀ + k₁rθ and F₂ = F₂₀ − k₂rθ, and
    /// their derivatives.
    pub(super) fn loads(&self, x: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
        let (Some(loads), Some(angle)) = (&self.data.loads, &self.data.displacement) else {
            return (Vec::new(), DMatrix::zeros(0, self.free.len()));
        };
        let value = |name: &str| {
            let free = self.free.iter().position(|f| f.name == name);
            (free.map_or_else(|| self.rig.plant[name], |i| self.free[i].value(x[i])), free)
        };
        let r = value("radius").0;
        let samples: Vec<usize> = self.windows.iter().flat_map(|w| w.first..w.end).collect();
        let mut jacobian = DMatrix::zeros(2 * samples.len(), self.free.len());
        let mut residuals = Vec::with_capacity(2 * samples.len());
        for (cell, side) in [(0, 1.0), (1, -1.0)] {
            let (k, k_free) = value(["k_1", "k_2"][cell]);
            let (f, f_free) = value(["f_10", "f_20"][cell]);
            for i in &samples {
                let stretch = side * r * angle.values[*i];
                let row = residuals.len();
                residuals
                    .push((f + k * stretch - loads[cell].values[*i]) / self.weights.loads[cell]);
                for (free, by) in [(k_free, stretch), (f_free, 1.0)] {
                    if let Some(j) = free {
                        let slope = self.free[j].slope(self.free[j].value(x[j]));
                        jacobian[(row, j)] = by * slope / self.weights.loads[cell];
                    }
                }
            }
        }
        (residuals, jacobian)
    }
}
