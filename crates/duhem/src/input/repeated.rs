//! A polyline repeated for ever.

use super::{error::InputError, polyline::Polyline};

/// One period of straight pieces, closed in u, and its copies before and after.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Repeated {
    line: Polyline,
    /// Start of the written period [s].
    start: f64,
    /// Its length [s].
    period: f64,
}

impl Repeated {
    pub(super) fn new(t: Vec<f64>, u: Vec<f64>) -> Result<Self, InputError> {
        let ends = t.first().copied().zip(t.last().copied());
        let jump = u.first().copied().zip(u.last().copied());
        let line = Polyline::new(t, u)?;
        let (Some((start, end)), Some((first, last))) = (ends, jump) else {
            return Err(InputError::Length { key: "t", found: 0, expected: "at least 2".into() });
        };
        if first != last {
            let expected = "the u it starts with: a period closes";
            return Err(InputError::Invalid { key: "u", found: last, expected });
        }
        Ok(Self { line, start, period: end - start })
    }

    pub(super) fn u(&self, t: f64) -> f64 {
        self.line.u(self.local(t))
    }

    pub(super) fn u_dot(&self, t: f64) -> f64 {
        self.line.u_dot(self.local(t))
    }

    pub(super) fn period(&self) -> f64 {
        self.period
    }

    pub(super) fn range(&self) -> (f64, f64) {
        self.line.range()
    }

    /// The written samples where the slope changes, the joint included, in every copy around the span.
    pub(super) fn corners(&self, start: f64, end: f64) -> Vec<f64> {
        let last = self.start + self.period;
        // The polyline is at rest outside: its ends are corners of its own, and may be none of the copies'.
        let mut inner = self.line.corners();
        inner.retain(|t| *t > self.start && *t < last);
        let joint = self.line.u_dot(self.start) != self.line.u_dot(last.next_down());
        let own = joint.then_some(self.start).into_iter().chain(inner);
        let own: Vec<f64> = own.collect();
        let mut copy = ((start - self.start) / self.period).floor() - 1.0;
        let mut corners = Vec::new();
        while self.start + copy * self.period < end && copy + 1.0 > copy {
            corners.extend(own.iter().map(|t| t + copy * self.period));
            copy += 1.0;
        }
        corners
    }

    /// The time in the written period.
    fn local(&self, t: f64) -> f64 {
        self.start + (t - self.start).rem_euclid(self.period)
    }
}
