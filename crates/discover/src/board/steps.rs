//! How long the steps of a simulation may be.

use super::{Board, Fitted};
use identify::fit::{FitError, models, problem::Piece};

/// The longest steps.
pub(super) const LONGEST: f64 = 1e-2;

/// What the steps may be wrong by, of the spans: the coarsest is taken with which the motion is right.
const TOLERANCES: [f64; 7] = [LONGEST, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];

/// By how much of the noise nine tenths of the samples may be off because of the steps: while effects are looked at far
/// from the floor, and else.
pub(crate) const ROUGH: f64 = 0.6;
pub(crate) const FINE: f64 = 0.2;

/// One block in so many is looked at for that.
const LOOKED_AT: usize = 4;

/// By how much nine tenths of the residuals of two simulations differ at most [1].
fn apart(a: &[Piece], b: &[Piece]) -> f64 {
    let pairs = a.iter().zip(b).flat_map(|(a, b)| a.residuals.iter().zip(&b.residuals));
    let mut off: Vec<f64> = pairs.map(|(a, b)| (a - b).abs()).collect();
    if off.is_empty() {
        return 0.0;
    }
    let place = off.len() * 9 / 10;
    *off.select_nth_unstable_by(place, f64::total_cmp).1
}

/// So many times as many steps are shorter ones.
const SHORTER: f64 = 1.2;

/// How many steps all motions have together.
fn steps(pieces: &[Piece]) -> f64 {
    pieces.iter().map(|p| p.motion.tape.steps() as f64).sum()
}

impl Board<'_> {
    /// Takes the longest steps with which a model's residuals are off by less than this `share` of what they are: of
    /// the noise, or of what the model leaves if that is more.
    pub(crate) fn refine(&mut self, fitted: &Fitted, share: f64) -> Result<(), FitError> {
        if self.imposed() {
            return Ok(());
        }
        let share = share * self.trained_level(fitted).sqrt().max(1.0);
        let rig = fitted.held();
        // Some of the windows are enough.
        let some = |k: usize| k.is_multiple_of(LOOKED_AT);
        let starts: Vec<Piece> = (0..self.windows.len())
            .filter(|w| some(self.block(*w)))
            .map(|w| fitted.pieces[w].clone())
            .collect();
        let mut last: Option<Vec<Piece>> = None;
        for (k, tolerance) in TOLERANCES.into_iter().enumerate() {
            self.tolerance = tolerance;
            let problem = self.problem(&rig, some)?;
            let pieces = models::settled(&problem, &[], Some(&starts), 0);
            // Two motions whose steps are both as long as the sampling time say nothing of each other.
            let shorter = |last: &Vec<Piece>| steps(&pieces) > SHORTER * steps(last);
            if last.as_ref().is_some_and(|last| shorter(last) && apart(last, &pieces) < share) {
                self.tolerance = TOLERANCES[k - 1];
                break;
            }
            last = Some(pieces);
        }
        Ok(())
    }

    /// The same as often as a model's residuals get smaller with the steps; the model as it is seen with them.
    pub(crate) fn refined(&mut self, fitted: &Fitted, share: f64) -> Result<Fitted, FitError> {
        let mut fitted = fitted.clone();
        for _ in 0..TOLERANCES.len() {
            let before = self.tolerance;
            self.refine(&fitted, share)?;
            let finer = self.tolerance < before;
            fitted = self.again(&fitted)?;
            if !finer {
                break;
            }
        }
        Ok(fitted)
    }

    /// The mean squared residual on the training blocks, by their logarithms [1].
    pub(crate) fn trained_level(&self, fitted: &Fitted) -> f64 {
        let samples = self.samples();
        let trained: Vec<f64> = (0..self.trains.len())
            .filter(|k| self.trains[*k])
            .map(|k| {
                let block = &fitted.blocks[k];
                let mean = block.iter().sum::<f64>() / (samples[k] * block.len() as f64);
                mean.max(f64::MIN_POSITIVE).ln()
            })
            .collect();
        (trained.iter().sum::<f64>() / trained.len().max(1) as f64).exp()
    }
}
