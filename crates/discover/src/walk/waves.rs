//! How long the waves are that a record shows along the way: a wave that is missed by half of its length over the whole
//! way is not found from there, and there may be hundreds on it.

use super::{Walk, named::NOTHING};
use crate::{
    board::{Board, Fitted},
    nudge::{self, Left},
};
use identify::effects::{Context, WAVES};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// At the largest speed a wave goes by in so many samples at least.
const SAMPLES: f64 = 3.0;

/// So many waves on the whole way at most.
const MOST: f64 = 400.0;

/// Wavenumbers so close, of the one with one wave on the way, are tried.
const APART: f64 = 0.25;

/// What is slower than this share of the largest speed says nothing of friction in sliding.
const SLOW: f64 = 0.05;

/// Of so many waves a force, and a friction, that repeats is tried: of those of which a record shows most, for parameters that
/// are a little off make crests of their own, and of those that stand out most from the waves around; of friction every wave
/// is tried in several forms.
const TRIED: [[usize; 2]; 2] = [[WAVES - 2, 2], [2, 1]];

/// So many waves that were tried on either side are around one. What an encoder's noise leaves grows with the frequency, and the
/// short waves that it shows most of say nothing.
const AROUND: usize = 24;

/// Near the floor, where the force that is left is all noise, so many half waves on the way are tried one after another.
const HALVES: f64 = 32.0;

impl Walk<'_> {
    /// The sizes of the record with the waves that a model leaves.
    pub(super) fn waved(&self, fitted: &Fitted, context: &Context) -> Context {
        let near = self.judged(&fitted.blocks).level() < NOTHING;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 32")]
        let halves = if near { (2.0 * shortest(context)).min(HALVES) as u32 } else { 0 };
        Context { waves: waves(&self.board, fitted, context), halves, ..*context }
    }
}

/// So many waves on the whole way are as short as the samples show.
fn shortest(context: &Context) -> f64 {
    (context.span / (SAMPLES * context.sample_time * context.speed)).clamp(1.0, MOST)
}

/// The wavenumbers [1/m] of the waves that what a model leaves shows most of, for a force that repeats along the way
/// and for a friction that does; 0 where there are none.
pub(super) fn waves(board: &Board<'_>, fitted: &Fitted, context: &Context) -> [[f64; WAVES]; 2] {
    let Some(left) = nudge::left(&fitted.held(), board.data) else { return [[0.0; WAVES]; 2] };
    let many = shortest(context);
    let way = Way::of(&left, context);
    let each = TAU * APART / context.span;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1600")]
    let tried: Vec<f64> = (1..=(many / APART) as usize).map(|i| each * (i as f64 + 1.0)).collect();
    let gains: Vec<[f64; 2]> = tried.par_iter().map(|k| way.gains(*k)).collect();
    [0, 1].map(|kind| {
        let own: Vec<f64> = gains.iter().map(|both| both[kind]).collect();
        crests(&tried, &own, TRIED[kind])
    })
}

/// Of the local maxima so many that are the largest, and so many more that are largest of what is usual around.
fn crests(at: &[f64], gains: &[f64], [largest, sharpest]: [usize; 2]) -> [f64; WAVES] {
    let own = |i: usize| gains.get(i).copied().unwrap_or(0.0);
    let crest = |i: &usize| (*i == 0 || own(*i) >= own(i - 1)) && own(*i) > own(i + 1);
    let sharp = |i: usize| {
        let mut near = gains[i.saturating_sub(AROUND)..(i + AROUND + 1).min(gains.len())].to_vec();
        near.sort_by(f64::total_cmp);
        own(i) / near[near.len() / 2].max(f64::MIN_POSITIVE)
    };
    let mut all: Vec<usize> = (0..gains.len()).filter(crest).collect();
    all.sort_by(|a, b| gains[*b].total_cmp(&gains[*a]));
    let rest = all.split_off(largest.min(all.len()));
    let mut rest: Vec<(f64, usize)> = rest.into_iter().map(|i| (sharp(i), i)).collect();
    rest.sort_by(|a, b| b.0.total_cmp(&a.0));
    all.extend(rest.into_iter().take(sharpest).map(|(_, i)| i));
    std::array::from_fn(|n| all.get(n).map_or(0.0, |i| at[*i]))
}

