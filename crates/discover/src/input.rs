//! A recorded input with less of its sensor's noise.
//!
//! Noise that never drove the plant shakes the simulated bristle: one under load creeps, and friction seems softer than it
//! is. It also moves what is fitted to where less of it is let through, to a larger mass or a softer bristle (errors in
//! variables), by far more than a standard error.
//!
//! An input that has a band, as tones or a chirp have, is what one filter passes; how dense the noise that is left there is,
//! and how it hangs together, is known. One that jumps has none: where it goes smoothly the samples around say what it is. Around
//! each sample a parabola is laid through ever more of them, for as long as it leaves what noise does (Goldenshluger and Nemirovski,
//! Mathematical Methods of Statistics 6, 1997, 135–170); across a jump it never does. Its width hangs on the noise itself, so
//! that more of that is left than the width says.

use identify::fit::data::Band;

/// Through so many samples on either side a parabola is laid, one width after the other.
const WIDTHS: [usize; 7] = [3, 4, 6, 9, 13, 19, 28];

/// What a parabola leaves is noise if its mean square is by fewer than so many standard errors more.
const SURE: f64 = 2.0;

/// And its value in the middle is that of every narrower one but for so many.
const SAME: f64 = 2.0;

/// `u` with the value of the widest parabola around each sample that leaves no more than this `noise`.
pub(crate) fn smoothed(u: &[f64], noise: f64) -> Vec<f64> {
    let one = |i: usize| {
        // The values, and of how much of the noise's variance each is.
        let mut all: Vec<[f64; 2]> = vec![[u[i], 1.0]];
        for half in WIDTHS {
            let Some(around) = i.checked_sub(half).and_then(|first| u.get(first..=i + half)) else {
                break;
            };
            let Some([value, share]) = parabola(around, noise) else { break };
            let same = |[other, of]: &[f64; 2]| {
                (value - other).abs() <= SAME * noise * (of - share).sqrt()
            };
            if !all.iter().all(same) {
                break;
            }
            all.push([value, share]);
        }
        all[all.len() - 1][0]
    };
    (0..u.len()).map(one).collect()
}

/// The middle value of the parabola through these samples, and the share of the noise's variance that it has, if it leaves
/// no more than `noise`.
fn parabola(around: &[f64], noise: f64) -> Option<[f64; 2]> {
    let half = (around.len() / 2) as f64;
    let n = around.len() as f64;
    let at = |i: usize| i as f64 - half;
    // Σ x² and Σ x⁴ of the whole numbers from −half to half.
    let second = half * (half + 1.0) * n / 3.0;
    let fourth = second * (3.0 * half * half + 3.0 * half - 1.0) / 5.0;
    let [mut sum, mut along, mut bent] = [0.0; 3];
    for (i, u) in around.iter().enumerate() {
        let x = at(i);
        sum += u;
        along += x * u;
        bent += x * x * u;
    }
    let own = n * fourth - second * second;
    let c = (n * bent - second * sum) / own;
    let (a, b) = ((sum - c * second) / n, along / second);
    let left = |(i, u): (usize, &f64)| (u - a - at(i) * (b + c * at(i))).powi(2);
    let squares: f64 = around.iter().enumerate().map(left).sum();
    let free = n - 3.0;
    let most = noise * noise * (free + SURE * (2.0 * free).sqrt());
    (squares <= most).then_some([a, fourth / own])
}

/// A band is told with filters of so many samples to either side, the longest first: each passes √2 times as wide a band as the
/// one before.
const LENGTHS: [usize; 11] = [1024, 724, 512, 362, 256, 181, 128, 90, 64, 45, 32];

/// Kaiser's β: what is outside of the band is smaller by 85 dB, and what is inside is as it was but for as much.
const BETA: f64 = 8.3;

