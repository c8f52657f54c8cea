//! What the anchors are judged by, made outside every clock.

use super::{Anchor, error};
use crate::{DrivenPlant, Motion, PLANT_REFERENCES, plant_reference::solve_located};
use duhem::{
    ParameterError, Plant,
    closed_form::{REFERENCES, Reference, ReferenceError},
};
use integrate::Outcome;

/// The right quantity on an anchor's grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The force [N] or the displacement [m] or [rad] at each time of the grid.
    pub values: Vec<f64>,
    /// Its error, relative to the largest value: a bound on the rounding of a closed form, or the
    /// difference of the two ways; not known for one that was read.
    pub error: Option<f64>,
    /// How it was made.
    pub way: String,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AnswerError {
    /// The parameters do not make the model.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// It cannot be made.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// No closed form, or no two ways, of this model.
    #[error("no answer is known for {0}")]
    Model(&'static str),
    /// A table that was read is not one of this grid.
    #[error("line {line}: {found}; expected {expected}")]
    Table {
        /// Counted from 1.
        line: usize,
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
}

/// The answer by our own means: the closed form under an imposed motion, two independent ways on a plant.
pub fn answer(anchor: &Anchor) -> Result<Answer, AnswerError> {
    match &anchor.task.plant {
        Some(plant) => on_plant(anchor, plant),
        None => closed_form(anchor),
    }
}

fn closed_form(anchor: &Anchor) -> Result<Answer, AnswerError> {
    let task = &anchor.task;
    let entry = REFERENCES.iter().find(|reference| reference.name == task.model.name);
    let entry = entry.ok_or(AnswerError::Model(task.model.name))?;
    let reference = (entry.build)(&task.parameters, &task.input, &task.y0, task.span)?;
    let motion = task.motion()?;
    let values = forces(anchor, reference.as_ref(), motion.as_ref(), 0.0);
    let beside = forces(anchor, reference.as_ref(), motion.as_ref(), reference.error_bound());
    let error = Some(error(&beside, &values));
    Ok(Answer { values, error, way: "closed form".to_owned() })
}

/// The force on the grid, with each state shifted.
fn forces(anchor: &Anchor, reference: &dyn Reference, motion: &dyn Motion, shift: f64) -> Vec<f64> {
    let mut x = vec![0.0; anchor.task.y0.len()];
    let mut force = |t: &f64| {
        reference.state(*t, &mut x);
        for x in &mut x {
            *x += shift;
        }
        motion.force(*t, &x)
    };
    anchor.grid.iter().map(&mut force).collect()
}

/// Relative tolerance of our stiff method here: on P4 it is then right to 5e-12 of q, where the plant
/// reference's own, at 1e-11, is to 2e-9.
const TIGHT: f64 = 1e-13;

/// Our stiff method, tighter than in the plant's reference, against that reference's second way.
fn on_plant(anchor: &Anchor, plant: &Plant) -> Result<Answer, AnswerError> {
    let task = &anchor.task;
    let entry = PLANT_REFERENCES.iter().find(|reference| reference.name == task.model.name);
    let entry = entry.ok_or(AnswerError::Model(task.model.name))?;
    let both = (entry.build)(&task.parameters, plant, &task.input, &task.y0, task.span)?;
    let motion = DrivenPlant::new(task.friction()?, *plant, task.input.clone(), task.span);
    let first = solve_located(&motion, &task.y0, TIGHT);
    let way = format!("{} at rtol {TIGHT:e}", both.ways[0]);
    if let Outcome::Failed { at, why } = first.outcome {
        return Err(ReferenceError::Unanswered { way, at, why: why.to_string() }.into());
    }
    let values: Vec<f64> = anchor.grid.iter().map(|t| first.path.q(*t)).collect();
    let second: Vec<f64> = anchor.grid.iter().map(|t| both.second.q(*t)).collect();
    let error = Some(error(&second, &values));
    Ok(Answer { values, error, way: format!("{way}; against {}", both.ways[1]) })
}

/// The answer of a table made elsewhere: a line for each time of the grid, `t quantity states…`.
pub fn table(anchor: &Anchor, text: &str) -> Result<Answer, AnswerError> {
    let refuse = |line: usize, found: &str, expected: String| AnswerError::Table {
        line,
        found: found.chars().take(60).collect(),
        expected,
    };
    let mut values = Vec::new();
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    if lines.len() != anchor.grid.len() {
        let expected = format!("one for each of the {} times", anchor.grid.len());
        return Err(refuse(lines.len(), &format!("{} lines", lines.len()), expected));
    }
    let end = anchor.task.span.1;
    for (i, (line, due)) in lines.iter().zip(&anchor.grid).enumerate() {
        let mut numbers = line.split_ascii_whitespace().map(str::parse::<f64>);
        match (numbers.next(), numbers.next()) {
            (Some(Ok(t)), Some(Ok(value)))
                if (t - due).abs() <= 1e-12 * end && value.is_finite() =>
            {
                values.push(value);
            }
            _ => return Err(refuse(i + 1, line, format!("the time {due} and a quantity"))),
        }
    }
    Ok(Answer { values, error: None, way: "read from a table".to_owned() })
}
