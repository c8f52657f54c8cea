//! An experiment from its TOML to its tables: read, checked, run, compared with the exact answer, judged.
//!
//! **Invariant**: draws nothing, prints nothing and knows no synthetic rig; a case that fails is a row and
//! never an error.
//!
//! Read first: [`spec::Spec`] (the TOML as written), [`Plan`] (as checked, with every case), [`run()`] (the
//! cases, run or found in the store).

pub mod checks;
mod compare;
mod curves;
mod discoveries;
mod drift;
mod error;
mod fits;
mod judge;
mod orders;
mod own;
mod plan;
pub mod quantities;
mod run;
mod solved;
pub mod spec;
mod summary;
mod written;

pub use compare::NEAR_A_KINK;
pub use discoveries::SEARCH_SOURCES;
pub use drift::{Drift, drift};
pub use error::ExperimentError;
pub use judge::four_digits;
pub use plan::{
    Answers, Case, Claim, Decision, Discovered, Discovery, Exact, Fit, Fitted, Hidden,
    Irreproducible, Measure, Plan, Point, Source, Study, Subject, Whose, control_name,
    corners_name,
};
pub use run::{Finished, Options, Progress, WATCHDOG, Why, run};
pub use summary::summary;
