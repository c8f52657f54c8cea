//! A recorded input by its band.
//!
//! An input of tones, a chirp or a filtered signal is what one filter passes. The noise that is left there is as dense as it was and
//! hangs together as the filter says, whatever it is; what a parabola through the samples around leaves does not. An input that
//! jumps has no band, but for one that does so once or twice.

use crate::fit::data::Band;

/// A band is told with filters of so many samples to either side, the shortest first: each passes 1/√2 times as wide a band as
/// the one before.
const LENGTHS: [usize; 11] = [32, 45, 64, 90, 128, 181, 256, 362, 512, 724, 1024];

/// Kaiser's β, at least: what is outside of the band is smaller by 85 dB, and what is inside is as it was but for as much.
const BETA: f64 = 8.3;

/// With that β the way from pass to stop is so wide, of 2π over a filter's whole length [1]; the band begins to end at twice and
/// ends at three times that.
const WAY: f64 = 5.36;

/// What a filter does to an input is to be less than its noise by so much [dB].
const BELOW: f64 = 45.0;

/// What is left beside a band is noise if its mean square is by fewer than so many standard errors more, in all between one
/// band and the next, and in each stretch of so many samples; the noise is known to a few hundredths.
const BETWEEN: f64 = 3.0;
const IN_EACH: f64 = 5.5;
const STRETCH: usize = 32;
const KNOWN: f64 = 0.03;

/// A band ends sharply if so many times the noise is beyond the last filter, or beyond that and within one twice as long. One
/// filter more than the noise asks for is spared; of a band that ends slowly, as that of a triangle with its corners, so many, each
/// of which lets a quarter as much of its end or less be.
const SHARP: f64 = 100.0;
const SPARE: usize = 2;

/// A band of more than this share of all is told no better than by the samples around each.
const NARROW: f64 = 0.25;

/// No more than this share of a record may have more than its band.
const OUTSIDE: f64 = 0.3;

/// `u` without what is above the narrowest band beside which no more is left than this `noise`, if it does not fill its own. Each
/// value hangs on the same filter (Kaiser and Schafer, IEEE Transactions on Acoustics, Speech, and Signal Processing 28, 1980,
/// 105–107), whatever its noise is; near the ends and where more than noise is left it is as it is `otherwise`.
pub(super) fn banded(u: &[f64], noise: f64, otherwise: Vec<f64>) -> (Vec<f64>, Option<Band>) {
    cut(narrowest(u, noise, None), otherwise)
}

/// The same by filters that do less to it than its noise, however quiet that is. It is
/// for imposed motions: with the narrower bands of driven inputs one record of 60 had a name though nothing is hidden in it.
pub(super) fn finely(u: &[f64], noise: f64, otherwise: Vec<f64>) -> (Vec<f64>, Option<Band>) {
    if noise <= 0.0 {
        return (otherwise, None);
    }
    cut(narrowest(u, noise, Some(decibels(u, noise))), otherwise)
}

/// What was `passed`, where no more than noise is left beside it.
fn cut(passed: Option<Passed>, otherwise: Vec<f64>) -> (Vec<f64>, Option<Band>) {
    let Some(Passed { filter, values, inside }) = passed else {
        return (otherwise, None);
    };
    let pairs = values.into_iter().zip(otherwise).zip(&inside);
    let input = pairs.map(|((own, other), inside)| if *inside { own } else { other }).collect();
    (input, Some(Band { edge: filter.edge, inside }))
}

/// What a filter makes of an input.
struct Passed {
    filter: Filter,
    /// Its values; those near the ends as they are.
    values: Vec<f64>,
    /// Which of them have no more than noise beside them.
    inside: Vec<bool>,
}

impl Passed {
    fn of(filter: Filter, u: &[f64], noise: f64) -> Self {
        let values = filter.pass(u);
        let inside = filter.inside((u, &values), noise);
        Self { filter, values, inside }
    }

