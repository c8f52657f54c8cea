//! A simulated window, and how it follows the parameters.

use super::{descent::within, window::START};
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

/// A window leaves no less than so much of what noise does: where an encoder rests a model that does is right to the last
/// digit, and its logarithm would decide over all other windows.
const LITTLE: f64 = 0.1;

impl Piece {
    /// The logarithm of its misfit.
    pub fn logarithm(&self) -> f64 {
        self.misfit().max(LITTLE * self.residuals.len() as f64).ln()
    }

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

/// A window's derivatives by its start: Q of their factors, the inverse of R, and the columns' sizes, for these differ
/// by the units of displacement and velocity, and it is their directions that count.
#[derive(Debug)]
pub(super) struct Starts {
    pub(super) q: DMatrix<f64>,
    r: DMatrix<f64>,
    inverse: DMatrix<f64>,
    sizes: Vec<f64>,
}

impl Starts {
    pub(super) fn of(mut columns: DMatrix<f64>) -> Self {
        let sizes: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
        for (mut column, size) in columns.column_iter_mut().zip(&sizes) {
            column /= *size;
        }
        let starts = columns.ncols();
        let qr = columns.qr();
        let r = qr.r();
        let inverse = r.clone().try_inverse().unwrap_or_else(|| DMatrix::zeros(starts, starts));
        Self { q: qr.q(), r, inverse, sizes }
    }

    /// By how much the start moves against what lies `along` its directions.
    pub(super) fn moved(&self, along: &DMatrix<f64>) -> DMatrix<f64> {
        let mut moved = -(&self.inverse * along);
        for (mut row, size) in moved.row_iter_mut().zip(&self.sizes) {
            row /= *size;
        }
        moved
    }

    /// The start of a window with the smallest misfit.
    pub(super) fn better(&self, piece: &Piece) -> [f64; START] {
        let more = self.moved(&self.q.tr_mul(&column(piece)));
        let start = |i: usize| piece.start[i] + if i < more.nrows() { more[(i, 0)] } else { 0.0 };
        std::array::from_fn(start)
    }

    /// The step to the smallest misfit within a reach [of the start's spread], and by how much that falls.
    pub(super) fn step(
        &self,
        piece: &Piece,
        (spread, reach): (&[f64; START], f64),
    ) -> ([f64; START], f64) {
        let n = self.sizes.len();
        // By each number of the start in units of its spread.
        let by = DMatrix::from_fn(n, n, |i, j| self.r[(i, j)] * self.sizes[j] * spread[j]);
        let along = self.q.tr_mul(&column(piece));
        let (gauss, gradient) = (by.tr_mul(&by), by.tr_mul(&along).column(0).into_owned());
        let (step, promised, _) = within(&gauss, &gradient, reach);
        (std::array::from_fn(|i| if i < n { step[i] * spread[i] } else { 0.0 }), promised)
    }
}

fn column(piece: &Piece) -> DMatrix<f64> {
    DMatrix::from_column_slice(piece.residuals.len(), 1, &piece.residuals)
}
