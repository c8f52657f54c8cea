//! What can be wrong with an input.

/// Why an input cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InputError {
    /// A number outside its domain.
    #[error("{key} = {found}: expected {expected}")]
    Invalid {
        /// The argument's name.
        key: &'static str,
        /// The value found.
        found: f64,
        /// What belongs there, with its unit.
        expected: &'static str,
    },
    /// Too few numbers in a list, or lists of different lengths.
    #[error("{key} has {found} entries: expected {expected}")]
    Length {
        /// The argument's name.
        key: &'static str,
        /// The number of entries found.
        found: usize,
        /// The number that belongs there.
        expected: String,
    },
    /// Times that do not increase.
    #[error("t[{index}] = {found} s: expected a time after t[{index} - 1] = {before} s")]
    Order {
        /// The index of the later entry.
        index: usize,
        /// The time found [s].
        found: f64,
        /// The time before it [s].
        before: f64,
    },
    /// A jump of u between the parts of a sequence.
    #[error(
        "parts[{index}] starts at u = {found} m: expected {before} m, where parts[{index} - 1] ends \
         after its duration"
    )]
    Jump {
        /// The index of the later part.
        index: usize,
        /// Where it starts [m].
        found: f64,
        /// Where the part before it ends [m].
        before: f64,
    },
}

/// The number, if it is positive and finite.
pub(super) fn positive(
    key: &'static str,
    found: f64,
    expected: &'static str,
) -> Result<f64, InputError> {
    if found > 0.0 && found.is_finite() {
        Ok(found)
    } else {
        Err(InputError::Invalid { key, found, expected })
    }
}

/// Refuses the first number that is not finite.
pub(super) fn all_finite(key: &'static str, list: &[f64]) -> Result<(), InputError> {
    match list.iter().find(|v| !v.is_finite()) {
        None => Ok(()),
        Some(found) => {
            Err(InputError::Invalid { key, found: *found, expected: "finite numbers only" })
        }
    }
}
