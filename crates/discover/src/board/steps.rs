//! How long the steps of a simulation may be.

use super::{Board, Fitted};
use identify::fit::{FitError, models, problem::Piece};

/// The longest steps.
pub(super) const LONGEST: f64 = 1e-2;

/// What the steps may be wrong by, of the spans: the coarsest is taken with which the motion is right.
const TOLERANCES: [f64; 7] = [LONGEST, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];

/// By how much of the noise most of the samples may be off because of the steps: while effects are looked at far
/// from the floor, and else.
pub(crate) const ROUGH: f64 = 0.6;
pub(crate) const FINE: f64 = 0.2;

/// At the floor, where what is left is below this, they may be off by so much of that: a fifth of the noise is a twenty-
/// fifth of its square, many standard errors of what ten thousand samples say.
const AT_FLOOR: f64 = 2.0;
const LESS: f64 = 0.25;

/// By how much of the noise a sample may be off for a `share` of what a model leaves, so many floors [1].
fn allowed(share: f64, level: f64) -> f64 {
    share * if level < AT_FLOOR { LESS } else { level.sqrt() }
}

/// One block in so many is looked at for that.
const LOOKED_AT: usize = 4;

/// By how much two simulations differ [1]: nine tenths of their residuals by no more than this, and half of their windows
/// by no more in the root mean square. Where a contact breaks away a few residuals differ most, and may be most of what a
/// window leaves; one window that goes another way says nothing.
fn apart(a: &[Piece], b: &[Piece]) -> f64 {
    let off = |(a, b): (&Piece, &Piece)| -> Vec<f64> {
        a.residuals.iter().zip(&b.residuals).map(|(a, b)| (a - b).abs()).collect()
    };
    let all: Vec<Vec<f64>> = a.iter().zip(b).map(off).collect();
    let mean =
        |off: &Vec<f64>| (off.iter().map(|d| d * d).sum::<f64>() / off.len().max(1) as f64).sqrt();
    let windows = all.iter().map(mean).collect();
    largest_of(all.concat(), 0.9).max(largest_of(windows, 0.5))
}

