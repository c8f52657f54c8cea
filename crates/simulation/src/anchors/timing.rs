//! How long a delivery takes, by a clock that is handed in: this crate has none.

use super::Verified;
use integrate::Limits;

/// How long and how often each contestant is timed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Repeats each has at least.
    pub least: usize,
    /// Repeats each has at most.
    pub most: usize,
    /// Time [s] after which one that has had its least is done.
    pub share_s: f64,
    /// A repeat that is shorter [s] is made of several deliveries.
    pub batch_s: f64,
}

/// Times all whose answer is right, in rounds: each has its turn before any has its next, so that a change
/// in the machine's speed meets all alike. `clock` tells the CPU time of this thread [s].
pub fn time(
    contestants: &mut [Verified<'_>],
    (grid, limits): (&[f64], &Limits),
    timing: &Timing,
    states: &mut [f64],
    clock: &mut dyn FnMut() -> f64,
) {
    let mut batches = vec![1_u32; contestants.len()];
    let mut spent = vec![0.0; contestants.len()];
    for round in 0..=timing.most {
        let mut busy = false;
        for (i, verified) in contestants.iter_mut().enumerate() {
            let repeats = verified.row.repeats_s.len();
            let done = repeats >= timing.least && spent[i] >= timing.share_s;
            if !verified.row.right() || done {
                continue;
            }
            let start = clock();
            for _ in 0..batches[i] {
                verified.contestant.deliver(grid, limits, states);
            }
            let taken = clock() - start;
            busy = true;
            spent[i] += taken;
            if round == 0 {
                // The first only warms up and tells how many make a batch.
                batches[i] = batch(timing.batch_s, taken);
            } else {
                verified.row.repeats_s.push(taken / f64::from(batches[i]));
            }
        }
        if !busy {
            break;
        }
    }
    for verified in contestants {
        verified.row.cpu_s = median(&verified.row.repeats_s);
    }
}

/// How many deliveries that take `one` [s] last `batch_s` [s].
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and 1000")]
fn batch(batch_s: f64, one: f64) -> u32 {
    (batch_s / one).ceil().clamp(1.0, 1000.0) as u32
}

/// The median; none of nothing.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (middle, odd) = (sorted.len() / 2, sorted.len() % 2 == 1);
    let upper = *sorted.get(middle)?;
    Some(if odd { upper } else { 0.5 * (sorted[middle - 1] + upper) })
}