    /// The mean square of what this one leaves and a `narrower` one does not, where so much is `inside`, and the most that noise
    /// leaves [of what it leaves in the mean].
    fn left(&self, narrower: (&Filter, &[f64]), inside: &[bool], noise: f64) -> [f64; 2] {
        let (filter, values) = narrower;
        let margin = filter.half();
        let all = (margin..values.len().saturating_sub(margin)).filter(|i| inside[*i]);
        let off = |i: usize| (self.values[i] - values[i]).powi(2);
        let (n, squares) = all.fold((0.0_f64, 0.0), |(n, sum), i| (n + 1.0, sum + off(i)));
        let share = self.filter.beside(filter);
        let left = squares / n / (noise * noise * share);
        [left, 1.0 + KNOWN + BETWEEN * (2.0 / (n * share)).sqrt()]
    }
}

/// What the filter of the narrowest band that is surely whole makes of `u`; none if no band is narrow. A filter that is `fine` stops
/// by so many decibels, and its band ends where twice as much is left as chance leaves: the noise may be told a little too low.
fn narrowest(u: &[f64], noise: f64, fine: Option<f64>) -> Option<Passed> {
    let all = Passed { filter: Filter::all(), values: u.to_vec(), inside: vec![true; u.len()] };
    let of = |half: usize| Filter::of(half, fine.unwrap_or(0.0));
    let mut passed = vec![all];
    for half in LENGTHS.into_iter().filter(|half| 4 * half < u.len()) {
        let next = Passed::of(of(half), u, noise);
        let many = next.inside.iter().filter(|inside| **inside).count() as f64;
        let last = &passed[passed.len() - 1];
        let [left, most] = last.left((&next.filter, &next.values), &next.inside, noise);
        // A filter that stops all that noise hides need not be spared what a band that ends slowly has there.
        let chance = if fine.is_none() { 1.0 } else { 2.0 };
        let ends = left - 1.0 > chance * (most - 1.0);
        if many <= (1.0 - OUTSIDE) * u.len() as f64 || ends {
            // A band that ends slowly has some of its end beside it, hidden in the noise.
            let whole = vec![true; u.len()];
            let beyond = |wider: &Passed, filter: &Filter| {
                wider.left((filter, &filter.pass(u)), &whole, noise)[0]
            };
            let sharp = beyond(last, &next.filter).max(beyond(&next, &of(2 * half))) > SHARP;
            let spared = if sharp { 1 } else { SPARE };
            passed.truncate(passed.len().saturating_sub(spared));
            break;
        }
        passed.push(next);
    }
    let narrow = |own: &Passed| own.filter.edge < NARROW * std::f64::consts::PI;
    passed.pop().filter(narrow)
}

/// By how much a filter of `u` has to stop what is beside a band, not to be seen in this `noise` [dB].
fn decibels(u: &[f64], noise: f64) -> f64 {
    let largest = u.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    20.0 * (largest / noise).log10() + BELOW
}

/// A low-pass filter.
#[derive(Debug, Clone)]
struct Filter {
    /// The weights of the middle sample and of those to one side.
    weights: Vec<f64>,
    /// The middle of its way from pass to stop [rad a sample].
    edge: f64,
}

impl Filter {
    /// That which passes all.
    fn all() -> Self {
        Self { weights: vec![1.0], edge: std::f64::consts::PI }
    }

    /// Of so many samples to either side, which stops by so many `decibels`, by Kaiser's formulas for β and the way from pass to stop.
    fn of(half: usize, decibels: f64) -> Self {
        let beta = BETA.max(0.1102 * (decibels - 8.7));
        let way = WAY.max((decibels - 7.95) / (2.285 * 2.0 * std::f64::consts::PI));
        let far = half as f64;
        let edge = 2.5 * std::f64::consts::PI * way / far;
        let one = |k: usize| {
            let x = k as f64;
            let sinc = if k == 0 { edge } else { (edge * x).sin() / x };
            sinc * bessel(beta * (1.0 - (x / (far + 1.0)).powi(2)).max(0.0).sqrt())
        };
        let weights: Vec<f64> = (0..=half).map(one).collect();
        let sum = 2.0 * weights.iter().sum::<f64>() - weights[0];
        Self { weights: weights.into_iter().map(|w| w / sum).collect(), edge }
    }

    /// How many samples it has to one side.
    fn half(&self) -> usize {
        self.weights.len() - 1
    }

