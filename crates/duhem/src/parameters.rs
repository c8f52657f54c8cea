//! Parameters by the names the experiments give them, and what can be wrong with them.

use std::collections::BTreeMap;

/// One parameter of a model.
#[derive(Debug, Clone, PartialEq)]
pub enum Parameter {
    /// A number.
    Scalar(f64),
    /// One number for each element.
    List(Vec<f64>),
}

impl From<f64> for Parameter {
    fn from(value: f64) -> Self {
        Self::Scalar(value)
    }
}

impl From<Vec<f64>> for Parameter {
    fn from(values: Vec<f64>) -> Self {
        Self::List(values)
    }
}

/// The parameters of a model by their keys, in SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Parameters(pub BTreeMap<String, Parameter>);

impl<K: Into<String>, V: Into<Parameter>> FromIterator<(K, V)> for Parameters {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(pairs: I) -> Self {
        Self(pairs.into_iter().map(|(key, value)| (key.into(), value.into())).collect())
    }
}

/// Why parameters do not make a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// The model has no such parameter.
    #[error("unknown key {key}: expected one of {expected}")]
    Unknown {
        /// The key found.
        key: String,
        /// The known keys, separated by commas.
        expected: String,
    },
    /// A parameter of the model is not given.
    #[error("{key} is missing: expected {expected}")]
    Missing {
        /// The key not found.
        key: String,
        /// What belongs there, with its unit.
        expected: String,
    },
    /// A parameter is outside the model's domain.
    #[error("{key} = {found}: expected {expected}")]
    Invalid {
        /// The key.
        key: String,
        /// The value found.
        found: String,
        /// What belongs there, with its unit.
        expected: String,
    },
}

impl ParameterError {
    /// The key that is wrong.
    pub fn key(&self) -> &str {
        match self {
            Self::Unknown { key, .. } | Self::Missing { key, .. } | Self::Invalid { key, .. } => {
                key
            }
        }
    }
}

impl Parameters {
    /// Refuses every key that is not among `keys`.
    pub fn only(&self, keys: &[&str]) -> Result<(), ParameterError> {
        match self.0.keys().find(|key| !keys.contains(&key.as_str())) {
            None => Ok(()),
            Some(key) => {
                Err(ParameterError::Unknown { key: key.clone(), expected: keys.join(", ") })
            }
        }
    }

    /// The positive, finite number under `key`; `quantity` is its name and unit, as "force [N]".
    pub fn positive(&self, key: &str, quantity: &str) -> Result<f64, ParameterError> {
        self.scalar(key, admits, &format!("a positive, finite {quantity}, from 1e-60 to 1e60"))
    }

    /// The finite number under `key` that is zero or more.
    pub fn not_negative(&self, key: &str, quantity: &str) -> Result<f64, ParameterError> {
        self.scalar(key, |v| v >= 0.0, &format!("a finite {quantity}, zero or more"))
    }

    /// The list of positive, finite numbers under `key`, at least one.
    pub fn positives(&self, key: &str, quantity: &str) -> Result<Vec<f64>, ParameterError> {
        let expected = format!("a list of positive, finite {quantity}, from 1e-60 to 1e60");
        match self.get(key, &expected)? {
            Parameter::List(list) if !list.is_empty() && list.iter().all(|v| admits(*v)) => {
                Ok(list.clone())
            }
            other => Err(invalid(key, other, &expected)),
        }
    }

    fn scalar(
        &self,
        key: &str,
        holds: impl Fn(f64) -> bool,
        expected: &str,
    ) -> Result<f64, ParameterError> {
        match self.get(key, expected)? {
            Parameter::Scalar(v) if v.is_finite() && holds(*v) => Ok(*v),
            other => Err(invalid(key, other, expected)),
        }
    }

    fn get(&self, key: &str, expected: &str) -> Result<&Parameter, ParameterError> {
        self.0.get(key).ok_or_else(|| ParameterError::Missing {
            key: key.to_owned(),
            expected: expected.to_owned(),
        })
    }
}

/// Positive and of a size that products and quotients of a few of them do not leave the range of f64.
fn admits(v: f64) -> bool {
    (1e-60..=1e60).contains(&v)
}

fn invalid(key: &str, found: &Parameter, expected: &str) -> ParameterError {
    let found = match found {
        Parameter::Scalar(v) => v.to_string(),
        Parameter::List(list) => format!("{list:?}"),
    };
    ParameterError::Invalid { key: key.to_owned(), found, expected: expected.to_owned() }
}
