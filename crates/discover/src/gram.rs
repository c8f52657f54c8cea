//! The derivatives of all residuals by what is free and by what may be missing, as one Gram matrix a block.

use crate::board::{Board, Fitted, SOFT};
use identify::{
    Effect, Rig,
    effects::{Context, Key, Kind, LAWS, Shape},
    fit::{
        FitError,
        binding::Scale,
        models,
        problem::{Piece, Problem},
        window::Window,
    },
};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// An effect at one probe, and its columns.
#[derive(Debug, Clone)]
pub(crate) struct Probe {
    /// The effect.
    pub(crate) kind: Kind,
    /// Its values: amounts at zero, shapes as probed.
    pub(crate) values: Vec<f64>,
    /// The places of its amounts among the columns.
    pub(crate) columns: Vec<usize>,
    /// What a variable of each column means in the amount's unit.
    pub(crate) sizes: Vec<f64>,
}

/// The Gram matrices of all blocks: nominal columns first, then the probes', the residual last.
#[derive(Debug, Clone)]
pub(crate) struct Gram {
    /// How many nominal columns there are.
    pub(crate) nominal: usize,
    /// The names of the nominal columns.
    pub(crate) names: Vec<String>,
    /// What holds each nominal column near its value: the inverse square of how far it may be off, and 0 for what
    /// may be anywhere.
    pub(crate) prior: Vec<f64>,
    /// How many residuals there are.
    pub(crate) residuals: f64,
    /// The effects at their probes.
    pub(crate) probes: Vec<Probe>,
    /// One matrix a block.
    pub(crate) blocks: Vec<DMatrix<f64>>,
}

/// What can be missing, effect by effect, with the probes of each.
pub(crate) fn lacking(
    board: &Board<'_>,
    rig: &Rig,
    context: &Context,
) -> Vec<(Kind, Vec<Vec<f64>>)> {
    // What is only a little loose can still be missing.
    let mut own = rig.clone();
    own.free.retain(|name| !board.loose.iter().any(|(loose, _)| loose == name));
    let applies = LAWS.iter().copied().filter(|kind| kind.applies(&own));
    applies.map(|kind| (kind, (kind.about().probes)(context))).collect()
}

/// Whether an effect can be scored along a derivative.
pub(crate) fn has_amount(kind: Kind) -> bool {
    kind.about().keys.iter().any(|key| key.shape == Shape::Amount)
}

/// The values of an effect whose shapes are as probed: its amounts are 0.
fn values_of(kind: Kind, probe: &[f64]) -> Vec<f64> {
    valued(kind, probe, |_| 0.0)
}

/// The values of an effect whose shapes are as probed, `tried` with so much of the natural sizes of its amounts.
pub(crate) fn tried(kind: Kind, probe: &[f64], tried: f64, context: &Context) -> Vec<f64> {
    valued(kind, probe, |key| tried * context.size(key.measure))
}

fn valued(kind: Kind, probe: &[f64], amount: impl Fn(&Key) -> f64) -> Vec<f64> {
    let mut shapes = probe.iter().copied();
    let value = |key: &Key| match key.shape {
        Shape::Amount => amount(key),
        _ => shapes.next().unwrap_or(key.usual.unwrap_or(1.0)),
    };
    kind.about().keys.iter().map(value).collect()
}

/// `rig` with an effect that changes nothing yet, its amounts free; its values. A number other than 0 stands behind
/// its name, so that several probes of one effect can stand side by side.
pub(crate) fn with(rig: &mut Rig, kind: Kind, probe: &[f64], number: usize) -> Vec<f64> {
    let about = kind.about();
    let values = values_of(kind, probe);
    let named = about.keys.iter().zip(&values).map(|(key, v)| (key.name.to_owned(), *v)).collect();
    let name = if number == 0 { about.name.to_owned() } else { format!("{}#{number}", about.name) };
    let amounts = about.keys.iter().filter(|key| key.shape == Shape::Amount);
    rig.free.extend(amounts.map(|key| format!("{name}.{}", key.name)));
    rig.effects.push(Effect { name, values: named });
    values
}

/// How many columns one pass over the record can carry.
const PASS: usize = 12;