/// A line for each direction of the motion, and a wave of two kinds.
const LINES: usize = 4;
const ALL: usize = LINES + 2;

/// What is left along the way, sample by sample, and what a line for each direction makes of it. Whatever is fitted lags
/// behind the motion as what is left does: a wave of some samples would else be gone.
struct Way<'a> {
    q: &'a [f64],
    /// The direction of the motion, 0 in slow motion.
    turn: Vec<f64>,
    force: &'a [f64],
    /// The lines.
    lines: Vec<SVector<f64, LINES>>,
    /// Of the difference from what lags a sample makes up so much.
    share: f64,
}

impl<'a> Way<'a> {
    fn of(left: &'a Left, context: &Context) -> Self {
        let fast = |v: &f64| if v.abs() > SLOW * context.speed { v.signum() } else { 0.0 };
        let way: Vec<f64> = left.v.iter().map(fast).collect();
        let share = if left.lag > 0.0 { 1.0 - (-1.0 / left.lag).exp() } else { 1.0 };
        let mut lines = Vec::with_capacity(way.len());
        let mut late = SVector::zeros();
        for (q, way) in left.q.iter().zip(&way) {
            let x = (q - context.low) / context.span - 0.5;
            late += (SVector::from([1.0, *way, x, way * x]) - late) * share;
            lines.push(late);
        }
        Self { q: &left.q, turn: way, force: &left.force, lines, share }
    }

    /// By how much a force, and a friction, that repeats along the way lowers the sum of squares that a line for each
    /// direction leaves.
    fn gains(&self, k: f64) -> [f64; 2] {
        let mut late = [[0.0; 2]; 2];
        let mut sums = [(SMatrix::<f64, ALL, ALL>::zeros(), SVector::<f64, ALL>::zeros()); 2];
        for (((q, way), force), lines) in
            self.q.iter().zip(&self.turn).zip(self.force).zip(&self.lines)
        {
            let (sin, cos) = (k * q).sin_cos();
            for (late, by) in late.iter_mut().zip([1.0, *way]) {
                late[0] += (by * sin - late[0]) * self.share;
                late[1] += (by * cos - late[1]) * self.share;
            }
            if *way == 0.0 || !force.is_finite() {
                continue;
            }
            for ((a, b), late) in sums.iter_mut().zip(&late) {
                let row = SVector::from([lines[0], lines[1], lines[2], lines[3], late[0], late[1]]);
                a.ger(1.0, &row, &row, 1.0);
                b.axpy(*force, &row, 1.0);
            }
        }
        sums.map(|(a, b)| fall::<ALL>(&a, &b) - fall::<LINES>(&a, &b))
    }
}

/// What the first so many of all lower a sum of squares by.
fn fall<const N: usize>(a: &SMatrix<f64, ALL, ALL>, b: &SVector<f64, ALL>) -> f64 {
    let (a, b) = (a.fixed_view::<N, N>(0, 0).into_owned(), b.fixed_rows::<N>(0).into_owned());
    // As little of each as rounding asks for.
    let least = 1e-9 * a.diagonal().max();
    let a = a + SMatrix::<f64, N, N>::identity() * least;
    a.cholesky().map_or(0.0, |factor| b.dot(&factor.solve(&b)))
}

#[cfg(test)]
mod tests {
    use super::{APART, HALVES, TAU, TRIED, Way, crests};
    use crate::{
        nudge::Left,
        walk::made::{BIAS, context, data, rig, walk, with},
    };
    use identify::effects::{Context, Kind};

