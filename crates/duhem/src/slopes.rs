//! The partial derivatives of the friction models, of which the Jacobian of a plant is made.

use crate::{
    Coulomb, Dahl, LuGre, MaxwellSlip,
    form::{negative_part, positive_part},
    models::step,
    sgn,
};

/// What ẋ(x, u, u̇) and F(x, ẋ, u, u̇) change by when one of their arguments does; ∂ẋ/∂x is
/// [`crate::FrictionModel::jacobian`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Slopes {
    /// ∂ẋᵢ/∂u.
    pub x_dot_by_u: Vec<f64>,
    /// ∂ẋᵢ/∂u̇.
    pub x_dot_by_u_dot: Vec<f64>,
    /// ∂F/∂xⱼ at constant ẋ.
    pub force_by_x: Vec<f64>,
    /// ∂F/∂ẋⱼ.
    pub force_by_x_dot: Vec<f64>,
    /// ∂F/∂u [N/m].
    pub force_by_u: f64,
    /// ∂F/∂u̇ [N·s/m].
    pub force_by_u_dot: f64,
}

impl Slopes {
    /// Room for a model of `n` states, all zero.
    pub fn new(n: usize) -> Self {
        let zero = vec![0.0; n];
        Self {
            x_dot_by_u: zero.clone(),
            x_dot_by_u_dot: zero.clone(),
            force_by_x: zero.clone(),
            force_by_x_dot: zero,
            ..Self::default()
        }
    }
}

/// A model whose partial derivatives are known.
pub trait Differentiable {
    /// Writes all of `slopes`, which has room for the model's states. They are finite always; at u̇ = 0
    /// they are the mean of the two sides, and where ẋ or F jumps those beside the jump.
    fn slopes(&self, x: &[f64], u: f64, u_dot: f64, slopes: &mut Slopes);

    /// The speed over which the friction changes by itself [m/s]; none if the model has no such scale.
    fn natural_speed(&self) -> Option<f64> {
        None
    }
}

impl Differentiable for Coulomb {
    fn slopes(&self, _x: &[f64], _u: f64, _u_dot: f64, slopes: &mut Slopes) {
        *slopes = Slopes::new(0);
    }
}

impl Differentiable for Dahl {
    fn slopes(&self, x: &[f64], _u: f64, u_dot: f64, slopes: &mut Slopes) {
        let direction = sgn(u_dot);
        slopes.x_dot_by_u[0] = 0.0;
        slopes.x_dot_by_u_dot[0] = match direction {
            d if d > 0.0 => self.d_plus(x[0]),
            d if d < 0.0 => self.d_minus(x[0]),
            _ => 0.5 * (self.d_plus(x[0]) + self.d_minus(x[0])),
        };
        slopes.force_by_x[0] = 1.0;
        slopes.force_by_x_dot[0] = 0.0;
        (slopes.force_by_u, slopes.force_by_u_dot) = (0.0, 0.0);
    }
}

impl Differentiable for LuGre {
    /// With r' = dr/du̇ of equation 20, ∂ẋ/∂u̇ is 1 − (sgn u̇ − |u̇| r'/r) x/r.
    fn slopes(&self, x: &[f64], _u: f64, u_dot: f64, slopes: &mut Slopes) {
        let r = self.r(u_dot);
        // r falls to F_C/σ₀ with the Stribeck term, whose slope is −2u̇/v_S² times itself.
        let r_slope = -2.0 * u_dot / (self.v_s * self.v_s) * (r - self.f_c / self.sigma_0);
        slopes.x_dot_by_u[0] = 0.0;
        slopes.x_dot_by_u_dot[0] = 1.0 - (sgn(u_dot) - u_dot.abs() * r_slope / r) * x[0] / r;
        slopes.force_by_x[0] = self.sigma_0;
        slopes.force_by_x_dot[0] = self.sigma_1;
        (slopes.force_by_u, slopes.force_by_u_dot) = (0.0, self.sigma_2);
    }

    fn natural_speed(&self) -> Option<f64> {
        Some(self.v_s)
    }
}

impl Differentiable for MaxwellSlip {
    fn slopes(&self, x: &[f64], u: f64, u_dot: f64, slopes: &mut Slopes) {
        // The share of each direction: one and none in motion, half and half at rest.
        let up = positive_part(sgn(u_dot)) + 0.5 * (1.0 - sgn(u_dot).abs());
        let down = -negative_part(sgn(u_dot)) + 0.5 * (1.0 - sgn(u_dot).abs());
        for (i, (x, delta)) in x.iter().zip(&self.delta).enumerate() {
            slopes.x_dot_by_u[i] = 0.0;
            slopes.x_dot_by_u_dot[i] = step(-x + u - delta) * up + step(x - u - delta) * down;
            slopes.force_by_x[i] = -self.k[i];
            slopes.force_by_x_dot[i] = 0.0;
        }
        (slopes.force_by_u, slopes.force_by_u_dot) = (self.k.iter().sum(), 0.0);
    }
}
