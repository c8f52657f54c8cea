//! The LuGre model, equations 18 to 21 (pp. 93–94).

use super::FrictionModel;
use crate::{DuhemForm, ParameterError, Parameters, sgn};

/// The LuGre model: the state is the mean deflection x of the bristles [m].
#[derive(Debug, Clone, PartialEq)]
pub struct LuGre {
    /// Coulomb force F_C [N].
    pub f_c: f64,
    /// Stiction force F_S [N].
    pub f_s: f64,
    /// Stribeck velocity v_S [m/s].
    pub v_s: f64,
    /// Bristle stiffness σ₀ [N/m].
    pub sigma_0: f64,
    /// Bristle damping σ₁ [N·s/m].
    pub sigma_1: f64,
    /// Viscous coefficient σ₂ [N·s/m].
    pub sigma_2: f64,
}

impl LuGre {
    /// The keys of its parameters.
    pub const KEYS: &[&str] = &["f_c", "f_s", "v_s", "sigma_0", "sigma_1", "sigma_2"];

    /// The model with these parameters.
    pub fn new(p: &Parameters) -> Result<Self, ParameterError> {
        p.only(Self::KEYS)?;
        Ok(Self {
            f_c: p.positive("f_c", "force [N]")?,
            f_s: p.positive("f_s", "force [N]")?,
            v_s: p.positive("v_s", "velocity [m/s]")?,
            sigma_0: p.positive("sigma_0", "stiffness [N/m]")?,
            sigma_1: p.not_negative("sigma_1", "damping [N·s/m]")?,
            sigma_2: p.not_negative("sigma_2", "damping [N·s/m]")?,
        })
    }

    /// r(u̇) = F_C/σ₀ + (F_S − F_C)/σ₀ · exp(−(u̇/v_S)²)   (20)
    pub fn r(&self, u_dot: f64) -> f64 {
        let s = u_dot / self.v_s;
        self.f_c / self.sigma_0 + (self.f_s - self.f_c) / self.sigma_0 * (-s * s).exp()
    }

    /// Fₛₛ(u̇) = σ₀ r(u̇) sgn u̇ + σ₂u̇   (21)
    pub fn steady_force(&self, u_dot: f64) -> f64 {
        self.sigma_0 * self.r(u_dot) * sgn(u_dot) + self.sigma_2 * u_dot
    }
}

impl FrictionModel for LuGre {
    fn states(&self) -> usize {
        1
    }

    /// ẋ = u̇ − |u̇|/r(u̇) · x   (18)
    fn x_dot(&self, x: &[f64], _u: f64, u_dot: f64, x_dot: &mut [f64]) {
        x_dot[0] = u_dot - u_dot.abs() / self.r(u_dot) * x[0];
    }

    /// F = σ₀x + σ₁ẋ + σ₂u̇   (19)
    fn force(&self, x: &[f64], x_dot: &[f64], _u: f64, u_dot: f64) -> f64 {
        self.sigma_0 * x[0] + self.sigma_1 * x_dot[0] + self.sigma_2 * u_dot
    }

    fn jacobian(&self, _x: &[f64], _u: f64, u_dot: f64, jacobian: &mut [f64]) {
        jacobian[0] = -u_dot.abs() / self.r(u_dot);
    }

    fn scale(&self) -> Vec<f64> {
        vec![self.f_s.max(self.f_c) / self.sigma_0]
    }

    fn form(&self) -> Option<&dyn DuhemForm> {
        Some(self)
    }
}
