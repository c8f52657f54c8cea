//! What is known of a recorded input or imposed displacement, beside the noise of its sensor.
//!
//! A bristle that is shaken by such noise forgets what it holds, and one under load creeps: what is at rest though its sensor
//! trembles is held, and what moves is as its band has it or, where it has none, laid smooth.

mod band;
mod chatter;
mod smooth;

pub use chatter::noise_of_input;

use crate::fit::Data;
use std::{borrow::Cow, ops::Range};

/// What lies within so many standard deviations of the noise, over at least so many samples, may be at rest.
const WITHIN: f64 = 7.0;
const LEAST: usize = 10;

/// So many samples that move tell their noise.
const LITTLE: usize = 64;

/// A slope of so many standard errors is a motion.
const MOVING: f64 = 4.0;

/// Values that spread by so many standard errors of a variance more than their noise lets them are not at rest.
const SPREAD: f64 = 4.0;

/// A record with an imposed motion as that is known; any other as it is.
pub(crate) fn motion(data: &Data) -> Cow<'_, Data> {
    // What was averaged is known already.
    if data.force.is_none() || data.averaged.is_some() {
        return Cow::Borrowed(data);
    }
    Cow::Owned(imposed(data))
}

/// `data` as its motion is simulated: an imposed one is as its band has it, or rests where it does, and an input is as its band has
/// it or, where it has none, held where it is and laid smooth elsewhere.
pub fn still(data: &Data) -> Data {
    if data.force.is_some() {
        return imposed(data);
    }
    let noise = noise_of_input(data);
    let rested = Data { averaged: Some(noise), ..rested(data) };
    // A command that answers its encoder drives the plant as it is.
    if !data.reference.is_empty() || noise < data.noise_of_input() {
        return rested;
    }
    let smooth = smooth::smoothed(&rested.input, noise);
    let (input, band) = band::banded(&data.input, noise, smooth);
    Data { input, band, ..rested }
}

/// An imposed motion as its band has it or, where it has none, laid smooth; at rest where it is so for longer than two waves of that
/// band.
fn imposed(data: &Data) -> Data {
    let rested = rested(data);
    let noise = noise_of_displacement(&rested.input);
    let mut otherwise = smooth::smoothed(&data.input, noise);
    let mut rests: Vec<Range<usize>> = Vec::new();
    let mut first = 0;
    for run in rested.input.chunk_by(|a, b| a == b) {
        let own = first..first + run.len();
        first = own.end;
        if run.len() >= LEAST {
            otherwise[own.clone()].copy_from_slice(run);
            rests.push(own);
        }
    }
    let (mut input, mut band) = band::finely(&data.input, noise, otherwise);
    if let Some(band) = &mut band {
        // Where a wave turns it is all but still, for less than two of its periods, and a rest begins and ends with some of the way.
        let wave = 4.0 * std::f64::consts::PI / band.edge;
        for mut own in rests {
            while own.len() as f64 > wave && spreads(&data.input[own.clone()], noise) {
                own = own.start + LEAST / 2..own.end - LEAST / 2;
            }
            if own.len() as f64 > wave {
                let mean = data.input[own.clone()].iter().sum::<f64>() / own.len() as f64;
                input[own.clone()].fill(mean);
                band.inside[own].fill(false);
            }
        }
    }
    Data { input, averaged: Some(noise), band, ..rested }
}

/// Standard deviation of the noise of an imposed displacement `u` [m], of what moves of it: where it rests it is its mean.
pub fn noise_of_displacement(u: &[f64]) -> f64 {
    let moving = u.chunk_by(|a, b| a == b).filter(|run| run.len() < LEAST);
    let moving: Vec<f64> = moving.flatten().copied().collect();
    crate::doctor::noise(if moving.len() > LITTLE { &moving } else { u })
}

