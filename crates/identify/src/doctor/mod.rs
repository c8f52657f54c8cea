//! The record's doctor: what is wrong with a record, and what it cannot tell.

mod instruments;
mod limits;
mod motion;
mod sampling;
mod series;
mod signs;

pub use series::noise;
pub(crate) use series::{median_step, quantum};

use crate::recording::{Columns, FEWEST_ROWS, stated_step, to_si, usable};
use crate::rig::{Kind, Rig};
use serde::Serialize;
use series::n;

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// A fit of this record is wrong, or some parameter that should be found cannot be.
    Problem,
}

/// Something that was found, and what to do about it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// Its kind, one of [`FINDINGS`].
    pub kind: &'static str,
    /// The channel of the rig, or the column where there is no rig; text of the file, not escaped.
    pub channel: String,
    /// The first and the last row, from 0, where it is a matter of rows.
    pub rows: Option<(usize, usize)>,
    /// What was found, with its numbers.
    pub text: String,
    /// What to do.
    pub remedy: String,
}

/// The kinds of findings.
pub const FINDINGS: &[&str] = &[
    "column",
    "rows",
    "missing",
    "not-finite",
    "duplicate",
    "backward",
    "gap",
    "jitter",
    "clock",
    "controller",
    "constant",
    "saturated",
    "outlier",
    "quantum",
    "sign",
    "scale",
    "delay",
    "slope",
    "unlike",
    "still",
    "cannot-tell",
    "motion",
];

/// All that was found in a record.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Examination {
    /// The clock, where there is one.
    pub sampling: Option<Sampling>,
    /// The channels, or the columns where there is no rig.
    pub channels: Vec<Facts>,
    /// The motion, where a rig says what moves.
    pub motion: Option<Motion>,
    /// What was found, problems first.
    pub findings: Vec<Finding>,
}

/// The record's clock.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sampling {
    /// Its column; text of the file, not escaped.
    pub column: String,
    /// The rows of the record.
    pub rows: usize,
    /// From the first stamp to the last [s].
    pub duration: f64,
    /// The usual step [s]: the median.
    pub step: f64,
    /// Standard deviation of the steps that are no gaps, in usual steps [1].
    pub jitter: f64,
    /// The steps above 1.5 usual ones.
    pub gaps: usize,
}

/// What a channel shows of its instrument, in SI units at the drum.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Facts {
    /// The channel, or the column where there is no rig; text of the file, not escaped.
    pub name: String,
    /// Its SI unit; empty where there is no rig.
    pub unit: &'static str,
    /// Rows without a usable number.
    pub missing: usize,
    /// The least sample.
    pub least: f64,
    /// The largest sample.
    pub largest: f64,
    /// The step of which all samples are multiples, where there is one: of the encoder, or of the digits
    /// that were written.
    pub quantum: Option<f64>,
    /// Standard deviation of white noise from the differences of order three to seven, and not below
    /// quantum/√12.
    pub noise: f64,
}

/// The motion of the record, in SI units at the drum.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Motion {
    /// How often it turns.
    pub reversals: usize,
    /// The smallest and the largest half swing between two turns, 0 without.
    pub amplitudes: (f64, f64),
    /// The share of time it is at rest [1], as far as the position can tell.
    pub at_rest: f64,
    /// The slowest and the fastest speed while it moves, but for 1 % on either side.
    pub speeds: (f64, f64),
    /// The speed that the position's step and noise can tell from rest.
    pub resolution: f64,
}

/// A channel or column with its numbers in SI units at the drum.
#[derive(Debug, Clone)]
struct Series {
    name: String,
    unit: &'static str,
    /// Whether it was measured or drives the plant; a reference and an added input are made.
    measured: bool,
    values: Vec<f64>,
    facts: Option<Facts>,
    /// The step that the rig file states.
    stated: Option<f64>,
}

/// Where findings are put down.
#[derive(Debug, Default)]
struct Findings(Vec<Finding>);

impl Findings {
    fn note(&mut self, kind: &'static str, channel: &str, text: String, remedy: &str) {
        self.add(Severity::Note, kind, channel, (text, remedy));
    }

    fn problem(&mut self, kind: &'static str, channel: &str, text: String, remedy: &str) {
        self.add(Severity::Problem, kind, channel, (text, remedy));
    }

    fn add(
        &mut self,
        severity: Severity,
        kind: &'static str,
        channel: &str,
        (text, remedy): (String, &str),
    ) {
        let (channel, remedy) = (channel.to_owned(), remedy.to_owned());
        self.0.push(Finding { severity, kind, channel, rows: None, text, remedy });
    }

    /// Gives the finding put down last its rows.
    fn rows(&mut self, first: usize, last: usize) {
        if let Some(finding) = self.0.last_mut() {
            finding.rows = Some((first, last));
        }
    }
}

/// Examines a record. With a rig its channels, in SI units, and what they cannot tell of the rig; without,
/// the `names` of the file's columns, each for itself.
///
/// Never fails: what is strange about the record is a finding.
pub fn examine(rig: Option<&Rig>, names: &[&str], columns: &Columns) -> Examination {
    let mut findings = Findings::default();
    let mut all = match rig {
        Some(rig) => of_rig(rig, columns, &mut findings),
        None => of_file(names, columns, &mut findings),
    };
    let clock = match rig {
        Some(_) => all.iter().position(|s| s.name == "time"),
        None => sampling::guess(&all, &mut findings),
    };
    let time = clock.map(|i| all.remove(i));
    let sampling = time.as_ref().and_then(|time| sampling::examine(time, &mut findings));
    if let (Some(rig), Some(sampling)) = (rig, &sampling) {
        controlled(rig, sampling, &mut findings);
    }
    for series in &mut all {
        series.facts = instruments::examine(series, rig.is_some(), &mut findings);
    }
    let motion = match (rig, &time, &sampling) {
        (Some(rig), Some(time), Some(_)) => examine_motion(rig, time, &all, &mut findings),
        _ => None,
    };
    let mut findings = findings.0;
    findings.sort_by_key(|f| std::cmp::Reverse(f.severity));
    let channels = all.into_iter().filter_map(|s| s.facts).collect();
    Examination { sampling, channels, motion, findings }
}