/// With that β the way from pass to stop is so wide, of 2π over a filter's whole length [1]; the band begins to end at twice and
/// ends at three times that.
const WAY: f64 = 5.36;

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
pub(crate) fn banded(u: &[f64], noise: f64, otherwise: Vec<f64>) -> (Vec<f64>, Option<Band>) {
    let mut all: Vec<(Filter, Band)> = Vec::new();
    for half in LENGTHS.into_iter().rev().filter(|half| 4 * half < u.len()) {
        let filter = Filter::of(half);
        let inside = filter.inside(u, noise);
        let many = inside.iter().filter(|inside| **inside).count() as f64;
        // A unit impulse is left as it is by what passes all.
        let wider = all.last().map_or(Filter { weights: vec![1.0] }, |(wider, _)| wider.clone());
        let [left, most] = wider.left(&filter, (u, &inside), noise);
        let fills = many > (1.0 - OUTSIDE) * u.len() as f64;
        if !fills || left > most {
            // A band that ends slowly has some of its end beside it, hidden in the noise.
            let whole = vec![true; u.len()];
            let beyond =
                |wider: &Filter, half| wider.left(&Filter::of(half), (u, &whole), noise)[0];
            let sharp = beyond(&wider, half).max(beyond(&filter, 2 * half)) > SHARP;
            let spared = if sharp { 1 } else { SPARE };
            all.truncate(all.len().saturating_sub(spared));
            break;
        }
        all.push((filter, Band { edge: edge(half), inside }));
    }
    let narrow = |(_, band): &(Filter, Band)| band.edge < NARROW * std::f64::consts::PI;
    let Some((filter, band)) = all.pop().filter(narrow) else { return (otherwise, None) };
    let one = |(i, value): (usize, f64)| if band.inside[i] { filter.at(u, i) } else { value };
    (otherwise.into_iter().enumerate().map(one).collect(), Some(band))
}

/// A low-pass filter: the weights of the middle sample and of those to one side.
#[derive(Debug, Clone)]
struct Filter {
    weights: Vec<f64>,
}

impl Filter {
    /// Of so many samples to either side.
    fn of(half: usize) -> Self {
        let (far, edge) = (half as f64, edge(half));
        let one = |k: usize| {
            let x = k as f64;
            let sinc = if k == 0 { edge } else { (edge * x).sin() / x };
            sinc * bessel(BETA * (1.0 - (x / (far + 1.0)).powi(2)).max(0.0).sqrt())
        };
        let weights: Vec<f64> = (0..=half).map(one).collect();
        let sum = 2.0 * weights.iter().sum::<f64>() - weights[0];
        Self { weights: weights.into_iter().map(|w| w / sum).collect() }
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

    /// The mean square `inside` of what this one leaves and the `narrower` does not, and the most that noise leaves [of what it
    /// leaves in the mean].
    fn left(&self, narrower: &Self, (u, inside): (&[f64], &[bool]), noise: f64) -> [f64; 2] {
        let margin = narrower.weights.len() - 1;
        let all = (margin..u.len().saturating_sub(margin)).filter(|i| inside[*i]);
        let off = |i: usize| (self.at(u, i) - narrower.at(u, i)).powi(2);
        let (n, squares) = all.fold((0.0_f64, 0.0), |(n, sum), i| (n + 1.0, sum + off(i)));
        let share = self.beside(narrower);
        let left = squares / n / (noise * noise * share);
        [left, 1.0 + KNOWN + BETWEEN * (2.0 / (n * share)).sqrt()]
    }

    /// Which samples have room for it on either side, with no more than noise beside what it leaves so far about.
    fn inside(&self, u: &[f64], noise: f64) -> Vec<bool> {
        let margin = self.weights.len() - 1;
        let left: Vec<f64> =
            (margin..u.len() - margin).map(|i| (u[i] - self.at(u, i)).powi(2)).collect();
        let all = noise * noise * Self { weights: vec![1.0] }.beside(self);
        let most = STRETCH as f64 * all * (1.0 + IN_EACH * (2.0 / STRETCH as f64).sqrt());
        let mut inside = vec![false; u.len()];
        inside[margin..u.len() - margin].fill(true);
        for (k, stretch) in left.chunks(STRETCH).enumerate() {
            if stretch.iter().sum::<f64>() >= most {
                let first = margin + k * STRETCH;
                let end = (first + STRETCH + margin).min(u.len());
                inside[first - margin..end].fill(false);
            }
        }
        inside
    }
}

/// The middle of a filter's way from pass to stop [rad a sample].
fn edge(half: usize) -> f64 {
    2.5 * std::f64::consts::PI * WAY / half as f64
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
    use super::{Band, Filter, banded, edge, smoothed};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    const NOISE: f64 = 0.02;

    /// By its band, if it has one.
    fn by_band(u: &[f64]) -> (Vec<f64>, Option<Band>) {
        banded(u, NOISE, smoothed(u, NOISE))
    }

    /// `clean` with noise.
    fn noisy(clean: &[f64]) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        clean.iter().map(|u| u + NOISE * noise()).collect()
    }