/// `data` with the imposed displacement, or the input, replaced by its mean wherever it rests.
pub fn rested(data: &Data) -> Data {
    let noise = crate::doctor::noise(&data.input);
    let mut rested = data.clone();
    let u = &data.input;
    let mut first = 0;
    while first < u.len() {
        let end = quiet(u, first, WITHIN * noise);
        let run = &u[first..end];
        let held = || data.force.is_some() || !spreads(run, noise) && stays(data, first, end);
        if run.len() >= LEAST && !moves(run, noise) && held() {
            let mean = run.iter().sum::<f64>() / run.len() as f64;
            rested.input[first..end].fill(mean);
            first = end;
        } else {
            first += 1;
        }
    }
    rested
}

/// One past the last sample from `first` on that lies within `range` of all before it.
fn quiet(u: &[f64], first: usize, range: f64) -> usize {
    let (mut low, mut high) = (u[first], u[first]);
    for (i, value) in u.iter().enumerate().skip(first) {
        (low, high) = (low.min(*value), high.max(*value));
        if high - low > range {
            return i;
        }
    }
    u.len()
}

/// Whether a driven plant is where it was through these samples: while it moves its input may be a slow one.
fn stays(data: &Data, first: usize, end: usize) -> bool {
    let seen = data.displacement.as_ref();
    seen.is_some_and(|seen| quiet(&seen.values[..end], first, WITHIN * seen.noise) == end)
}

/// Whether the values are further from their mean than their `noise` lets them be, as those of an arc are.
fn spreads(run: &[f64], noise: f64) -> bool {
    let n = run.len() as f64;
    let mean = run.iter().sum::<f64>() / n;
    let squares: f64 = run.iter().map(|v| (v - mean).powi(2)).sum();
    squares / (n - 1.0) > noise * noise * (1.0 + SPREAD * (2.0 / (n - 1.0)).sqrt())
}

/// Whether the values go up or down by more than their `noise` lets them.
fn moves(run: &[f64], noise: f64) -> bool {
    let n = run.len() as f64;
    let (middle, mean) = (0.5 * (n - 1.0), run.iter().sum::<f64>() / n);
    let along: f64 = run.iter().enumerate().map(|(i, v)| (i as f64 - middle) * (v - mean)).sum();
    let squares = n * (n * n - 1.0) / 12.0;
    along.abs() / squares.sqrt() > MOVING * noise
}

#[cfg(test)]
mod tests {
    use super::smooth::tests::{NOISE, noisy, off};
    use super::{Data, moves, rested, still};
    use crate::{Hold, fit::Seen};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn a_slow_ramp_is_no_rest() {
        let noise = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let still: Vec<f64> = (0..40).map(noise).collect();
        let creeping: Vec<f64> = (0..40).map(|i| noise(i) + 0.1 * i as f64).collect();
        assert!(!moves(&still, 1.0) && moves(&creeping, 1.0));
    }

    #[test]
    fn an_input_is_averaged_where_it_is_held_and_the_plant_rests() {
        // 2 N for a while, in which the plant goes fast, and once more while it rests; else 1 N to either side, which has no band.
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let seen = time.iter().map(|t| (2.0 * t).sin() + 1e-3 * noise()).collect();
        let seen = Seen::new("position", seen, 0.0);
        let mut data = Data::driven(time, vec![0.0; 4000], Hold::Linear, seen);
        let (moves, rests) = (880..1040, 3000..3200);
        for i in 0..data.input.len() {
            let held = moves.contains(&i) || rests.contains(&i);
            data.input[i] =
                0.01 * noise() + if held { 2.0 } else { (0.01 * i as f64).sin().signum() };
        }
        let seen = data.displacement.as_mut().expect("it is seen");
        let there = seen.values[rests.start];
        seen.values[rests.clone()].fill(there);
        let shown = data.noise_of_input();
        let still = still(&data);
        assert_eq!(rested(&data).input[moves.clone()], data.input[moves.clone()]);
        let off = |u: &[f64]| u.iter().map(|u| (u - 2.0).powi(2)).sum::<f64>();
        let [less, more] = [&still, &data].map(|data| off(&data.input[moves.clone()]));
        // 0.35 to 0.54 with three seeds; 1 as it is recorded.
        assert!(less < 0.7 * more, "what moves is laid smooth: {less} for {more}");
        let held = &still.input[rests];
        let answers =
            super::still(&Data { reference: vec![0.0; data.input.len()], ..data.clone() });
        assert_eq!(answers.input, rested(&data).input, "a controller's command is as it is");
        let near = held.iter().filter(|u| (*u - 2.0).abs() < 4e-3).count();
        assert!(near > 180, "{near} of 200");
        // What is known of its noise is what it was.
        assert_eq!(still.noise_of_input(), shown);
        assert!((shown - 0.01).abs() < 1e-3, "{shown} N");
    }

