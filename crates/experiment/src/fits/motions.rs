//! The record's own motion, and those of the rig with its nominal and its fitted parameters.

use crate::plan::Fit;
use identify::{
    Rig,
    fit::binding,
    march::{Drive, Start, Tolerance, march},
};

/// Whose motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Which {
    /// As it was recorded.
    Record,
    /// Simulated with the nominal parameters, and the bias that the fit found.
    Given,
    /// Simulated with the fitted parameters.
    Fitted,
}

impl Which {
    /// As the TOML names it.
    pub(crate) fn of(name: &str) -> Result<Self, String> {
        match name {
            "record" => Ok(Self::Record),
            "given" => Ok(Self::Given),
            "fitted" => Ok(Self::Fitted),
            other => Err(format!("found `{other}`: expected one of record, given, fitted")),
        }
    }

    /// As a figure labels it.
    pub(crate) fn label(self, fit: &Fit) -> &'static str {
        match self {
            // Only what was made has a truth.
            Self::Record if !fit.truth.is_empty() => "synthetic record",
            Self::Record => "record",
            Self::Given => "tuned by hand",
            Self::Fitted => "fitted",
        }
    }
}

/// A motion at the samples of the record.
pub(crate) struct Motions {
    /// Displacement [m] or [rad].
    pub(crate) q: Vec<f64>,
    /// Velocity [m/s] or [rad/s]; empty of a record without it.
    pub(crate) v: Vec<f64>,
    /// The force [N] or torque [N·m] of the drive, its gain times the input.
    pub(crate) drive: Vec<f64>,
    /// The constant part of it that a loop is drawn without: the bias, and what unequal springs pull.
    pub(crate) constant: f64,
}

/// What a step may be wrong by, of the span of the record [1].
const TOLERANCE: f64 = 1e-6;

impl Motions {
    /// The motion of `which`, its steps' tolerance divided by `finer`.
    pub(crate) fn of(fit: &Fit, which: Which, finer: f64) -> Result<Self, String> {
        let fitted = fit.fitted_rig()?;
        let rig = match which {
            Which::Record | Which::Fitted => fitted.clone(),
            Which::Given => {
                let mut rig = fit.rig.clone();
                binding::set(&mut rig, "offset", fitted.value("offset").unwrap_or(0.0));
                rig
            }
        };
        let model = binding::model::<f64>(&rig, &|_| None);
        let drive = fit.data.input.iter().map(|u| model.balance.gain * u).collect();
        let constant = model.offset - model.balance.constant;
        let seen =
            fit.data.displacement.as_ref().ok_or("an imposed motion where a plant is needed")?;
        let velocity = fit.data.velocity.as_ref();
        let (q, v) = if which == Which::Record {
            (seen.values.clone(), velocity.map(|v| v.values.clone()).unwrap_or_default())
        } else {
            simulated(fit, &rig, TOLERANCE / finer)?
        };
        Ok(Self { q, v, drive, constant })
    }

    /// The samples from the time `from` [s] up to `to`.
    pub(crate) fn within(time: &[f64], [from, to]: [f64; 2]) -> std::ops::Range<usize> {
        time.partition_point(|t| *t < from)..time.partition_point(|t| *t <= to)
    }
}

/// The rig from the record's first sample, at rest there, driven by the record's input.
fn simulated(fit: &Fit, rig: &Rig, tolerance: f64) -> Result<(Vec<f64>, Vec<f64>), String> {
    let model = binding::model::<f64>(rig, &|_| None);
    let data = &fit.data;
    let first = |seen: &Option<identify::fit::Seen>| {
        seen.as_ref().and_then(|s| s.values.first().copied()).unwrap_or(0.0)
    };
    let span = data.displacement.as_ref().map_or(1.0, |s| s.span);
    let q = first(&data.displacement);
    let z = model.contact.holding(model.drive(first_input(data), q, 0.0));
    let motion = march(
        &model,
        &Drive::Recorded { values: &data.input, hold: data.hold },
        &data.time,
        &Start { q, v: 0.0, z },
        &Tolerance {
            q: tolerance * span,
            v: tolerance * data.speed(),
            z: tolerance,
            steps: 10_000_000,
        },
    )
    .map_err(|e| e.to_string())?;
    Ok((motion.q, motion.v))
}

fn first_input(data: &identify::fit::Data) -> f64 {
    data.input.first().copied().unwrap_or(0.0)
}
