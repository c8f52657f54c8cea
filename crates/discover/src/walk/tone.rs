//! Whether a tone sounds in what is left: a vibration comes at its own time, whatever the plant does.

use super::Walk;
use crate::board::Fitted;
use rustfft::{FftPlanner, num_complex::Complex};
use std::f64::consts::PI;

/// So many samples are looked at, at most.
const MOST: usize = 16_384;

/// A line of a spectrum is so many times as strong as what is beside it: noise comes to that once in 10¹¹ bins.
const LINE: f64 = 25.0;

/// Beside a line are so many bins to either side, but for the nearest.
const BESIDE: usize = 32;
const NEAREST: usize = 3;

/// Mains hum in a sensor is noise: these frequencies and their multiples, up to so many and as near as this [Hz].
const MAINS: [f64; 2] = [50.0, 60.0];
const MULTIPLES: usize = 10;
const NEAR: f64 = 0.3;

impl Walk<'_> {
    /// The frequency of a tone in what a model leaves [Hz]: a line of the residuals' spectrum that the motion does not
    /// have and no mains make.
    pub(super) fn tone(&self, fitted: &Fitted) -> Option<f64> {
        let data = self.board.data;
        let rate = data.sample_time().recip();
        let of = 1 + usize::from(data.displacement.is_some() && data.velocity.is_some());
        let (mut left, mut moved) = (vec![Vec::new(); of], Vec::new());
        for (window, piece) in self.board.windows.iter().zip(&fitted.pieces) {
            let n = window.len();
            if piece.residuals.len() < n * of || piece.motion.v.len() < n {
                return None;
            }
            for (c, left) in left.iter_mut().enumerate() {
                left.extend(piece.residuals.iter().skip(c).step_by(of).take(n));
            }
            moved.extend(piece.motion.v.iter().take(n));
        }
        let mut moves: Option<Vec<f64>> = None;
        for left in &left {
            for k in lines(&powers(left)) {
                let own = moves.get_or_insert_with(|| powers(&moved));
                let f = k as f64 * rate / left.len().min(MOST) as f64;
                let sounds =
                    (k.saturating_sub(NEAREST)..=k + NEAREST).any(|k| against(own, k) > LINE);
                if !sounds && !hums(f, rate) {
                    return Some(f);
                }
            }
        }
        None
    }
}

/// The squares of the Fourier coefficients of `values` under Hann's window.
fn powers(values: &[f64]) -> Vec<f64> {
    let values = &values[..values.len().min(MOST)];
    let n = values.len();
    let hann = |(i, x): (usize, &f64)| x * (PI * i as f64 / n as f64).sin().powi(2);
    let mut all: Vec<Complex<f64>> =
        values.iter().enumerate().map(hann).map(Complex::from).collect();
    FftPlanner::new().plan_fft_forward(n).process(&mut all);
    all.truncate(n / 2);
    all.iter().map(Complex::norm_sqr).collect()
}

/// How many times as strong a bin is as those beside it [1].
fn against(powers: &[f64], k: usize) -> f64 {
    let beside = |i: &usize| i.abs_diff(k) > NEAREST && *i > 0;
    let all = (k.saturating_sub(BESIDE)..(k + BESIDE + 1).min(powers.len())).filter(beside);
    let (sum, count) = all.fold((0.0, 0.0), |(sum, n), i| (sum + powers[i], n + 1.0));
    powers.get(k).map_or(0.0, |own| own * count / f64::max(sum, f64::MIN_POSITIVE))
}

/// The bins of the lines of a spectrum, the strongest first.
fn lines(powers: &[f64]) -> Vec<usize> {
    let all = (NEAREST + 1..powers.len()).map(|k| (k, against(powers, k)));
    let mut all: Vec<(usize, f64)> = all.filter(|(_, strength)| *strength > LINE).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all.into_iter().map(|(k, _)| k).collect()
}

/// Whether a frequency is that of mains, or what is seen of it at this `rate` [Hz].
fn hums(f: f64, rate: f64) -> bool {
    let seen = |g: f64| (g - rate * (g / rate).round()).abs();
    let all = MAINS.iter().flat_map(|mains| (1..=MULTIPLES).map(move |n| mains * n as f64));
    all.into_iter().any(|g| (seen(g) - f).abs() < NEAR)
}

#[cfg(test)]
mod tests {
    use super::{super::made, hums, powers};
    use identify::effects::Kind;

    #[test]
    fn a_tone_is_heard_that_neither_the_motion_has_nor_the_mains() {
        let right = made::with(&made::rig(2.0), Kind::CurrentBias, &[made::BIAS]);
        // Of noise of 1 mm three tenths: hardly more is left than without.
        let heard = |hertz: f64, size: f64| {
            let mut data = made::data();
            let time = data.time.clone();
            let seen = &mut data.displacement.as_mut().expect("it is seen").values;
            for (x, t) in seen.iter_mut().zip(&time) {
                *x += size * (std::f64::consts::TAU * hertz * t).sin();
            }
            let walk = made::walk(&right, &data, &[]);
            walk.tone(&walk.best)
        };
        let found = heard(17.3, 3e-4).expect("a tone");
        assert!((found - 17.3).abs() < 0.1, "{found} Hz");
        assert_eq!(heard(17.3, 0.0), None, "noise");
        assert_eq!(heard(50.0, 3e-4), None, "mains");
    }

    #[test]
    fn the_spectrum_of_a_tone_is_that_of_hanns_window() {
        // A cos under the window: a quarter of its samples at its own bin, an eighth at those beside it.
        for n in [1000_u16, 997] {
            let turn = std::f64::consts::TAU * 37.0 / f64::from(n);
            let tone: Vec<f64> = (0..n).map(|i| 3.0 * (turn * f64::from(i)).cos()).collect();
            let powers = powers(&tone);
            let size = |share: f64| (3.0 * share * f64::from(n)).powi(2);
            for (k, expected) in [(36, size(0.125)), (37, size(0.25)), (38, size(0.125)), (50, 0.0)]
            {
                assert!((powers[k] - expected).abs() < 1e-9 * size(0.25), "{n} {k}: {}", powers[k]);
            }
        }
    }

    #[test]
    fn mains_are_known_by_what_is_seen_of_them() {
        assert!(hums(50.1, 500.0) && hums(40.0, 100.0) && !hums(41.0, 500.0));
        // 150 Hz at 200 Hz, and 60 Hz at 100 Hz.
        assert!(hums(50.0, 200.0) && hums(40.0, 100.0) && !hums(30.0, 200.0));
    }
}
