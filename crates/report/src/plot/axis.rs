//! One axis: its ends, its ticks, and where a value lies on it.

use crate::number;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged};
use std::ops::Range;

/// One axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Axis {
    /// What is on it, with unit.
    pub(crate) label: String,
    /// The value at its start: left or bottom.
    pub(crate) from: f64,
    /// The value at its end, which may be the smaller one.
    pub(crate) to: f64,
    /// Whether it is logarithmic.
    pub(crate) log: bool,
    /// The values to label; none for round ones.
    pub(crate) at: Vec<f64>,
    /// Whether its start stands for all that is less.
    pub(crate) below: bool,
}

/// A place on an axis and its label.
pub(crate) type Tick = (f64, String);

impl Axis {
    /// A linear axis that holds these values with a little air.
    pub(crate) fn linear(label: &str, values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = ends(values.filter(|v| v.is_finite())).unwrap_or((0.0, 1.0));
        let air = if high > low { 0.04 * (high - low) } else { 0.5 * low.abs().max(1.0) };
        let (from, to) = (low - air, high + air);
        Self { label: label.to_owned(), from, to, ..Self::default() }
    }

    /// A logarithmic axis of whole decades that holds these values.
    pub(crate) fn decades(label: &str, values: impl Iterator<Item = f64>) -> Self {
        let positive = values.filter(|v| v.is_finite() && *v > 0.0);
        let (low, high) = ends(positive).unwrap_or((1.0, 10.0));
        let from = low.log10().floor();
        let to = high.log10().ceil().max(from + 1.0);
        let (from, to) = (10f64.powf(from), 10f64.powf(to));
        Self { label: label.to_owned(), from, to, log: true, ..Self::default() }
    }

    /// A logarithmic axis that holds these values with a little air.
    pub(crate) fn tight(label: &str, values: impl Iterator<Item = f64>) -> Self {
        Self { at: Vec::new(), ..Self::values(label, values.collect()) }
    }

    /// A logarithmic axis that holds these few values and labels each of them.
    pub(crate) fn values(label: &str, mut values: Vec<f64>) -> Self {
        values.retain(|v| v.is_finite() && *v > 0.0);
        values.sort_by(f64::total_cmp);
        values.dedup();
        let (low, high) = ends(values.iter().copied()).unwrap_or((1.0, 10.0));
        let air = (high / low).powf(0.05).max(1.1);
        let at = if values.len() > 8 { Vec::new() } else { values };
        let label = label.to_owned();
        Self { label, from: low / air, to: high * air, log: true, at, below: false }
    }

    /// The same axis from the other end.
    pub(crate) fn reversed(self) -> Self {
        Self { from: self.to, to: self.from, ..self }
    }

    /// Made usable whatever a table says: ends that are finite, apart, and positive if logarithmic.
    pub(crate) fn checked(mut self) -> Self {
        let positive = self.from > 0.0 && self.to > 0.0;
        let finite = self.from.is_finite() && self.to.is_finite();
        if !finite || (self.log && !positive) {
            (self.from, self.to) = if self.log { (1e-3, 1.0) } else { (0.0, 1.0) };
        }
        if self.from == self.to {
            (self.from, self.to) = if self.log {
                (self.from / 10.0, self.to * 10.0)
            } else {
                (self.from - 1.0, self.to + 1.0)
            };
        }
        self
    }

    /// Where `value` lies: 0 at the start, 1 at the end.
    pub(crate) fn share(&self, value: f64) -> f64 {
        if self.log {
            let value = value.max(f64::MIN_POSITIVE);
            (value / self.from).log10() / (self.to / self.from).log10()
        } else {
            (value - self.from) / (self.to - self.from)
        }
    }

    /// At most about `most` labelled places.
    pub(crate) fn ticks(&self, most: usize) -> Vec<Tick> {
        if !self.at.is_empty() {
            return self.at.iter().map(|v| (*v, self.label_of(*v))).collect();
        }
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        let mut ticks =
            if self.log { log_ticks(low, high, most) } else { linear_ticks(low, high, most) };
        if self.below {
            ticks.retain(|(value, _)| (value / self.from).log10() > 0.5);
            ticks.push((self.from, format!("<\u{202f}{}", self.label_of(self.from))));
        }
        ticks
    }

    /// A value as this axis writes it: whole decades of a logarithmic one as powers.
    #[expect(clippy::cast_possible_truncation, reason = "exponents of finite numbers are small")]
    fn label_of(&self, value: f64) -> String {
        let exponent = value.log10().round() as i32;
        if self.log && (value / 10f64.powi(exponent) - 1.0).abs() < 1e-9 {
            number::power_of_ten(exponent)
        } else {
            number::short(value)
        }
    }

