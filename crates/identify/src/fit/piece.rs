//! A simulated window, and how it follows the parameters.

use super::window::START;
use crate::march::Motion;
use nalgebra::DMatrix;

/// One window, simulated.
#[derive(Debug, Clone)]
pub struct Piece {
    /// Its start: see [`START`].
    pub start: [f64; START],
    /// Its motion; the force [N] in place of the displacement if the motion is imposed.
    pub motion: Motion,
    /// Weighed residuals, sample by sample and channel by channel, then those of the start.
    pub residuals: Vec<f64>,
}

/// How the start of a window follows the parameters: from where, by how much more, by how much per variable;
/// and what the window's misfit was there.
#[derive(Debug, Clone)]
pub struct Lead {
    pub(super) was: [f64; START],
    pub(super) misfit: f64,
    pub(super) start: [f64; START],
    pub(super) by: DMatrix<f64>,
}

impl Lead {
    /// A start that does not move.
    pub fn staying(start: [f64; START], variables: usize) -> Self {
        Self { was: start, misfit: f64::INFINITY, start, by: DMatrix::zeros(START, variables) }
    }

    /// The start at the variables `x`, where the lead was taken at `x_0`.
    pub(super) fn at(&self, x: &[f64], x_0: &[f64]) -> [f64; START] {
        let more = |j: usize| -> f64 {
            x.iter().zip(x_0).enumerate().map(|(i, (x, x_0))| self.by[(j, i)] * (x - x_0)).sum()
        };
        std::array::from_fn(|j| self.start[j] + more(j))
    }
}

impl Piece {
    /// The sum of its squared residuals [1].
    pub fn misfit(&self) -> f64 {
        self.residuals.iter().map(|r| r * r).sum()
    }
}

/// A window's derivatives, its start projected out.
#[derive(Debug, Clone)]
pub struct Slopes {
    /// By the variables.
    pub jacobian: DMatrix<f64>,
    /// How the start follows.
    pub lead: Lead,
}
