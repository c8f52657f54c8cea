//! The score of every effect: what a small amount of it would explain that the free parameters cannot.

use crate::gram::{Gram, Probe};
use identify::effects::{Kind, Shape, Sign};
use nalgebra::{DMatrix, DVector};

/// An effect at its best probe, along the derivative.
#[derive(Debug, Clone)]
pub(crate) struct Scored {
    /// The effect.
    pub(crate) kind: Kind,
    /// Its values, amounts estimated and shapes as probed.
    pub(crate) values: Vec<f64>,
    /// By how much each nominal variable moves with it.
    pub(crate) nominal: Vec<f64>,
    /// By how much the sum of squares falls on the training blocks [1].
    pub(crate) gain: f64,
    /// The sum of squares left in every block [1].
    pub(crate) left: Vec<f64>,
    /// Whether its signs are plausible.
    pub(crate) plausible: bool,
}

impl Scored {
    /// An effect with these values that no derivative tells anything of.
    pub(crate) fn unscored(kind: Kind, values: Vec<f64>) -> Self {
        let (nominal, left) = (Vec::new(), Vec::new());
        Self { kind, values, nominal, gain: 0.0, left, plausible: true }
    }
}

/// How small an amount shows, and what hides it.
#[derive(Debug, Clone)]
pub(crate) struct Visible {
    /// The effect.
    pub(crate) kind: Kind,
    /// The amount that is 5 standard errors [its unit], of its first amount.
    pub(crate) amount: f64,
    /// The free parameter that takes up most of it.
    pub(crate) hidden_by: Option<String>,
}

/// A direction of the free parameters that is this much flatter than the steepest is left alone.
const FLAT: f64 = 1e-10;

/// What changes the sum of squares by so little, in units of the floor, is not seen at all.
const UNSEEN: f64 = 1e-20;

/// The best change along `places` on a Gram matrix whose last column is the residual.
fn best(gram: &DMatrix<f64>, places: &[usize]) -> DVector<f64> {
    let n = places.len();
    if n == 0 {
        return DVector::zeros(0);
    }
    let residual = gram.nrows() - 1;
    let size = |i: &usize| {
        let square = gram[(*i, *i)];
        if square > UNSEEN { square.sqrt() } else { f64::INFINITY }
    };
    let size: Vec<f64> = places.iter().map(size).collect();
    let scaled = DMatrix::from_fn(n, n, |a, b| gram[(places[a], places[b])] / (size[a] * size[b]));
    let right = DVector::from_fn(n, |a, _| -gram[(places[a], residual)] / size[a]);
    let eigen = scaled.symmetric_eigen();
    let along = eigen.eigenvectors.transpose() * right;
    let moved = DVector::from_fn(n, |a, _| {
        if eigen.eigenvalues[a] > FLAT { along[a] / eigen.eigenvalues[a] } else { 0.0 }
    });
    let back = &eigen.eigenvectors * moved;
    DVector::from_fn(n, |a, _| back[a] / size[a])
}

/// The sum of squares after the change `by` along `places`.
fn left(gram: &DMatrix<f64>, places: &[usize], by: &DVector<f64>) -> f64 {
    let r = gram.nrows() - 1;
    let mut sum = gram[(r, r)];
    for (a, i) in places.iter().enumerate() {
        sum += 2.0 * by[a] * gram[(*i, r)];
        for (b, j) in places.iter().enumerate() {
            sum += by[a] * by[b] * gram[(*i, *j)];
        }
    }
    sum.max(0.0)
}

