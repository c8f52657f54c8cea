//! What a row of numbers tells of the instrument that wrote it.

use crate::recording::usable;

/// The median; 0 of nothing. Reorders `values`.
pub(super) fn median(values: &mut [f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value below which a share `p` of the others lies; 0 of nothing. Reorders `values`.
pub(super) fn quantile(values: &mut [f64], p: f64) -> f64 {
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let i = at_share(last, p);
    *values.select_nth_unstable_by(i, f64::total_cmp).1
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share of an index is an index"
)]
fn at_share(last: usize, p: f64) -> usize {
    ((last as f64 * p).round() as usize).min(last)
}

/// The usual step of a clock [s]: the median of the steps that go forward; 0 if none does.
pub(crate) fn median_step(time: &[f64]) -> f64 {
    let steps = time.windows(2).map(|w| w[1] - w[0]).filter(|d| *d > 0.0 && usable(*d));
    median(&mut steps.collect::<Vec<f64>>())
}

/// Standard deviation of the white noise on a smooth signal, from its differences of order three and above:
/// a cubic leaves nothing of the third, and white noise of variance σ² leaves var(Δ³) = (1 + 9 + 9 + 1)σ² =
/// 20σ², of the fifth 252σ², of the seventh 3432σ².
///
/// White noise gives the same σ by each order, and what the signal adds falls with the order, so the least
/// is taken. The spread is that of the median size, which corners and outliers do not move. A signal that is
/// sampled very coarsely (ωT above some 0.5) still leaves something and the noise comes out too large; one
/// that changes by less than its quantum from sample to sample leaves nothing, and the noise comes out as 0.
pub fn noise(values: &[f64]) -> f64 {
    let mut differences = values.to_vec();
    let mut least = f64::INFINITY;
    for order in 1..=7_u32 {
        differences = differences.windows(2).map(|w| w[1] - w[0]).collect();
        let good = differences.iter().map(|d| d.abs()).filter(|d| d.is_finite());
        let mut good: Vec<f64> = good.collect();
        if order < 3 || order.is_multiple_of(2) || good.is_empty() {
            continue;
        }
        // The median size of a normal variable is 0.6745 of its standard deviation.
        let spread = median(&mut good) / 0.674_489_750_196_082;
        least = least.min(spread / central_binomial(order).sqrt());
    }
    if least.is_finite() { least } else { 0.0 }
}

/// The sum of the squares of the coefficients of a difference: (2n)!/(n!)².
fn central_binomial(n: u32) -> f64 {
    (1..=n).map(|i| f64::from(n + i) / f64::from(i)).product()
}

/// The fewest levels from which a quantum can be told: two-level signals have none.
const LEVELS: usize = 8;

/// The step of which the distances between all levels are multiples, if there is one.
///
/// The smallest distance is the first guess, refined over ever larger distances; it is a quantum if 95 % of
/// the distances are within a tenth of a step of a multiple, where chance would give 20 %.
pub(crate) fn quantum(values: &[f64]) -> Option<f64> {
    let mut levels: Vec<f64> = values.iter().copied().filter(|v| usable(*v)).collect();
    levels.sort_unstable_by(f64::total_cmp);
    let largest = levels.last()?.abs().max(levels.first()?.abs());
    // What a conversion of units leaves in the last bits is no level of its own.
    let same = 1e-12 * largest;
    levels.dedup_by(|b, a| *b - *a <= same);
    if levels.len() < LEVELS {
        return None;
    }
    let gaps: Vec<f64> = levels.windows(2).map(|w| w[1] - w[0]).collect();
    let mut step = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    for reach in [1.5, 10.0, 100.0, 1e3, 1e4] {
        let near = gaps.iter().filter(|g| **g <= reach * step);
        let (sum, count) = near.fold((0.0, 0.0), |(s, n), g| (s + g, n + (g / step).round()));
        step = sum / count;
    }
    let whole = |g: &&f64| (*g / step - (*g / step).round()).abs() < 0.1;
    let share = gaps.iter().filter(whole).count() as f64 / gaps.len() as f64;
    (share >= 0.95 && step > 0.0).then_some(step)
}

/// The longest run of samples equal to `value`: its first row and its length.
pub(super) fn longest_run(values: &[f64], value: f64) -> (usize, usize) {
    let (mut best, mut start, mut length) = ((0, 0), 0, 0);
    for (i, v) in values.iter().enumerate() {
        if *v == value {
            if length == 0 {
                start = i;
            }
            length += 1;
            if length > best.1 {
                best = (start, length);
            }
        } else {
            length = 0;
        }
    }
    best
}

/// A number in three figures.
pub(super) fn n(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    if !(1e-3..1e5).contains(&size) {
        let text = format!("{value:.2e}");
        return match text.split_once('e') {
            Some((digits, power)) if digits.contains('.') => {
                format!("{}e{power}", digits.trim_end_matches('0').trim_end_matches('.'))
            }
            _ => text,
        };
    }
    let decimals = [1.0, 10.0, 100.0].iter().filter(|t| size < **t).count()
        + [1e-2, 1e-1].iter().filter(|t| size < **t).count();
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_noise_leaves_the_sum_of_the_squared_coefficients() {
        let sums = [(3, 1.0 + 9.0 + 9.0 + 1.0), (5, 252.0), (7, 3432.0)];
        for (order, sum) in sums {
            assert!((central_binomial(order) - sum).abs() < 1e-9 * sum, "order {order}");
        }
    }

    #[test]
    fn numbers_are_told_in_three_figures() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (1234.6, "1235"),
            (12.346, "12.3"),
            (0.123_46, "0.123"),
            (0.012_346, "0.0123"),
            (0.001_234_6, "0.00123"),
            (1.5e-4, "1.5e-4"),
            (-2e-9, "-2e-9"),
            (1e300, "1e300"),
            (f64::NAN, "NaN"),
        ];
        for (value, text) in cases {
            assert_eq!(n(value), text);
        }
    }
}
