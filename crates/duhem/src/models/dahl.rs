//! The Dahl model, equations 11 to 15 (pp. 92–93).

use super::FrictionModel;
use crate::{DuhemForm, ParameterError, Parameters, sgn};

/// The Dahl model: the force itself is the state. γ shapes the approach to F_C.
///
/// |w|^γ is 1 for γ = 0 also at w = 0, and sgn 0 = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Dahl {
    /// Coulomb force F_C [N].
    pub f_c: f64,
    /// Rest stiffness σ, the slope of F(u) at F = 0 [N/m].
    pub sigma: f64,
    /// Shape γ ≥ 0 [1].
    pub gamma: f64,
}

impl Dahl {
    /// The keys of its parameters.
    pub const KEYS: &[&str] = &["f_c", "sigma", "gamma"];

    /// The model with these parameters.
    pub fn new(parameters: &Parameters) -> Result<Self, ParameterError> {
        parameters.only(Self::KEYS)?;
        Ok(Self {
            f_c: parameters.positive("f_c", "force [N]")?,
            sigma: parameters.positive("sigma", "stiffness [N/m]")?,
            gamma: parameters.not_negative("gamma", "exponent [1]")?,
        })
    }

    /// D₊(F) = σ |1 − F/F_C|^γ sgn(1 − F/F_C)   (12)
    pub fn d_plus(&self, force: f64) -> f64 {
        let w = 1.0 - force / self.f_c;
        self.sigma * w.abs().powf(self.gamma) * sgn(w)
    }

    /// D₋(F) = σ |1 + F/F_C|^γ sgn(1 + F/F_C)   (13)
    pub fn d_minus(&self, force: f64) -> f64 {
        let w = 1.0 + force / self.f_c;
        self.sigma * w.abs().powf(self.gamma) * sgn(w)
    }
}

impl FrictionModel for Dahl {
    fn states(&self) -> usize {
        1
    }

    /// Ḟ = σ |1 − (F/F_C) sgn u̇|^γ sgn(1 − (F/F_C) sgn u̇) u̇   (11)
    fn x_dot(&self, x: &[f64], _u: f64, u_dot: f64, x_dot: &mut [f64]) {
        let w = 1.0 - x[0] / self.f_c * sgn(u_dot);
        x_dot[0] = self.sigma * w.abs().powf(self.gamma) * sgn(w) * u_dot;
    }

    /// y = F   (15)
    fn force(&self, x: &[f64], _x_dot: &[f64], _u: f64, _u_dot: f64) -> f64 {
        x[0]
    }

    /// −(σγ/F_C) |w|^(γ−1) |u̇| with w = 1 − (F/F_C) sgn u̇; 0 at the kink w = 0 of γ < 1.
    fn jacobian(&self, x: &[f64], _u: f64, u_dot: f64, jacobian: &mut [f64]) {
        let w = 1.0 - x[0] / self.f_c * sgn(u_dot);
        let kink = self.gamma < 1.0 && w == 0.0;
        let slope = if kink { 0.0 } else { self.gamma * w.abs().powf(self.gamma - 1.0) };
        jacobian[0] = -self.sigma / self.f_c * slope * u_dot.abs();
    }

    fn scale(&self) -> Vec<f64> {
        vec![self.f_c]
    }

    fn form(&self) -> Option<&dyn DuhemForm> {
        Some(self)
    }
}
