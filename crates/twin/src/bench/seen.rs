//! How much of a change of nature is left to be seen once the free parameters have been refitted.

use super::{Case, Hides, draw, nominal, visible};
use crate::{Scenario, TwinError};

/// By how much a free parameter is moved to see what it can take up.
const STEP: f64 = 0.01;
/// What is left of a direction of which less than this is its own is the others' [1].
const OWN: f64 = 1e-6;

impl Case {
    /// For each hidden effect, or for the wrong parameter, how well it can be seen beside everything else that the
    /// record holds: the norm of its change over all samples of all channels, each in units of its sensor's noise,
    /// less what the rig's free parameters could take up, to first order [σ].
    ///
    /// As in [`super::Visible::local`], a straight line is taken off every second of every change, unless the effect
    /// is something steady. Noise of the recorded drive is not counted against it. Nothing hidden gives no number.
    ///
    /// # Errors
    /// A motion that cannot be followed.
    pub fn seen(&self) -> Result<Vec<f64>, TwinError> {
        let without = Scenario { hidden: Vec::new(), ..self.scenario.clone() };
        let one = |steady: bool, other: &Scenario, wrong: Option<&str>| {
            let change = self.change(&self.scenario, other, steady)?;
            let free = self.directions(&without, steady, wrong)?;
            Ok(left(change, free))
        };
        match (&self.recipe.hides, &self.key.parameter) {
            (Hides::Effects(_), _) => (0..self.scenario.hidden.len())
                .map(|i| {
                    let mut other = self.scenario.clone();
                    let effect = other.hidden.remove(i);
                    one(draw::steady(effect.name(), &without), &other, None)
                })
                .collect(),
            (Hides::Parameter, Some(wrong)) => {
                let mut off = without.clone();
                nominal::scale(&mut off, &wrong.name, wrong.nominal / wrong.truth);
                // A preload or a spring's stiffness shows in a line.
                Ok(vec![one(true, &off, Some(&wrong.name))?])
            }
            _ => Ok(Vec::new()),
        }
    }

    /// What each free parameter changes, but for the one that is asked about.
    fn directions(
        &self,
        without: &Scenario,
        steady: bool,
        but: Option<&str>,
    ) -> Result<Vec<Vec<f64>>, TwinError> {
        let free = nominal::free(self.recipe.family, without);
        free.iter()
            .filter(|name| Some(name.as_str()) != but)
            .map(|name| {
                let mut moved = without.clone();
                nominal::scale(&mut moved, name, 1.0 + STEP);
                self.change(&moved, without, steady)
            })
            .collect()
    }

    fn change(&self, a: &Scenario, b: &Scenario, steady: bool) -> Result<Vec<f64>, TwinError> {
        let changes = visible::changes(a, b, self.seed)?;
        let whole = |(_, noise, change): (_, f64, Vec<f64>)| {
            let change = if steady { change } else { visible::straightened(&change, super::RATE) };
            change.into_iter().map(move |v| v / noise)
        };
        Ok(changes.into_iter().flat_map(whole).collect())
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The norm of what of `change` is in none of the directions.
fn left(mut change: Vec<f64>, directions: Vec<Vec<f64>>) -> f64 {
    let mut base: Vec<Vec<f64>> = Vec::new();
    for mut direction in directions {
        let whole = dot(&direction, &direction).sqrt();
        // Twice is enough for round-off.
        take_off(&mut direction, &base);
        take_off(&mut direction, &base);
        let own = dot(&direction, &direction).sqrt();
        if own > OWN * whole {
            for v in &mut direction {
                *v /= own;
            }
            base.push(direction);
        }
    }
    take_off(&mut change, &base);
    dot(&change, &change).sqrt()
}

fn take_off(change: &mut [f64], base: &[Vec<f64>]) {
    for direction in base {
        let part = dot(change, direction);
        for (v, d) in change.iter_mut().zip(direction) {
            *v -= part * d;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::left;

    #[test]
    fn what_two_oblique_directions_span_is_taken_off_and_the_rest_stays() {
        let directions = vec![vec![1.0, 0.0, 0.0], vec![5.0, 1.0, 0.0], vec![-3.0, 2.0, 0.0]];
        let rest = left(vec![7.0, -4.0, 3.0], directions);
        assert!((rest - 3.0).abs() < 1e-12, "{rest} σ of 3 σ are left");
        let whole = left(vec![3.0, 4.0], vec![]);
        assert!((whole - 5.0).abs() < 1e-12, "{whole} σ of 5 σ are left");
    }
}
