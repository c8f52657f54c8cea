//! The exact methods, where the mathematics allows them, and the list of them.
//!
//! They take no time step and no tolerance: what they deliver is right to rounding at every time asked for.

mod dahl;
mod imposed;
mod lugre;
mod maxwell_slip;
mod semilinear;
mod slip_plant;

pub use slip_plant::{Event, EventKind, ExactSolution, SlipPlant};

use crate::Own;

/// The exact methods.
pub const EXACT: &[Own] =
    &[dahl::METHOD, lugre::METHOD, maxwell_slip::METHOD, semilinear::METHOD, slip_plant::METHOD];
