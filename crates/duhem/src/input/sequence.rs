//! Inputs one after the other.

use super::{Input, InputError, error::positive};
use crate::elementary::in_place;

/// How far u may jump between two parts, relative to their larger range: rounding, no more.
const CONTINUOUS: f64 = 1e-12;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sequence {
    parts: Vec<Part>,
}

#[derive(Debug, Clone, PartialEq)]
struct Part {
    input: Input,
    /// When it starts [s].
    start: f64,
    /// How long it lasts [s].
    duration: f64,
}

impl Sequence {
    pub(super) fn new(list: Vec<(Input, f64)>) -> Result<Self, InputError> {
        if list.is_empty() {
            let expected = "at least 1".to_owned();
            return Err(InputError::Length { key: "parts", found: 0, expected });
        }
        let (mut parts, mut start) = (Vec::<Part>::with_capacity(list.len()), 0.0);
        for (index, (input, duration)) in list.into_iter().enumerate() {
            positive("duration", duration, "a positive, finite time [s]")?;
            if let Some(last) = parts.last() {
                joins(index, last, &input)?;
            }
            parts.push(Part { input, start, duration });
            start += duration;
        }
        Ok(Self { parts })
    }

    pub(super) fn u(&self, t: f64) -> f64 {
        let part = self.part(t);
        part.input.u(t - part.start)
    }

    /// u in the place of each of the rising times.
    pub(super) fn displace(&self, times: &mut [f64]) {
        let mut rest = times;
        for (i, part) in self.parts.iter().enumerate() {
            let until = self.parts.get(i + 1).map_or(f64::INFINITY, |next| next.start);
            let (here, later) = rest.split_at_mut(rest.partition_point(|t| *t < until));
            in_place(here, |t| t - part.start);
            part.input.displace(here);
            rest = later;
        }
    }

    pub(super) fn piecewise_linear(&self) -> bool {
        self.parts.iter().all(|part| part.input.piecewise_linear())
    }

    pub(super) fn u_dot(&self, t: f64) -> f64 {
        let part = self.part(t);
        part.input.u_dot(t - part.start)
    }

    pub(super) fn u_dot_on(&self, from: f64, to: f64, t: f64) -> f64 {
        let part = self.part(from + 0.5 * (to - from));
        part.input.u_dot_on(from - part.start, to - part.start, t - part.start)
    }

    pub(super) fn period(&self) -> Option<f64> {
        self.parts.last().and_then(|part| part.input.period())
    }

    pub(super) fn range(&self) -> (f64, f64) {
        let last = self.parts.len() - 1;
        let ranges = self.parts.iter().enumerate().map(|(i, part)| {
            if i == last { part.input.range() } else { part.input.range_on(0.0, part.duration) }
        });
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        ranges.fold(ends, |(low, high), (l, h)| (low.min(l), high.max(h)))
    }

    /// The joints and the corners of the parts between them.
    pub(super) fn corners(&self, start: f64, end: f64) -> Vec<f64> {
        let last = self.parts.len() - 1;
        let mut corners = Vec::new();
        for (i, part) in self.parts.iter().enumerate() {
            if i > 0 {
                corners.push(part.start);
            }
            let from = if i == 0 { start.min(0.0) } else { 0.0 };
            let local = if i == last { end - part.start } else { part.duration };
            corners.extend(part.input.corners(from, local).iter().map(|t| part.start + t));
        }
        corners
    }

    fn part(&self, t: f64) -> &Part {
        let after = self.parts.partition_point(|part| part.start <= t);
        &self.parts[after.saturating_sub(1)]
    }
}

fn joins(index: usize, last: &Part, next: &Input) -> Result<(), InputError> {
    let (before, found) = (last.input.u(last.duration), next.u(0.0));
    let ((a, b), (c, d)) = (last.input.range(), next.range());
    let size = [a, b, c, d].iter().fold(0.0_f64, |size, u| size.max(u.abs()));
    if (found - before).abs() <= CONTINUOUS * size {
        Ok(())
    } else {
        Err(InputError::Jump { index, found, before })
    }
}
