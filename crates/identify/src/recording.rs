//! A record as the channels of its rig, in SI units and at the drum.

use crate::rig::{Channel, Kind, Quantity, Rig, Shaft, units};
use std::collections::BTreeMap;

/// What hands over a column by its header, or says in words why it cannot.
pub type Columns<'a> = dyn Fn(&str) -> Result<&'a [f64], String> + 'a;

/// A record of a drive: its channels in SI units, an angle and a speed at the drum.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The times of the samples [s], increasing.
    pub time: Vec<f64>,
    /// The channels by their names, without the time; each as long as `time`.
    pub channels: BTreeMap<String, Vec<f64>>,
    /// The steps of encoders and converters, as the rig file says them or else as the samples show them, in SI units at the
    /// drum.
    pub quantum: BTreeMap<String, f64>,
}

/// Why a record cannot be used with its rig. Rows count from 0 and leave the header out.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecordingError {
    /// A column that cannot be had.
    #[error("channel {channel}: {found}")]
    Column {
        /// The channel.
        channel: String,
        /// Why, in words.
        found: String,
    },
    /// Too short, or columns of unlike lengths.
    #[error("column {column}: found {found} rows: expected {expected}")]
    Rows {
        /// The column, quoted.
        column: String,
        /// Its rows.
        found: usize,
        /// What was expected.
        expected: String,
    },
    /// A sample that cannot be used.
    #[error("column {column}: found {found}: expected {expected}")]
    Sample {
        /// The row, from 0.
        row: usize,
        /// The column, quoted.
        column: String,
        /// What was found.
        found: String,
        /// What was expected, and what to do.
        expected: String,
    },
}

impl RecordingError {
    /// The row, from 0, where the error is one of a sample.
    pub fn row(&self) -> Option<usize> {
        match self {
            Self::Sample { row, .. } => Some(*row),
            Self::Column { .. } | Self::Rows { .. } => None,
        }
    }
}

/// The fewest rows that are a record.
pub(crate) const FEWEST_ROWS: usize = 8;

/// The largest sample of any channel [SI]: what is above is a wrong unit or no measurement.
pub(crate) const LARGEST: f64 = 1e15;

/// A step of the clock so many times the usual one is a gap.
pub(crate) const GAP: f64 = 1.5;

impl Recording {
    /// The record of a rig from the columns of a file.
    ///
    /// Fails on a column that cannot be had, on fewer than 8 rows, on a sample of a channel
    /// that the rig file names which is not finite or above 1e15, and on time that does not increase.
    pub fn new(rig: &Rig, columns: &Columns) -> Result<Self, RecordingError> {
        let mut channels = BTreeMap::new();
        let mut quantum = BTreeMap::new();
        for quantity in Kind::of(rig.kind).map_or(&[][..], |kind| kind.channels) {
            let Some(channel) = rig.channels.get(quantity.name) else { continue };
            let column = columns(&channel.column).map_err(|found| RecordingError::Column {
                channel: quantity.name.to_owned(),
                found,
            })?;
            let factor = to_si(rig, quantity, channel);
            let values: Vec<f64> = column.iter().map(|v| v * factor).collect();
            check(&channel.column, column, &values)?;
            // What a file does not say the samples do: an encoder that rests shows no noise but has its steps.
            let step = stated_step(rig, channel, (factor, &values))
                .or_else(|| crate::doctor::quantum(&values));
            if let Some(step) = step {
                quantum.insert(quantity.name.to_owned(), step);
            }
            channels.insert(quantity.name.to_owned(), values);
        }
        let time = channels.remove("time").unwrap_or_default();
        for (name, values) in &channels {
            if values.len() != time.len() {
                let column = rig.channels.get(name).map_or("", |c| c.column.as_str());
                return Err(RecordingError::Rows {
                    column: crate::rig::quoted(column),
                    found: values.len(),
                    expected: format!("{}, as many as the time has", time.len()),
                });
            }
        }
        if let Some(row) = (1..time.len()).find(|i| time[*i] <= time[i - 1]) {
            return Err(RecordingError::Sample {
                row,
                column: crate::rig::quoted(rig.channels.get("time").map_or("", |c| &c.column)),
                found: format!("the time {} s after {} s", time[row], time[row - 1]),
                expected: "time that increases from row to row; sort the record or cut it there"
                    .to_owned(),
            });
        }
        Ok(Self { time, channels, quantum })
    }

    /// The usual step of its clock [s]: the median.
    pub fn sample_time(&self) -> f64 {
        crate::doctor::median_step(&self.time)
    }

