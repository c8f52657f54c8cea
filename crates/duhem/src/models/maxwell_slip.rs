//! The Maxwell-slip model, equations 24 to 26 (pp. 94–95).

use super::FrictionModel;
use crate::{
    DuhemForm, ParameterError, Parameters,
    form::{negative_part, positive_part},
};

/// The Maxwell-slip model: N massless elements in parallel, the states are their positions xᵢ [m].
///
/// Element i slips in the direction of u̇ when its spring is deflected by Δᵢ in that direction, and
/// sticks otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct MaxwellSlip {
    /// Stiffnesses k_i [N/m].
    pub k: Vec<f64>,
    /// Deadbands Δ_i [m].
    pub delta: Vec<f64>,
}

impl MaxwellSlip {
    /// The keys of its parameters.
    pub const KEYS: &[&str] = &["k", "delta"];

    /// The model with these parameters.
    pub fn new(parameters: &Parameters) -> Result<Self, ParameterError> {
        parameters.only(Self::KEYS)?;
        let k = parameters.positives("k", "stiffnesses [N/m]")?;
        let delta = parameters.positives("delta", "deadbands [m]")?;
        if k.len() != delta.len() {
            let (found, n) = (format!("{delta:?}"), k.len());
            let expected = format!("one deadband [m] for each of the {n} stiffnesses in k");
            return Err(ParameterError::Invalid { key: "delta".to_owned(), found, expected });
        }
        Ok(Self { k, delta })
    }
}

/// U(v) = 1 for v ≥ 0, 0 for v < 0   (26)
pub fn step(v: f64) -> f64 {
    if v >= 0.0 { 1.0 } else { 0.0 }
}

impl FrictionModel for MaxwellSlip {
    fn states(&self) -> usize {
        self.k.len()
    }

    /// *Printed* 1 − U(−xᵢ + u + Δᵢ) for the way down. *Read as* U(xᵢ − u − Δᵢ), *because* the two
    /// differ at a deflection of exactly −Δᵢ only, where the print sticks while its mirror image slips.
    ///
    /// ẋᵢ = U(−xᵢ + u − Δᵢ) u̇₊ + (1 − U(−xᵢ + u + Δᵢ)) u̇₋   (24)
    fn x_dot(&self, x: &[f64], u: f64, u_dot: f64, x_dot: &mut [f64]) {
        let (up, down) = (positive_part(u_dot), negative_part(u_dot));
        for ((x_dot, x), delta) in x_dot.iter_mut().zip(x).zip(&self.delta) {
            *x_dot = step(-x + u - delta) * up + step(x - u - delta) * down;
        }
    }

    /// F = Σ kᵢ(u − xᵢ)   (25)
    fn force(&self, x: &[f64], _x_dot: &[f64], u: f64, _u_dot: f64) -> f64 {
        self.k.iter().zip(x).map(|(k, x)| k * (u - x)).sum()
    }

    /// Zero: ẋ is piecewise constant in x, and at the steps it is taken to be zero too.
    fn jacobian(&self, _x: &[f64], _u: f64, _u_dot: f64, jacobian: &mut [f64]) {
        jacobian.fill(0.0);
    }

    fn scale(&self) -> Vec<f64> {
        self.delta.clone()
    }

    fn form(&self) -> Option<&dyn DuhemForm> {
        Some(self)
    }
}