/// How many amounts an effect has.
fn amounts(kind: Kind) -> usize {
    kind.about().keys.iter().filter(|key| key.shape == Shape::Amount).count()
}

impl Gram {
    /// Of a fitted model and all that it may lack; what does not begin smoothly at its smallest amount,
    /// if `begun` asks for it.
    pub(crate) fn of(
        board: &Board<'_>,
        fitted: &Fitted,
        (context, begun): (&Context, bool),
    ) -> Result<Self, FitError> {
        let lacking = lacking(board, &fitted.rig, context);
        let own = board.problem(&fitted.rig, |_| true)?;
        let (nominal, names) =
            (own.free.len(), own.free.iter().map(|f| f.name.clone()).collect::<Vec<_>>());
        let mut columns: Vec<Vec<DMatrix<f64>>> = jacobians(board, &own, &fitted.x, &fitted.pieces)
            .into_iter()
            .map(|j| vec![j])
            .collect();
        let (smooth, joints): (Vec<_>, Vec<_>) = lacking
            .into_iter()
            .filter(|(kind, _)| has_amount(*kind))
            .partition(|(kind, _)| kind.tried().is_empty());
        let each = |(kind, probes): (Kind, Vec<Vec<f64>>)| {
            probes.into_iter().map(move |probe| (kind, probe))
        };
        let all: Vec<(Kind, Vec<f64>)> = smooth.into_iter().flat_map(each).collect();
        let (mut probes, mut place, mut next): (Vec<Probe>, _, _) = (Vec::new(), nominal, 0);
        while next < all.len() {
            let mut rig = Rig { free: Vec::new(), ..fitted.rig.clone() };
            let first = probes.len();
            let mut taken = 0;
            while next < all.len() && taken + amounts(all[next].0) <= PASS {
                let (kind, probe) = &all[next];
                let n = amounts(*kind);
                let values = with(&mut rig, *kind, probe, next + 1);
                let columns = (place + taken..place + taken + n).collect();
                probes.push(Probe { kind: *kind, values, columns, sizes: vec![1.0; n] });
                (next, taken) = (next + 1, taken + n);
            }
            let problem = board.problem(&rig, |_| true)?;
            let mut sizes = problem.free.iter().map(|f| f.slope(0.0));
            for probe in &mut probes[first..] {
                probe.sizes.fill_with(|| sizes.next().unwrap_or(1.0));
            }
            for (k, j) in jacobians(board, &problem, &vec![0.0; taken], &fitted.pieces)
                .into_iter()
                .enumerate()
            {
                columns[k].push(j);
            }
            place += taken;
        }
        let residuals = residuals(board, &own, &fitted.x, &fitted.pieces);
        for (kind, own) in joints.into_iter().filter(|_| begun) {
            for (probe, tried) in own.iter().zip(kind.tried()).take(1) {
                let (size, moved) = tried_at(board, fitted, (kind, probe, *tried), context)?;
                let values = values_of(kind, probe);
                probes.push(Probe { kind, values, columns: vec![place], sizes: vec![size] });
                place += 1;
                for ((columns, r), moved) in columns.iter_mut().zip(&residuals).zip(moved) {
                    columns.push(DMatrix::from_column_slice(r.len(), 1, (moved - r).as_slice()));
                }
            }
        }
        let (prior, count) = (prior(&own), residuals.iter().map(|r| r.len() as f64).sum());
        let windows = columns.into_par_iter().zip(residuals).map(|(columns, r)| gram(&columns, &r));
        let blocks = folded(board, windows.collect());
        Ok(Self { nominal, names, prior, residuals: count, probes, blocks })
    }

