//! What the input does between the samples, and a controller that makes it.

use super::{Real, course::course};
use crate::Hold;

/// The input of a plant over a record.
#[derive(Debug, Clone)]
pub enum Drive<'a> {
    /// As recorded, one value a sample.
    Recorded {
        /// The input at each sample, and before them what a drive that comes late still has of it.
        values: &'a [f64],
        /// The place of the first sample among them.
        first: usize,
        /// What it does between them.
        hold: Hold,
    },
    /// Made by the controller from the simulated displacement.
    Controlled(Feedback<'a>),
}

impl Drive<'_> {
    /// The input at the first sample where it was recorded, late by the `delay` where there is one; it has the times of
    /// the samples [s] beside it.
    pub(crate) fn begins<D: Real>(&self, delay: Option<(D, &[f64])>) -> Option<D> {
        match self {
            Self::Recorded { .. } => Some(course(self, 0, &[], delay).ends[0]),
            Self::Controlled(_) => None,
        }
    }
}

/// A sampled controller, one sample of the record for each of its own:
/// u = clip(k_v (k_p (reference − q) − dq), ±limit) + added, where dq is the difference quotient of the mean of
/// each two neighbouring positions.
#[derive(Debug, Clone, Copy)]
pub struct Feedback<'a> {
    /// Position gain k_p [1/s].
    pub kp: f64,
    /// Velocity gain k_v [V·s/m].
    pub kv: f64,
    /// Largest command [V].
    pub limit: f64,
    /// Sampling time [s].
    pub sample_time: f64,
    /// The reference position at each sample [m].
    pub reference: &'a [f64],
    /// What is added to the command at each sample [V]; none if empty.
    pub added: &'a [f64],
}

impl Feedback<'_> {
    /// The command at sample `i` [V] from the displacements [m] now and two samples ago.
    pub fn command<D: Real>(&self, i: usize, [q, earlier]: [D; 2]) -> D {
        let dq = (q - earlier) / (2.0 * self.sample_time);
        let free = ((-q + self.reference[i]) * self.kp - dq) * self.kv;
        let clipped = if free.re() > self.limit {
            D::from(self.limit)
        } else if free.re() < -self.limit {
            D::from(-self.limit)
        } else {
            free
        };
        clipped + self.added.get(i).copied().unwrap_or(0.0)
    }
}
