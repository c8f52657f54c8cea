//! Coulomb friction, the static model of Figure 2a and of the first row of Table 1.

use super::FrictionModel;
use crate::{DuhemForm, ParameterError, Parameters, sgn};

/// Coulomb friction: a force of constant size against the motion, without a state.
#[derive(Debug, Clone, PartialEq)]
pub struct Coulomb {
    /// Coulomb force F_C [N].
    pub f_c: f64,
}

impl Coulomb {
    /// The keys of its parameters.
    pub const KEYS: &[&str] = &["f_c"];

    /// The model with these parameters.
    pub fn new(parameters: &Parameters) -> Result<Self, ParameterError> {
        parameters.only(Self::KEYS)?;
        Ok(Self { f_c: parameters.positive("f_c", "force [N]")? })
    }
}

impl FrictionModel for Coulomb {
    fn states(&self) -> usize {
        0
    }

    fn x_dot(&self, _x: &[f64], _u: f64, _u_dot: f64, _x_dot: &mut [f64]) {}

    /// F = F_C sgn u̇, unnumbered in the paper; zero at rest.
    fn force(&self, _x: &[f64], _x_dot: &[f64], _u: f64, u_dot: f64) -> f64 {
        self.f_c * sgn(u_dot)
    }

    fn jacobian(&self, _x: &[f64], _u: f64, _u_dot: f64, _jacobian: &mut [f64]) {}

    fn scale(&self) -> Vec<f64> {
        Vec::new()
    }

    fn form(&self) -> Option<&dyn DuhemForm> {
        Some(self)
    }
}