    /// Of a fitted model and all that `rig` has free beside it, as one probe.
    pub(crate) fn of_rig(board: &Board<'_>, fitted: &Fitted, rig: &Rig) -> Result<Self, FitError> {
        let own = board.problem(&fitted.rig, |_| true)?;
        let problem = board.problem(rig, |_| true)?;
        let nominal = own.free.len();
        let names = own.free.iter().map(|f| f.name.clone()).collect();
        let sizes: Vec<f64> = problem.free.iter().skip(nominal).map(|f| f.slope(0.0)).collect();
        let x: Vec<f64> = fitted.x.iter().copied().chain(vec![0.0; sizes.len()]).collect();
        let jacobians = jacobians(board, &problem, &x, &fitted.pieces);
        let residuals = residuals(board, &own, &fitted.x, &fitted.pieces);
        let (prior, count) = (prior(&own), residuals.iter().map(|r| r.len() as f64).sum());
        let both = jacobians.into_par_iter().zip(residuals);
        let windows = both.map(|(columns, r)| gram(&[columns], &r)).collect();
        let blocks = folded(board, windows);
        let probes = vec![crate::maps::probe(nominal, sizes)];
        Ok(Self { nominal, names, prior, residuals: count, probes, blocks })
    }

    /// The sum over the blocks that `take` says, the nominal columns held near their values as much as the misfit asks for. Where the model is near, every
    /// block is worth its logarithm, so that one that went astray does not decide over all others.
    pub(crate) fn held(&self, near: bool, take: impl Fn(usize) -> bool) -> DMatrix<f64> {
        let count = self.residuals / self.blocks.len().max(1) as f64;
        let worth = |block: &DMatrix<f64>| {
            let last = block.nrows() - 1;
            let mean = block[(last, last)] / count;
            if near && mean > SOFT { mean } else { 1.0 }
        };
        let mut sum = self.weighed(take, worth);
        let n = sum.nrows();
        let variance = (sum[(n - 1, n - 1)] / self.residuals).max(1.0);
        for (i, prior) in self.prior.iter().enumerate() {
            sum[(i, i)] += prior * variance;
        }
        sum
    }

    /// The sum over the blocks that `take` says.
    pub(crate) fn sum(&self, take: impl Fn(usize) -> bool) -> DMatrix<f64> {
        self.weighed(take, |_| 1.0)
    }

    /// The same, each block divided by what `worth` says of it.
    fn weighed(
        &self,
        take: impl Fn(usize) -> bool,
        worth: impl Fn(&DMatrix<f64>) -> f64,
    ) -> DMatrix<f64> {
        let n = self.blocks.first().map_or(0, DMatrix::nrows);
        let taken = self.blocks.iter().enumerate().filter(|(k, _)| take(*k));
        taken.fold(DMatrix::zeros(n, n), |sum, (_, block)| sum + block / worth(block))
    }
}

/// The residuals with so much of an effect, of its natural size, and how much that is: for one that does not begin
/// smoothly, so that no derivative says what a little of it does.
fn tried_at(
    board: &Board<'_>,
    fitted: &Fitted,
    (kind, probe, tried): (Kind, &[f64], f64),
    context: &Context,
) -> Result<(f64, Vec<DVector<f64>>), FitError> {
    let mut rig = Fitted::holding(&fitted.rig);
    with(&mut rig, kind, probe, 0);
    let about = kind.about();
    let mut amount = 0.0;
    for key in about.keys.iter().filter(|key| key.shape == Shape::Amount) {
        amount = tried * context.size(key.measure);
        identify::fit::binding::set(&mut rig, &format!("{}.{}", about.name, key.name), amount);
    }
    rig.free.clear();
    let problem = board.problem(&rig, |_| true)?;
    let pieces = models::settled(&problem, &[], Some(&fitted.pieces), 1);
    Ok((amount, residuals(board, &problem, &[], &pieces)))
}

/// How far a nominal value may be off, in its logarithm, before an effect is the better explanation.
const OFF: f64 = 0.1;

/// What holds the free parameters near their values.
pub(crate) fn prior(problem: &Problem<'_>) -> Vec<f64> {
    let loose = |name: &str| problem.priors.iter().find(|(n, ..)| n == name).map(|p| p.2.powi(-2));
    let held = problem.free.iter().map(|free| match free.scale {
        _ if loose(&free.name).is_some() => loose(&free.name).unwrap_or(0.0),
        Scale::Linear(_) => 0.0,
        Scale::Logarithm(_) | Scale::Above(_) | Scale::InverseSquare(_) => OFF.powi(-2),
    });
    held.collect()
}