    #[test]
    fn an_input_that_has_a_band_is_as_that_has_it() {
        let clean: Vec<f64> = (0..12_000)
            .map(|i| (0.011 * f64::from(i)).sin() + 0.4 * (0.094 * f64::from(i)).sin())
            .collect();
        let input = noisy(&clean);
        let time: Vec<f64> = (0..12_000).map(|i| 0.005 * f64::from(i)).collect();
        let seen = Seen::new("position", clean.clone(), 0.0);
        let known = still(&Data::driven(time, input, Hold::Smooth, seen));
        let band = known.band.expect("tones have one");
        // White noise of which so much is in the band; by the samples around each it would be twice as much.
        let left = off(&known.input, &clean) / NOISE;
        let share = (band.edge / std::f64::consts::PI).sqrt();
        assert!((left / share - 1.0).abs() < 0.2, "{left} of the noise for {share}");
    }

    #[test]
    fn an_imposed_motion_is_as_its_band_has_it_and_rests_where_it_does() {
        // Forth and back in two seconds, and a rest of two.
        let way = |i: usize| 1.0 - (std::f64::consts::PI * (i % 800).min(400) as f64 / 200.0).cos();
        let clean: Vec<f64> = (0..12_000).map(way).collect();
        let force = Seen::new("force", noisy(&clean), 0.0);
        let time = (0..12_000).map(|i| 0.005 * f64::from(i)).collect();
        let driven = Data::driven(time, noisy(&clean), Hold::Linear, force.clone());
        let seen = Data { displacement: None, force: Some(force), ..driven };
        let known = still(&seen);
        let band = known.band.as_ref().expect("it has one");
        let rests = |i: usize| known.input[i] == known.input[i + 1];
        let all = || (1000..11_000).filter(|i| (20..780).contains(&(i % 800)));
        let (resting, moving) = (all().filter(|i| i % 800 > 420), all().filter(|i| i % 800 < 380));
        // A few of 5400 samples begin a rest anew: noise goes further once in a while.
        let not = resting.clone().filter(|i| !rests(*i) || band.inside[*i]).count();
        assert!(not < 30, "{not} do not rest");
        // Of the way a little beside a rest is within noise.
        let resting_ways = moving.clone().filter(|i| rests(*i) || !band.inside[*i]).count();
        assert!(resting_ways < 100, "{resting_ways} of 4500 samples rest on the way");
        let of = |u: &[f64]| moving.clone().map(|i| u[i]).collect::<Vec<f64>>();
        let left = off(&of(&known.input), &of(&clean)) / NOISE;
        // Where a rest ends it has no band, but for one that is hidden in the noise.
        assert!(left < 0.6, "{left} of the noise is left");
        assert!((known.averaged.unwrap() / NOISE - 1.0).abs() < 0.05);
        // What an encoder shows at rest is no noise to lay smooth.
        let steps = clean.iter().map(|u| (u / 0.01).round() * 0.01).collect();
        let stepped = still(&Data { input: steps, ..seen });
        let not = resting.filter(|i| stepped.input[*i] != stepped.input[i + 1]).count();
        assert!(not < 30, "{not} do not rest");
    }
}