/// All amounts of the only probe together: what they are in their sizes, by how much the sum of squares falls on the
/// training blocks, and what is left in every block. A little is asked of them to be small, for some are seen nowhere.
pub(crate) fn joint(gram: &Gram, trains: &[bool]) -> (Vec<f64>, f64, Vec<f64>) {
    let mut train = gram.held(true, |k| trains[k]);
    let own: Vec<usize> = (0..gram.nominal).collect();
    let without = left(&train, &own, &best(&train, &own));
    let plain = train.clone();
    let probe = &gram.probes[0];
    for column in &probe.columns {
        train[(*column, *column)] *= 1.0 + 1e-3;
    }
    let places: Vec<usize> = own.iter().chain(&probe.columns).copied().collect();
    let by = best(&train, &places);
    let blocks = gram.blocks.iter().map(|block| left(block, &places, &by)).collect();
    let gain = without - left(&plain, &places, &by);
    (by.iter().skip(gram.nominal).copied().collect(), gain, blocks)
}

/// The sum of squares left in every block without any effect, in its one column [1]; `near` as in [`scores`].
pub(crate) fn without(gram: &Gram, near: bool, trains: &[bool]) -> Vec<Vec<f64>> {
    let own: Vec<usize> = (0..gram.nominal).collect();
    let by = best(&gram.held(near, |k| trains[k]), &own);
    gram.blocks.iter().map(|block| vec![left(block, &own, &by)]).collect()
}

/// The effects that would explain something, the best first, each at its best probe and at the best with which it is
/// plausible; `near` says that the model is not far from the truth.
pub(crate) fn scores(gram: &Gram, near: bool, trains: &[bool]) -> Vec<Scored> {
    let train = gram.held(near, |k| trains[k]);
    let own: Vec<usize> = (0..gram.nominal).collect();
    let without = left(&train, &own, &best(&train, &own));
    let mut all: Vec<Scored> =
        gram.probes.iter().map(|probe| score(gram, &train, without, probe)).collect();
    all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let mut seen = Vec::new();
    all.retain(|s| {
        let first = !seen.contains(&(s.kind, s.plausible));
        seen.push((s.kind, s.plausible));
        first
    });
    all
}

/// The Gram matrix where the residual has a whole `column` more.
fn moved(gram: &DMatrix<f64>, column: usize) -> DMatrix<f64> {
    let (mut moved, r) = (gram.clone(), gram.nrows() - 1);
    for i in 0..r {
        moved[(i, r)] += gram[(i, column)];
        moved[(r, i)] = moved[(i, r)];
    }
    moved[(r, r)] += 2.0 * gram[(column, r)] + gram[(column, column)];
    moved
}

/// What does not begin smoothly, as much of it as was tried.
fn as_tried(gram: &Gram, train: &DMatrix<f64>, without: f64, probe: &Probe) -> Scored {
    let own: Vec<usize> = (0..gram.nominal).collect();
    let train = moved(train, probe.columns[0]);
    let by = best(&train, &own);
    let after = |block: &DMatrix<f64>| left(&moved(block, probe.columns[0]), &own, &by);
    let first = probe.kind.about().keys.iter().position(|key| key.shape == Shape::Amount);
    let mut values = probe.values.clone();
    values[first.unwrap_or(0)] = probe.sizes[0];
    Scored {
        kind: probe.kind,
        values,
        nominal: by.iter().copied().collect(),
        gain: without - left(&train, &own, &by),
        left: gram.blocks.iter().map(after).collect(),
        plausible: true,
    }
}

fn score(gram: &Gram, train: &DMatrix<f64>, without: f64, probe: &Probe) -> Scored {
    let places: Vec<usize> = (0..gram.nominal).chain(probe.columns.iter().copied()).collect();
    let by = best(train, &places);
    // A chord says something of what lies along it.
    if !probe.kind.tried().is_empty() && !(0.1..10.0).contains(&by[gram.nominal]) {
        return as_tried(gram, train, without, probe);
    }
    let mut values = probe.values.clone();
    let mut amounts = 0;
    let mut plausible = true;
    for (value, key) in values.iter_mut().zip(probe.kind.about().keys) {
        if key.shape != Shape::Amount {
            continue;
        }
        *value = by[gram.nominal + amounts] * probe.sizes[amounts];
        plausible &= match key.sign {
            Sign::Any => true,
            Sign::Positive => *value >= 0.0,
            Sign::Negative => *value <= 0.0,
        };
        amounts += 1;
    }
    let after = left(train, &places, &by);
    let blocks = gram.blocks.iter().map(|block| left(block, &places, &by)).collect();
    let nominal = by.iter().take(gram.nominal).copied().collect();
    Scored { kind: probe.kind, values, nominal, gain: without - after, left: blocks, plausible }
}