    #[test]
    fn near_the_floor_one_wave_after_another_is_tried_and_no_shorter_one_than_samples_show() {
        let data = data();
        let halves = |bias: f64| {
            let walk = walk(&with(&rig(2.0), Kind::CurrentBias, &[bias]), &data, &[]);
            let context = context(&walk);
            let waved = walk.waved(&walk.best, &context);
            let coarse = Context { sample_time: context.span / (16.0 * context.speed), ..context };
            (waved, walk.waved(&walk.best, &coarse).halves)
        };
        let (near, coarse) = halves(BIAS);
        assert_eq!((f64::from(near.halves), coarse), (HALVES, 10), "five waves of three samples");
        // Twenty-one and a half half waves are not far from one that is tried.
        let k = 21.5 * 0.5 * TAU / near.span;
        let probes = (Kind::Cogging.about().probes)(&near);
        let apart = |probe: &Vec<f64>| (probe[0] - k).abs() * near.span;
        assert!(probes.iter().map(apart).fold(f64::INFINITY, f64::min) < 0.26 * TAU);
        assert_eq!(halves(0.0).0.halves, 0, "far from it");
    }

    #[test]
    fn the_length_of_a_wave_is_seen_along_the_way_though_what_is_left_lags() {
        let data = data();
        let walk = walk(&rig(2.0), &data, &[]);
        let context = context(&walk);
        // Twenty-three and a half waves, forth and back over a way of its length.
        let k = 23.5 * TAU / context.span;
        let time: Vec<f64> = (0..20_000).map(|i| 0.005 * f64::from(i)).collect();
        let q: Vec<f64> = time
            .iter()
            .map(|t| context.low + context.span * (0.5 + 0.5 * (0.7 * t).sin()))
            .collect();
        let v: Vec<f64> = time.iter().map(|t| context.speed * (0.7 * t).cos()).collect();
        for (friction, lag) in [(false, 0.0), (true, 0.0), (false, 10.0), (true, 10.0)] {
            let force = |(q, v): (&f64, &f64)| {
                let way = if friction { v.signum() } else { 1.0 };
                0.3 + 0.2 * v.signum() + 0.05 * way * (k * q + 0.4).sin()
            };
            let mut force: Vec<f64> = q.iter().zip(&v).map(force).collect();
            let mut late = force[0];
            for force in force.iter_mut().filter(|_| lag > 0.0) {
                late += (*force - late) / (lag + 0.5);
                *force = late;
            }
            let left = Left { q: q.clone(), v: v.clone(), force, lag };
            let way = Way::of(&left, &context);
            let tried: Vec<f64> =
                (1..200).map(|i| APART * TAU * f64::from(i) / context.span).collect();
            let gains: Vec<[f64; 2]> = tried.iter().map(|k| way.gains(*k)).collect();
            let of = |kind: usize| gains.iter().map(|both| both[kind]).collect::<Vec<f64>>();
            let [first, second, third, ..] = crests(&tried, &of(usize::from(friction)), [1, 1]);
            assert!(second > 0.0 && third == 0.0, "as many as are asked for");
            assert!((first / k - 1.0).abs() < 0.5 * APART / 23.5, "{first} 1/m of {k}");
            let most = |kind| of(usize::from(kind)).into_iter().fold(0.0, f64::max);
            assert!(most(friction) > 5.0 * most(!friction), "the other kind shows less");
        }
    }

    #[test]
    fn a_wave_that_stands_out_among_its_like_is_tried_however_many_show_more() {
        // What noise leaves grows with the square of the wavenumber: of all the crests of the short ones each is larger.
        let at: Vec<f64> = (1..=400).map(f64::from).collect();
        let noise = |k: &f64| 1e-4 * k * k * (1.0 + 0.5 * (2.1 * k).sin());
        let mut gains: Vec<f64> = at.iter().map(noise).collect();
        gains[59] += 6.0;
        assert!(crests(&at, &gains, [5, 0]).iter().all(|k| *k != 60.0));
        let all = crests(&at, &gains, TRIED[0]);
        assert_eq!(all[4], 60.0, "{all:?}");
        assert!(all[..4].iter().all(|k| *k > 380.0) && all[5] != all[4]);
    }
}
