//! The anchors: six problems of the paper, P1 to P6, by which our methods and the libraries are compared.
//!
//! A method delivers its states on a problem's grid, and its error is that of one quantity there: the
//! force under an imposed motion, the displacement of a plant.

mod answer;
mod contest;
mod rigs;
mod row;
mod timing;

pub use answer::{Answer, AnswerError, answer, table};
pub use contest::{Contest, Contestant, Verified, contestants, run};
pub use rigs::{rigs, rigs_of};
pub use row::{RTOLS, Row, RowControl, SOLVED};
pub use timing::{Timing, median, time};

use crate::{Motion, Task};
use duhem::{Input, InputError, MODELS, ModelEntry, Parameter, ParameterError, Parameters};
use duhem::{Plant, Rig};
use std::f64::consts::PI;

/// One problem with what it is solved for.
#[derive(Debug, Clone)]
pub struct Anchor {
    /// Its name: P1 to P6.
    pub problem: &'static str,
    /// What sets it apart from the others of the name: γ of P1, ω [rad/s] of P2.
    pub parameter: Option<f64>,
    /// What is to be solved.
    pub task: Task,
    /// The times at which the states are delivered [s].
    pub grid: Vec<f64>,
}

/// Why there are no anchors: a model or an input of the list has changed under them.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AnchorError {
    /// No such model.
    #[error("no model is called {0}")]
    Model(&'static str),
    /// The parameters are not those of the model.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// The input cannot be.
    #[error(transparent)]
    Input(#[from] InputError),
}

/// The names of the problems, in order.
pub const PROBLEMS: [&str; 6] = ["P1", "P2", "P3", "P4", "P5", "P6"];

/// All anchors, in order.
pub fn anchors() -> Result<Vec<Anchor>, AnchorError> {
    let mut anchors = Vec::new();
    for gamma in [0.0, 0.25, 1.0, 2.0] {
        anchors.push(dahl(gamma)?);
    }
    for omega in [10.0, 5.0, 1.0, 0.1] {
        anchors.push(lugre(omega)?);
    }
    anchors.push(maxwell_slip()?);
    anchors.push(mass_spring_dahl()?);
    anchors.push(mass_spring_lugre()?);
    anchors.push(rig_lugre()?);
    Ok(anchors)
}

impl Anchor {
    /// The quantity the error is taken of, from the states on the grid, with `motion` that of the task:
    /// F [N] under an imposed motion, q [m] or [rad] of a plant.
    pub fn quantity(&self, motion: &dyn Motion, states: &[f64]) -> Vec<f64> {
        let rows = states.chunks_exact(self.task.y0.len());
        self.grid.iter().zip(rows).map(|(t, y)| motion.response(*t, y)).collect()
    }
}

/// max abs(delivered − reference)/max abs(reference); not a number if one of them is not.
pub fn error(delivered: &[f64], reference: &[f64]) -> f64 {
    let apart = delivered.iter().zip(reference).map(|(d, r)| (d - r).abs());
    // Written so that a value that is not a number stays.
    let worst =
        apart.fold(0.0, |worst: f64, v| if worst.is_nan() || v <= worst { worst } else { v });
    worst / reference.iter().fold(0.0, |largest: f64, r| largest.max(r.abs()))
}

/// P1: Dahl under u = sin 0.1t; three periods from F = 0.
fn dahl(gamma: f64) -> Result<Anchor, AnchorError> {
    let parameters = scalars(&[("f_c", 0.75), ("sigma", 1.5), ("gamma", gamma)]);
    imposed(("P1", Some(gamma)), ("dahl", parameters), (1.0, 0.1), 1)
}

/// P2: LuGre of Figure 3 under u = 1e-4 sin ωt; three periods from x = 0.
fn lugre(omega: f64) -> Result<Anchor, AnchorError> {
    imposed(("P2", Some(omega)), ("lugre", bristles()), (1e-4, omega), 1)
}

/// P3: Maxwell-slip of Figure 6b, ten elements, under u = 0.01 sin 0.1t; three periods from rest.
fn maxwell_slip() -> Result<Anchor, AnchorError> {
    let element = |first: f64, more: f64| -> Vec<f64> {
        (0..10).map(|i| first + more * f64::from(i)).collect()
    };
    let (k, delta) = (element(1.0, 0.8), element(1.5e-3, 0.9e-3));
    let parameters = [("k", Parameter::from(k)), ("delta", delta.into())].into_iter().collect();
    imposed(("P3", None), ("maxwell-slip", parameters), (0.01, 0.1), 10)
}

/// P4: mass-spring with Dahl friction, Figure 13, from rest.
fn mass_spring_dahl() -> Result<Anchor, AnchorError> {
    let parameters = scalars(&[("f_c", 0.75), ("sigma", 7.5), ("gamma", 1.0)]);
    let drive = Input::sine(5.0, 0.001)?;
    driven("P4", ("dahl", parameters), (Plant::mass_spring(1.0, 1.5), drive), STAIRCASE)
}

/// P5: mass-spring with LuGre friction, Figure 14, k_s = 2 N/m, m = 1 kg, from rest.
fn mass_spring_lugre() -> Result<Anchor, AnchorError> {
    let drive = Input::sine(10.0, 0.001)?;
    driven("P5", ("lugre", bristles()), (Plant::mass_spring(1.0, 2.0), drive), STAIRCASE)
}

/// P6: the rig with LuGre friction, Figure 20, from rest.
fn rig_lugre() -> Result<Anchor, AnchorError> {
    let parameters = scalars(&[
        ("f_c", 0.6),
        ("f_s", 1.0),
        ("v_s", 1e-3),
        ("sigma_0", 1e3),
        ("sigma_1", 1e3_f64.sqrt()),
        ("sigma_2", 1.3),
    ]);
    let current = Input::sine(0.05, 0.2 * PI)?;
    driven("P6", ("lugre", parameters), (Rig::PAPER.plant(), current), (50.0, 5001))
}

/// The end [s] of P4 and P5 and the points of their grid: about one a second.
const STAIRCASE: (f64, u32) = (6283.185, 6284);

/// The LuGre model of Figure 3 and of Figure 14.
fn bristles() -> Parameters {
    scalars(&[
        ("f_c", 1.0),
        ("f_s", 1.5),
        ("v_s", 1e-3),
        ("sigma_0", 1e5),
        ("sigma_1", 1e5_f64.sqrt()),
        ("sigma_2", 0.4),
    ])
}

fn scalars(pairs: &[(&str, f64)]) -> Parameters {
    pairs.iter().map(|(key, value)| (*key, *value)).collect()
}

/// A model under a sine of this amplitude [m] and frequency [rad/s] over three periods, on 601 points.
fn imposed(
    (problem, parameter): (&'static str, Option<f64>),
    (model, parameters): (&'static str, Parameters),
    (amplitude, omega): (f64, f64),
    states: usize,
) -> Result<Anchor, AnchorError> {
    let (input, end) = (Input::sine(amplitude, omega)?, 6.0 * PI / omega);
    let (y0, span) = (vec![0.0; states], (0.0, end));
    let task = Task { model: entry(model)?, parameters, plant: None, input, y0, span };
    Ok(Anchor { problem, parameter, task, grid: grid(end, 601) })
}

/// A plant with a model of one state, from rest to the end [s], on so many points.
fn driven(
    problem: &'static str,
    (model, parameters): (&'static str, Parameters),
    (plant, input): (Plant, Input),
    (end, points): (f64, u32),
) -> Result<Anchor, AnchorError> {
    let (y0, span, plant) = (vec![0.0; 3], (0.0, end), Some(plant));
    let task = Task { model: entry(model)?, parameters, plant, input, y0, span };
    Ok(Anchor { problem, parameter: None, task, grid: grid(end, points) })
}

fn entry(name: &'static str) -> Result<&'static ModelEntry, AnchorError> {
    MODELS.iter().find(|model| model.name == name).ok_or(AnchorError::Model(name))
}

/// So many times from 0 to the end, equally spaced, the last of them the end.
fn grid(end: f64, points: u32) -> Vec<f64> {
    let last = points - 1;
    (0..=last).map(|i| if i == last { end } else { end * f64::from(i) / f64::from(last) }).collect()
}
