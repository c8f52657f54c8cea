//! What noise alone leaves: that of the sensors, and that of the recorded input on its way through the model.

use crate::board::{Board, Fitted};
use identify::{
    Rig,
    fit::{
        Data, FitError,
        data::Seen,
        models,
        problem::{Piece, Problem},
        shaken::Shaken,
        whitening::Whitening,
    },
    march::{Contact, Feedback},
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use std::sync::Arc;

/// How many times the input is perturbed by its own noise.
const TIMES: u64 = 16;

/// How many samples to either side tell of one sample's spread.
const AROUND: usize = 1;

/// So many samples that move tell their noise.
const LITTLE: usize = 64;

/// By how much every sample spreads beside what makes the rest independent: force [N] and none.
type Floor = (Vec<[f64; 2]>, Option<Arc<Whitening>>);

/// What the noise of an imposed displacement makes of a model's force: by how much every sample spreads beside what
/// follows from it to first order [N], and what makes the rest independent. Turns are noisier than the rest, so that
/// this is local in time.
pub(crate) fn imposed(board: &Board<'_>, fitted: &Fitted, seed: u64) -> Result<Floor, FitError> {
    let board = &Board { spread: Vec::new(), whitening: None, ..board.clone() };
    let rig = fitted.held();
    let problem = board.problem(&rig, |_| true)?;
    let contact = &problem.model(&[]).contact;
    let Some(shaken) = problem.shaken(&[], noise_of_displacement(&board.data.input)) else {
        return Ok((timed(board.data, contact, Vec::new()), None));
    };
    let here = models::settled(&problem, &[], Some(&fitted.pieces), 1);
    let draws: Result<Vec<Vec<f64>>, FitError> = (0..TIMES)
        .into_par_iter()
        .map(|time| one(board, (&rig, &here[0]), (&shaken, seed.wrapping_add(time))))
        .collect();
    let n = board.data.time.len();
    let mut sum = vec![0.0; n + 1];
    for draw in draws? {
        for (sum, d) in sum[1..].iter_mut().zip(&draw) {
            *sum += d * d;
        }
    }
    for i in 0..n {
        sum[i + 1] += sum[i];
    }
    let local = |i: usize| {
        let (low, high) = (i.saturating_sub(AROUND), (i + AROUND + 1).min(n));
        let count = (high - low) as f64 * TIMES as f64;
        [((sum[high] - sum[low]).max(0.0) / count).sqrt(), 0.0]
    };
    let spread = timed(board.data, contact, (0..n).map(local).collect());
    let weighed = Problem { spread: &spread, ..problem };
    let whitening = shaken.whitening(&weighed).map(Arc::new);
    Ok((spread, whitening))
}

/// Standard deviation of the noise of an imposed displacement [m], of what moves of it: where it rests it is its mean.
fn noise_of_displacement(u: &[f64]) -> f64 {
    let moving = u.chunk_by(|a, b| a == b).filter(|run| run.len() < crate::rest::LEAST);
    let moving: Vec<f64> = moving.flatten().copied().collect();
    identify::doctor::noise(if moving.len() > LITTLE { &moving } else { u })
}

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
    let least = identify::doctor::noise(&data.input);
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

/// By what one draw of the displacement's noise moves the force of every sample, less what it does to first order [N].
fn one(
    board: &Board<'_>,
    (rig, undisturbed): (&Rig, &Piece),
    (shaken, seed): (&Shaken, u64),
) -> Result<Vec<f64>, FitError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let (errors, first) = shaken.drawn(&mut || StandardNormal.sample(&mut random));
    let mut data: Data = board.data.clone();
    for (u, error) in data.input.iter_mut().zip(errors) {
        *u += error;
    }
    let other = Board { data: &data, ..board.clone() };
    let problem = other.problem(rig, |_| true)?;
    let there = models::settled(&problem, &[], Some(std::slice::from_ref(undisturbed)), 1);
    let pairs = there[0].motion.q.iter().zip(&undisturbed.motion.q).zip(first);
    Ok(pairs.map(|((there, here), first)| there - here - first).collect())
}

/// How well the time of a sample is known, in sampling times: at a corner there are two velocities, and a friction that
/// turns at once does so between two samples.
const CORNER: f64 = 2.0;
const TURN: f64 = 0.1;

/// The spread with that of a force that changes from sample to sample: one at a turn is worth what its time is.
pub(crate) fn timed(data: &Data, contact: &Contact<f64>, spread: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let Some(force) = &data.force else { return spread };
    let f = &force.values;
    let corners = identify::fit::corners(&data.input);
    let turn = if matches!(contact, Contact::Coulomb { .. }) { TURN } else { 0.0 };
    let u = &data.input;
    let step = |i: usize| u.get(i + 1).map_or(0.0, |next| next - u[i]);
    let turned = |i: usize| i > 0 && step(i - 1) * step(i) <= 0.0;
    let turns = |i: usize| (i.saturating_sub(1)..i + 2).any(turned);
    let known = |i: usize| {
        if corners[i] {
            CORNER
        } else if turns(i) {
            turn
        } else {
            0.0
        }
    };
    let of =
        |i: usize| known(i) * 0.5 * (f[(i + 1).min(f.len() - 1)] - f[i.saturating_sub(1)]).abs();
    let own = |i: usize| spread.get(i).copied().unwrap_or([0.0; 2]);
    (0..f.len()).map(|i| [own(i)[0].hypot(of(i)), own(i)[1]]).collect()
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
    use super::{
        Board, ChaCha8Rng, Data, Distribution, Rig, SeedableRng, Seen, StandardNormal, imposed,
        noise,
    };

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
    fn noise_does_not_shake_an_imposed_motion_at_rest() {
        // Half a second of rest and half a second of motion in turn, forth and back; displacement to 1 µm.
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut noise = |size: f64| -> f64 {
            let drawn: f64 = StandardNormal.sample(&mut random);
            size * drawn
        };
        let rests = |i: usize| i % 200 < 100;
        let way = |i: usize| if i % 400 < 200 { 1.0 } else { -1.0 };
        let (mut x, mut last) = (0.0, 0.0);
        let (mut input, mut force) = (Vec::new(), Vec::new());
        for i in 0..8000 {
            if !rests(i) {
                (x, last) = (x + 1e-4 * way(i), way(i));
            }
            input.push(x + noise(1e-6));
            force.push(1.5 * last + noise(1e-3));
        }
        let time = (0..8000).map(|i| 0.005 * f64::from(i)).collect();
        let seen = Seen::new("force", force, 0.0);
        let driven = Data::driven(time, input, identify::Hold::Linear, seen.clone());
        let data = Data { displacement: None, force: Some(seen), ..driven };
        let data = crate::rest::rested(&data);
        let rig = "title = \"a slide\"\n[plant]\nkind = \"prescribed\"\n[friction]\nname = \"coulomb\"\nf_c = 1.5\n\
            [channels]\ntime = \"t\"\ndisplacement = \"x\"\nforce = \"f\"\n";
        let rig = Rig::parse(rig).unwrap();
        let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let fitted = board.judged(&rig, None).unwrap();
        let (all, _) = imposed(&board, &fitted, 1).unwrap();
        // Away from the turns, whose time noise does move.
        let resting = (0..8000).filter(|i| (20..80).contains(&(i % 200)));
        let worst = resting.map(|i| all[i][0]).fold(0.0, f64::max);
        assert!(worst < 1e-3, "{worst} N of 1.5 N");
    }
}
