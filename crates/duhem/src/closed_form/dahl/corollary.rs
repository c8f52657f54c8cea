//! Corollary 1 (p. 93): the loop of γ = 1 in the paper's own words.

use crate::Dahl;

/// The left side of equation 9 for γ = 1 and a loop of the width `beta` [m]; it converges if it is < 1.
///
/// exp(−2βσ/F_C) < 1   (16)
pub fn contraction(dahl: &Dahl, beta: f64) -> f64 {
    (-2.0 * beta * dahl.sigma / dahl.f_c).exp()
}

/// The force at the left turning point [N].
///
/// α₊ = −α₋ = F_C (e^(−βσ/F_C) − 1)/(e^(−βσ/F_C) + 1), of equation 17.
pub fn alpha_plus(dahl: &Dahl, beta: f64) -> f64 {
    let e = -beta * dahl.sigma / dahl.f_c;
    dahl.f_c * e.exp_m1() / (e.exp() + 1.0)
}

/// F₊(u) = e^(−(σ/F_C)(u−u_min)) α₊ + F_C (1 − e^(−(σ/F_C)(u−u_min)))   (17)
pub fn rising(dahl: &Dahl, (u_min, u_max): (f64, f64), u: f64) -> f64 {
    let e = (-dahl.sigma / dahl.f_c * (u - u_min)).exp();
    e * alpha_plus(dahl, u_max - u_min) + dahl.f_c * (1.0 - e)
}

/// F₋(u) = e^((σ/F_C)(u−u_max)) α₋ − F_C (1 − e^((σ/F_C)(u−u_max))), of equation 17.
///
/// *Printed* e^(−(σ/F_C)(u−u_max)) in the bracket. *Read as* e^((σ/F_C)(u−u_max)), *because* only then
/// does F₋ solve equation 11 for u̇ < 0 and end at α₊.
pub fn falling(dahl: &Dahl, (u_min, u_max): (f64, f64), u: f64) -> f64 {
    let e = (dahl.sigma / dahl.f_c * (u - u_max)).exp();
    -e * alpha_plus(dahl, u_max - u_min) - dahl.f_c * (1.0 - e)
}

/// F₋ of equation 17 to the letter, with the sign that is wrong.
pub fn falling_as_printed(dahl: &Dahl, (u_min, u_max): (f64, f64), u: f64) -> f64 {
    let e = (dahl.sigma / dahl.f_c * (u - u_max)).exp();
    -e * alpha_plus(dahl, u_max - u_min) - dahl.f_c * (1.0 - 1.0 / e)
}