    /// What it leaves of all samples; those too near an end for it are as they are.
    fn pass(&self, u: &[f64]) -> Vec<f64> {
        let mut values = u.to_vec();
        let end = u.len().saturating_sub(self.half());
        for (i, value) in values.iter_mut().enumerate().take(end).skip(self.half()) {
            *value = self.at(u, i);
        }
        values
    }

    /// What it leaves of sample `i`.
    fn at(&self, u: &[f64], i: usize) -> f64 {
        let sides = self.weights.iter().enumerate().skip(1).map(|(k, w)| w * (u[i - k] + u[i + k]));
        self.weights[0] * u[i] + sides.sum::<f64>()
    }

    /// Of how much of white noise's variance what this one leaves and the `other` does not is.
    fn beside(&self, other: &Self) -> f64 {
        let longest = self.weights.len().max(other.weights.len());
        let of = |filter: &Self, k: usize| filter.weights.get(k).copied().unwrap_or(0.0);
        let square =
            |k: usize| (of(self, k) - of(other, k)).powi(2) * if k > 0 { 2.0 } else { 1.0 };
        (0..longest).map(square).sum()
    }

    /// Which samples have room for it on either side, with no more than noise beside the values that it leaves so far about.
    fn inside(&self, (u, values): (&[f64], &[f64]), noise: f64) -> Vec<bool> {
        let margin = self.half();
        let all = noise * noise * Self::all().beside(self);
        let most = STRETCH as f64 * all * (1.0 + IN_EACH * (2.0 / STRETCH as f64).sqrt());
        let mut inside = vec![false; u.len()];
        inside[margin..u.len() - margin].fill(true);
        let mut first = margin;
        while first < u.len() - margin {
            let end = (first + STRETCH).min(u.len() - margin);
            let left: f64 = (first..end).map(|i| (u[i] - values[i]).powi(2)).sum();
            if left >= most {
                inside[first - margin..(first + STRETCH + margin).min(u.len())].fill(false);
            }
            first = end;
        }
        inside
    }
}

