//! What the last model leaves, and whether that is noise.

use super::{
    Walk,
    answer::MORE,
    struck::{STRUCK, middle, run},
};
use crate::{board::Fitted, decide::Judged};
use identify::fit::{Data, problem::Piece, window::Window};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// What is left in one channel may be so much larger than its floor before it is said that more is missing: right models
/// of the records looked at left 0.6 to 1.2 in each.
const ALONE: f64 = 1.4;

/// Noise that is not white hangs together over so few samples, is the same in all blocks but for so much, and no more
/// than this share of it hangs on how the plant moves. What a wrong model leaves on the records looked at hung together
/// over 18 samples and more.
const TOGETHER: f64 = 12.0;
const STEADY: f64 = 1.5;
const TOLD: f64 = 0.02;

/// Nor is it louder: noise of first order that hangs together over twelve samples, of which 0.846 lasts from one to the
/// next, is in its square eleven times what its differences of seventh order tell, the least of those that are asked.
const LOUDEST: f64 = 11.0;

/// So many samples later nothing is counted that hangs together.
const LATEST: usize = 120;

/// How far back the velocity is looked at [s].
const BACK: [f64; 3] = [0.02, 0.1, 0.5];

/// Slow is what goes with this share of the largest velocity.
const SLOW: f64 = 0.03;

/// So many places along the way are looked at.
const PLACES: usize = 12;

/// The share of a curvature that is added to it.
const RIDGE: f64 = 1e-4;

/// What a channel leaves that hangs together.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rest {
    /// Over how many samples [1].
    together: f64,
    /// The share of its squares that the motion tells of on the judging blocks [1].
    told: f64,
}

/// How a window moves, and what is left of it.
struct Motion<'m> {
    window: usize,
    /// What one channel leaves of every sample.
    rows: Vec<f64>,
    /// The displacement [m], velocity [m/s], and what drives it, or the force if the motion is imposed.
    q: &'m [f64],
    v: Vec<f64>,
    drives: &'m [f64],
}

/// The velocities of an imposed motion at these samples [m/s].
fn speeds(data: &Data, of: Range<usize>) -> Vec<f64> {
    let (time, u) = (&data.time, &data.input);
    let one = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(u.len() - 1));
        (u[after] - u[before]) / (time[after] - time[before])
    };
    of.map(one).collect()
}

