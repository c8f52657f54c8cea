//! The record's own motion, and those of the rig as given and as it was found.

use crate::plan::{Discovery, Fit};
use identify::{
    Recording, Rig,
    fit::{Data, binding},
    march::{Drive, Start, Tolerance, march},
};

/// Whose motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Which {
    /// As it was recorded.
    Record,
    /// Simulated with the rig as given.
    Given,
    /// Simulated with the rig as it was found.
    Found,
}

impl Which {
    /// As the TOML names it.
    pub(crate) fn of(name: &str) -> Result<Self, String> {
        match name {
            "record" => Ok(Self::Record),
            "given" => Ok(Self::Given),
            "fitted" | "found" => Ok(Self::Found),
            other => Err(format!("found `{other}`: expected one of record, given, fitted, found")),
        }
    }
}

/// A record with the rig as given and as it was found.
pub(crate) struct Runs<'a> {
    /// The record's channels.
    pub(crate) recording: &'a Recording,
    /// The record as it is simulated.
    pub(crate) data: &'a Data,
    /// The rig as given.
    pub(crate) given: Rig,
    /// The rig as found.
    pub(crate) found: Rig,
    /// How a figure labels the record, the first and the second rig.
    labels: [&'static str; 3],
}

impl<'a> Runs<'a> {
    /// The rig with nominal parameters, and the bias that the fit found; and with the fitted ones.
    pub(crate) fn of_fit(fit: &'a Fit) -> Result<Self, String> {
        let (mut given, found) = (fit.rig.clone(), fit.fitted_rig()?);
        binding::set(&mut given, "offset", found.value("offset").unwrap_or(0.0));
        // Only what was made has a truth.
        let record = if fit.truth.is_empty() { "record" } else { "synthetic record" };
        let labels = [record, "tuned by hand", "fitted"];
        Ok(Self { recording: &fit.recording, data: &fit.data, given, found, labels })
    }

    /// The rig as given, and with what was found.
    pub(crate) fn of_discovery(search: &'a Discovery) -> Result<Self, String> {
        let source = &search.source;
        let found = Rig::parse(&search.found()?.model).map_err(|e| e.to_string())?;
        let record = if search.hidden.is_none() { "record" } else { "synthetic record" };
        let labels = [record, "as given", "as found"];
        let (recording, data) = (&source.recording, &source.data);
        Ok(Self { recording, data, given: source.rig.clone(), found, labels })
    }

    /// As a figure labels it.
    pub(crate) fn label(&self, which: Which) -> &'static str {
        let [record, given, found] = self.labels;
        match which {
            Which::Record => record,
            Which::Given => given,
            Which::Found => found,
        }
    }

    /// The rig of a motion; of the record's own the one that was found.
    pub(crate) fn rig(&self, which: Which) -> &Rig {
        if which == Which::Given { &self.given } else { &self.found }
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
    pub(crate) fn of(runs: &Runs<'_>, which: Which, finer: f64) -> Result<Self, String> {
        let (rig, data) = (runs.rig(which), runs.data);
        let model = binding::model::<f64>(rig, &|_| None);
        let drive = data.input.iter().map(|u| model.balance.gain * u).collect();
        let constant = model.offset - model.balance.constant;
        let seen = data.displacement.as_ref().ok_or("an imposed motion where a plant is needed")?;
        let velocity = data.velocity.as_ref();
        let (q, v) = if which == Which::Record {
            (seen.values.clone(), velocity.map(|v| v.values.clone()).unwrap_or_default())
        } else {
            simulated(data, rig, TOLERANCE / finer)?
        };
        Ok(Self { q, v, drive, constant })
    }

    /// The samples from the time `from` [s] up to `to`.
    pub(crate) fn within(time: &[f64], [from, to]: [f64; 2]) -> std::ops::Range<usize> {
        time.partition_point(|t| *t < from)..time.partition_point(|t| *t <= to)
    }
}

/// The rig from the record's first sample, at rest there, driven by the record's input.
fn simulated(data: &Data, rig: &Rig, tolerance: f64) -> Result<(Vec<f64>, Vec<f64>), String> {
    let model = binding::model::<f64>(rig, &|_| None);
    let first = |seen: &Option<identify::fit::Seen>| {
        seen.as_ref().and_then(|s| s.values.first().copied()).unwrap_or(0.0)
    };
    let span = data.displacement.as_ref().map_or(1.0, |s| s.span);
    let q = first(&data.displacement);
    let z = model.contact.holding(model.drive(first_input(data), q, 0.0));
    let motion = march(
        &model,
        &Drive::Recorded { values: &data.input, first: 0, hold: data.hold },
        &data.time,
        &Start { q, v: 0.0, z, shown: None },
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

fn first_input(data: &Data) -> f64 {
    data.input.first().copied().unwrap_or(0.0)
}