/// I₀, the modified Bessel function of the first kind, by its series.
fn bessel(x: f64) -> f64 {
    let (mut sum, mut term) = (1.0, 1.0);
    for k in 1..60 {
        term *= (0.5 * x / f64::from(k)).powi(2);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::smooth::{
        smoothed,
        tests::{NOISE, noisy, off},
    };
    use super::{Band, Filter, banded, finely};

    /// By its band, if it has one.
    fn by_band(u: &[f64]) -> (Vec<f64>, Option<Band>) {
        banded(u, NOISE, smoothed(u, NOISE))
    }

    #[test]
    fn what_has_a_band_is_known_by_it() {
        // Tones up to 2π·3/200 rad a sample, far above the noise.
        let tone = |i: i32, w: f64| (w * f64::from(i)).sin();
        let clean: Vec<f64> = (0..12_000)
            .map(|i| tone(i, 0.011) + 0.5 * tone(i, 0.0497) + 0.4 * tone(i, 0.094))
            .collect();
        let (found, band) = by_band(&noisy(&clean));
        let band = band.unwrap();
        // The narrowest filter that passes 0.094 is 0.116 wide; one more is spared.
        assert!((0.13..0.2).contains(&band.edge), "{}", band.edge);
        // White noise of which so much is in the band; by the samples around each, more.
        let left = off(&found, &clean) / NOISE;
        let share = (band.edge / std::f64::consts::PI).sqrt();
        assert!((left / share - 1.0).abs() < 0.2, "{left} of the noise for {share}");
        assert!(left < 0.6 * off(&smoothed(&noisy(&clean), NOISE), &clean) / NOISE);
    }

    #[test]
    fn a_quiet_band_is_known_by_it_too() {
        // A chirp, and tones, whose noise is 90 dB below them: a filter of 85 dB does more to them than that.
        let chirp = |t: f64| (0.003 * t + 1.1e-6 * t * t).sin();
        let tones = |t: f64| (0.0023 * t).sin() + (0.011 * t).sin() + (0.05 * t).sin();
        for way in [&chirp as &dyn Fn(f64) -> f64, &tones] {
            let clean: Vec<f64> = (0..12_000).map(|i| 3e4 * NOISE * way(f64::from(i))).collect();
            let seen = noisy(&clean);
            assert!(by_band(&seen).1.is_none_or(|band| band.edge > 0.3), "not by 85 dB");
            let (found, band) = finely(&seen, NOISE, seen.clone());
            let band = band.expect("it has one");
            let inside = |u: &[f64]| -> Vec<f64> {
                u.iter().zip(&band.inside).filter(|(_, own)| **own).map(|(u, _)| *u).collect()
            };
            let left = off(&inside(&found), &inside(&clean)) / NOISE;
            let share = (band.edge / std::f64::consts::PI).sqrt();
            assert!(left < 1.3 * share && share < 0.25, "{left} of the noise for {share}");
            // By a noise that is told a twentieth too low, as differences may, too.
            let low = finely(&seen, 0.945 * NOISE, seen.clone()).1.expect("it still has one");
            assert!(low.edge < 1.5 * band.edge, "{} for {}", low.edge, band.edge);
        }
    }

    #[test]
    fn where_it_jumps_once_it_is_known_by_its_band_elsewhere() {
        let clean: Vec<f64> = (0..12_000)
            .map(|i| (0.03 * f64::from(i)).sin() + if i < 5000 { 0.0 } else { 0.2 })
            .collect();
        let (found, band) = by_band(&noisy(&clean));
        let band = band.unwrap();
        assert!(!band.inside[5000] && !band.inside[5] && band.inside[3000] && band.inside[9000]);
        let all: Vec<usize> = (0..clean.len()).filter(|i| band.inside[*i]).collect();
        let of = |u: &[f64]| all.iter().map(|i| u[*i]).collect::<Vec<f64>>();
        let share = (band.edge / std::f64::consts::PI).sqrt();
        assert!(off(&of(&found), &of(&clean)) < 1.2 * share * NOISE);
        assert!(off(&found[4990..5010], &clean[4990..5010]) < 1.5 * NOISE);
    }

    #[test]
    fn a_band_that_ends_slowly_is_spared_what_noise_hides_of_it() {
        // A triangle of a fifth of the noise in each sample: a corner is off by the same everywhere.
        let clean: Vec<f64> =
            (0..16_000).map(|i| 0.2 * NOISE * f64::from((i % 200 - 100_i32).abs())).collect();
        let (found, band) = by_band(&noisy(&clean));
        let band = band.unwrap();
        let corners: Vec<f64> = (200..15_900)
            .step_by(100)
            .filter(|i| band.inside[*i])
            .map(|i| (found[i] - clean[i]) * if i % 200 == 0 { -1.0 } else { 1.0 })
            .collect();
        let rounded = corners.iter().sum::<f64>() / corners.len() as f64 / NOISE;
        assert!(rounded.abs() < 0.3, "{rounded} of the noise");
    }

    #[test]
    fn a_filter_passes_its_band_and_stops_what_is_above() {
        for (decibels, most) in [(60.0, 1e-4), (120.0, 1.5e-6)] {
            let filter = Filter::of(128, decibels);
            let gain = |share: f64| {
                let tone: Vec<f64> =
                    (-128..=128).map(|i| (share * filter.edge * f64::from(i)).cos()).collect();
                filter.at(&tone, 128)
            };
            // From four to six fifths of the edge it goes from one to nothing.
            for share in [0.0, 0.3, 0.6, 0.8] {
                assert!((gain(share) - 1.0).abs() < most, "{}", gain(share));
            }
            for share in [1.2, 1.5, 3.0, 6.0] {
                assert!(gain(share).abs() < most, "{}", gain(share));
            }
        }
    }

    #[test]
    fn what_jumps_has_no_band() {
        let square: Vec<f64> = (0..4000).map(|i| f64::from(i / 300 % 2)).collect();
        assert!(by_band(&noisy(&square)).1.is_none());
        let wave: Vec<f64> = (0..4000).map(|i| (0.3 * f64::from(i)).sin()).collect();
        assert!(banded(&wave, 0.0, wave.clone()).1.is_none(), "nothing is hidden by no noise");
        assert!(finely(&wave, 0.0, wave.clone()).1.is_none(), "nothing is hidden by no noise");
        // Three tenths of all would do, which is told as well by the samples around each.
        let wide: Vec<f64> = (0..4000).map(|i| (0.5 * f64::from(i)).sin()).collect();
        assert!(by_band(&noisy(&wide)).1.is_none());
    }
}