impl Walk<'_> {
    /// What a model leaves but for its worst blocks [1]: in all channels, or in the worst of them if that is so much more
    /// that it is no chance; what is noise alone is none.
    pub(super) fn leaves(&self, fitted: &Fitted) -> f64 {
        let channels = (0..channels(fitted)).map(|c| self.channel(fitted, c));
        let worst = channels.map(|blocks| self.judging_of(&blocks).mostly()).fold(0.0, f64::max);
        let left = self.judged(&fitted.blocks).mostly().max(worst * MORE / ALONE);
        if left > MORE && self.only_noise(fitted) { 1.0 } else { left }
    }

    /// The mean squared residual of every block in one channel [1].
    pub(super) fn channel(&self, fitted: &Fitted, channel: usize) -> Vec<f64> {
        let samples = self.board.samples();
        fitted.blocks.iter().zip(samples).map(|(block, n)| block[channel] / n).collect()
    }

    fn judging_of(&self, blocks: &[f64]) -> Judged {
        let judging = blocks.iter().zip(&self.board.trains).filter(|(_, trains)| !**trains);
        Judged { blocks: judging.map(|(block, _)| *block).collect(), counts: Vec::new() }
    }

    /// Whether what a model leaves is noise of the sensors or of the input that is not white: it hangs together for a
    /// few samples, is the same in all blocks, and does not hang on how the plant moves.
    fn only_noise(&self, fitted: &Fitted) -> bool {
        let (data, imposed) = (self.board.data, self.board.imposed());
        let of = 1 + usize::from(!imposed && data.velocity.is_some());
        let told = |c: usize| {
            let blocks = self.channel(fitted, c);
            (c, self.judging_of(&blocks).mostly(), run(&blocks))
        };
        let noise = |(c, left, run): (usize, f64, f64)| {
            c < of && left < LOUDEST && run < STEADY && {
                let rest = self.rest(fitted, (c, of));
                rest.together < TOGETHER && rest.told < TOLD
            }
        };
        let seen = imposed || data.displacement.is_some();
        let loud = |(_, left, _): &(usize, f64, f64)| *left > MORE;
        let mut all = (0..channels(fitted)).map(told).filter(loud).peekable();
        seen && all.peek().is_some() && all.all(noise)
    }

    /// Whether what a model leaves of a driven motion hangs together for longer than any noise: it is white where the
    /// model was followed with the noise of its input, and over 3.8 samples at most on 90 records that were explained,
    /// but for a pair at 18.
    /// An imposed motion's is white to first order only: what went astray by more lasts.
    pub(super) fn hangs_together(&self, fitted: &Fitted) -> bool {
        let loads = if self.board.data.loads.is_some() { 2 } else { 0 };
        let of = channels(fitted) - loads;
        let noise = |c: usize| TOGETHER * if c == 0 { self.grained(fitted) } else { 1.0 };
        !self.board.imposed() && (0..of).any(|c| self.together(fitted, (c, of)) > noise(c))
    }

    /// What one of `of` channels leaves.
    fn rest(&self, fitted: &Fitted, (channel, of): (usize, usize)) -> Rest {
        let (board, data) = (&self.board, self.board.data);
        let all = self.motions(fitted, (channel, of));
        let largest = |of: &dyn Fn(&Motion<'_>) -> f64| all.iter().map(of).fold(1e-300, f64::max);
        let most = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let sizes =
            [largest(&|m| most(m.q)), largest(&|m| most(&m.v)), largest(&|m| most(m.drives))];
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "half a second of samples"
        )]
        let back = BACK.map(|back| (back / data.sample_time()).round().max(1.0) as usize);
        let mut fitting: Option<(DMatrix<f64>, DVector<f64>)> = None;
        let mut judged: Vec<(DVector<f64>, f64)> = Vec::new();
        for Motion { window, rows, q, v, drives } in &all {
            for (i, row) in rows.iter().enumerate() {
                let now = [q[i] / sizes[0], v[i] / sizes[1], drives[i] / sizes[2]];
                let before = back.map(|back| v[i.saturating_sub(back)] / sizes[1]);
                let row = (DVector::from_vec(features(now, before)), *row);
                if board.trains[board.block(*window)] {
                    let n = row.0.len();
                    let (a, b) =
                        fitting.get_or_insert_with(|| (DMatrix::zeros(n, n), DVector::zeros(n)));
                    a.ger(1.0, &row.0, &row.0, 1.0);
                    b.axpy(row.1, &row.0, 1.0);
                } else {
                    judged.push(row);
                }
            }
        }
        let by = fitting.and_then(|(a, b)| {
            let stiffer = DMatrix::from_diagonal(&a.diagonal().map(|own| RIDGE * own + 1e-12));
            Some((a + stiffer).cholesky()?.solve(&b))
        });
        let told = by.map_or(1.0, |by| {
            let squares = |left: &dyn Fn(&DVector<f64>, f64) -> f64| -> f64 {
                judged.iter().map(|(f, row)| left(f, *row).powi(2)).sum()
            };
            1.0 - squares(&|f, row| row - by.dot(f)) / squares(&|_, row| row)
        });
        Rest { together: self.together(fitted, (channel, of)), told }
    }

    /// Every window's motion with what one of `of` channels leaves of it, but for those that went astray.
    fn motions<'m>(&'m self, fitted: &'m Fitted, (channel, of): (usize, usize)) -> Vec<Motion<'m>> {
        let (board, data) = (&self.board, self.board.data);
        let own = |window: usize| {
            let Window { first, end, .. } = board.windows[window];
            // An imposed motion is one piece, and its q is the force.
            let imposed = board.imposed();
            let (piece, from) = if imposed { (0, first) } else { (window, 0) };
            let (Piece { motion, residuals, .. }, n) = (fitted.pieces.get(piece)?, end - first);
            let rows: Vec<f64> =
                residuals.iter().skip(channel).step_by(of).skip(from).take(n).copied().collect();
            let (input, own) = (&data.input[first..end], motion.q.get(from..from + n)?);
            let (q, v, drives) = if imposed {
                (input, speeds(data, first..end), own)
            } else {
                (own, motion.v.get(..n)?.to_vec(), input)
            };
            (rows.len() == n).then_some(Motion { window, rows, q, v, drives })
        };
        (0..board.windows.len()).filter_map(own).collect()
    }

    /// Over how many samples what is left in one of `of` channels hangs together [1]; a window that went
    /// astray by itself does so all along.
    fn together(&self, fitted: &Fitted, (channel, of): (usize, usize)) -> f64 {
        let motions = self.motions(fitted, (channel, of));
        let all: Vec<Vec<f64>> = motions.into_iter().map(|motion| motion.rows).collect();
        let mean =
            |rows: &[f64]| rows.iter().map(|r| r * r).sum::<f64>() / rows.len().max(1) as f64;
        let means: Vec<f64> = all.iter().map(|rows| mean(rows)).collect();
        let most = STRUCK * middle(&means).unwrap_or(0.0).max(1.0);
        let own = all.iter().zip(means).filter(|(_, mean)| *mean < most);
        lasts(own.map(|(rows, _)| &rows[..]), 0.0)
    }
}

