//! What the runs of a plant are judged by, where no closed form is: two independent ways to solve it.

mod entries;
mod library;
mod located;

pub use entries::{PLANT_REFERENCES, PlantReferenceEntry};
pub use library::along;
pub use located::{Located, solve_located};

use crate::Path;
use duhem::closed_form::Reference;

/// A plant solved in two independent ways: the first is the answer, their difference its error.
#[derive(Debug, Clone)]
pub struct PlantReference {
    /// The answer.
    pub first: Path,
    /// The same by the other way.
    pub second: Path,
    /// What the two ways are.
    pub ways: [&'static str; 2],
    difference: f64,
    reversals: Vec<f64>,
}

impl PlantReference {
    /// The two solutions of one plant over the same span, and what made them.
    pub fn new(first: Path, second: Path, ways: [&'static str; 2]) -> Self {
        let apart = |nodes: &Path, other: &Path| {
            let at = |i: usize| (nodes.node(i)[0] - other.q(nodes.t()[i])).abs();
            (0..nodes.t().len()).map(at).fold(0.0, f64::max)
        };
        let difference = apart(&first, &second).max(apart(&second, &first));
        let reversals = first.reversals();
        Self { first, second, ways, difference, reversals }
    }

    /// The speed [m/s] that one way still has where the other reverses, at most. The time of a reversal
    /// is known as well as this divided by the acceleration there: a creep that follows a slow drive
    /// turns at 2e-10 m/s², and a speed of 1e-16 m/s is then a microsecond.
    pub fn speed_at_reversals(&self) -> f64 {
        let left =
            |path: &Path, times: &[f64]| times.iter().map(|t| path.v(*t).abs()).fold(0.0, f64::max);
        left(&self.second, &self.reversals).max(left(&self.first, &self.second.reversals()))
    }

    /// The largest difference [s] of the times at which the two ways reverse; none if one has a reversal
    /// more, as it can happen to a motion that rings down. See [`Self::speed_at_reversals`].
    pub fn reversal_difference(&self) -> Option<f64> {
        largest_difference(&self.reversals, &self.second.reversals())
    }

    /// The largest difference [s] of the times at which the speed rises through `speed` [m/s]; none if one
    /// way has more of them.
    pub fn onset_difference(&self, speed: f64) -> Option<f64> {
        largest_difference(&self.first.onsets(speed), &self.second.onsets(speed))
    }
}

fn largest_difference(a: &[f64], b: &[f64]) -> Option<f64> {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    (a.len() == b.len()).then(|| differences.fold(0.0, f64::max))
}

impl Reference for PlantReference {
    fn state(&self, t: f64, y: &mut [f64]) {
        self.first.state(t, y);
    }

    /// The largest |q₁ − q₂| over the nodes of both ways [m].
    fn error_bound(&self) -> f64 {
        self.difference
    }

    /// The reversals.
    fn kinks(&self) -> Vec<f64> {
        self.reversals.clone()
    }
}
