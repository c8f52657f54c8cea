//! Duhem models of friction: the models of the paper, the inputs that drive them, the plants they act
//! on, their closed forms and the measures of hysteresis.
//!
//! The paper is Padthe, Drincic, Oh, Rizos, Fassois and Bernstein, "Duhem Modeling of Friction-Induced
//! Hysteresis", IEEE Control Systems Magazine 28, no. 5, 2008. An equation stands directly above the
//! function that is it and ends with its number in brackets, so a search for the number in brackets
//! finds the function. Where the print does not hold the text there says *Printed … Read as … because …*.
//!
//! **Invariant.** This crate knows no solvers, no files, no plots and no clocks: everything in it is a
//! function of its arguments.
//!
//! ```
//! use duhem::{Dahl, Input, closed_form::dahl};
//!
//! // Figure 1 with γ = 1: the paper says that the loop encloses 2.6 J.
//! let model = Dahl { f_c: 0.75, sigma: 1.5, gamma: 1.0 };
//! let input = Input::sine(1.0, 0.1)?;
//! let settled = dahl::Loop::new(&model, input.range());
//! assert!((settled.area() - (3.0 - 1.5 * 2.0_f64.tanh())).abs() < 1e-14); // 1.554 J
//! # Ok::<(), duhem::InputError>(())
//! ```
//!
//! Read first: [`FrictionModel`], what a model of friction is; [`Input`], what drives it;
//! [`closed_form::Reference`], what it answers exactly.

pub mod closed_form;
pub mod elementary;
pub mod form;
pub mod input;
pub mod measures;
pub mod models;
mod parameters;
pub mod plant;
pub mod slopes;

pub use form::{Continuity, DuhemForm, DuhemType};
pub use input::{Harmonic, Input, InputError};
pub use models::{Coulomb, Dahl, FrictionModel, LuGre, MODELS, MaxwellSlip, ModelEntry};
pub use parameters::{Parameter, ParameterError, Parameters};
pub use plant::{PLANTS, Plant, PlantEntry, Rig};
pub use slopes::{Differentiable, Slopes};

/// The paper's sign: sgn 0 = 0, where `f64::signum` gives ±1. Not a number stays not a number.
pub fn sgn(v: f64) -> f64 {
    if v > 0.0 {
        1.0
    } else if v < 0.0 {
        -1.0
    } else {
        v.abs()
    }
}
