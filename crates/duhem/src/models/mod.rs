//! The friction models and the list of them.

mod coulomb;
mod dahl;
mod lugre;
mod maxwell_slip;

pub use coulomb::Coulomb;
pub use dahl::Dahl;
pub use lugre::LuGre;
pub use maxwell_slip::{MaxwellSlip, step};

use crate::{Differentiable, DuhemForm, ParameterError, Parameters};

/// A model of friction between two surfaces in relative motion u.
///
/// Matrices are slices in row-major order. All functions are defined for every finite argument, also
/// outside the states the exact solution visits, because solvers go there.
pub trait FrictionModel: Differentiable + std::fmt::Debug + Send + Sync {
    /// The number n of internal states.
    fn states(&self) -> usize;

    /// Writes ẋ for the state `x`, the displacement `u` [m] and the velocity `u_dot` [m/s].
    fn x_dot(&self, x: &[f64], u: f64, u_dot: f64, x_dot: &mut [f64]);

    /// The friction force F [N], positive when it opposes u̇ > 0; `x_dot` as [`Self::x_dot`] wrote it.
    fn force(&self, x: &[f64], x_dot: &[f64], u: f64, u_dot: f64) -> f64;

    /// Writes ∂ẋᵢ/∂xⱼ, n × n. It is finite always; at a kink it is what the model's file says.
    fn jacobian(&self, x: &[f64], u: f64, u_dot: f64, jacobian: &mut [f64]);

    /// The natural size of each state.
    fn scale(&self) -> Vec<f64>;

    /// The model as a Duhem model; every model of [`MODELS`] is one.
    fn form(&self) -> Option<&dyn DuhemForm> {
        None
    }
}

/// One friction model of the list.
#[derive(Debug, Clone, Copy)]
pub struct ModelEntry {
    /// Its name in the experiments.
    pub name: &'static str,
    /// The keys of its parameters.
    pub keys: &'static [&'static str],
    /// Their units, in the same order; empty for a pure number.
    pub units: &'static [&'static str],
    /// Builds the model from its parameters.
    pub build: fn(&Parameters) -> Result<Box<dyn FrictionModel>, ParameterError>,
}

/// The friction models.
pub const MODELS: &[ModelEntry] = &[
    ModelEntry {
        name: "coulomb",
        keys: Coulomb::KEYS,
        units: &["N"],
        build: |p| boxed(Coulomb::new(p)),
    },
    ModelEntry {
        name: "dahl",
        keys: Dahl::KEYS,
        units: &["N", "N/m", ""],
        build: |p| boxed(Dahl::new(p)),
    },
    ModelEntry {
        name: "lugre",
        keys: LuGre::KEYS,
        units: &["N", "N", "m/s", "N/m", "N·s/m", "N·s/m"],
        build: |p| boxed(LuGre::new(p)),
    },
    ModelEntry {
        name: "maxwell-slip",
        keys: MaxwellSlip::KEYS,
        units: &["N/m", "m"],
        build: |p| boxed(MaxwellSlip::new(p)),
    },
];

fn boxed<M: FrictionModel + 'static>(
    model: Result<M, ParameterError>,
) -> Result<Box<dyn FrictionModel>, ParameterError> {
    Ok(Box::new(model?))
}
