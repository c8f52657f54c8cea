//! The list of plant references: which two ways each friction model is solved by.

use super::{PlantReference, library, solve_located};
use crate::{
    DrivenPlant, Path, SimulationError,
    displacement::{ByDisplacement, RateIndependent},
    exact::SlipPlant,
};
use duhem::{
    Dahl, FrictionModel, Input, LuGre, MaxwellSlip, Parameters, Plant,
    closed_form::{ReferenceError, check},
};
use integrate::Outcome;

/// Relative tolerance of our stiff method. At 1e-11 the staircase of Figure 14 is right to 1e-9 m over
/// 7000 s: ten times less moves q by 3e-10 m, and an explicit method of order 5 agrees to 3e-10 m.
const LOCATED: f64 = 1e-11;

/// Relative tolerance of the library's method. The staircase by `bdf` then is 1e-8 m off; at ten times
/// less rounding doubles the steps and the rig's motion gets no better.
const LIBRARY: f64 = 1e-13;

/// How closely the exact solution is sampled [m] or [rad].
const SAMPLED: f64 = 1e-10;

const LOCATED_WAY: &str = "Radau IIA of order 5, every reversal located";
const BDF_WAY: &str = "backward differentiation, diffsol's bdf";
const DISPLACEMENT_WAY: &str = "friction in closed form over q, the motion by RK4";
const EXACT_WAY: &str = "exactly, from event to event";

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

/// The references.
pub const PLANT_REFERENCES: &[PlantReferenceEntry] = &[
    PlantReferenceEntry { name: "dahl", ways: [LOCATED_WAY, DISPLACEMENT_WAY], build: dahl },
    PlantReferenceEntry { name: "lugre", ways: [LOCATED_WAY, BDF_WAY], build: lugre },
    PlantReferenceEntry {
        name: "maxwell-slip",
        ways: [EXACT_WAY, DISPLACEMENT_WAY],
        build: maxwell_slip,
    },
];

/// For γ ≥ 1; below that F arrives at F_C, where ẋ is not Lipschitz and no step of a solver ends.
fn dahl(
    parameters: &Parameters,
    plant: &Plant,
    input: &Input,
    y0: &[f64],
    span: (f64, f64),
) -> Result<PlantReference, ReferenceError> {
    check(y0, 3, span)?;
    let model = Dahl::new(parameters)?;
    if model.gamma < 1.0 {
        let why = format!("γ = {}: expected at least 1, for a Lipschitz model", model.gamma);
        return Err(unanswered(LOCATED_WAY, span, why));
    }
    let motion = DrivenPlant::new(Box::new(model.clone()), *plant, input.clone(), span);
    let first = located(&motion, y0)?;
    let second = by_displacement(RateIndependent::Dahl(model), (plant, input), y0, span)?;
    Ok(PlantReference::new(first, second, [LOCATED_WAY, DISPLACEMENT_WAY]))
}

/// The library is not told where the reversals are.
fn lugre(
    parameters: &Parameters,
    plant: &Plant,
    input: &Input,
    y0: &[f64],
    span: (f64, f64),
) -> Result<PlantReference, ReferenceError> {
    check(y0, 3, span)?;
    let model = LuGre::new(parameters)?;
    let motion = DrivenPlant::new(Box::new(model), *plant, input.clone(), span);
    let first = located(&motion, y0)?;
    let (second, outcome) = library::solve_by("bdf", &motion, y0, LIBRARY);
    answered(BDF_WAY, outcome)?;
    Ok(PlantReference::new(first, second, [LOCATED_WAY, BDF_WAY]))
}

/// For a drive that is a sine, an offset cosine or constant.
fn maxwell_slip(
    parameters: &Parameters,
    plant: &Plant,
    input: &Input,
    y0: &[f64],
    span: (f64, f64),
) -> Result<PlantReference, ReferenceError> {
    let model = MaxwellSlip::new(parameters)?;
    check(y0, 2 + model.states(), span)?;
    let refuse = |error: SimulationError| unanswered(EXACT_WAY, span, error.to_string());
    let slip = SlipPlant::new(model.clone(), plant, input).map_err(refuse)?;
    let first = slip.solve(y0, span).map_err(refuse)?.path(SAMPLED);
    let second = by_displacement(RateIndependent::MaxwellSlip(model), (plant, input), y0, span)?;
    Ok(PlantReference::new(first, second, [EXACT_WAY, DISPLACEMENT_WAY]))
}

fn located(motion: &DrivenPlant, y0: &[f64]) -> Result<Path, ReferenceError> {
    let located = solve_located(motion, y0, LOCATED);
    answered(LOCATED_WAY, located.outcome)?;
    Ok(located.path)
}

fn by_displacement(
    friction: RateIndependent,
    (plant, input): (&Plant, &Input),
    y0: &[f64],
    span: (f64, f64),
) -> Result<Path, ReferenceError> {
    let by = ByDisplacement { friction, plant: *plant, input: input.clone() };
    let steps = by.steps();
    let refuse = |error: SimulationError| unanswered(DISPLACEMENT_WAY, span, error.to_string());
    by.solve(y0, span, steps).map_err(refuse)
}

fn answered(way: &str, outcome: Outcome) -> Result<(), ReferenceError> {
    match outcome {
        Outcome::Solved => Ok(()),
        Outcome::Failed { at, why } => Err(unanswered(way, (at, at), why.to_string())),
    }
}

/// The way got no further than the start of `span`, or to where it stopped.
fn unanswered(way: &str, (at, _): (f64, f64), why: String) -> ReferenceError {
    ReferenceError::Unanswered { way: way.to_owned(), at, why }
}