    fn off(a: &[f64], b: &[f64]) -> f64 {
        let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
        (squares / a.len() as f64).sqrt()
    }

    #[test]
    fn what_goes_smoothly_is_known_better_than_each_sample() {
        // The widest parabola leaves √(9/4/57) = 0.2 of the noise; which one is taken, more.
        let clean: Vec<f64> = (0..4000).map(|i| (0.01 * f64::from(i)).sin()).collect();
        let found = smoothed(&noisy(&clean), NOISE);
        let left = off(&found, &clean) / NOISE;
        assert!((0.2..0.65).contains(&left), "{left} of the noise is left");
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
        assert!((0.094..0.2).contains(&band.edge), "{}", band.edge);
        // White noise of which so much is in the band; by the samples around each, more.
        let left = off(&found, &clean) / NOISE;
        let share = (band.edge / std::f64::consts::PI).sqrt();
        assert!((left / share - 1.0).abs() < 0.2, "{left} of the noise for {share}");
        assert!(left < 0.6 * off(&smoothed(&noisy(&clean), NOISE), &clean) / NOISE);
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
        let filter = Filter::of(128);
        let gain = |share: f64| {
            let tone: Vec<f64> =
                (-128..=128).map(|i| (share * edge(128) * f64::from(i)).cos()).collect();
            filter.at(&tone, 128)
        };
        // From four to six fifths of the edge it goes from one to nothing.
        for share in [0.0, 0.3, 0.6, 0.8] {
            assert!((gain(share) - 1.0).abs() < 1e-4, "{}", gain(share));
        }
        for share in [1.2, 1.5, 3.0, 9.0] {
            assert!(gain(share).abs() < 1e-4, "{}", gain(share));
        }
    }

    #[test]
    fn what_jumps_has_no_band() {
        let square: Vec<f64> = (0..4000).map(|i| f64::from(i / 300 % 2)).collect();
        assert!(by_band(&noisy(&square)).1.is_none());
        let wave: Vec<f64> = (0..4000).map(|i| (0.3 * f64::from(i)).sin()).collect();
        assert!(banded(&wave, 0.0, wave.clone()).1.is_none(), "nothing is hidden by no noise");
    }

    #[test]
    fn a_corner_is_not_rounded_by_more_than_noise_hides() {
        // Up and down by a third of the noise in each sample: a parabola through 57 is off by 1.6 of it in a corner, and
        // leaves little more than noise.
        let clean: Vec<f64> =
            (0..8000).map(|i| 0.3 * NOISE * f64::from((i % 200 - 100_i32).abs())).collect();
        let found = smoothed(&noisy(&clean), NOISE);
        let corners = |u: &[f64]| u.iter().skip(100).step_by(100).copied().collect::<Vec<f64>>();
        let left = off(&corners(&found), &corners(&clean)) / NOISE;
        assert!(left < 1.0, "{left} of the noise is left");
    }

    #[test]
    fn what_jumps_or_has_no_noise_stays_as_it_is() {
        let clean: Vec<f64> = (0..400).map(|i| f64::from(u8::from(i >= 200))).collect();
        let noisy = noisy(&clean);
        let found = smoothed(&noisy, NOISE);
        assert_eq!(found[197..203], noisy[197..203]);
        assert!(off(&found[..190], &clean[..190]) < 0.6 * NOISE);
        let wave: Vec<f64> = (0..400).map(|i| (0.3 * f64::from(i)).sin()).collect();
        assert_eq!(smoothed(&wave, 0.0), wave);
        // A controller's tremble drives the plant: it is far more than what its sensor adds.
        assert!(off(&smoothed(&noisy, 0.2 * NOISE), &noisy) < 0.1 * NOISE);
    }
}
