//! What the tests share.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

use twin::{Made, Scenario, make};

/// The record of a scenario's text.
pub(crate) fn made(text: &str) -> Made {
    make(&Scenario::parse(text).unwrap(), 1).unwrap()
}

/// A true column of a record, by its header.
pub(crate) fn clean<'a>(made: &'a Made, column: &str) -> &'a [f64] {
    &made.clean.iter().find(|(name, _)| name == column).unwrap().1
}

/// The largest distance of a true column from a function of time.
pub(crate) fn off(made: &Made, column: &str, exact: impl Fn(f64) -> f64) -> f64 {
    let pairs = clean(made, "time_s").iter().zip(clean(made, column));
    pairs.map(|(t, found)| (found - exact(*t)).abs()).fold(0.0, f64::max)
}

/// Perfect sensors of these quantities, each in a column of its name.
pub(crate) fn sensors(quantities: &[&str]) -> String {
    let one = |q: &&str| format!("\n[[sensor]]\nquantity = \"{q}\"\ncolumn = \"{q}\"\n");
    quantities.iter().map(one).collect()
}
