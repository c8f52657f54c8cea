//! How much of a change of nature is left to be seen once the free parameters have been refitted.

use super::{
    Case, Hides, draw, nominal,
    visible::{self, Shown},
};
use crate::{Scenario, TwinError};
use nalgebra::{DMatrix, DVector};

/// By how much a free parameter is moved to see what it can take up.
const STEP: f64 = 0.01;
/// What is left of a direction of which less than this is its own is the others' [1].
const OWN: f64 = 1e-6;
/// The refit goes on for as long as it leaves less than this share of what it left before, and so often at most.
const LESS: f64 = 0.9;
const REFITS: usize = 10;
/// A refitted parameter is so many times too large or too small at most: a record that hardly shows some parameter
/// lets the next step take it anywhere, to where the motion cannot be followed in any time [seed 8010961].
const FAR: f64 = 100.0;
/// Parts of a step that are tried in turn.
const PARTS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];

impl Case {
    /// For each hidden effect, or for the wrong parameter, how well it can be seen beside everything else that the
    /// record holds: the norm of its change over all samples of all channels, each in units of its sensor's noise,
    /// that is left when the rig's free parameters are refitted to take up as much of it as they can [σ]; where that
    /// refit stops short, what it promises there, which may be too much.
    ///
    /// As in [`super::Visible::local`], a straight line is taken off every second of every change, unless the effect
    /// is something steady. Noise of the recorded drive is not counted against it. Nothing hidden gives no number.
    ///
    /// # Errors
    /// A motion that cannot be followed.
    pub fn seen(&self) -> Result<Vec<f64>, TwinError> {
        let without = Scenario { hidden: Vec::new(), ..self.scenario.clone() };
        match (&self.recipe.hides, &self.key.parameter) {
            (Hides::Effects(_), _) => (0..self.scenario.hidden.len())
                .map(|i| {
                    let mut other = self.scenario.clone();
                    let effect = other.hidden.remove(i);
                    self.refitted(&other, draw::steady(effect.name(), &without), None)
                })
                .collect(),
            (Hides::Parameter, Some(wrong)) => {
                let mut off = without.clone();
                nominal::scale(&mut off, &wrong.name, wrong.nominal / wrong.truth);
                // A preload or a spring's stiffness shows in a line.
                Ok(vec![self.refitted(&off, true, Some(&wrong.name))?])
            }
            _ => Ok(Vec::new()),
        }
    }

    /// What `other` leaves of the record [σ] when its free parameters but one, `wrong`, are refitted by Gauss and
    /// Newton's method: where a mass sticks and slides, what a first step leaves is mostly what is not linear in them.
    fn refitted(
        &self,
        other: &Scenario,
        steady: bool,
        wrong: Option<&str>,
    ) -> Result<f64, TwinError> {
        let mut free = nominal::free(self.recipe.family, other);
        free.retain(|name| Some(name.as_str()) != wrong);
        let truth = visible::shown(&self.scenario, self.seed)?;
        let (mut at, there) = (other.clone(), visible::shown(other, self.seed)?);
        let mut here = self.around(&at, Change::of(&truth, &there), (&there, &free))?;
        let first = here.left(steady).0;
        for _ in 0..REFITS {
            // A refit takes what is steady as it is: preloads that are said by nothing else are said by that.
            let (_, steps) = here.left(true);
            let moved = |part: f64| {
                let mut moved = at.clone();
                for (name, step) in free.iter().zip(steps.iter()) {
                    let gone = gone(name, &at, other);
                    nominal::scale(&mut moved, name, within(1.0 + part * STEP * step, gone));
                }
                let there = visible::shown(&moved, self.seed).ok()?;
                let then = Change::of(&truth, &there);
                let less = then.all(true).norm() < LESS * here.change.all(true).norm();
                less.then_some((moved, then, there))
            };
            let Some((moved, change, there)) = PARTS.into_iter().find_map(moved) else { break };
            here = self.around(&moved, change, (&there, &free))?;
            at = moved;
        }
        // What cannot be reached is not linear either: what the nearest point known promises counts, and no more than
        // what the first one does.
        Ok(here.left(steady).0.min(first))
    }

    /// A `change` that nature `at` leaves, with what each `free` parameter changes of what that shows.
    fn around(
        &self,
        at: &Scenario,
        change: Change,
        (there, free): (&[Shown], &[String]),
    ) -> Result<Around, TwinError> {
        let one = |name: &String| {
            let mut moved = at.clone();
            nominal::scale(&mut moved, name, 1.0 + STEP);
            Ok(Change::of(&visible::shown(&moved, self.seed)?, there))
        };
        let directions = free.iter().map(one).collect::<Result<_, TwinError>>()?;
        Ok(Around { change, directions })
    }
}