    /// The decades between the labelled ones.
    pub(crate) fn minor(&self) -> Vec<f64> {
        if !self.log || !self.at.is_empty() {
            return Vec::new();
        }
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        decades(low, high).map(|e| 10f64.powi(e)).collect()
    }
}

fn ends(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |ends, v| match ends {
        None => Some((v, v)),
        Some((low, high)) => Some((low.min(v), high.max(v))),
    })
}

#[expect(clippy::cast_possible_truncation, reason = "exponents of finite numbers are small")]
fn decades(low: f64, high: f64) -> std::ops::RangeInclusive<i32> {
    (low.log10() - 1e-9).ceil() as i32..=(high.log10() + 1e-9).floor() as i32
}

fn log_ticks(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let all: Vec<i32> = decades(low, high).collect();
    if all.len() < 3 && high / low < 150.0 {
        return near_ticks(low, high, most);
    }
    let stride = [1, 2, 3, 4, 5, 6, 8, 10, 20, 50, 100]
        .into_iter()
        .find(|stride| all.len() <= most.max(2) * stride)
        .unwrap_or(200);
    let stride = i32::try_from(stride).unwrap_or(1);
    all.iter()
        .filter(|e| *e % stride == 0)
        .map(|e| (10f64.powi(*e), number::power_of_ten(*e)))
        .collect()
}

/// Ticks of an axis with hardly a decade: 1, 2 and 5 in each, or round numbers as on a linear one.
fn near_ticks(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let (first, last) = (low.log10().floor(), high.log10().ceil());
    let mut ticks = Vec::new();
    let mut exponent = first;
    while exponent <= last {
        for lead in [1.0, 2.0, 5.0] {
            let value = lead * 10f64.powf(exponent);
            if value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9) {
                ticks.push((value, number::short(value)));
            }
        }
        exponent += 1.0;
    }
    if ticks.len() < 2 { linear_ticks(low, high, most) } else { ticks }
}

fn linear_ticks(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let raw = (high - low) / most.max(2) as f64;
    let decade = 10f64.powf(raw.log10().floor());
    let lead = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().find(|l| l * decade >= raw * 0.8);
    let step = lead.unwrap_or(10.0) * decade;
    let first = (low / step - 1e-9).ceil();
    let mut ticks = Vec::new();
    let mut i = first;
    while i * step <= high + 1e-9 * step && ticks.len() < 50 {
        let value = i * step;
        ticks.push((value, number::short((value / step).round() * step)));
        i += 1.0;
    }
    ticks
}

/// For plotters: values are mapped to its units along the axis.
impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    #[expect(clippy::cast_possible_truncation, reason = "clamped to what fits")]
    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = self.share(*value).clamp(-100.0, 100.0);
        (f64::from(limit.0) + share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        self.ticks(hint.max_num_points()).into_iter().map(|(value, _)| value).collect()
    }

    fn range(&self) -> Range<f64> {
        self.from..self.to
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, most: usize) -> Vec<String> {
        axis.ticks(most).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_powers_of_ten_or_round_numbers() {
        let axis = |from, to, log| Axis { from, to, log, ..Axis::default() };
        assert_eq!(labels(&axis(1e-4, 1.0, true), 6), ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "1"]);
        assert_eq!(
            labels(&axis(1e-16, 10.0, true), 6),
            ["10⁻¹⁵", "10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "1"]
        );
        assert_eq!(labels(&axis(3.0, 40.0, true), 6), ["5", "10", "20"]);
        assert_eq!(labels(&axis(-1.0, 1.0, false), 5), ["−1", "−0.5", "0", "0.5", "1"]);
        assert_eq!(
            labels(&axis(-0.8, 0.8, false), 8),
            ["−0.8", "−0.6", "−0.4", "−0.2", "0", "0.2", "0.4", "0.6", "0.8"]
        );
        assert_eq!(labels(&Axis::values("", vec![65.0, 33.0, 65.0]), 6), ["33", "65"]);
        assert_eq!(labels(&Axis::values("", vec![1e-3, 1e-5]), 6), ["10⁻⁵", "10⁻³"]);
    }

    #[test]
    fn an_axis_that_makes_no_sense_becomes_one_that_can_be_drawn() {
        for (from, to, log) in
            [(0.0, 0.0, true), (f64::NAN, 1.0, false), (2.0, 2.0, false), (-1.0, 1.0, true)]
        {
            let axis = Axis { from, to, log, ..Axis::default() }.checked();
            assert!(axis.share(axis.from) == 0.0 && axis.share(axis.to) == 1.0, "{axis:?}");
        }
    }
}
