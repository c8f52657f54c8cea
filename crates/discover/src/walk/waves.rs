//! How long the waves are that a record shows along the way: a wave that is missed by half of its length over the whole
//! way is not found from there, and there may be hundreds on it.

use crate::{
    board::{Board, Fitted},
    nudge,
};
use identify::effects::Context;
use nalgebra::{SMatrix, SVector};
use std::f64::consts::TAU;

/// The places of a shortest wave.
const PLACES: f64 = 6.0;

/// At the largest speed a wave goes by in so many samples at least.
const SAMPLES: f64 = 8.0;

/// So many waves on the whole way at most.
const MOST: f64 = 400.0;

/// Wavenumbers so close, of the one with one wave on the way, are tried.
const APART: f64 = 0.25;

/// What is slower than this share of the largest speed says nothing of friction in sliding.
const SLOW: f64 = 0.05;

/// The wavenumbers [1/m] of the two waves that what a model leaves shows most of, for a force that repeats along the way
/// and for a friction that does; 0 where there are none.
pub(super) fn waves(board: &Board<'_>, fitted: &Fitted, context: &Context) -> [[f64; 2]; 2] {
    let Some([q, v, force]) = nudge::left(&fitted.held(), board.data) else { return [[0.0; 2]; 2] };
    let step = context.sample_time * context.speed;
    let many = (context.span / (SAMPLES * step)).clamp(1.0, MOST);
    let cells = Cells::of([&q, &v, &force], context, (PLACES * many).ceil());
    let each = TAU * APART / context.span;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1600")]
    let tried: Vec<f64> = (1..=(many / APART) as usize).map(|i| each * (i as f64 + 1.0)).collect();
    [false, true].map(|friction| {
        let gains: Vec<f64> = tried.iter().map(|k| cells.gain(*k, friction)).collect();
        crests(&tried, &gains)
    })
}

/// The two largest of the local maxima.
fn crests(at: &[f64], gains: &[f64]) -> [f64; 2] {
    let own = |i: usize| gains.get(i).copied().unwrap_or(0.0);
    let crest = |i: &usize| (*i == 0 || own(*i) >= own(i - 1)) && own(*i) > own(i + 1);
    let mut all: Vec<usize> = (0..gains.len()).filter(crest).collect();
    all.sort_by(|a, b| gains[*b].total_cmp(&gains[*a]));
    [0, 1].map(|n| all.get(n).map_or(0.0, |i| at[*i]))
}

/// The mean force at every place of the way, going forth and going back.
struct Cells {
    /// Place [m], direction, mean force [N], how many samples.
    all: Vec<[f64; 4]>,
    low: f64,
    span: f64,
}

impl Cells {
    fn of([q, v, force]: [&[f64]; 3], context: &Context, many: f64) -> Self {
        let (low, span) = (context.low, context.span);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let place = |q: f64| ((q - low) / span * many).clamp(0.0, many - 1.0) as usize;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let mut sums = vec![[0.0; 3]; 2 * many as usize];
        for ((q, v), force) in q.iter().zip(v).zip(force) {
            if v.abs() > SLOW * context.speed && force.is_finite() {
                let cell = &mut sums[2 * place(*q) + usize::from(*v > 0.0)];
                *cell = [cell[0] + q, cell[1] + force, cell[2] + 1.0];
            }
        }
        let one = |(i, [q, force, n]): (usize, &[f64; 3])| {
            let way = if i % 2 == 1 { 1.0 } else { -1.0 };
            [q / n, way, force / n, *n]
        };
        let all = sums.iter().enumerate().filter(|(_, cell)| cell[2] > 0.0).map(one).collect();
        Self { all, low, span }
    }

    /// By how much a wave lowers the sum of squares that a line for each direction leaves.
    fn gain(&self, k: f64, friction: bool) -> f64 {
        let (mut a, mut b) = (SMatrix::<f64, 6, 6>::zeros(), SVector::<f64, 6>::zeros());
        for [q, way, force, n] in &self.all {
            let x = (q - self.low) / self.span - 0.5;
            let (sin, cos) = (k * q).sin_cos();
            let by = if friction { *way } else { 1.0 };
            let row = SVector::from([1.0, *way, x, way * x, by * sin, by * cos]);
            a += *n * row * row.transpose();
            b += *n * *force * row;
        }
        let fall = |n: usize| {
            let (a, b) = (a.view((0, 0), (n, n)).into_owned(), b.rows(0, n).into_owned());
            // As little of each as rounding asks for.
            let least = 1e-9 * a.diagonal().max();
            let a = a + nalgebra::DMatrix::identity(n, n) * least;
            a.cholesky().map_or(0.0, |factor| b.dot(&factor.solve(&b)))
        };
        fall(6) - fall(4)
    }
}

#[cfg(test)]
mod tests {
    use super::{APART, Cells, TAU, crests};
    use crate::walk::made::{context, data, rig, walk};

    #[test]
    fn the_length_of_a_wave_is_seen_along_the_way() {
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
        for friction in [false, true] {
            let force = |(q, v): (&f64, &f64)| {
                let way = if friction { v.signum() } else { 1.0 };
                0.3 + 0.2 * v.signum() + 0.05 * way * (k * q + 0.4).sin()
            };
            let force: Vec<f64> = q.iter().zip(&v).map(force).collect();
            let cells = Cells::of([&q, &v, &force], &context, 400.0);
            let tried: Vec<f64> =
                (1..200).map(|i| APART * TAU * f64::from(i) / context.span).collect();
            let gains =
                |friction| tried.iter().map(|k| cells.gain(*k, friction)).collect::<Vec<f64>>();
            let [first, _] = crests(&tried, &gains(friction));
            assert!((first / k - 1.0).abs() < 0.5 * APART / 23.5, "{first} 1/m of {k}");
            let most = |friction| gains(friction).into_iter().fold(0.0, f64::max);
            assert!(most(friction) > 5.0 * most(!friction), "the other kind shows less");
        }
    }
}