/// How many times as large a parameter is `at` one nature as in the `other`.
fn gone(name: &str, at: &Scenario, other: &Scenario) -> f64 {
    let ratio = nominal::value(at, name).zip(nominal::value(other, name)).map(|(at, of)| at / of);
    ratio.filter(|ratio| ratio.is_finite()).unwrap_or(1.0)
}

/// A factor for a parameter that has `gone` so many times already, so that it is never more than [`FAR`] off.
fn within(factor: f64, gone: f64) -> f64 {
    factor.clamp(1.0 / FAR / gone, FAR / gone)
}

/// A change of every channel [σ].
struct Change(Vec<Vec<f64>>);

impl Change {
    /// Of what is shown from what another nature shows.
    fn of(shown: &[Shown], other: &[Shown]) -> Self {
        let one = |(shown, other): (&Shown, &Shown)| {
            shown.change(other).into_iter().map(|v| v / shown.noise).collect()
        };
        Self(shown.iter().zip(other).map(one).collect())
    }

    /// All samples of all channels; a straight line is taken off every second of what is not to be `steady`.
    fn all(&self, steady: bool) -> DVector<f64> {
        let one = |channel: &Vec<f64>| {
            if steady { channel.clone() } else { visible::straightened(channel, super::RATE) }
        };
        DVector::from_vec(self.0.iter().flat_map(one).collect())
    }
}

/// A change, and what each free parameter changes.
struct Around {
    change: Change,
    directions: Vec<Change>,
}

impl Around {
    /// The norm of what the parameters leave, to first order, and how much of each takes up the rest.
    fn left(&self, steady: bool) -> (f64, Vec<f64>) {
        let directions: Vec<DVector<f64>> = self.directions.iter().map(|d| d.all(steady)).collect();
        left(&self.change.all(steady), &directions)
    }
}

/// The norm of what of `change` is in none of the directions, and how much of each takes up the rest.
fn left(change: &DVector<f64>, directions: &[DVector<f64>]) -> (f64, Vec<f64>) {
    let sizes: Vec<f64> = directions.iter().map(|d| d.norm().max(f64::MIN_POSITIVE)).collect();
    let columns: Vec<DVector<f64>> =
        directions.iter().zip(&sizes).map(|(direction, size)| direction / *size).collect();
    if columns.is_empty() {
        return (change.norm(), Vec::new());
    }
    let base = DMatrix::from_columns(&columns);
    let Ok(taken) = base.clone().svd(true, true).solve(change, OWN) else {
        return (change.norm(), vec![0.0; sizes.len()]);
    };
    let rest = (change - base * &taken).norm();
    (rest, taken.iter().zip(&sizes).map(|(much, size)| much / size).collect())
}

#[cfg(test)]
mod tests {
    use super::{FAR, left, within};
    use nalgebra::DVector;

    fn vector(values: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(values)
    }

    #[test]
    fn a_refitted_parameter_stays_within_a_hundredfold_of_what_it_was() {
        let taken = |steps: &[f64]| steps.iter().fold(1.0, |gone, step| gone * within(*step, gone));
        assert!((taken(&[2.0, 3.0]) - 6.0).abs() < 1e-12);
        assert!((taken(&[50.0, 1e5, 3.0]) - FAR).abs() < 1e-9);
        assert!((taken(&[-0.66, 1e-3, 0.5]) - 1.0 / FAR).abs() < 1e-15);
        assert!((taken(&[1e5, 0.5]) - FAR / 2.0).abs() < 1e-9, "it may come back");
    }

    #[test]
    fn what_two_oblique_directions_span_is_taken_off_and_the_rest_stays() {
        let directions = [[1.0, 0.0, 0.0], [5.0, 1.0, 0.0], [-3.0, 2.0, 0.0]].map(|d| vector(&d));
        let (rest, _) = left(&vector(&[7.0, -4.0, 3.0]), &directions);
        assert!((rest - 3.0).abs() < 1e-12, "{rest} σ of 3 σ are left");
        let (rest, steps) = left(&vector(&[7.0, -4.0, 3.0]), &directions[..2]);
        assert!((rest - 3.0).abs() < 1e-12 && (steps[1] + 4.0).abs() < 1e-12, "{steps:?}");
        assert!((steps[0] - 27.0).abs() < 1e-12, "{steps:?}");
        let (whole, _) = left(&vector(&[3.0, 4.0]), &[]);
        assert!((whole - 5.0).abs() < 1e-12, "{whole} σ of 5 σ are left");
    }
}
