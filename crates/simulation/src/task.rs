//! What is to be solved, by names and numbers: a method of our own builds what it needs from it.

use crate::{DrivenPlant, Motion, PrescribedMotion};
use duhem::{FrictionModel, Input, ModelEntry, ParameterError, Parameters, Plant};

/// A friction model under an imposed motion or on a driven plant, from an initial state, over a span.
///
/// [`Self::motion`] is the same as a right-hand side, for a solver that knows nothing of friction.
#[derive(Debug, Clone)]
pub struct Task {
    /// The friction model.
    pub model: &'static ModelEntry,
    /// Its parameters.
    pub parameters: Parameters,
    /// The plant; none if the displacement is imposed.
    pub plant: Option<Plant>,
    /// The imposed displacement [m], or what drives the plant [N] or [A].
    pub input: Input,
    /// The state at the start: x₁ … x_n, on a plant q, v, x₁ … x_n.
    pub y0: Vec<f64>,
    /// First and last time [s].
    pub span: (f64, f64),
}

impl Task {
    /// The friction model.
    pub fn friction(&self) -> Result<Box<dyn FrictionModel>, ParameterError> {
        (self.model.build)(&self.parameters)
    }

    /// The right-hand side of it.
    pub fn motion(&self) -> Result<Box<dyn Motion>, ParameterError> {
        let (model, input) = (self.friction()?, self.input.clone());
        Ok(match self.plant {
            Some(plant) => Box::new(DrivenPlant::new(model, plant, input, self.span)),
            None => Box::new(PrescribedMotion::new(model, input, self.span)),
        })
    }
}
