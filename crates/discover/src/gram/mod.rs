//! The derivatives of all residuals by what is free and by what may be missing, as one Gram matrix a block.

mod rows;
mod spreads;

use crate::board::{Board, Fitted, SOFT};
use identify::{
    Effect, Rig,
    effects::{Context, Key, Kind, LAWS, Shape},
    fit::{
        FitError,
        binding::Scale,
        models,
        problem::{Along, Problem},
    },
};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
pub(crate) use rows::{beside, jacobians, residuals};
pub(crate) use spreads::spreads;

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
    own.free.retain(|name| !board.holds(name));
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

/// How many columns one pass over the record carries at most.
const PASS: usize = 15;

/// How many amounts an effect has.
fn amounts(kind: Kind) -> usize {
    kind.about().keys.iter().filter(|key| key.shape == Shape::Amount).count()
}

/// Effects at their probes, so many together that one pass over the record carries all of their amounts.
fn passes(all: &[(Kind, Vec<f64>)]) -> Vec<Vec<&(Kind, Vec<f64>)>> {
    let mut passes: Vec<(usize, Vec<&(Kind, Vec<f64>)>)> = Vec::new();
    for one in all {
        let many = amounts(one.0);
        match passes.iter_mut().find(|(taken, _)| taken + many <= PASS) {
            Some((taken, pass)) => {
                *taken += many;
                pass.push(one);
            }
            None => passes.push((many, vec![one])),
        }
    }
    passes.into_iter().map(|(_, pass)| pass).collect()
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
        let Own { names, prior, along, columns, residuals } = Own::of(board, fitted)?;
        let nominal = names.len();
        let mut columns: Vec<Vec<DMatrix<f64>>> = columns.into_iter().map(|j| vec![j]).collect();
        let (smooth, joints): (Vec<_>, Vec<_>) = lacking
            .into_iter()
            .filter(|(kind, _)| has_amount(*kind))
            .partition(|(kind, _)| kind.tried().is_empty());
        let each = |(kind, probes): (Kind, Vec<Vec<f64>>)| {
            probes.into_iter().map(move |probe| (kind, probe))
        };
        let all: Vec<(Kind, Vec<f64>)> = smooth.into_iter().flat_map(each).collect();
        let (mut probes, mut place): (Vec<Probe>, _) = (Vec::new(), nominal);
        for pass in passes(&all) {
            let mut rig = Rig { free: Vec::new(), ..fitted.rig.clone() };
            let first = probes.len();
            for (kind, probe) in pass {
                let n = amounts(*kind);
                let values = with(&mut rig, *kind, probe, probes.len() + 1);
                let columns = (place..place + n).collect();
                probes.push(Probe { kind: *kind, values, columns, sizes: vec![1.0; n] });
                place += n;
            }
            let problem = board.problem(&rig, |_| true)?;
            let mut sizes = problem.free.iter().map(|f| f.slope(0.0));
            for probe in &mut probes[first..] {
                probe.sizes.fill_with(|| sizes.next().unwrap_or(1.0));
            }
            let more = beside(board, &problem, &vec![0.0; problem.free.len()], &along);
            columns.iter_mut().zip(more).for_each(|(own, more)| own.push(more));
        }
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
        let count = residuals.iter().map(|r| r.len() as f64).sum();
        let windows = columns.par_iter().zip(residuals);
        let windows = windows.map(|(own, r)| gram(&own.iter().collect::<Vec<_>>(), &r));
        let blocks = folded(board, windows.collect());
        Ok(Self { nominal, names, prior, residuals: count, probes, blocks })
    }

    /// Of a fitted model alone.
    pub(crate) fn alone(board: &Board<'_>, fitted: &Fitted) -> Result<Self, FitError> {
        Own::of(board, fitted)?.with(board, &fitted.held())
    }

    /// Of a fitted model and all that each of the `rigs` has free beside it, as one probe.
    pub(crate) fn beside(
        board: &Board<'_>,
        fitted: &Fitted,
        rigs: &[Rig],
    ) -> Result<Vec<Self>, FitError> {
        let own = Own::of(board, fitted)?;
        rigs.iter().map(|rig| own.with(board, rig)).collect()
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

/// The derivatives by what is free in a fitted model, and what it leaves, window by window.
struct Own<'f> {
    names: Vec<String>,
    prior: Vec<f64>,
    along: Vec<Along<'f>>,
    columns: Vec<DMatrix<f64>>,
    residuals: Vec<DVector<f64>>,
}

