//! Our own methods that take a tolerance and know what they solve, and the list of them.
//!
//! They are compiled for a friction model and use what a library cannot know of it: where it has kinks,
//! that LuGre is linear in x, that Dahl has a power series.

mod lugre_linear;

pub use lugre_linear::LUGRE_LINEAR;

use crate::Own;

/// Our own adaptive methods.
pub const ADAPTIVE: &[Own] = &[LUGRE_LINEAR];
