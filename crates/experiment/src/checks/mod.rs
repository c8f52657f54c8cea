//! Sentences that can be checked: one entry for each kind of sentence.

mod dahl;
mod discovery;
mod energy;
mod fit;
mod lugre;
mod maxwell_slip;
mod plant;
mod table1;

use crate::plan::{Plan, Subject};

/// What a check found.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    /// Whether the sentence holds.
    pub holds: bool,
    /// The number that shows it.
    pub value: Option<f64>,
    /// A bound of its error.
    pub error: Option<f64>,
    /// Its unit; `1` for none.
    pub unit: &'static str,
    /// What was computed and within which tolerance.
    pub how: String,
}

/// One kind of sentence.
#[derive(Debug)]
pub struct Check {
    /// Its name in the TOML.
    pub name: &'static str,
    /// Where the code is.
    pub code: &'static str,
    /// The model it is made for; empty for any.
    pub model: &'static str,
    /// What it can be told to expect; empty if it needs no telling.
    pub expects: &'static [&'static str],
    /// The numbers it takes from the TOML, besides values of the sweep.
    pub takes: &'static [&'static str],
    /// Whether it looks at several points of a sweep, or at one.
    pub many: bool,
    /// Looks whether it holds.
    pub run: fn(&Plan, &Subject) -> Result<Checked, String>,
}

/// An error as a check's complaint.
#[expect(clippy::needless_pass_by_value, reason = "it is what `map_err` hands over")]
fn fails(error: impl ToString) -> String {
    error.to_string()
}

/// All checks.
pub const CHECKS: &[Check] = &[
    dahl::COROLLARY_1,
    dahl::LOCAL_MEMORY,
    dahl::FRICTION_LAG,
    dahl::EQUATION_14,
    dahl::FINITE_SATURATION,
    energy::ORIENTATION,
    plant::SETTLES_AT_F_C,
    plant::COMES_TO_REST,
    plant::STAIRCASE,
    plant::EXCEEDS_F_S,
    plant::SAME_SLIP,
    plant::TOGETHER,
    plant::WITHIN_AXES,
    plant::PRESTRESSED,
    plant::EQUIVALENT,
    plant::RESTS,
    lugre::IS_DAHL,
    lugre::LOOP_CHANGES,
    lugre::SLOW_ENOUGH,
    lugre::STRIBECK,
    lugre::LOCAL_MEMORY,
    lugre::SLIDING,
    lugre::DISSIPATES,
    maxwell_slip::IS_DAHL,
    maxwell_slip::PRESLIDING,
    maxwell_slip::NONLOCAL,
    maxwell_slip::ENERGY,
    maxwell_slip::RETURNED,
    maxwell_slip::LAG,
    maxwell_slip::MIRROR,
    maxwell_slip::OVERSHOOT,
    maxwell_slip::RETURN_POINT,
    maxwell_slip::WIPING_OUT,
    table1::DUHEM_TYPE,
    table1::RATE,
    table1::CONTINUITY,
    fit::BEST_MODEL,
    discovery::ANSWER,
    discovery::CLOSES,
];