impl<'f> Own<'f> {
    fn of(board: &Board<'_>, fitted: &'f Fitted) -> Result<Self, FitError> {
        let problem = board.problem(&fitted.rig, |_| true)?;
        let along = problem.all_along(&fitted.x, &fitted.pieces);
        Ok(Self {
            names: problem.free.iter().map(|f| f.name.clone()).collect(),
            prior: prior(&problem),
            columns: beside(board, &problem, &fitted.x, &along),
            along,
            residuals: residuals(board, &problem, &fitted.x, &fitted.pieces),
        })
    }

    /// With all that `rig` has free, as one probe.
    fn with(&self, board: &Board<'_>, rig: &Rig) -> Result<Gram, FitError> {
        let problem = board.problem(rig, |_| true)?;
        let sizes: Vec<f64> = problem.free.iter().map(|f| f.slope(0.0)).collect();
        let more = beside(board, &problem, &vec![0.0; sizes.len()], &self.along);
        let windows = self.columns.par_iter().zip(more).zip(&self.residuals);
        let windows = windows.map(|((own, more), r)| gram(&[own, &more], r)).collect();
        Ok(Gram {
            nominal: self.names.len(),
            names: self.names.clone(),
            prior: self.prior.clone(),
            residuals: self.residuals.iter().map(|r| r.len() as f64).sum(),
            probes: vec![crate::maps::probe(self.names.len(), sizes)],
            blocks: folded(board, windows),
        })
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

fn gram(columns: &[&DMatrix<f64>], residual: &DVector<f64>) -> DMatrix<f64> {
    let rows = residual.len();
    let all: usize = columns.iter().map(|part| part.ncols()).sum();
    let mut joined = DMatrix::zeros(rows, all + 1);
    let mut first = 0;
    for part in columns {
        joined.columns_mut(first, part.ncols()).copy_from(*part);
        first += part.ncols();
    }
    joined.set_column(all, residual);
    // Faster than its `tr_mul`, which goes column by column.
    joined.transpose() * joined
}

#[cfg(test)]
mod tests {
    use super::{Gram, PASS, has_amount, lacking, passes, with};
    use crate::{
        board::{Board, Fitted},
        model,
        walk::made,
    };
    use identify::effects::Kind;

    #[test]
    fn what_is_beside_an_effect_changes_none_of_its_derivatives() {
        let data = made::data();
        let board = &Board::of(&made::rig(2.0), &data, 1, Vec::new()).unwrap();
        let fitted = &board.judged(&made::rig(2.0), None).unwrap();
        let context = &model::context(board, fitted);
        let gram = Gram::of(board, fitted, (context, false)).unwrap();
        let lacking = lacking(board, &fitted.rig, context).into_iter();
        let smooth = lacking.filter(|(kind, _)| has_amount(*kind) && kind.tried().is_empty());
        let each = |(kind, own): (Kind, Vec<_>)| own.into_iter().map(move |probe| (kind, probe));
        let all: Vec<(Kind, Vec<f64>)> = smooth.flat_map(each).collect();
        assert_eq!(gram.probes.len(), all.len());
        let columns: Vec<usize> = gram.probes.iter().flat_map(|p| p.columns.clone()).collect();
        assert!(columns.iter().copied().eq(gram.nominal..gram.nominal + columns.len()));
        let passes = passes(&all);
        assert!(passes.len() > 1 && passes.iter().all(|pass| pass.len() <= PASS));
        let squares = gram.sum(|_| true);
        for (own, (kind, probe)) in gram.probes.iter().zip(passes.into_iter().flatten()) {
            let mut rig = Fitted::holding(&fitted.rig);
            let values = with(&mut rig, *kind, probe, 0);
            assert_eq!((own.kind, &own.values), (*kind, &values));
            let problem = board.problem(&rig, |_| true).unwrap();
            let alone = problem.all_slopes(&vec![0.0; own.columns.len()], &fitted.pieces);
            for (place, column) in own.columns.iter().enumerate() {
                let own = problem.windows.iter().zip(&alone).map(|(window, slopes)| {
                    slopes.jacobian.rows(0, window.len()).column(place).norm_squared()
                });
                let sum: f64 = own.sum();
                let beside = squares[(*column, *column)];
                assert!((beside - sum).abs() <= 1e-9 * sum, "{kind:?}: {beside}, alone {sum}");
            }
        }
    }
}
