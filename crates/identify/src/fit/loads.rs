//! The load cells of a drum, which see the springs and no friction.

use super::{binding::terms, problem::Problem};
use crate::{
    effects::{Load, Term},
    march::Dual,
};
use nalgebra::DMatrix;

impl Problem<'_> {
    /// The load cells, and then what holds some of the variables near their values.
    pub fn loads(&self, x: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
        let (mut residuals, jacobian) = self.cells(x);
        if self.priors.is_empty() {
            return (residuals, jacobian);
        }
        let rows = residuals.len();
        let mut all = jacobian.resize_vertically(rows + self.priors.len(), 0.0);
        for (i, (name, value, spread)) in self.priors.iter().enumerate() {
            let place = self.free.iter().position(|free| free.name == *name);
            let off = place.map_or(0.0, |j| (x[j] - self.free[j].variable(*value)) / spread);
            residuals.push(off);
            if let Some(j) = place {
                all[(rows + i, j)] = spread.recip();
            }
        }
        (residuals, all)
    }

    /// Weighed residuals of the load cells against the measured angle, F₁ = F₁₀ + k₁rθ and F₂ = F₂₀ − k₂rθ, and
    /// their derivatives by the springs', the preloads and the radius.
    pub fn cells(&self, x: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
        let (Some(loads), Some(angle)) = (&self.data.loads, &self.data.displacement) else {
            return (Vec::new(), DMatrix::zeros(0, self.free.len()));
        };
        let value = |name: &str| {
            let free = self.free.iter().position(|f| f.name == name);
            (free.map_or_else(|| self.rig.plant[name], |i| self.free[i].value(x[i])), free)
        };
        let (r, r_free) = value("radius");
        let samples: Vec<usize> = self.windows.iter().flat_map(|w| w.first..w.end).collect();
        let by_effects = self.effects_by_free(x);
        let given = terms::<Dual<1>>(self.rig, &|_| None);
        let mut jacobian = DMatrix::zeros(2 * samples.len(), self.free.len());
        let mut residuals = Vec::with_capacity(2 * samples.len());
        for (cell, side) in [(0, 1.0), (1, -1.0)] {
            let (k, k_free) = value(["k_1", "k_2"][cell]);
            let (f, f_free) = value(["f_10", "f_20"][cell]);
            for i in &samples {
                let stretch = side * r * angle.values[*i];
                let row = residuals.len();
                let load = Load { cell, t: self.data.time[*i], stretch, radius: r };
                let nominal = f + k * stretch;
                let shown = |terms: &[Term<Dual<1>>]| {
                    let all = terms.iter();
                    all.fold(Dual::from(nominal), |force, e| e.kind.load(&e.p, &load, force))
                };
                let force = match by_effects.first() {
                    Some((_, terms)) => shown(terms).re,
                    None => shown(&given).re,
                };
                residuals.push((force - loads[cell].values[*i]) / self.weights.loads[cell]);
                for (j, terms) in &by_effects {
                    jacobian[(row, *j)] = shown(terms).eps[0] / self.weights.loads[cell];
                }
                for (free, by) in [(k_free, stretch), (f_free, 1.0), (r_free, k * stretch / r)] {
                    if let Some(j) = free {
                        let slope = self.free[j].slope(self.free[j].value(x[j]));
                        jacobian[(row, j)] = by * slope / self.weights.loads[cell];
                    }
                }
            }
        }
        (residuals, jacobian)
    }

    /// The effects with derivatives by one of the free parameters of an effect each, and its place.
    fn effects_by_free(&self, x: &[f64]) -> Vec<(usize, Vec<Term<Dual<1>>>)> {
        let of_effect = (0..self.free.len()).filter(|j| self.free[*j].name.contains('.'));
        let one = |j: usize| {
            let number = |name: &str| {
                let i = self.free.iter().position(|f| f.name == name)?;
                let value = self.free[i].value(x[i]);
                let mut number = Dual::from(value);
                if i == j {
                    number.eps[0] = self.free[i].slope(value);
                }
                Some(number)
            };
            (j, terms(self.rig, &number))
        };
        of_effect.map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        Rig,
        fit::data::{Data, Seen},
        rig::Hold,
    };

    const RIG: &str = include_str!("../../tests/rigs/gearbox.toml");

    #[test]
    fn cells_that_show_the_springs_leave_nothing() {
        let mut rig = Rig::parse(RIG).expect("a rig");
        let angle: Vec<f64> = (0..20).map(|i| 0.3 * f64::from(i).sin()).collect();
        let value = |key: &str| rig.value(key).expect("a parameter");
        let (r, k_1, k_2) = (value("radius"), value("k_1"), value("k_2"));
        // By hand: a positive angle draws the first spring out and lets the second in.
        let first: Vec<f64> = angle.iter().map(|a| value("f_10") + k_1 * r * a).collect();
        let second: Vec<f64> = angle.iter().map(|a| value("f_20") - k_2 * r * a).collect();
        let time = (0..20).map(|i| 0.01 * f64::from(i)).collect();
        let seen = Seen::new("angle", angle.clone(), 1e-3);
        let cells = [Seen::new("force_1", first, 1e-4), Seen::new("force_2", second, 1e-4)];
        let driven = Data::driven(time, vec![0.0; 20], Hold::Linear, seen);
        let data = Data { loads: Some(cells), ..driven };
        rig.free = vec!["k_1".to_owned(), "k_2".to_owned()];
        let problem = crate::fit::problem(&rig, &data).expect("a problem");
        let x = crate::fit::starts::nominal(&problem);
        let (residuals, slopes) = problem.loads(&x);
        assert!(residuals.iter().all(|r| r.abs() < 1e-9), "{residuals:?}");
        // One hundredth more of k₂ in its logarithm, in the second cell alone.
        let (moved, _) = problem.loads(&[x[0], x[1] + 0.01]);
        for (row, (moved, slope)) in moved.iter().zip(slopes.column(1).iter()).enumerate() {
            assert!((moved - 0.01 * slope).abs() <= 0.006 * moved.abs(), "row {row}");
            assert!(row >= 20 || *moved == 0.0);
        }
    }
}
