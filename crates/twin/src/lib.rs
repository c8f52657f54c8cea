//! The rig as nature: synthetic records of drives, with their own equations and their own integrator.
//!
//! **Invariant**: knows no other crate of the project, so that no equation, no solver and no mistake is
//! shared with those who analyse its records.
//!
//! The equations are written in other variables than the paper's: a rate-independent model is a function of the
//! displacement since the last reversal, LuGre is carried by the momentum `p = M v + σ₁ z`, in which ż does not
//! appear, and Coulomb's law is the set-valued one, stuck or sliding.
//! The integrator is a Rosenbrock method of order 4 whose steps end at every sample, every corner of the drive
//! and every reversal.
//!
//! A scenario may hide effects ([`HiddenEffect`], `[[hidden]]` in its TOML) and have a controller; such a record has
//! an integrator of its own, with as many states as the effects need. [`bench`] draws whole cases by seed.
//!
//! Read first: [`Scenario`] (what is made), [`make`] (makes it), [`Made`] (the record and its truth).

pub mod bench;
mod catalogue;
mod check;
mod contact;
mod driven;
mod error;
pub mod hidden;
mod imposed;
mod make;
mod plant;
mod planted;
mod rosenbrock;
mod scenario;
mod sensor;
mod signal;
mod units;
mod wide;

pub use catalogue::{SCENARIOS, scenario};
pub use error::TwinError;
pub use hidden::{Hidden, HiddenEffect};
pub use make::{Column, Made, Truth, make, make_hidden};
pub use scenario::{Controller, Friction, Input, Part, PlantKind, Scenario, Sensor, Start};
pub use units::Quantity;