/// A controller's time may differ from the record's by this share of it: they are told in numbers of few digits.
const SAME: f64 = 0.01;

/// A controller is simulated with a sample of the record for each of its own.
fn controlled(rig: &Rig, sampling: &Sampling, findings: &mut Findings) {
    let Some(controller) = &rig.controller else { return };
    if (controller.sample_time - sampling.step).abs() <= SAME * sampling.step {
        return;
    }
    let text = format!(
        "the controller samples every {} s, the record every {} s: what it commanded between two rows is not in it",
        series::n(controller.sample_time),
        series::n(sampling.step)
    );
    let remedy = "record every sample of the controller, or take [controller] and what the input does between its samples out \
                  of the rig file: then the recorded input is taken as it is";
    findings.problem("controller", "time", text, remedy);
}

fn examine_motion(
    rig: &Rig,
    time: &Series,
    all: &[Series],
    findings: &mut Findings,
) -> Option<Motion> {
    let track = motion::Track::new(rig, time, all, findings)?;
    signs::examine(rig, &track, findings);
    let motion = track.motion();
    limits::examine(rig, &track, &motion, findings);
    Some(motion)
}

/// The channels of the rig.
fn of_rig(rig: &Rig, columns: &Columns, findings: &mut Findings) -> Vec<Series> {
    let mut all: Vec<Series> = Vec::new();
    for quantity in Kind::of(rig.kind).map_or(&[][..], |kind| kind.channels) {
        let Some(channel) = rig.channels.get(quantity.name) else { continue };
        let column = match columns(&channel.column) {
            Ok(column) => column,
            Err(why) => {
                findings.problem(
                    "column",
                    quantity.name,
                    why,
                    "name another column in the rig file",
                );
                continue;
            }
        };
        let factor = to_si(rig, quantity, channel);
        let si = quantity.dimensions.iter().find(|d| {
            channel.unit.as_deref().is_none_or(|u| crate::rig::units::size_in_si(u, &[**d]).is_ok())
        });
        let values: Vec<f64> = column.iter().map(|v| v * factor).collect();
        all.push(Series {
            name: quantity.name.to_owned(),
            unit: si.map_or("", |d| d.si()),
            measured: !["reference", "added_input"].contains(&quantity.name),
            stated: stated_step(rig, channel, (factor, &values)),
            values,
            facts: None,
        });
    }
    short(&mut all, findings);
    all
}

/// The columns of the file.
fn of_file(names: &[&str], columns: &Columns, findings: &mut Findings) -> Vec<Series> {
    let mut all = Vec::new();
    for name in names {
        match columns(name) {
            Ok(column) => all.push(Series {
                name: (*name).to_owned(),
                unit: "",
                measured: true,
                values: column.to_vec(),
                facts: None,
                stated: None,
            }),
            Err(why) => findings.note("column", name, why, "it is left out"),
        }
    }
    short(&mut all, findings);
    all
}

/// Finds that there are few rows, or columns of unlike lengths, and makes them alike.
fn short(all: &mut [Series], findings: &mut Findings) {
    let rows = all.iter().map(|s| s.values.len()).min().unwrap_or(0);
    if let Some(longer) = all.iter().find(|s| s.values.len() > rows) {
        let text = format!("has {} rows where another column has {rows}", longer.values.len());
        findings.problem("rows", &longer.name, text, "cut the record to complete rows");
    }
    for series in all.iter_mut() {
        series.values.truncate(rows);
    }
    if all.is_empty() {
        let text = "the record has no column of numbers that is asked for".to_owned();
        findings.problem("rows", "", text, "see the names of its columns and what stands in them");
    } else if rows < FEWEST_ROWS {
        let text = format!("the record has {rows} rows, too few to tell anything");
        let remedy = format!("record at least {FEWEST_ROWS} rows, better some thousands");
        findings.problem("rows", "", text, &remedy);
    }
}

/// How many of the values no number stands for, and the first and last such row.
fn bad_rows(values: &[f64], bad: impl Fn(f64) -> bool) -> Option<(usize, usize, usize)> {
    let first = values.iter().position(|v| bad(*v))?;
    let last = values.iter().rposition(|v| bad(*v))?;
    Some((values.iter().filter(|v| bad(**v)).count(), first, last))
}

/// Finds samples that are no number, or none that can be meant.
fn examine_values(series: &Series, findings: &mut Findings) {
    let values = &series.values;
    if let Some((count, first, last)) = bad_rows(values, f64::is_nan) {
        let text = format!("{count} of {} samples are blank or no number", values.len());
        let remedy =
            "cut the record to a stretch without them, or fill them where you know the value";
        findings.problem("missing", &series.name, text, remedy);
        findings.rows(first, last);
    }
    if let Some((count, first, last)) = bad_rows(values, |v| !v.is_nan() && !usable(v)) {
        let text = format!(
            "{count} samples are infinite or absurdly large, the first {}",
            n(values[first])
        );
        findings.problem(
            "not-finite",
            &series.name,
            text,
            "see how the record was written, and its unit",
        );
        findings.rows(first, last);
    }
}
