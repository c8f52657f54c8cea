//! The fit by regression: velocity and acceleration from the filtered position, then ordinary least
//! squares of the force, which is linear in inertia, spring, viscous and Coulomb friction.
//!
//! The way is that of the EMPS benchmark (Janot, Gautier and Brunot, 2019), reproduced from its published
//! numbers to all their digits: a Butterworth filter of order 4 both ways over the position, central
//! differences twice, the columns made at the full rate (so that sgn q̇ is decimated as a signal), some
//! samples left away at the ends, force and every column (that of ones too) decimated, least squares.
//! A sample with q̇ = 0 stays, with the Coulomb column at 0.
//! The authors leave away 49 samples at the start and none at the end, where their one-sided differences
//! then move F_C by 0.08 %; here 49 go at both ends unless [`Options::trim`] says otherwise.

pub mod filter;
mod least_squares;
mod prepare;
mod terms;

pub use terms::{Column, LINEAR, Linear, Term};

use crate::Rig;
use least_squares::norm;
use prepare::Prepared;

/// What is regressed: columns of equal length, evenly sampled, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Samples<'a> {
    /// Times [s].
    pub time: &'a [f64],
    /// Position q [m] or angle [rad], as measured: not yet filtered.
    pub position: &'a [f64],
    /// Driving force [N] or torque [N·m], as measured: [`drive_gain`] times what the channel holds.
    pub force: &'a [f64],
}

/// How it is regressed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The plant, an entry of [`LINEAR`].
    pub plant: &'static Linear,
    /// Whether each direction has its own friction: `sigma_2_up`, `f_c_up`, `sigma_2_down`, `f_c_down`
    /// in the place of `sigma_2`, `f_c` and `offset`.
    pub by_direction: bool,
    /// Damping known beforehand, K_t²/R of a motor's back-EMF [N·s/m] or [N·m·s/rad]: taken off the force.
    pub known_damping: f64,
    /// Cut-off of the position's filter [Hz]; a tenth of the sampling rate if none is given (EMPS: 100 Hz
    /// at 1 kHz, five times the bandwidth of the closed loop).
    pub cutoff: Option<f64>,
    /// Of so many samples one row is kept; 1 keeps all.
    pub decimation: usize,
    /// Samples left away at start and end before decimation, where the filter and the differences are not central.
    pub trim: (usize, usize),
    /// Lags for which the standard errors allow [rows]; by Andrews' rule from the residuals if none is given.
    pub lag: Option<usize>,
}

impl Options {
    /// The usual options for a plant: decimation by 10, 49 samples left away at both ends.
    pub fn new(plant: &'static Linear) -> Self {
        Self {
            plant,
            by_direction: false,
            known_damping: 0.0,
            cutoff: None,
            decimation: 10,
            trim: (49, 49),
            lag: None,
        }
    }

    /// The usual options for the plant of `rig`, the back-EMF of a pendulum's motor known.
    pub fn of_rig(rig: &Rig) -> Result<Self, RegressionError> {
        let plant = Linear::of(rig.kind).ok_or_else(|| RegressionError::Kind {
            found: rig.kind.to_owned(),
            known: LINEAR.iter().map(|plant| plant.kind).collect::<Vec<_>>().join(", "),
        })?;
        let known_damping = match (rig.plant.get("torque_constant"), rig.plant.get("resistance")) {
            (Some(torque), Some(resistance)) => torque * torque / resistance,
            _ => 0.0,
        };
        Ok(Self { known_damping, ..Self::new(plant) })
    }
}

/// Driving force or torque per unit of the channel that drives `rig`: an axis' gain under a voltage, the
/// drum's motor constant, K_t/R of a pendulum's motor, else 1.
pub fn drive_gain(rig: &Rig) -> f64 {
    let key = |name: &str| rig.plant.get(name).copied();
    match rig.kind {
        "axis" if rig.channels.contains_key("voltage") => key("gain").unwrap_or(1.0),
        "drum" => key("motor_constant").unwrap_or(1.0),
        "pendulum" => match (key("torque_constant"), key("resistance")) {
            (Some(torque), Some(resistance)) => torque / resistance,
            _ => 1.0,
        },
        _ => 1.0,
    }
}

/// A coefficient with its errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficient {
    /// What it is.
    pub term: Term,
    /// Its value, in the term's unit.
    pub value: f64,
    /// Standard error that allows for residuals that hang together in time (Newey and West), same unit.
    pub standard_error: f64,
    /// Standard error as if the residuals of all rows were independent, same unit: too small as a rule.
    pub classical_error: f64,
}

/// A fitted regression.
#[derive(Debug, Clone, PartialEq)]
pub struct Regression {
    /// The coefficients, in the order of [`Linear::terms`].
    pub coefficients: Vec<Coefficient>,
    /// Their correlations after Newey and West, row-major.
    pub correlation: Vec<f64>,
    /// 100 ‖F − F̂‖/‖F‖ over the rows [%], the authors' measure.
    pub relative_error: f64,
    /// Condition number of the columns, each scaled to length one [1].
    pub condition: f64,
    /// Times of the rows [s].
    pub time: Vec<f64>,
    /// F − F̂ at the rows [N] or [N·m], divided by what decimation does to a constant.
    pub residual: Vec<f64>,
    /// Lags for which the standard errors allow [rows].
    pub lag: usize,
    /// Cut-off of the position's filter [Hz].
    pub cutoff: f64,
    /// Sampling rate of the record [Hz].
    pub sampling: f64,
    /// Rows of the record at which q̇ is exactly 0, so that they say nothing of F_C.
    pub at_rest: usize,
}

