//! The times of two rows: the ratio of their medians, with an interval.

use simulation::anchors::{Row, median};

/// Draws of the bootstrap.
const DRAWS: usize = 2000;

/// The share of draws left out at each end. So little, because a run has a thousand rows: one in a
/// thousand would already be one wrong alarm in every comparison.
const LEFT_OUT: f64 = 5e-4;

/// A ratio nearer to one than this is none. Of the 1098 times of two runs of one build, on a loaded machine, the
/// intervals of three lay beyond one by more than 5 %, the farthest by 9 %; none by a tenth.
const SAME: f64 = 0.1;

/// Fewer repeats than this tell no interval.
const LEAST: usize = 5;

/// How the time of a row changed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TimeChange {
    pub(super) key: String,
    /// The medians [s], before and after.
    pub(super) times: [f64; 2],
    /// The second by the first.
    pub(super) ratio: f64,
    /// Where 99.9 % of the ratios of resampled medians lie.
    pub(super) interval: (f64, f64),
}

impl TimeChange {
    /// Whether the second is slower beyond doubt.
    pub(super) fn slower(&self) -> bool {
        self.interval.0 > 1.0 + SAME
    }

    /// Whether the second is faster beyond doubt.
    pub(super) fn faster(&self) -> bool {
        self.interval.1 < 1.0 / (1.0 + SAME)
    }
}

/// The change between two rows, if both have times enough. The draws are the same each time.
pub(super) fn change(a: &Row, b: &Row) -> Option<TimeChange> {
    if a.repeats_s.len() < LEAST || b.repeats_s.len() < LEAST {
        return None;
    }
    let times = [median(&a.repeats_s)?, median(&b.repeats_s)?];
    let mut draw = Draw(0x5eed);
    let mut ratios = Vec::with_capacity(DRAWS);
    for _ in 0..DRAWS {
        let (a, b) = (draw.median_of(&a.repeats_s)?, draw.median_of(&b.repeats_s)?);
        ratios.push(b / a);
    }
    ratios.sort_by(f64::total_cmp);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small share")]
    let left_out = (LEFT_OUT * DRAWS as f64) as usize;
    let interval = (ratios[left_out], ratios[DRAWS - 1 - left_out]);
    Some(TimeChange { key: a.key(), times, ratio: times[1] / times[0], interval })
}

/// A stream of numbers: Steele, Lea and Flood's `SplitMix64`.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The median of as many values, drawn with repetition.
    fn median_of(&mut self, values: &[f64]) -> Option<f64> {
        let n = values.len() as u64;
        let at = |i: u64| usize::try_from(i % n).ok().and_then(|i| values.get(i)).copied();
        let drawn: Option<Vec<f64>> = (0..n).map(|_| at(self.next())).collect();
        median(&drawn?)
    }
}