/// The value that this share of all do not exceed; 0 if there are none.
fn largest_of(mut all: Vec<f64>, share: f64) -> f64 {
    if all.is_empty() {
        return 0.0;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below the length")]
    let place = ((all.len() as f64 * share) as usize).min(all.len() - 1);
    *all.select_nth_unstable_by(place, f64::total_cmp).1
}

/// So many times as many steps are shorter ones.
const SHORTER: f64 = 1.2;

/// So many times as many steps are shorter ones all along.
const HALVED: f64 = 2.0;

/// What shorter steps all along move the motions by is no more than so much of what longer ones did, if it is the steps that
/// these are wrong by: a tenth of the tolerance is a fifth of the error of a method of the second order. Where a load meets
/// its tooth elsewhere in every simulation a hundred times the steps say no more than a few.
const FALLS: f64 = 0.7;

/// So often in turn: steps as long as the sampling time say little of what a hundredth of them would, for a mass that rings on
/// its bristles faster than it is sampled (8014048: 101 floors of the truth, 0.87 with steps a hundred times as many).
const IN_VAIN: usize = 2;

/// How many steps all motions have together.
fn steps(pieces: &[Piece]) -> f64 {
    pieces.iter().map(|p| p.motion.tape.steps() as f64).sum()
}

/// Whether the motions `now` are no better than the `last` ones, which had longer steps: they differ by less than this
/// `share`, or one that could be followed no longer can, for it takes more steps than there are.
fn no_better(last: &[Piece], now: &[Piece], share: f64) -> bool {
    let lost = |pieces: &[Piece]| pieces.iter().filter(|p| p.motion.tape.steps() == 0).count();
    // Two motions whose steps are both as long as the sampling time say nothing of each other.
    let shorter = steps(now) > SHORTER * steps(last);
    lost(now) > lost(last) || shorter && apart(last, now) < share
}

/// Whether shorter steps, which move the motions by so much `now`, come no nearer to the truth than longer ones did, where
/// those before them `moved` the motions by that; what is below the `share` is near enough.
fn no_truer(moved: f64, now: f64, share: f64) -> bool {
    now > share && now > FALLS * moved
}

/// How often in turn shorter steps came no nearer, after these as well.
fn vainly(before: usize, [moved, now]: [f64; 2], share: f64) -> usize {
    if no_truer(moved, now, share) { before + 1 } else { 0 }
}

impl Board<'_> {
    /// Takes the longest steps with which a model's residuals are off by less than this `share` of what they are: of
    /// the noise, or of what the model leaves if that is more; or those before the first with which it cannot be followed.
    pub(crate) fn refine(&mut self, fitted: &Fitted, share: f64) -> Result<(), FitError> {
        if self.imposed() {
            return Ok(());
        }
        let share = allowed(share, self.trained_level(fitted));
        let rig = fitted.held();
        // Some of the windows are enough.
        let some = |k: usize| k.is_multiple_of(LOOKED_AT);
        let starts: Vec<Piece> = (0..self.windows.len())
            .filter(|w| some(self.block(*w)))
            .map(|w| fitted.pieces[w].clone())
            .collect();
        let mut last: Option<Vec<Piece>> = None;
        let mut moved = f64::INFINITY;
        let mut in_vain = 0;
        for (k, tolerance) in TOLERANCES.into_iter().enumerate() {
            self.tolerance = tolerance;
            let problem = self.problem(&rig, some)?;
            let pieces = models::settled(&problem, &[], Some(&starts), 0);
            if let Some(last) = &last {
                let now = apart(last, &pieces);
                in_vain = vainly(in_vain, [moved, now], share);
                if no_better(last, &pieces, share) || in_vain == IN_VAIN {
                    self.tolerance = TOLERANCES[k - 1];
                    break;
                }
                let halved = steps(&pieces) > HALVED * steps(last);
                moved = if halved { now } else { f64::INFINITY };
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

#[cfg(test)]
mod tests {
    use super::{Board, FINE, IN_VAIN, Piece, allowed, apart, no_better, no_truer, vainly};
    use crate::walk::made;
    use identify::{fit::window::START, march::Motion};

    /// So many windows of a hundred residuals each, three of them off in the first few windows.
    fn windows(far: usize) -> Vec<Piece> {
        let residuals = |w: usize| (0..100).map(move |i| if w < far && i < 3 { 4.0 } else { 0.0 });
        let one = |w: usize| Piece {
            start: [0.0; START],
            motion: Motion::default(),
            residuals: residuals(w).collect(),
        };
        (0..40).map(one).collect()
    }

    #[test]
    fn a_few_residuals_that_differ_in_half_of_the_windows_ask_for_shorter_steps() {
        let still = windows(0);
        // √(3 · 16/100) of what noise leaves, though 97 of 100 residuals are the same.
        assert!((apart(&still, &windows(40)) - 0.48_f64.sqrt()).abs() < 1e-12);
        assert!(apart(&still, &windows(22)) > FINE);
        assert_eq!(apart(&still, &windows(5)), 0.0, "what went another way says nothing");
        assert_eq!(apart(&[], &[]), 0.0);
    }

    #[test]
    fn steps_with_which_a_motion_can_no_longer_be_followed_are_too_short() {
        let data = made::data();
        let mut board = Board::of(&made::rig(2.0), &data, 1, Vec::new()).unwrap();
        let fitted = board.judged(&made::rig(2.0), None).unwrap();
        board.tolerance = 1e-8;
        let (longer, shorter) = (fitted.pieces.clone(), board.again(&fitted).unwrap().pieces);
        assert!(no_better(&longer, &shorter, FINE), "they are as good");
        assert!(!no_better(&longer, &shorter, 1e-12));
        let mut lost = shorter.clone();
        lost[3].motion = Motion::default();
        assert!(no_better(&longer, &lost, 1e-12));
        assert!(!no_better(&lost, &shorter, 1e-12), "it is found again");
        assert!(!no_better(&longer, &longer, FINE), "the same steps say nothing");
    }

    #[test]
    fn steps_that_bring_motions_no_nearer_to_each_other_are_short_enough() {
        // A contact: each tenth of the tolerance moves its motion by a fifth.
        assert!(!no_truer(f64::INFINITY, 5.0, 0.05) && !no_truer(5.0, 1.0, 0.05));
        // The load of 8012016, which meets its tooth elsewhere in every simulation.
        assert!(!no_truer(5.74, 2.14, 0.05) && no_truer(2.14, 2.85, 0.05));
        assert!(!no_truer(0.01, 0.04, 0.05), "near enough");
    }

    #[test]
    fn long_steps_that_say_little_of_each_other_are_not_given_up() {
        // What a tenth of the tolerance moves the motions by, again and again, and how often it was tried then.
        let tried = |moved: &[f64]| {
            let (mut last, mut in_vain) = (f64::INFINITY, 0);
            for (k, now) in moved.iter().enumerate() {
                in_vain = vainly(in_vain, [last, *now], 2.0);
                if in_vain == IN_VAIN {
                    return k + 1;
                }
                last = *now;
            }
            moved.len()
        };
        // 8014048, and a load that meets its tooth elsewhere in every simulation.
        assert_eq!(tried(&[48.5, 46.6, 18.7, 5.6, 1.7]), 5);
        assert_eq!(tried(&[5.74, 2.14, 2.85, 2.9, 2.7]), 4);
    }

    #[test]
    fn what_steps_leave_at_the_floor_is_no_effect() {
        // In squared standard errors of a record of twelve thousand samples: six of them are worth no name.
        let left = 12_000.0 * allowed(FINE, 1.0).powi(2);
        assert!(left < 36.0, "{left}");
        assert!(
            (allowed(FINE, 9.0) - 3.0 * FINE).abs() < 1e-12,
            "far off it is a share of what is left"
        );
    }
}