/// Why there is no regression.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RegressionError {
    /// The plant is not one of the list.
    #[error("plant {found} is not linear in its parameters here: expected one of {known}")]
    Kind {
        /// The kind found.
        found: String,
        /// The known kinds.
        known: String,
    },
    /// A column is not as long as the others.
    #[error("{channel} has {found} samples: expected {expected}, as many as time")]
    Length {
        /// The column.
        channel: &'static str,
        /// Its length.
        found: usize,
        /// The length of time.
        expected: usize,
    },
    /// A sample is not a number of usable size.
    #[error(
        "{channel} is {found} at sample {row}: expected a number within ±1e100; cut the record there"
    )]
    NotFinite {
        /// The column.
        channel: &'static str,
        /// The sample, counted from 1.
        row: usize,
        /// What stands there.
        found: f64,
    },
    /// The record is not evenly sampled.
    #[error(
        "{found} s from sample {row} to the next: expected {expected} s as in the mean, within half of it; cut the record at its gaps or resample it"
    )]
    Uneven {
        /// The sample, counted from 1.
        row: usize,
        /// The step found [s].
        found: f64,
        /// The mean step [s].
        expected: f64,
    },
    /// The samples are too close for differences.
    #[error("a sampling step of {found} s: expected {least} s at least; time is in seconds")]
    Step {
        /// The mean step [s].
        found: f64,
        /// The least [s].
        least: f64,
    },
    /// The record is too short for the filters or the coefficients.
    #[error(
        "{found} samples: expected {expected} at least; decimate or trim less, or record longer"
    )]
    Short {
        /// Its samples.
        found: usize,
        /// What is needed.
        expected: usize,
    },
    /// The cut-off cannot be.
    #[error(
        "cut-off {found} Hz: expected more than 0 and less than {below} Hz, half the sampling rate"
    )]
    Cutoff {
        /// The cut-off asked for [Hz].
        found: f64,
        /// Half the sampling rate [Hz].
        below: f64,
    },
    /// A coefficient cannot be told from the others.
    #[error(
        "this record cannot tell {name}: its column is zero or made up of the others; record a motion that goes both ways at several speeds"
    )]
    Untold {
        /// The coefficient.
        name: &'static str,
    },
    /// Values for another set of terms.
    #[error("{found} values: expected {expected}, one for each term")]
    Values {
        /// How many came.
        found: usize,
        /// How many terms there are.
        expected: usize,
    },
}

/// Fits the coefficients of the plant's terms to the record.
pub fn regress(samples: &Samples<'_>, options: &Options) -> Result<Regression, RegressionError> {
    let Prepared { terms, columns, force, time, at_rest, gain, cutoff, sampling } =
        prepare::prepare(samples, options)?;
    let solved = least_squares::solve(&columns, &force, options.lag)
        .map_err(|dependent| RegressionError::Untold { name: terms[dependent.0].name })?;
    let p = terms.len();
    let error = |j: usize| solved.covariance[j * p + j].sqrt();
    let coefficient = |(j, term): (usize, &Term)| Coefficient {
        term: *term,
        value: solved.beta[j],
        standard_error: error(j),
        classical_error: solved.classical[j],
    };
    let correlation = |k: usize| match error(k / p) * error(k % p) {
        // Without residuals there is no error to correlate.
        0.0 => f64::from(u8::from(k / p == k % p)),
        product => solved.covariance[k] / product,
    };
    Ok(Regression {
        coefficients: terms.iter().enumerate().map(coefficient).collect(),
        correlation: (0..p * p).map(correlation).collect(),
        relative_error: percent(&solved.residual, &force),
        condition: solved.condition,
        time,
        residual: solved.residual.iter().map(|e| e / gain).collect(),
        lag: solved.lag,
        cutoff,
        sampling,
        at_rest,
    })
}

/// The relative error 100 ‖F − F̂‖/‖F‖ [%] of given coefficients, in the order of [`Linear::terms`], on a record:
/// one they were not fitted to, or with those of somebody else.
pub fn relative_error(
    samples: &Samples<'_>,
    options: &Options,
    values: &[f64],
) -> Result<f64, RegressionError> {
    let Prepared { terms, columns, force, .. } = prepare::prepare(samples, options)?;
    if values.len() != terms.len() {
        return Err(RegressionError::Values { found: values.len(), expected: terms.len() });
    }
    let model = |i: usize| columns.iter().zip(values).map(|(x, value)| x[i] * value).sum::<f64>();
    let residual: Vec<f64> = force.iter().enumerate().map(|(i, f)| f - model(i)).collect();
    Ok(percent(&residual, &force))
}

/// 100 ‖e‖/‖F‖ [%]; 0 where both are.
fn percent(residual: &[f64], force: &[f64]) -> f64 {
    let (error, size) = (norm(residual), norm(force));
    if error == 0.0 { 0.0 } else { 100.0 * error / size }
}
