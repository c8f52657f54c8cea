//! What noise alone leaves: that of the sensors, and that of the recorded input on its way through the model.

mod imposed;

pub(crate) use imposed::imposed;

use crate::board::{Board, Fitted};
use identify::{
    Rig,
    fit::{Data, FitError, data::Seen, whitening::Whitening},
    march::Feedback,
};
use rayon::prelude::*;
use std::sync::Arc;

/// What makes the residuals of every window independent of each other: on its way through the model the noise of the
/// input, white as it is, moves many samples at once.
pub(crate) fn whitened(
    board: &Board<'_>,
    fitted: &Fitted,
) -> Result<Vec<Option<Arc<Whitening>>>, FitError> {
    let noise = noise_of_input(board.data, &fitted.rig);
    let held = fitted.held();
    let problem = board.problem(&held, |_| true)?;
    let both = board.windows.par_iter().zip(&fitted.pieces);
    Ok(both.map(|both| problem.whitening(&[], both, noise).map(Arc::new)).collect())
}

/// Standard deviation of the noise of the recorded input. A controller's command jumps with every step of its encoder,
/// which is no noise: there it is what the record differs by from the command that its own positions ask for.
fn noise_of_input(data: &Data, rig: &Rig) -> f64 {
    let least = data.noise_of_input();
    let (Some(c), Some(seen)) = (&rig.controller, &data.displacement) else { return least };
    if data.reference.is_empty() {
        return 0.0;
    }
    let law = Feedback {
        kp: c.kp,
        kv: c.kv,
        limit: c.limit,
        sample_time: c.sample_time,
        reference: &data.reference,
        added: &data.added,
    };
    let off = |i: usize| data.input[i] - law.command(i, [seen.values[i], seen.values[i - 2]]);
    let mut off: Vec<f64> = (2..data.input.len()).map(|i| off(i).abs()).collect();
    let middle = off.len() / 2;
    let middle = *off.select_nth_unstable_by(middle, f64::total_cmp).1;
    (middle / MIDDLE).min(least)
}

/// Differences beyond so many standard deviations are no noise.
const OUTLYING: f64 = 4.0;

/// From this order on the differences of an encoder are so many steps that their middle says enough.
const FINE: usize = 7;

/// The median size of a normal variable is so much of its standard deviation.
const MIDDLE: f64 = 0.674_489_750_196_082;

/// The signal of an encoder is the same as before for more than one sample in so many.
const OFTEN: usize = 10;

/// A signal that has come so many standard deviations moves, and hardly ever if for fewer than one sample in so many.
const MOVED: f64 = 4.0;
const SELDOM: usize = 50;

/// Of what the middle difference or the step of an encoder says at least so much shows.
const SHOWN: f64 = 0.7;

/// Standard deviation of the white noise on a smooth signal, from its third, fifth, seventh and ninth differences:
/// of the first two by their root mean square, where the middle one would see only the steps of an encoder; `least` is
/// that of the middle one.
pub(crate) fn noise(seen: &Seen, least: f64) -> f64 {
    let values = &seen.values;
    let mut differences = values.clone();
    let mut found = f64::INFINITY;
    let rests = values.windows(2).filter(|w| w[0] == w[1]).count();
    let stepped = rests > values.len() / OFTEN;
    for order in 1..=9 {
        differences = differences.windows(2).map(|w| w[1] - w[0]).collect();
        // The sum of the squares of a difference's coefficients.
        let sum: f64 = match order {
            3 => 20.0,
            5 => 252.0,
            7 => 3432.0,
            9 => 48_620.0,
            _ => continue,
        };
        let far = if stepped { MOVED * least } else { f64::NEG_INFINITY };
        let seen = moving(&differences, values, far);
        let one = if order < FINE {
            by_squares(&seen, OUTLYING * least * f64::sqrt(sum))
        } else {
            by_middle(seen)
        };
        let one = one / sum.sqrt();
        if one > SHOWN * least {
            found = found.min(one);
        }
    }
    // A signal that changes by less than a step from sample to sample shows no noise at all.
    let found = if found.is_finite() { found } else { least };
    found.max(seen.quantum / 12.0_f64.sqrt())
}

/// The differences where the signal moves by more than this `far` while they are taken: within a step of an encoder
/// nothing is seen of its noise. All of them where it hardly ever does.
fn moving(differences: &[f64], values: &[f64], far: f64) -> Vec<f64> {
    let order = values.len() - differences.len();
    let moves = |(i, _): &(usize, &f64)| (values[*i + order] - values[*i]).abs() > far;
    let found: Vec<f64> = differences.iter().enumerate().filter(moves).map(|(_, d)| *d).collect();
    if found.len() > differences.len() / SELDOM { found } else { differences.to_vec() }
}

