//! The Duhem model, equations 1 to 5 and 8 (pp. 91–92).

mod of_models;

use crate::FrictionModel;

/// The kinds of Duhem model in Table 1 (p. 92).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DuhemType {
    /// Without a state.
    Static,
    /// f is any function of x and u.
    Generalized,
    /// f is affine in x and u, equation 6.
    Semilinear,
}

/// The smoothness column of Table 1 (p. 92).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Continuity {
    /// f, or the output of a model without a state, jumps.
    Discontinuous,
    /// f is continuous in x, with an infinite slope somewhere.
    NotLipschitz,
    /// f is Lipschitz in x on bounded sets.
    Lipschitz,
}

/// A friction model as the product ẋ = f(x, u) g(u̇) of an n × r matrix and a vector of r.
pub trait DuhemForm: FrictionModel {
    /// The number r of columns of f.
    fn columns(&self) -> usize;

    /// Writes f(x, u), n × r, row by row.
    fn f(&self, x: &[f64], u: f64, f: &mut [f64]);

    /// Writes g(u̇), r numbers; g(0) = 0.
    fn g(&self, u_dot: f64, g: &mut [f64]);

    /// The output. The paper's h has x and u only; equation 23 needs ẋ and u̇ as well.
    ///
    /// y = h(x, u)   (2)
    fn h(&self, x: &[f64], x_dot: &[f64], u: f64, u_dot: f64) -> f64 {
        self.force(x, x_dot, u, u_dot)
    }

    /// h₊ and h₋ of equation 3 if g is positively homogeneous, and nothing if it is not.
    fn directions(&self) -> Option<(Vec<f64>, Vec<f64>)>;

    /// The model's type in Table 1.
    fn duhem_type(&self) -> DuhemType;

    /// The model's smoothness in Table 1.
    fn continuity(&self) -> Continuity;

    /// Whether stretching time stretches the response and nothing else: Proposition 1 (p. 92).
    fn rate_independent(&self) -> bool {
        self.directions().is_some()
    }
}

/// ẋ = f(x, u) g(u̇)   (1)
pub fn x_dot(form: &dyn DuhemForm, x: &[f64], u: f64, u_dot: f64) -> Vec<f64> {
    let mut g = vec![0.0; form.columns()];
    form.g(u_dot, &mut g);
    times(form, x, u, &g)
}

/// g(v) = h₊v for v ≥ 0, h₋v for v < 0   (3)
pub fn homogeneous_g(form: &dyn DuhemForm, v: f64) -> Option<Vec<f64>> {
    let (plus, minus) = form.directions()?;
    let h = if v >= 0.0 { plus } else { minus };
    Some(h.iter().map(|h| h * v).collect())
}

/// Nothing if the model is rate dependent; `rising` says that u increases.
///
/// dx/du = f₊(x, u) when u increases, f₋(x, u) when u decreases, f± = f h±   (4)
pub fn dx_du(form: &dyn DuhemForm, x: &[f64], u: f64, rising: bool) -> Option<Vec<f64>> {
    let (plus, minus) = form.directions()?;
    Some(times(form, x, u, if rising { &plus } else { &minus }))
}

/// The output over the displacement, taken at unit speed: every speed gives the same.
///
/// y(u) = h(x(u), u)   (5)
pub fn y(form: &dyn DuhemForm, x: &[f64], u: f64, rising: bool) -> Option<f64> {
    let slope = dx_du(form, x, u, rising)?;
    let u_dot = if rising { 1.0 } else { -1.0 };
    let x_dot: Vec<f64> = slope.iter().map(|slope| slope * u_dot).collect();
    Some(form.h(x, &x_dot, u, u_dot))
}

/// u̇₊ = max(0, u̇), u̇₋ = min(0, u̇)   (8)
pub fn positive_part(u_dot: f64) -> f64 {
    u_dot.max(0.0)
}

/// u̇₋ = min(0, u̇), the other half of equation 8.
pub fn negative_part(u_dot: f64) -> f64 {
    u_dot.min(0.0)
}

fn times(form: &dyn DuhemForm, x: &[f64], u: f64, g: &[f64]) -> Vec<f64> {
    let (n, r) = (form.states(), form.columns());
    let mut f = vec![0.0; n * r];
    form.f(x, u, &mut f);
    (0..n).map(|i| (0..r).map(|j| f[i * r + j] * g[j]).sum()).collect()
}