/// The smallest amounts that would show on this record, at five standard errors.
pub(crate) fn detectability(gram: &Gram) -> Vec<Visible> {
    let all = gram.sum(|_| true);
    let mut found: Vec<Visible> = Vec::new();
    for probe in &gram.probes {
        if found.iter().any(|v| v.kind == probe.kind) {
            continue;
        }
        let column = probe.columns[0];
        let whole = all[(column, column)];
        let as_residual = |j: usize| {
            let mut places: Vec<usize> = (0..gram.nominal).filter(|i| *i != j).collect();
            places.push(column);
            places
        };
        let own: Vec<usize> = (0..gram.nominal).collect();
        let rest = projected(&all, column, &own);
        let shares = (0..gram.nominal).map(|j| {
            let without = as_residual(j);
            projected(&all, column, &without[..without.len() - 1])
        });
        let hidden_by = shares
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|(_, left)| *left > 1.5 * rest && rest < 0.9 * whole)
            .map(|(j, _)| gram.names[j].clone());
        let amount = 5.0 * probe.sizes[0] / rest.max(1e-300).sqrt();
        found.push(Visible { kind: probe.kind, amount, hidden_by });
    }
    found
}

/// What is left of a column's square when `places` are projected out.
fn projected(gram: &DMatrix<f64>, column: usize, places: &[usize]) -> f64 {
    let n = places.len();
    let mut small = DMatrix::zeros(n + 1, n + 1);
    let index: Vec<usize> = places.iter().copied().chain([column]).collect();
    for (a, i) in index.iter().enumerate() {
        for (b, j) in index.iter().enumerate() {
            small[(a, b)] = gram[(*i, *j)];
        }
    }
    let own: Vec<usize> = (0..n).collect();
    left(&small, &own, &best(&small, &own))
}

#[cfg(test)]
mod tests {
    use super::{best, scores};
    use crate::gram::{Gram, Probe};
    use identify::effects::Kind;
    use nalgebra::DMatrix;

    #[test]
    fn a_probe_of_the_wrong_sign_hides_none_of_the_right_one() {
        let probe = |column: usize, v_s: f64| Probe {
            kind: Kind::Stribeck,
            values: vec![0.0, v_s],
            columns: vec![column],
            sizes: vec![1.0],
        };
        // The first takes 90 away with a drop of -3, the second 80 with one of 2.83.
        let (a, b) = (30.0, -800_f64.sqrt());
        let block = DMatrix::from_row_slice(3, 3, &[10., 0., a, 0., 10., b, a, b, 400.]);
        let gram = Gram {
            nominal: 0,
            names: Vec::new(),
            prior: Vec::new(),
            residuals: 100.0,
            probes: vec![probe(0, 0.2), probe(1, 0.01)],
            blocks: vec![block],
        };
        let all = scores(&gram, false, &[true]);
        assert!((all[0].gain - 90.0).abs() < 1e-9 && !all[0].plausible, "{all:?}");
        assert!((all[1].gain - 80.0).abs() < 1e-9 && all[1].plausible, "{all:?}");
        assert!((all[1].values[0] - 8_f64.sqrt()).abs() < 1e-9, "{all:?}");
    }

    #[test]
    fn what_is_not_seen_does_not_move() {
        // The second column is what rounding leaves of one that is zero.
        let gram =
            DMatrix::from_row_slice(3, 3, &[10., 0., 30., 0., 1e-290, 1e-160, 30., 1e-160, 400.]);
        let by = best(&gram, &[0, 1]);
        assert!((by[0] + 3.0).abs() < 1e-12 && by[1] == 0.0, "{by}");
    }
}