    /// The rows, from 0, that come later than 1.5 usual steps after the row before.
    pub fn gaps(&self) -> Vec<usize> {
        let longest = GAP * self.sample_time();
        (1..self.time.len()).filter(|i| self.time[*i] - self.time[i - 1] > longest).collect()
    }
}

/// The number by which a sample of this channel becomes SI at the drum.
pub(crate) fn to_si(rig: &Rig, quantity: &Quantity, channel: &Channel) -> f64 {
    let unit = channel.unit.as_deref();
    // A rig that was parsed has only units that fit.
    let size = unit.map_or(1.0, |unit| units::size_in_si(unit, quantity.dimensions).unwrap_or(1.0));
    size / gear(rig, channel)
}

/// The step of the channel's encoder at the drum [SI], where the rig file says it, of samples that are `values` there
/// and came by `factor` from those of the column. A rig file says it in SI units; one in the unit of the column, which is
/// what an encoder's sheet has, is taken for that where the samples move in such steps.
pub(crate) fn stated_step(
    rig: &Rig,
    channel: &Channel,
    (factor, values): (f64, &[f64]),
) -> Option<f64> {
    let stated = channel.quantum?;
    let (si, own) = (stated / gear(rig, channel).abs(), stated * factor.abs());
    let off = |step: f64, seen: f64| (step / seen).ln().abs();
    let in_column = |seen: f64| off(own, seen) < off(si, seen);
    let in_column = crate::doctor::quantum(values).is_some_and(in_column);
    Some(if in_column { own } else { si })
}

fn gear(rig: &Rig, channel: &Channel) -> f64 {
    match channel.at {
        Shaft::Motor => rig.value("gear_ratio").unwrap_or(1.0),
        Shaft::Drum => 1.0,
    }
}

/// That a column is long enough and every sample of it a number that can be meant.
fn check(column: &str, raw: &[f64], si: &[f64]) -> Result<(), RecordingError> {
    let column = crate::rig::quoted(column);
    if raw.len() < FEWEST_ROWS {
        let expected = format!("at least {FEWEST_ROWS}");
        return Err(RecordingError::Rows { column, found: raw.len(), expected });
    }
    let Some(row) = si.iter().position(|v| !usable(*v)) else { return Ok(()) };
    let (found, expected) = if raw[row].is_nan() {
        let expected = "a number; cut the record there, or take the channel out of the rig file if it may be missing";
        ("no number (blank or NaN)".to_owned(), expected.to_owned())
    } else {
        let expected =
            format!("a finite number, in SI units at most {LARGEST:e}; is the unit right?");
        (shown(raw[row]), expected)
    };
    Err(RecordingError::Sample { row, column, found, expected })
}

fn shown(value: f64) -> String {
    if value.is_finite() { format!("{value:e}") } else { value.to_string() }
}

/// Whether a sample is a number that can be meant.
pub(crate) fn usable(value: f64) -> bool {
    value.abs() <= LARGEST
}

#[cfg(test)]
mod tests {
    use super::Recording;
    use crate::{Rig, fit::Data};

    #[test]
    fn an_encoder_that_rests_is_known_by_its_steps() {
        // It rests for two thirds of the record, in which its samples differ by nothing at all.
        let rig = "title = \"t\"\n[plant]\nkind = \"mass-spring\"\nmass = 1.0\nstiffness = 1.0\n[friction]\n\
            name = \"none\"\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n";
        let rig = Rig::parse(rig).unwrap();
        let step = 1.534e-3;
        let way = |i: u32| f64::from(i.saturating_sub(200).min(100)) * 0.7e-3;
        let time: Vec<f64> = (0..300).map(|i| 0.005 * f64::from(i)).collect();
        let position = |i: u32| step * (way(i) / step).round();
        let columns = |name: &str| -> Result<Vec<f64>, String> {
            Ok(match name {
                "t" => time.clone(),
                "x" => (0..300).map(position).collect(),
                _ => vec![0.0; 300],
            })
        };
        let all = ["t", "x", "f"].map(|name| (name, columns(name).unwrap()));
        let column = |name: &str| {
            let found = all.iter().find(|(own, _)| *own == name);
            found.map(|(_, values)| values.as_slice()).ok_or_else(|| name.to_owned())
        };
        let recording = Recording::new(&rig, &column).unwrap();
        assert!((recording.quantum["position"] / step - 1.0).abs() < 1e-9);
        let noise = Data::of(&rig, &recording).displacement.unwrap().noise;
        assert!((noise / (step / 12f64.sqrt()) - 1.0).abs() < 1e-9, "{noise} m");
    }
}
