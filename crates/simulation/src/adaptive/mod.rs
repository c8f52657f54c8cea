//! Our own methods that take a tolerance and know what they solve, and the list of them.
//!
//! They are compiled for a friction model and use what a library cannot know of it: where it has kinks,
//! that LuGre is linear in x, that Dahl has a power series.

mod dahl_series;
mod lugre_linear;
mod stiff_plant;

use crate::Own;

/// Our own adaptive methods.
pub const ADAPTIVE: &[Own] = &[lugre_linear::METHOD, dahl_series::METHOD, stiff_plant::METHOD];
