//! The friction models as Duhem models: the recasts of the paper and the rows of Table 1.

use super::{Continuity, DuhemForm, DuhemType, negative_part, positive_part};
use crate::{Coulomb, Dahl, LuGre, MaxwellSlip, models::step};

/// g = [u̇₊ u̇₋]ᵀ, so h₊ = [1 0]ᵀ and h₋ = [0 1]ᵀ.
fn split(u_dot: f64, g: &mut [f64]) {
    g[0] = positive_part(u_dot);
    g[1] = negative_part(u_dot);
}

#[expect(clippy::unnecessary_wraps, reason = "the value a rate-independent model gives")]
fn split_directions() -> Option<(Vec<f64>, Vec<f64>)> {
    Some((vec![1.0, 0.0], vec![0.0, 1.0]))
}

impl DuhemForm for Coulomb {
    fn columns(&self) -> usize {
        0
    }

    fn f(&self, _x: &[f64], _u: f64, _f: &mut [f64]) {}

    fn g(&self, _u_dot: f64, _g: &mut [f64]) {}

    fn directions(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        Some((Vec::new(), Vec::new()))
    }

    fn continuity(&self) -> Continuity {
        Continuity::Discontinuous
    }

    fn duhem_type(&self) -> DuhemType {
        DuhemType::Static
    }
}

impl Dahl {
    /// Equation 14 to the letter, σ times its right-hand side: σ times too large.
    pub fn x_dot_as_printed(&self, force: f64, u_dot: f64) -> f64 {
        let row =
            self.d_plus(force) * positive_part(u_dot) + self.d_minus(force) * negative_part(u_dot);
        self.sigma * row
    }
}

impl DuhemForm for Dahl {
    fn columns(&self) -> usize {
        2
    }

    /// *Printed* Ḟ = σ [D₊(F) D₋(F)] [u̇₊; u̇₋]. *Read as* the same without σ, *because* D₊ and D₋
    /// contain it already and only then is this equation 11.
    ///
    /// Ḟ = [D₊(F) D₋(F)] [u̇₊; u̇₋]   (14)
    fn f(&self, x: &[f64], _u: f64, f: &mut [f64]) {
        f[0] = self.d_plus(x[0]);
        f[1] = self.d_minus(x[0]);
    }

    fn g(&self, u_dot: f64, g: &mut [f64]) {
        split(u_dot, g);
    }

    fn directions(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        split_directions()
    }

    fn continuity(&self) -> Continuity {
        match self.gamma {
            0.0 => Continuity::Discontinuous,
            gamma if gamma < 1.0 => Continuity::NotLipschitz,
            _ => Continuity::Lipschitz,
        }
    }

    fn duhem_type(&self) -> DuhemType {
        if self.gamma == 1.0 { DuhemType::Semilinear } else { DuhemType::Generalized }
    }
}

impl DuhemForm for LuGre {
    fn columns(&self) -> usize {
        2
    }

    /// ẋ = [1 x] [u̇; −|u̇|/r(u̇)]   (22)
    fn f(&self, x: &[f64], _u: f64, f: &mut [f64]) {
        f[0] = 1.0;
        f[1] = x[0];
    }

    fn g(&self, u_dot: f64, g: &mut [f64]) {
        g[0] = u_dot;
        g[1] = -u_dot.abs() / self.r(u_dot);
    }

    /// y = σ₀x + σ₁ẋ + σ₂u̇   (23)
    fn h(&self, x: &[f64], x_dot: &[f64], _u: f64, u_dot: f64) -> f64 {
        self.sigma_0 * x[0] + self.sigma_1 * x_dot[0] + self.sigma_2 * u_dot
    }

    /// None: r is not homogeneous. It is if F_S = F_C, but then y is not, unless σ₁ = σ₂ = 0.
    fn directions(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        let is_dahl = self.f_s == self.f_c && self.sigma_1 == 0.0 && self.sigma_2 == 0.0;
        let r = self.f_c / self.sigma_0;
        is_dahl.then(|| (vec![1.0, -1.0 / r], vec![1.0, 1.0 / r]))
    }

    fn continuity(&self) -> Continuity {
        Continuity::Lipschitz
    }

    fn duhem_type(&self) -> DuhemType {
        DuhemType::Generalized
    }
}

impl DuhemForm for MaxwellSlip {
    fn columns(&self) -> usize {
        2
    }

    /// Row i is [U(−xᵢ + u − Δᵢ)  U(xᵢ − u − Δᵢ)], equation 24 as read.
    fn f(&self, x: &[f64], u: f64, f: &mut [f64]) {
        for ((row, x), delta) in f.chunks_exact_mut(2).zip(x).zip(&self.delta) {
            row[0] = step(-x + u - delta);
            row[1] = step(x - u - delta);
        }
    }

    fn g(&self, u_dot: f64, g: &mut [f64]) {
        split(u_dot, g);
    }

    fn directions(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        split_directions()
    }

    fn continuity(&self) -> Continuity {
        Continuity::Discontinuous
    }

    fn duhem_type(&self) -> DuhemType {
        DuhemType::Generalized
    }
}

impl MaxwellSlip {
    /// Equation 24 to the letter: like ẋ, except that at a deflection of exactly −Δᵢ the element
    /// sticks on the way down, while at +Δᵢ it slips on the way up.
    pub fn x_dot_as_printed(&self, x: &[f64], u: f64, u_dot: f64, x_dot: &mut [f64]) {
        let (up, down) = (positive_part(u_dot), negative_part(u_dot));
        for ((x_dot, x), delta) in x_dot.iter_mut().zip(x).zip(&self.delta) {
            *x_dot = step(-x + u - delta) * up + (1.0 - step(-x + u + delta)) * down;
        }
    }
}
