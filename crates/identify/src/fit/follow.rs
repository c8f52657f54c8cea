//! How the starts of the windows follow the parameters.

use super::{
    descent::{GOOD, LONGER, POOR, SHORTER},
    piece::{Lead, Piece},
    problem::Problem,
    window::{START, Window},
};
use rayon::prelude::*;

/// What gains no more than this share of a misfit [1], or than this, is not worth another step of a start.
const SHARE: f64 = 0.02;
const LITTLE: f64 = 0.1;

/// The first share of a window in which its start is looked for, how many times farther, and how far off a motion is that
/// has gone another way [standard deviations].
const EARLY: usize = 16;
const LENGTHS: usize = 20;
const GONE: f64 = 20.0;

impl Problem<'_> {
    /// Every window at the variables `x`, its start as `leads` have it, or as it was seen.
    pub fn pieces(&self, x: &[f64], at: Option<(&[f64], &[Lead])>) -> Vec<Piece> {
        self.windows
            .par_iter()
            .enumerate()
            .map(|(w, window)| {
                let Some((x_0, leads)) = at else { return self.piece(x, window, window.start) };
                let lead = &leads[w];
                let led = self.piece(x, window, lead.at(x, x_0));
                if led.misfit() <= lead.misfit {
                    return led;
                }
                // Where friction holds, or soon will, a start is followed badly by a straight line.
                let stayed = self.piece(x, window, lead.was);
                if stayed.misfit() < led.misfit() { stayed } else { led }
            })
            .collect()
    }

    /// A window with its start in so many of Gauss and Newton's steps at most to the best one near, each within a reach
    /// that grows and shrinks as a search's radius does.
    pub fn nearest(&self, x: &[f64], window: &Window, piece: Piece, most: usize) -> Piece {
        if self.starts() == 0 {
            return piece;
        }
        let (mut best, mut reach, mut looked) = (piece, f64::INFINITY, None);
        for _ in 0..most {
            let starts = looked.take().unwrap_or_else(|| self.by_start(x, window, &best));
            let (step, promised) = starts.step(&best, (&window.spread, reach));
            if promised <= LITTLE.max(SHARE * best.misfit()) {
                break;
            }
            let next = self.piece(x, window, std::array::from_fn(|i| best.start[i] + step[i]));
            let gained = best.misfit() - next.misfit();
            let long = norm(&step, &window.spread);
            if gained > GOOD * promised {
                reach = reach.max(LONGER * long);
            } else if gained.is_nan() || gained < POOR * promised {
                reach = SHORTER * long;
            }
            if gained > 0.0 {
                best = next;
            } else {
                looked = Some(starts);
            }
        }
        best
    }

    /// A window with its start looked for in its first samples, and then in as many as a motion from there is near: where
    /// friction decides between resting and slipping, what follows differs by leaps that no slope tells of, and only what
    /// lies before tells the start.
    pub(super) fn farther(
        &self,
        x: &[f64],
        window: &Window,
        start: [f64; START],
        most: usize,
    ) -> Piece {
        let (mut start, mut samples) = (start, (window.len() / EARLY).max(1));
        let all = window.beginning(window.len());
        for _ in 0..LENGTHS {
            let head = window.beginning(samples);
            start = self.nearest(x, &head, self.piece(x, &head, start), most).start;
            let motion = self.piece(x, &all, start);
            let seen = motion.residuals.len().saturating_sub(self.starts());
            let gone = motion.residuals[..seen].iter().position(|r| r.abs() > GONE);
            // The whole window is near, or no more of it than before.
            let Some(near) = gone.map(|place| place / self.channels()) else { break };
            if near <= samples {
                break;
            }
            samples = near + 1;
        }
        self.nearest(x, window, self.piece(x, window, start), most)
    }
}

/// The length of a step of a start, each number in units of its spread.
fn norm(step: &[f64; START], spread: &[f64; START]) -> f64 {
    step.iter().zip(spread).map(|(step, spread)| (step / spread).powi(2)).sum::<f64>().sqrt()
}
