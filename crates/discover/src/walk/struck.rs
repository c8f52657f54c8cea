//! Whether something acts for a while only.

use super::{Walk, left::channels};

/// So many neighbouring blocks, so many times as far off as the middle one, are no chance: on the records looked at with
/// nothing missing three in a row come to 1.9 times at most, in whichever channel.
const LASTING: usize = 3;
pub(super) const STRUCK: f64 = 4.0;

/// And so many anywhere, so many times as far off: a right model of 18 records at which this was looked at left one at 4.
const SCATTERED: usize = 3;
const APART: f64 = 10.0;

/// The noise of an imposed displacement has moved a force that spreads by so many times the noise of its own sensor.
const LOST: f64 = 3.0;

impl Walk<'_> {
    /// Whether something acts for a while only: some neighbouring blocks are far worse than the middle one, or several
    /// anywhere by more. A single one may have gone astray, and so may all through which an imposed motion rests.
    pub(super) fn struck(&self) -> bool {
        let adrift = self.adrift();
        let told = |channel: usize| {
            let blocks = self.channel(&self.best, channel).into_iter().zip(&adrift);
            blocks.map(|(left, adrift)| if *adrift { 0.0 } else { left }).collect::<Vec<f64>>()
        };
        (0..channels(&self.best))
            .map(told)
            .any(|blocks| run(&blocks) > STRUCK || scattered(&blocks))
    }

    /// In which blocks the force of an imposed motion is what the noise of the displacement made of it: where it rests the
    /// contact keeps what it was left with, so that all samples of the rest are off by the same.
    fn adrift(&self) -> Vec<bool> {
        let (board, mut adrift) = (&self.board, vec![false; self.board.trains.len()]);
        for (w, window) in board.windows.iter().enumerate().filter(|_| board.imposed()) {
            let spread = board.spread.get(window.first..window.end).unwrap_or_default();
            let many = spread.iter().filter(|own| **own > LOST * board.weights.force).count();
            adrift[board.block(w)] |= 2 * many > window.len();
        }
        adrift
    }
}

/// The middle one of some numbers.
pub(super) fn middle(all: &[f64]) -> Option<f64> {
    let mut sorted = all.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// So many times the middle of the blocks all of some neighbouring ones are far off at least [1].
pub(super) fn run(blocks: &[f64]) -> f64 {
    let Some(middle) = middle(blocks) else { return 0.0 };
    let least = |run: &[f64]| run.iter().copied().fold(f64::INFINITY, f64::min);
    blocks.windows(LASTING).map(least).fold(0.0, f64::max) / middle.max(1.0)
}

/// Whether several blocks are far off, wherever they are.
fn scattered(blocks: &[f64]) -> bool {
    let Some(middle) = middle(blocks) else { return false };
    let far = |block: &&f64| **block > APART * middle.max(1.0);
    blocks.iter().filter(far).count() >= SCATTERED
}

#[cfg(test)]
mod tests {
    use super::{super::made, run, scattered};

    #[test]
    fn several_blocks_that_are_far_off_anywhere_went_not_astray() {
        let with = |far: &[usize]| -> Vec<f64> {
            (0..30).map(|k| if far.contains(&k) { 30.0 } else { 0.9 }).collect()
        };
        assert!(scattered(&with(&[3, 11, 20])) && !scattered(&with(&[3, 11])) && !scattered(&[]));
        assert!(run(&with(&[3, 11, 20])) < 1.0);
        let near: Vec<f64> = with(&[3, 11, 20]).iter().map(|b| b.min(9.0)).collect();
        assert!(!scattered(&near));
    }

    #[test]
    fn a_rest_in_which_an_imposed_motion_left_a_force_strikes_nothing() {
        let data = made::slide(0.0);
        let mut walk = made::walk(&made::slides(1.5), &data, &[]);
        for block in &mut walk.best.blocks[4..7] {
            block[0] *= 30.0;
        }
        assert!(walk.struck());
        // A force that spreads as far there as the noise of the displacement moves it.
        let force = walk.board.weights.force;
        walk.board.spread.resize(data.time.len(), 0.0);
        for window in 4..7 {
            let own = &walk.board.windows[window];
            walk.board.spread[own.first..own.end].fill(30.0 * force);
        }
        assert!(!walk.struck());
        // Without two of them the third alone is one that went astray.
        let own = &walk.board.windows[6];
        walk.board.spread[own.first..own.end].fill(0.1 * force);
        assert!(!walk.struck());
    }

    #[test]
    fn what_lasts_for_three_blocks_is_no_block_gone_astray() {
        let with = |far: &[usize]| -> Vec<f64> {
            (0..40).map(|k| if far.contains(&k) { 30.0 } else { 0.9 }).collect()
        };
        assert!((run(&with(&[7, 8, 9])) - 30.0).abs() < 1e-12);
        assert!(run(&with(&[7, 8, 10, 20])) < 1.0, "never three in a row");
        // Where half of the blocks are far off the middle one is, too.
        assert!((run(&with(&(0..30).collect::<Vec<usize>>())) - 1.0).abs() < 1e-12);
        assert!(run(&[]) < 1.0);
    }
}
