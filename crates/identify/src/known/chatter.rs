//! The noise of a recorded input that a controller made.
//!
//! A digital controller answers each step of its encoder, and its command trembles with them. The motor gets that command all
//! the same: it is no noise of the record, though from the input alone it looks like some.

use crate::{doctor, fit::Data};
use nalgebra::{DMatrix, DVector};

/// A command may hang on so many last samples of each measured channel.
const LAGS: usize = 4;

/// Differences of this order leave nothing of what is smooth.
const ORDER: usize = 3;

/// Rows further off than so many times the median are corners of the input and fit nothing.
const CORNER: f64 = 5.0;

/// A command trembles with the encoder if so much less is left without what it answers: the same noise is told twice only to
/// a few hundredths.
const CLEARLY: f64 = 0.8;

/// It is fitted so often, without the corners of the fit before.
const FITS: usize = 3;

/// Standard deviation of the noise of the recorded input [its unit]: what is left of its differences beside those of the
/// displacement and the velocity as they were measured, and as a controller would have had them.
pub fn noise_of_input(data: &Data) -> f64 {
    let alone = data.noise_of_input();
    if data.averaged.is_some() {
        return alone;
    }
    let seen: Vec<&[f64]> = [&data.displacement, &data.velocity]
        .into_iter()
        .filter_map(|seen| Some(seen.as_ref()?.values.as_slice()))
        .collect();
    if seen.is_empty() || data.input.len() < 100 * LAGS {
        return alone;
    }
    let rest = beside(&data.input, &seen);
    let beside = rest.map_or(alone, |rest| doctor::noise(&rest));
    if beside < CLEARLY * alone { beside } else { alone }
}

/// `input` less what goes along with the last samples of `seen`.
fn beside(input: &[f64], seen: &[&[f64]]) -> Option<Vec<f64>> {
    let rough = differences(input);
    let others: Vec<Vec<f64>> = seen.iter().map(|values| differences(values)).collect();
    let others: Vec<&[f64]> = others.iter().map(Vec::as_slice).collect();
    let n = LAGS * seen.len();
    let mut along = DVector::zeros(n);
    for _ in 0..FITS {
        let left = |i: usize| (rough[i] - lagged(&others, i).dot(&along)).abs();
        let mut sizes: Vec<f64> = (LAGS..rough.len()).map(left).collect();
        let middle = sizes.len() / 2;
        let typical = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
        let (mut normal, mut right) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for i in (LAGS..rough.len()).filter(|i| left(*i) <= CORNER * typical) {
            let row = lagged(&others, i);
            normal.ger(1.0, &row, &row, 1.0);
            right.axpy(rough[i], &row, 1.0);
        }
        let ridge = 1e-12 * normal.diagonal().max();
        along = (normal + DMatrix::identity(n, n) * ridge).cholesky()?.solve(&right);
    }
    Some((LAGS..input.len()).map(|i| input[i] - lagged(seen, i).dot(&along)).collect())
}

/// The last samples of each channel up to the one at `i`.
fn lagged(channels: &[&[f64]], i: usize) -> DVector<f64> {
    let last = |values: &&[f64]| (0..LAGS).map(|lag| values[i - lag]).collect::<Vec<f64>>();
    DVector::from_vec(channels.iter().flat_map(last).collect())
}

fn differences(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    for _ in 0..ORDER {
        values = values.windows(2).map(|w| w[1] - w[0]).collect();
    }
    values
}

#[cfg(test)]
mod tests {
    use super::noise_of_input;
    use crate::{
        Hold,
        fit::{Data, Seen},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    const NOISE: f64 = 0.01;

    /// The command of a controller that differentiates an encoder of 0.1 mrad, with noise of its own; or of none that looks
    /// at the encoder.
    fn data(differentiates: f64) -> Data {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..8000).map(|i| 0.002 * f64::from(i)).collect();
        let angle = |t: f64| 1e-4 * (1e4 * (0.3 * (2.0 * t).sin() + 0.1 * (5.7 * t).cos())).round();
        let seen: Vec<f64> = time.iter().map(|t| angle(*t)).collect();
        let input = (0..seen.len()).map(|i| {
            let rate = (seen[i] - seen[i.saturating_sub(1)]) / 0.002;
            let reference = 3.0 * (2.0 * time[i]).sin() + if i % 1500 < 700 { 1.0 } else { 0.0 };
            reference - differentiates * rate - 5.0 * seen[i] + NOISE * noise()
        });
        let input = input.collect();
        Data::driven(time, input, Hold::ZeroOrder, Seen::new("angle", seen, 1e-4))
    }

    #[test]
    fn what_a_controller_answers_its_encoder_is_no_noise() {
        let closed = data(1.5);
        let (alone, beside) = (closed.noise_of_input(), noise_of_input(&closed));
        assert!(alone > 3.0 * NOISE, "{alone}");
        assert!((beside / NOISE - 1.0).abs() < 0.05, "{beside}");
    }

    #[test]
    fn an_input_that_no_controller_made_is_as_noisy_as_it_looks() {
        let open = data(0.0);
        let (alone, beside) = (open.noise_of_input(), noise_of_input(&open));
        assert!((beside - alone).abs() < 1e-15, "{beside} of {alone}");
        let mut known = data(1.5);
        known.averaged = Some(0.7);
        assert!((noise_of_input(&known) - 0.7).abs() < 1e-12);
    }
}
