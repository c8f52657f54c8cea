//! Where models go in one step, and what they may leave there.

use super::{Board, Fitted, with_values};
use crate::gram;
use identify::{
    Rig,
    effects::Kind,
    fit::{FitError, models, problem::Piece, starts},
};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Some of the training blocks are looked at, but no fewer than so many.
const LEAST: usize = 4;

/// A window is worth its logarithm: that is told so often.
const TIMES: usize = 4;

/// A model beside another one: what it leaves [1] as the mean logarithm of the windows' mean squares, once what is free in
/// the other one has gone one step.
#[derive(Debug, Clone)]
pub(crate) struct Ahead {
    /// What it leaves, as a logarithm [1].
    pub(crate) far: f64,
    /// The kind of what it has more.
    pub(crate) kind: Kind,
    /// Its place among what was tried.
    pub(crate) place: usize,
    /// The model, moved.
    pub(crate) rig: Rig,
}

impl Board<'_> {
    /// Models that have something more than `point`, each with what is free in that moved by one step of Gauss and
    /// Newton's method along its derivatives there, the nearest first; and what `point` itself leaves.
    pub(crate) fn ahead(
        &self,
        point: &Fitted,
        rigs: &[(Kind, Rig)],
    ) -> Result<(f64, Vec<Ahead>), FitError> {
        if rigs.is_empty() {
            return Ok((f64::INFINITY, Vec::new()));
        }
        let taken = self.few(LEAST);
        let own = self.problem(&point.rig, |k| taken.contains(&k))?;
        let there = (0..self.windows.len()).filter(|w| taken.contains(&self.block(*w)));
        let pieces: Vec<Piece> = there.map(|w| point.pieces[w].clone()).collect();
        let slopes = gram::jacobians(self, &own, &point.x, &pieces);
        let prior = gram::prior(&own);
        let left = gram::residuals(self, &own, &point.x, &pieces);
        let (_, alone) = step(&slopes, &left, &prior);
        let one = |(place, (kind, rig)): (usize, &(Kind, Rig))| {
            let held = Fitted::holding(rig);
            let problem = self.problem(&held, |k| taken.contains(&k)).ok()?;
            let pieces = models::settled(&problem, &[], Some(&pieces), 1);
            let left = gram::residuals(self, &problem, &[], &pieces);
            let (step, far) = step(&slopes, &left, &prior);
            Some(Ahead { far, kind: *kind, place, rig: self.moved(rig, &step).ok()? })
        };
        let mut all: Vec<Ahead> = rigs.par_iter().enumerate().filter_map(one).collect();
        all.sort_by(|a, b| a.far.total_cmp(&b.far));
        Ok((alone, all))
    }

    /// `rig` with its first variables moved by a step.
    fn moved(&self, rig: &Rig, step: &DVector<f64>) -> Result<Rig, FitError> {
        let problem = self.problem(rig, |_| false)?;
        let mut x = starts::nominal(&problem);
        for (x, step) in x.iter_mut().zip(step.iter()) {
            *x += step;
        }
        Ok(with_values(rig, &problem, &x))
    }
}

/// The mean logarithm of the windows' mean squares [1].
fn far(left: &[DVector<f64>]) -> f64 {
    let mean = |r: &DVector<f64>| r.norm_squared() / r.len().max(1) as f64;
    let logarithms = left.iter().map(|r| mean(r).max(f64::MIN_POSITIVE).ln());
    logarithms.sum::<f64>() / left.len().max(1) as f64
}

/// The step along the `slopes` of all windows after which least is left, if they are straight, and how much that is.
fn step(slopes: &[DMatrix<f64>], left: &[DVector<f64>], prior: &[f64]) -> (DVector<f64>, f64) {
    let mut best = (DVector::zeros(prior.len()), far(left));
    let mut now = left.to_vec();
    for _ in 0..TIMES {
        let mut square = DMatrix::from_diagonal(&DVector::from_column_slice(prior));
        let mut side = DVector::zeros(prior.len());
        for ((slope, r), now) in slopes.iter().zip(left).zip(&now) {
            let worth = (now.norm_squared() / now.len().max(1) as f64).max(1.0);
            square += slope.tr_mul(slope) / worth;
            side -= slope.tr_mul(r) / worth;
        }
        let Some(step) = square.cholesky().map(|c| c.solve(&side)) else { break };
        now = slopes.iter().zip(left).map(|(slope, r)| r + slope * &step).collect();
        let far = far(&now);
        if far < best.1 {
            best = (step, far);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::walk::made::{BIAS, data, rig, with};
    use identify::fit::Data;

    /// From a mass that is 2 % off, all amounts of a bias that were tried, the nearest first, with what is left and the
    /// mass; and what is left without a bias.
    fn biases(data: &Data, tried: &[f64]) -> (f64, Vec<[f64; 3]>) {
        let rig = Rig { free: vec!["mass".to_owned()], ..rig(2.04) };
        let board = Board::of(&rig, data, 1, Vec::new()).unwrap();
        let point = board.judged(&rig, None).unwrap();
        let kind = Kind::CurrentBias;
        let all: Vec<_> = tried.iter().map(|bias| (kind, with(&rig, kind, &[*bias]))).collect();
        let (alone, all) = board.ahead(&point, &all).unwrap();
        let one = |a: Ahead| {
            let value = |name: &str| a.rig.value(name).unwrap();
            [value("current_bias.bias"), a.far, value("mass")]
        };
        (alone, all.into_iter().map(one).collect())
    }

    #[test]
    fn what_goes_along_with_the_model_is_nearest() {
        let tried = [0.5, 0.0, 1.0, 2.0].map(|share| share * BIAS);
        let (alone, all) = biases(&data(), &tried);
        let amounts: Vec<f64> = all.iter().map(|a| a[0]).collect();
        assert_eq!(amounts[0], BIAS, "of {amounts:?}");
        let [_, far, mass] = all[0];
        // A right model leaves what the noise does.
        assert!(far.exp() < 1.3 && alone.exp() > 3.0, "{} and {}", far.exp(), alone.exp());
        assert!((mass - 2.0).abs() < 0.005, "{mass} kg");
        let nothing = all.iter().find(|a| a[0] == 0.0).unwrap();
        assert!((nothing[1] - alone).abs() < 1e-6, "{} and {alone}", nothing[1]);
    }

    #[test]
    fn a_window_that_was_struck_does_not_lead() {
        let mut data = data();
        // Ten newtons for half a second.
        for (u, t) in data.input.iter_mut().zip(&data.time) {
            *u += if (8.0..8.5).contains(t) { 10.0 } else { 0.0 };
        }
        let (_, all) = biases(&data, &[0.5 * BIAS, BIAS]);
        let [bias, _, mass] = all[0];
        assert!(bias == BIAS && (mass - 2.0).abs() < 0.01, "{bias} N, {mass} kg");
    }
}