/// The root mean square of all values but those beyond the `most`.
fn by_squares(values: &[f64], most: f64) -> f64 {
    let near = values.iter().filter(|d| d.abs() <= most);
    let (count, squares) = near.fold((0.0_f64, 0.0), |(n, s), d| (n + 1.0, s + d * d));
    (squares / count.max(1.0)).sqrt()
}

/// The standard deviation of a normal variable whose middle size is that of the values.
fn by_middle(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() {
        return 0.0;
    }
    for value in &mut values {
        *value = value.abs();
    }
    *values.select_nth_unstable_by(middle, f64::total_cmp).1 / MIDDLE
}

#[cfg(test)]
mod tests {
    use super::{Seen, noise};
    use crate::{board::Board, walk::made};
    use identify::{
        Hold, Rig,
        fit::{Data, search::Patience},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn the_noise_of_an_encoder_is_that_of_its_steps() {
        // A sine seen in steps of 1: the error is uniform, 1/√12, but the middle third difference is one step.
        let values: Vec<f64> =
            (0..20_000).map(|i| (300.0 * (0.013 * f64::from(i)).sin()).round()).collect();
        let median = identify::doctor::noise(&values);
        let found = noise(&Seen::new("angle", values, 1.0), median);
        let truth = 1.0 / 12f64.sqrt();
        assert!(
            (found / truth - 1.0).abs() < 0.05,
            "{found}, by the median {median}, in truth {truth}"
        );
    }

    #[test]
    fn rests_and_corners_of_a_motion_are_no_noise() {
        // Forth and back with rests between, seen in steps of 1 that tremble by a fifth.
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut tremble = || {
            let drawn: f64 = StandardNormal.sample(&mut random);
            0.2 * drawn
        };
        let way = |i: u32| 400.0 * (0.01 * f64::from(i % 1000)).min(3.0).sin();
        let values: Vec<f64> = (0..20_000).map(|i| (way(i) + tremble()).round()).collect();
        let median = identify::doctor::noise(&values);
        let found = noise(&Seen::new("position", values, 1.0), median);
        let truth = 0.2_f64.hypot(1.0 / 12f64.sqrt());
        assert!((found / truth - 1.0).abs() < 0.1, "{found}, in truth {truth}");
    }

    #[test]
    fn a_mass_is_not_heavier_for_the_noise_of_its_input() {
        // 50 g on 3 N/m with 0.5 N·s/m under a force that is recorded with 0.4 N of noise: a heavier mass lets less of it through.
        let mut random = ChaCha8Rng::seed_from_u64(12);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..8000).map(|i| 0.005 * f64::from(i)).collect();
        let tones = [(0.5, 2.0), (0.1, 14.0)];
        let force = |t: f64, (x, w): (f64, f64)| {
            let (s, c) = f64::sin_cos(w * t);
            x * ((3.0 - 0.05 * w * w) * s + 0.5 * w * c)
        };
        let force = |t: f64| tones.iter().map(|tone| force(t, *tone)).sum::<f64>();
        let input = time.iter().map(|t| force(*t) + 0.4 * noise()).collect();
        let way = |t: f64| tones.iter().map(|(x, w)| x * (w * t).sin()).sum::<f64>();
        let seen = time.iter().map(|t| way(*t) + 1e-3 * noise()).collect();
        let as_recorded = Data::driven(time, input, Hold::Smooth, Seen::new("position", seen, 0.0));
        let rig = Rig { free: vec!["mass".into(), "sigma_2".into()], ..made::rig(0.05) };
        let off = |data: &Data| {
            let mut board = Board::of(&rig, data, 1, Vec::new()).unwrap();
            let mut fitted = board.judged(&rig, None).unwrap();
            for _ in 0..3 {
                board.refloor(&fitted, 0).unwrap();
                let from = (fitted.x.clone(), fitted.pieces.clone());
                fitted = board
                    .fit(
                        &fitted.rig,
                        Some((&from.0, &from.1)),
                        &Patience { misfit: 0.05, share: 1e-6, simulations: 20 },
                    )
                    .unwrap();
            }
            let level = board.trained_level(&fitted);
            (fitted.rig.value("mass").unwrap() / 0.05 - 1.0, level)
        };
        let (heavier, _) = off(&Data { averaged: Some(0.4), ..as_recorded.clone() });
        let (mass, level) = off(&identify::known::still(&as_recorded));
        assert!(heavier > 0.02 && mass.abs() < 0.01, "{mass} off, {heavier} as recorded");
        assert!((level - 1.0).abs() < 0.06, "{level} floors");
    }
}