/// The sums over the windows of each block.
fn folded(board: &Board<'_>, windows: Vec<DMatrix<f64>>) -> Vec<DMatrix<f64>> {
    let mut blocks: Vec<Option<DMatrix<f64>>> = vec![None; board.trains.len()];
    for (w, matrix) in windows.into_iter().enumerate() {
        let block = &mut blocks[board.block(w)];
        *block = Some(match block.take() {
            Some(sum) => sum + matrix,
            None => matrix,
        });
    }
    blocks.into_iter().flatten().collect()
}

fn gram(columns: &[DMatrix<f64>], residual: &DVector<f64>) -> DMatrix<f64> {
    let rows = residual.len();
    let all: usize = columns.iter().map(DMatrix::ncols).sum();
    let mut joined = DMatrix::zeros(rows, all + 1);
    let mut first = 0;
    for part in columns {
        joined.columns_mut(first, part.ncols()).copy_from(part);
        first += part.ncols();
    }
    joined.set_column(all, residual);
    // Faster than its `tr_mul`, which goes column by column.
    joined.transpose() * joined
}

/// The derivatives of every block's residuals, those of the load cells last.
pub(crate) fn jacobians(
    board: &Board<'_>,
    problem: &Problem<'_>,
    x: &[f64],
    pieces: &[Piece],
) -> Vec<DMatrix<f64>> {
    let slopes = problem.all_slopes(x, pieces);
    let loads = problem.cells(x).1;
    let channels = problem.channels();
    let windows = windows(board, problem);
    let one = |k: usize| {
        let window = &windows[k];
        let n = window.len();
        let own = if board.imposed() {
            slopes[0].jacobian.rows(window.first, n).into_owned()
        } else {
            slopes[k].jacobian.rows(0, n * channels).into_owned()
        };
        if loads.nrows() == 0 {
            return own;
        }
        let rows = own.nrows();
        let mut all = DMatrix::zeros(rows + 2 * n, own.ncols());
        all.rows_mut(0, rows).copy_from(&own);
        for cell in 0..2 {
            let from = cell_row(windows, k, cell);
            all.rows_mut(rows + cell * n, n).copy_from(&loads.rows(from, n));
        }
        all
    };
    (0..windows.len()).map(one).collect()
}

/// Every block's residuals in the same order.
pub(crate) fn residuals(
    board: &Board<'_>,
    problem: &Problem<'_>,
    x: &[f64],
    pieces: &[Piece],
) -> Vec<DVector<f64>> {
    let loads = problem.cells(x).0;
    let channels = problem.channels();
    let windows = windows(board, problem);
    let one = |k: usize| {
        let window = &windows[k];
        let n = window.len();
        let mut all: Vec<f64> = if board.imposed() {
            pieces[0].residuals[window.first..window.end].to_vec()
        } else {
            pieces[k].residuals[..n * channels].to_vec()
        };
        if !loads.is_empty() {
            for cell in 0..2 {
                let from = cell_row(windows, k, cell);
                all.extend_from_slice(&loads[from..from + n]);
            }
        }
        DVector::from_vec(all)
    };
    (0..windows.len()).map(one).collect()
}

/// The row with which a load cell begins in a window, the cells after one another.
fn cell_row(windows: &[Window], window: usize, cell: usize) -> usize {
    let before = |windows: &[Window]| windows.iter().map(Window::len).sum::<usize>();
    cell * before(windows) + before(&windows[..window])
}

/// The windows of a problem; those of the board where the motion is imposed, which is one run.
fn windows<'a>(board: &'a Board<'_>, problem: &'a Problem<'_>) -> &'a [Window] {
    if board.imposed() { &board.windows } else { &problem.windows }
}

#[cfg(test)]
mod tests {
    use super::{Window, cell_row};
    use crate::{board::Board, walk::made};

    #[test]
    fn the_cells_rows_of_some_windows_follow_one_another() {
        let (rig, data) = (made::rig(2.0), made::data());
        let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let some: Vec<Window> = [1, 4, 6].map(|w| board.windows[w].clone()).into();
        let [a, b, c] = [0, 1, 2].map(|w| some[w].len());
        let rows = [0, 1].map(|cell| [0, 1, 2].map(|w| cell_row(&some, w, cell)));
        assert_eq!(rows, [[0, a, a + b], [a + b + c, 2 * a + b + c, 2 * a + 2 * b + c]]);
    }
}
