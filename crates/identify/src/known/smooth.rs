//! A recorded input with less of its sensor's noise.
//!
//! Noise that never drove the plant shakes the simulated bristle: one under load creeps, and friction seems softer than it
//! is. It also moves what is fitted to where less of it is let through, to a larger mass or a softer bristle (errors in
//! variables), by far more than a standard error.
//!
//! Where an input goes smoothly the samples around say what it is. Around each sample a parabola is laid through ever more of
//! them, for as long as it leaves what noise does (Goldenshluger and Nemirovski, Mathematical Methods of Statistics 6, 1997,
//! 135–170); across a jump it never does. Its width hangs on the noise itself, so that more of that is left than the width
//! says: an input that has a band is known better by it (`band.rs`).

/// Through so many samples on either side a parabola is laid, one width after the other.
const WIDTHS: [usize; 7] = [3, 4, 6, 9, 13, 19, 28];

/// What a parabola leaves is noise if its mean square is by fewer than so many standard errors more.
const SURE: f64 = 2.0;

/// And its value in the middle is that of every narrower one but for so many.
const SAME: f64 = 2.0;

/// `u` with the value of the widest parabola around each sample that leaves no more than this `noise`.
pub(super) fn smoothed(u: &[f64], noise: f64) -> Vec<f64> {
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

#[cfg(test)]
pub(super) mod tests {
    use super::smoothed;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    pub(in crate::known) const NOISE: f64 = 0.02;

    /// `clean` with noise.
    pub(in crate::known) fn noisy(clean: &[f64]) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        clean.iter().map(|u| u + NOISE * noise()).collect()
    }

    /// The root mean square of what two inputs differ by.
    pub(in crate::known) fn off(a: &[f64], b: &[f64]) -> f64 {
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
