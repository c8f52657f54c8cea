//! Our own methods that take a tolerance and know what they solve, and the list of them.
//!
//! They are compiled for a friction model and use what a library cannot know of it: where it has kinks,
//! that LuGre is linear in x, that Dahl has a power series.

mod dahl_series;
mod lugre_linear;

pub use dahl_series::DAHL_SERIES;
pub use lugre_linear::LUGRE_LINEAR;

use crate::Own;

/// Our own adaptive methods.
pub const ADAPTIVE: &[Own] = &[LUGRE_LINEAR, DAHL_SERIES];

/// a b + c, in one operation where the processor it is compiled for has that.
#[inline]
fn fma(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}