/// Over how many samples these residuals of some windows hang together [1]; of their squares, so much in all, more is white.
pub(super) fn lasts<'a>(all: impl Iterator<Item = &'a [f64]>, white: f64) -> f64 {
    let mut lagged = vec![0.0; LATEST];
    for rows in all {
        for (i, row) in rows.iter().enumerate() {
            for (sum, before) in lagged.iter_mut().zip(rows[..=i].iter().rev()) {
                *sum += row * before;
            }
        }
    }
    let all = lagged[0] + white;
    let shares = lagged.iter().skip(1).map(|sum| sum / all);
    1.0 + 2.0 * shares.take_while(|r| *r > 0.0).sum::<f64>()
}

/// How many channels a model has, the load cells among them.
pub(super) fn channels(fitted: &Fitted) -> usize {
    fitted.blocks.first().map_or(0, Vec::len)
}

/// What a wrong model may hang on, of displacement, velocity and input now, and of the velocity `before`, each of its
/// largest.
fn features([q, v, u]: [f64; 3], before: [f64; 3]) -> Vec<f64> {
    let way = |v: f64| (v / SLOW).tanh();
    let (sign, slow) = (way(v), (-(v / SLOW).powi(2)).exp());
    let own = [1.0, q, q * q, q * q * q, v, v * v, v * v * v, v.abs() * v, u, u * u, u * u * u];
    let across = [q * v, q * u, u * v, v.abs(), slow];
    let dry = [1.0, q, q * q, u, u * u, slow].map(|more| sign * more);
    let past = before.iter().flat_map(|v| [*v, way(*v)]);
    // What acts at one place alone, as a force or as friction.
    let width = 2.0 / (PLACES - 1) as f64;
    let place = |k: usize| (1.0 - (q + 1.0 - width * k as f64).abs() / width).max(0.0);
    let places = (0..PLACES).flat_map(|k| [place(k), sign * place(k)]);
    own.into_iter().chain(across).chain(dry).chain(past).chain(places).collect()
}

