//! The scenarios that have a name.

use crate::{Scenario, TwinError};

/// Name and text of every scenario.
pub const SCENARIOS: &[(&str, &str)] = &[
    ("axis", include_str!("../scenarios/axis.toml")),
    ("gearbox", include_str!("../scenarios/gearbox.toml")),
    ("mass-spring", include_str!("../scenarios/mass-spring.toml")),
    ("pendulum", include_str!("../scenarios/pendulum.toml")),
    ("prescribed", include_str!("../scenarios/prescribed.toml")),
];

/// The scenario of this name.
///
/// # Errors
/// A name that is not in the list.
pub fn scenario(name: &str) -> Result<Scenario, TwinError> {
    let Some((_, text)) = SCENARIOS.iter().find(|(known, _)| *known == name) else {
        let known: Vec<&str> = SCENARIOS.iter().map(|(known, _)| *known).collect();
        return Err(TwinError::Name { found: name.to_owned(), known: known.join(", ") });
    };
    Scenario::parse(text)
}
