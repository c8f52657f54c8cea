//! Levenberg and Marquardt's method on the problem of the fit.

use super::problem::{Lead, Piece, Problem};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra_lm::{DMatrix, DVector, Dyn, Owned};
use std::cell::{Cell, RefCell};

/// Where a search ended.
#[derive(Debug, Clone)]
pub struct Found {
    /// The variables.
    pub x: Vec<f64>,
    /// The sum of the squared weighed residuals [1].
    pub misfit: f64,
    /// The simulated windows.
    pub pieces: Vec<Piece>,
    /// How it ended.
    pub end: End,
    /// How many times all windows were simulated, and how many times with derivatives.
    pub simulations: [usize; 2],
}

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// At a minimum: neither the misfit nor the parameters change any more.
    Converged,
    /// It stopped, but the misfit still falls in some direction: not a minimum.
    Stalled,
    /// After as many simulations as allowed.
    OutOfPatience,
    /// Nothing it tried could be simulated.
    NoMotion,
}

/// When a search ends: the change of the misfit that counts as none, and the simulations it may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patience {
    /// Change of the misfit [1]; a standard error changes it by 1.
    pub misfit: f64,
    /// The same as a share of the misfit [1]: the larger one ends the search.
    pub share: f64,
    /// Simulations.
    pub simulations: usize,
}

/// Enough for the last fit.
pub const TO_THE_END: Patience = Patience { misfit: 0.05, share: 0.0, simulations: 40 };

/// The slope of the misfit along any variable above which a search has not converged, in that variable's standard
/// errors as if it were the only one.
const SLANTED: f64 = 0.3;

/// The first step, of the variables' size. Those of P6 were 1 at their nominal values: with longer first steps
/// one search in five, from starts within 30 % of the truth, jumped to where no bristle or no Stribeck effect
/// is left, and ended in another minimum.
const FIRST_STEP: f64 = 0.03;

struct Search<'p, 'd> {
    problem: &'p Problem<'d>,
    /// The variables, and which of them the search moves.
    x: Vec<f64>,
    moving: Vec<usize>,
    pieces: Vec<Piece>,
    at: RefCell<Option<(Vec<f64>, Vec<Lead>)>>,
    simulations: usize,
    derivatives: Cell<usize>,
}

impl Search<'_, '_> {
    fn simulate(&mut self) {
        let at = self.at.borrow();
        let lead = at.as_ref().map(|(x, leads)| (x.as_slice(), leads.as_slice()));
        self.pieces = self.problem.pieces(&self.x, lead);
        self.simulations += 1;
    }

    fn misfit(&self) -> f64 {
        let windows: f64 = self.pieces.iter().flat_map(|p| &p.residuals).map(|r| r * r).sum();
        windows + self.problem.loads(&self.x).0.iter().map(|r| r * r).sum::<f64>()
    }

    fn found(self, end: End) -> Found {
        Found {
            misfit: self.misfit(),
            x: self.x.clone(),
            end,
            simulations: [self.simulations, self.derivatives.get()],
            pieces: self.pieces,
        }
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Search<'_, '_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        for (place, i) in self.moving.iter().enumerate() {
            self.x[*i] = x[place];
        }
        self.simulate();
    }

    fn params(&self) -> DVector<f64> {
        DVector::from_iterator(self.moving.len(), self.moving.iter().map(|i| self.x[*i]))
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let mut all: Vec<f64> =
            self.pieces.iter().flat_map(|p| p.residuals.iter().copied()).collect();
        all.extend(self.problem.loads(&self.x).0);
        Some(DVector::from_vec(all))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let slopes = self.problem.all_slopes(&self.x, &self.pieces);
        self.derivatives.set(self.derivatives.get() + 1);
        let loads = self.problem.loads(&self.x).1;
        let rows = slopes.iter().map(|s| s.jacobian.nrows()).sum::<usize>() + loads.nrows();
        let mut all = DMatrix::zeros(rows, self.moving.len());
        let mut row = 0;
        for part in slopes.iter().map(|s| &s.jacobian).chain([&loads]) {
            for (column, i) in self.moving.iter().enumerate() {
                for j in 0..part.nrows() {
                    all[(row + j, column)] = part[(j, *i)];
                }
            }
            row += part.nrows();
        }
        let leads = slopes.into_iter().map(|s| s.lead).collect();
        *self.at.borrow_mut() = Some((self.x.clone(), leads));
        Some(all)
    }
}

/// Searches from `x` for the smallest misfit, moving all variables but the `fixed` one. The windows start where
/// they did in `pieces` of a search nearby, or, if there are none, as they were seen.
pub fn search(
    problem: &Problem<'_>,
    from: (&[f64], Option<&[Piece]>),
    fixed: Option<usize>,
    patience: &Patience,
) -> Found {
    let (mut search, reason) = descended(problem, from, fixed, patience);
    let end = end(&search, &reason);
    search.simulate();
    search.found(end)
}

fn descended<'p, 'd>(
    problem: &'p Problem<'d>,
    (x, pieces): (&[f64], Option<&[Piece]>),
    fixed: Option<usize>,
    patience: &Patience,
) -> (Search<'p, 'd>, TerminationReason) {
    let stays = |piece: &Piece| Lead::staying(piece.start, x.len());
    let at = pieces.map(|pieces| (x.to_vec(), pieces.iter().map(stays).collect()));
    let moving: Vec<usize> = (0..x.len()).filter(|i| Some(*i) != fixed).collect();
    let mut search = Search {
        problem,
        x: x.to_vec(),
        moving,
        pieces: Vec::new(),
        at: RefCell::new(at),
        simulations: 0,
        derivatives: Cell::new(0),
    };
    search.simulate();
    let rounds = patience.simulations.div_ceil(search.moving.len() + 1);
    let share = patience.misfit / search.misfit();
    // The library panics on a tolerance that is no number.
    let share = if share.is_finite() { share.clamp(1e-12, 1e-3) } else { 1e-3 };
    let share = share.max(patience.share);
    let method = LevenbergMarquardt::new()
        .with_ftol(share)
        .with_xtol(1e-9)
        .with_gtol(0.0)
        .with_stepbound(FIRST_STEP)
        .with_scale_diag(false)
        .with_patience(rounds.max(1));
    // The starts of the windows have followed along straight lines; a last simulation shows where they are.
    let (search, report) = method.minimize(search);
    (search, report.termination)
}

fn end(search: &Search<'_, '_>, reason: &TerminationReason) -> End {
    let still = search.pieces.iter().filter(|p| p.motion.q.is_empty()).count();
    if still > 0 {
        return if still == search.pieces.len() { End::NoMotion } else { End::Stalled };
    }
    if search.moving.is_empty() {
        return End::Converged;
    }
    if matches!(reason, TerminationReason::LostPatience) {
        return End::OutOfPatience;
    }
    let (Some(residuals), Some(jacobian)) = (search.residuals(), search.jacobian()) else {
        return End::Stalled;
    };
    let size = residuals.norm().max(f64::MIN_POSITIVE);
    let slanted = jacobian.column_iter().any(|column| {
        let long = column.norm();
        let errors = (residuals.len() as f64).sqrt() * column.dot(&residuals) / (long * size);
        long > 0.0 && errors.abs() > SLANTED
    });
    if slanted && size > 1e-6 { End::Stalled } else { End::Converged }
}