#[cfg(test)]
mod tests {
    use super::super::made;
    use identify::{
        Hold,
        effects::Kind,
        fit::{Data, Seen},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// The record with more noise on its displacement, of which this share lasts from sample to sample.
    fn noisier(lasts: f64) -> Data {
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut data = made::data();
        let mut off = 0.0;
        for x in &mut data.displacement.as_mut().expect("it is seen").values {
            let drawn: f64 = StandardNormal.sample(&mut random);
            off = lasts * off + 1e-3 * (1.0 - lasts * lasts).sqrt() * drawn;
            *x += off;
        }
        data
    }

    #[test]
    fn noise_that_is_not_white_is_told_from_what_is_missing() {
        let right = made::with(&made::rig(2.0), Kind::CurrentBias, &[made::BIAS]);
        let leaves = |lasts: f64, rig: &identify::Rig| {
            let data = noisier(lasts);
            let walk = made::walk(rig, &data, &[]);
            let mostly = walk.judged(&walk.best.blocks).mostly();
            (mostly, walk.leaves(&walk.best))
        };
        let (mostly, left) = leaves(0.7, &right);
        assert!(mostly > 1.4 && left <= 1.0, "{mostly} are noise, and {left} is left");
        // A little of the bias is left.
        let wrong = made::with(&made::rig(2.0), Kind::CurrentBias, &[0.6 * made::BIAS]);
        let (mostly, left) = leaves(0.0, &wrong);
        assert!(left > 1.2 && left >= mostly, "{left} of {mostly}");
        let (mostly, left) = leaves(0.7, &wrong);
        assert!(left > 1.2 && left >= mostly, "{left} of {mostly}, with noise that is not white");
        // What hangs together as long as a window is no noise.
        let (mostly, left) = leaves(0.99, &right);
        assert!(mostly < 1.2 || left >= mostly, "{left} of {mostly}");
    }

    #[test]
    fn a_sensor_of_force_may_have_noise_that_is_not_white() {
        // A sine of 20 mm against 1.5 N, of whose noise this share lasts from sample to sample; and six times it more at one place, to and fro.
        let record = |lasts: f64, more: f64| {
            let mut random = ChaCha8Rng::seed_from_u64(4);
            let mut off = 0.0;
            let time: Vec<f64> = (0..8000).map(|i| 0.005 * f64::from(i)).collect();
            let force = time.iter().map(|t| {
                let drawn: f64 = StandardNormal.sample(&mut random);
                off = lasts * off + 1e-2 * (1.0 - lasts * lasts).sqrt() * drawn;
                let place = ((1.3 * t).sin() - 0.3) / 0.12;
                let acts = more * 1e-2 * place * (-place * place).exp();
                1.5 * (1.3 * t).cos().signum() + acts + off
            });
            let seen = Seen::new("force", force.collect(), 0.0);
            let input = time.iter().map(|t| 0.02 * (1.3 * t).sin()).collect();
            let driven = Data::driven(time, input, Hold::Linear, seen.clone());
            Data { displacement: None, force: Some(seen), ..driven }
        };
        let leaves = |data: &Data| {
            let walk = made::walk(&made::slides(1.5), data, &[]);
            (walk.judged(&walk.best.blocks).mostly(), walk.leaves(&walk.best))
        };
        let (mostly, left) = leaves(&record(0.7, 0.0));
        assert!(mostly > 3.0 && left <= 1.0, "{mostly} are noise, and {left} is left");
        let (mostly, left) = leaves(&record(0.7, 6.0));
        assert!(left >= mostly, "{left} of {mostly}, with a force at one place");
        // What lasts as long as a rest is no noise.
        let (mostly, left) = leaves(&record(0.97, 0.0));
        assert!(left >= mostly, "{left} of {mostly}");
    }

    #[test]
    fn what_a_wrong_model_leaves_hangs_together_longer_than_noise() {
        let hangs = |data: &Data, bias: f64| {
            let with = made::with(&made::rig(2.0), Kind::CurrentBias, &[bias]);
            let walk = made::walk(&with, data, &[]);
            walk.hangs_together(&walk.best)
        };
        for lasts in [0.0, 0.7, 0.9] {
            assert!(!hangs(&noisier(lasts), made::BIAS), "noise of which {lasts} lasts");
        }
        assert!(hangs(&made::data(), 0.5 * made::BIAS));
    }

    #[test]
    fn one_window_that_went_astray_hangs_together_by_itself() {
        let data = made::data();
        let right = made::with(&made::rig(2.0), Kind::CurrentBias, &[made::BIAS]);
        let walk = made::walk(&right, &data, &[]);
        let off = |by: f64, every: usize| {
            let mut astray = walk.best.clone();
            for piece in astray.pieces.iter_mut().skip(3).step_by(every) {
                piece.residuals.iter_mut().for_each(|r| *r += by);
            }
            walk.hangs_together(&astray)
        };
        assert!(!off(3.0, 1000), "a single one");
        assert!(off(1.5, 2), "every other one, each by less");
    }

    #[test]
    fn what_is_far_louder_than_its_differences_tell_is_no_noise() {
        let right = made::with(&made::rig(2.0), Kind::CurrentBias, &[made::BIAS]);
        let data = made::data();
        let walk = made::walk(&right, &data, &[]);
        let louder = |times: f64| {
            let mut fitted = walk.best.clone();
            fitted.blocks.iter_mut().flatten().for_each(|sum| *sum *= times * times);
            let rows = fitted.pieces.iter_mut().flat_map(|piece| &mut piece.residuals);
            rows.for_each(|row| *row *= times);
            walk.leaves(&fitted)
        };
        let (quiet, loud) = (louder(2.5), louder(4.0));
        assert!(quiet <= 1.0 && loud > 12.0, "{quiet} and {loud} floors");
    }

    #[test]
    fn one_channel_is_not_hidden_by_the_others() {
        let data = made::data();
        let mut walk = made::walk(&made::rig(2.0), &data, &[]);
        walk.counts = walk.counts.iter().map(|n| 4.0 * n).collect();
        let mut fitted = walk.best.clone();
        for (block, n) in fitted.blocks.iter_mut().zip(walk.board.samples()) {
            *block = [2.0, 1.0, 1.0, 1.0].map(|level| level * n).to_vec();
        }
        assert!(walk.leaves(&fitted) > 1.2, "{}", walk.leaves(&fitted));
        for (block, n) in fitted.blocks.iter_mut().zip(walk.board.samples()) {
            *block = [1.3, 1.0, 1.0, 1.0].map(|level| level * n).to_vec();
        }
        assert!(walk.leaves(&fitted) < 1.2, "{}", walk.leaves(&fitted));
    }
}
