//! What the runs of a plant are judged by, where no closed form is: two independent ways to solve it.

mod library;
mod located;

pub use library::along;
pub use located::{Located, solve_located};

use crate::{DrivenPlant, Path};
use duhem::{
    Input, MODELS, Parameters, Plant,
    closed_form::{Reference, ReferenceError, check},
};
use integrate::{Dynamics, Outcome};

/// Relative tolerance of our stiff method. At 1e-11 the staircase of Figure 14 is right to 1e-9 m over
/// 7000 s: ten times less moves q by 3e-10 m, and an explicit method of order 5 agrees to 3e-10 m.
const LOCATED: f64 = 1e-11;

/// Relative tolerance of the library's method. With LuGre the staircase by `bdf` then is 1e-8 m off; at
/// ten times less rounding doubles the steps and the rig's motion gets no better. With Dahl the mass of
/// Figure 13 rings undamped for 14 500 s, and the phase is what is lost: 7e-9 m by `dopri5`, 2e-7 m by
/// `bdf`.
const LIBRARY: f64 = 1e-13;

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

/// One reference of the list.
#[derive(Debug, Clone, Copy)]
pub struct PlantReferenceEntry {
    /// The friction model's name.
    pub name: &'static str,
    /// The two ways, in words.
    pub ways: [&'static str; 2],
    /// The answer for a model of these parameters on this plant under this input, from the state
    /// (q, v, x) and over the span [s].
    pub build: fn(
        &Parameters,
        &Plant,
        &Input,
        &[f64],
        (f64, f64),
    ) -> Result<PlantReference, ReferenceError>,
}

const LOCATED_WAY: &str = "Radau IIA of order 5, every reversal located";
const BDF_WAY: &str = "backward differentiation, diffsol's bdf";
const DOPRI5_WAY: &str = "explicit Runge-Kutta of order 5, ode_solvers' dopri5";

/// The references.
pub const PLANT_REFERENCES: &[PlantReferenceEntry] = &[
    PlantReferenceEntry {
        name: "dahl",
        ways: [LOCATED_WAY, DOPRI5_WAY],
        build: |model, plant, input, y0, span| {
            let motion = driven("dahl", model, plant, input, span)?;
            solved_twice(&motion, y0, ("dopri5", DOPRI5_WAY))
        },
    },
    PlantReferenceEntry {
        name: "lugre",
        ways: [LOCATED_WAY, BDF_WAY],
        build: |model, plant, input, y0, span| {
            let motion = driven("lugre", model, plant, input, span)?;
            solved_twice(&motion, y0, ("bdf", BDF_WAY))
        },
    },
];

/// The plant with the model of this name.
fn driven(
    name: &str,
    parameters: &Parameters,
    plant: &Plant,
    input: &Input,
    span: (f64, f64),
) -> Result<DrivenPlant, ReferenceError> {
    check(&[], 0, span)?;
    let entry = MODELS.iter().find(|entry| entry.name == name);
    let unknown = || ReferenceError::Unanswered {
        way: name.to_owned(),
        at: span.0,
        why: "is no model of the list".to_owned(),
    };
    let model = (entry.ok_or_else(unknown)?.build)(parameters)?;
    Ok(DrivenPlant::new(model, *plant, input.clone(), span))
}

/// By our stiff method and by a library's, which is not told where the reversals are.
fn solved_twice(
    motion: &DrivenPlant,
    y0: &[f64],
    (solver, way): (&str, &'static str),
) -> Result<PlantReference, ReferenceError> {
    check(y0, motion.dimension(), motion.span())?;
    let located = solve_located(motion, y0, LOCATED);
    answered(LOCATED_WAY, located.outcome)?;
    let (second, outcome) = library::solve_by(solver, motion, y0, LIBRARY);
    answered(way, outcome)?;
    Ok(PlantReference::new(located.path, second, [LOCATED_WAY, way]))
}

fn answered(way: &str, outcome: Outcome) -> Result<(), ReferenceError> {
    match outcome {
        Outcome::Solved => Ok(()),
        Outcome::Failed { at, why } => {
            Err(ReferenceError::Unanswered { way: way.to_owned(), at, why: why.to_string() })
        }
    }
}
