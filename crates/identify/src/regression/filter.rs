//! Zero-phase low-pass filters, decimation and differences, as MATLAB's `butter`, `cheby1`, `filtfilt`
//! and `decimate` do them.
//!
//! Filters are cascades of second-order sections, of even order, made from the analogue prototype by the
//! bilinear transform. No crate we found designs both kinds and runs them forwards and backwards from
//! the steady state, so it is done here and checked against SciPy.

use std::f64::consts::PI;

/// A section (b₀ + b₁z⁻¹ + b₂z⁻²)/(1 + a₁z⁻¹ + a₂z⁻²) with the zeros of a low-pass, both at z = −1.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Section {
    /// Gain b₀ = b₂ = b₁/2 [1].
    b: f64,
    /// Denominator a₁, a₂ [1].
    a: [f64; 2],
}

/// A low-pass filter of even order.
#[derive(Debug, Clone, PartialEq)]
pub struct LowPass {
    sections: Vec<Section>,
}

impl LowPass {
    /// Butterworth of the order 2 × `pairs`, 3 dB down at `cutoff`, a share of half the sampling rate in (0, 1).
    pub fn butterworth(pairs: usize, cutoff: f64) -> Self {
        Self::design(pairs, cutoff, 1.0, (1.0, 1.0))
    }

    /// Chebyshev of type I and the order 2 × `pairs`, with `ripple` [dB] in the band that ends at `cutoff`,
    /// a share of half the sampling rate in (0, 1).
    ///
    /// Of even order, so its gain at rest is the lower edge of the ripple and not 1.
    pub fn chebyshev(pairs: usize, ripple: f64, cutoff: f64) -> Self {
        let epsilon = (10.0_f64.powf(0.1 * ripple) - 1.0).sqrt();
        let mu = (1.0 / epsilon).asinh() / (2 * pairs) as f64;
        Self::design(pairs, cutoff, 10.0_f64.powf(-0.05 * ripple), (mu.sinh(), mu.cosh()))
    }

    /// The filter whose analogue poles lie on the ellipse of the half `axes`, with the gain at rest `gain`.
    fn design(pairs: usize, cutoff: f64, gain: f64, axes: (f64, f64)) -> Self {
        let warped = (0.5 * PI * cutoff).tan();
        let section = |k: usize| {
            let angle = PI * (2 * k + 1) as f64 / (4 * pairs) as f64;
            // z = (1 + p)/(1 − p) for the pole p and its conjugate.
            let (re, im) = (-axes.0 * angle.sin() * warped, axes.1 * angle.cos() * warped);
            let size = re * re + im * im;
            let below = 1.0 - 2.0 * re + size;
            let a = [2.0 * (size - 1.0) / below, (1.0 + 2.0 * re + size) / below];
            // 1 + a₁ + a₂ would lose digits where the cut-off is low: it is 4|p|²/|1 − p|².
            Section { b: size / below, a }
        };
        let mut sections: Vec<Section> = (0..pairs).map(section).collect();
        if let Some(first) = sections.first_mut() {
            first.b *= gain;
        }
        Self { sections }
    }

    /// The order [1].
    pub fn order(&self) -> usize {
        2 * self.sections.len()
    }

    /// The gain at rest [1].
    fn gain(&self) -> f64 {
        self.sections.iter().map(|s| 4.0 * s.b / (1.0 + s.a[0] + s.a[1])).product()
    }

    /// The samples `x`, filtered forwards and then backwards, so that nothing is delayed and the gain is
    /// squared.
    ///
    /// Both ends are continued by three times the order of samples, mirrored at the end's point, and each
    /// pass begins as if the first of them had stood there for ever: MATLAB's `filtfilt`. `x` has to be
    /// longer than three times the order.
    pub fn both_ways(&self, x: &[f64]) -> Vec<f64> {
        let pad = (3 * self.order()).min(x.len().saturating_sub(1));
        let (Some(first), Some(last)) = (x.first(), x.last()) else { return Vec::new() };
        let before = x[1..=pad].iter().rev().map(|v| 2.0 * first - v);
        let after = x[x.len() - 1 - pad..x.len() - 1].iter().rev().map(|v| 2.0 * last - v);
        let mut y: Vec<f64> = before.chain(x.iter().copied()).chain(after).collect();
        for _ in 0..2 {
            self.forwards(&mut y);
            y.reverse();
        }
        y[pad..pad + x.len()].to_vec()
    }

    /// Filters in place, from the steady state of the first sample.
    fn forwards(&self, samples: &mut [f64]) {
        for section in &self.sections {
            let Section { b, a: [a_1, a_2] } = *section;
            let rest = samples.first().copied().unwrap_or(0.0);
            let out = 4.0 * b / (1.0 + a_1 + a_2) * rest;
            let (mut s_1, mut s_2) = (out - b * rest, b * rest - a_2 * out);
            for x in samples.iter_mut() {
                let y = b * *x + s_1;
                s_1 = 2.0 * b * *x - a_1 * y + s_2;
                s_2 = b * *x - a_2 * y;
                *x = y;
            }
        }
    }
}

/// Every `factor`-th of the samples behind a low-pass that takes away what they could not show: MATLAB's
/// `decimate`, a Chebyshev filter of order 8 with 0.05 dB up to 0.8 of the new half sampling rate, both ways.
///
/// Kept are the last sample and every `factor`-th before it, as MATLAB counts. The constant 1 becomes 10^(−0.005): a column of ones has to be decimated like the rest. A factor of 1 leaves `x` as it is.
pub fn decimate(x: &[f64], factor: usize) -> Vec<f64> {
    if factor <= 1 {
        return x.to_vec();
    }
    let smooth = decimator(factor).both_ways(x);
    smooth.into_iter().skip(first_kept(x.len(), factor)).step_by(factor).collect()
}

/// The filter before the choice of every `factor`-th sample.
pub(super) fn decimator(factor: usize) -> LowPass {
    LowPass::chebyshev(4, 0.05, 0.8 / factor as f64)
}

/// Which of `n` samples decimation keeps first, counted from 0.
pub(super) fn first_kept(n: usize, factor: usize) -> usize {
    n.saturating_sub(1) % factor
}

/// The factor by which decimation multiplies a constant [1].
pub(super) fn gain_at_rest(factor: usize) -> f64 {
    if factor <= 1 { 1.0 } else { decimator(factor).gain().powi(2) }
}

/// Central differences of samples `step` [s] apart; at both ends the one-sided difference.
pub fn differences(x: &[f64], step: f64) -> Vec<f64> {
    let last = x.len().saturating_sub(1);
    let at = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
        if a == b { 0.0 } else { (x[b] - x[a]) / ((b - a) as f64 * step) }
    };
    (0..x.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_1_SQRT_2;

    /// Two waves, a slope and a jump.
    fn samples(n: u32) -> Vec<f64> {
        let jump = |i: u32| if i >= 60 { 0.5 } else { 0.0 };
        let at = |i: u32| {
            let t = f64::from(i);
            (0.05 * t).sin() + 0.3 * (1.1 * t).sin() + 0.01 * t + jump(i)
        };
        (0..n).map(at).collect()
    }

    fn assert_close(what: &str, found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() < tolerance, "{what}: {found:.16}, SciPy {expected:.16}");
    }

    /// |H| at the angular frequency `omega` [rad per sample].
    fn size(filter: &LowPass, omega: f64) -> f64 {
        let polynomial = |c: [f64; 3]| {
            let re = c[0] + c[1] * omega.cos() + c[2] * (2.0 * omega).cos();
            let im = c[1] * omega.sin() + c[2] * (2.0 * omega).sin();
            re.hypot(im)
        };
        let section =
            |s: &Section| polynomial([s.b, 2.0 * s.b, s.b]) / polynomial([1.0, s.a[0], s.a[1]]);
        filter.sections.iter().map(section).product()
    }

    /// `abs(sosfreqz(butter(4, 0.2, output='sos'), worN=[0.1π, 0.2π, 0.5π])[1])` and the same of
    /// `cheby1(8, 0.05, 0.08)` at 0.03π, 0.08π and 0.12π; SciPy 1.17.1.
    #[test]
    fn the_filters_pass_what_those_of_scipy_pass() {
        let butterworth = LowPass::butterworth(2, 0.2);
        for (share, expected) in
            [(0.1, 0.998_409_897_978_756_9), (0.2, FRAC_1_SQRT_2), (0.5, 0.011_144_925_783_573_572)]
        {
            assert_close("butter", size(&butterworth, PI * share), expected, 1e-14);
        }
        let chebyshev = LowPass::chebyshev(4, 0.05, 0.08);
        for (share, expected) in [
            (0.03, 0.994_297_404_411_125_4),
            (0.08, 0.994_260_073_952_949_5),
            (0.12, 0.007_841_701_238_542_281),
        ] {
            assert_close("cheby1", size(&chebyshev, PI * share), expected, 1e-11);
        }
    }

    /// `filtfilt(*butter(4, 0.2), x, padlen=12)`; SciPy 1.17.1. Its default padding is 15 samples, MATLAB's 12.
    #[test]
    fn filtering_both_ways_is_that_of_scipy_at_the_ends_and_at_a_jump() {
        let y = LowPass::butterworth(2, 0.2).both_ways(&samples(120));
        for (i, expected) in [
            (0, 0.000_300_807_665_075_814),
            (1, 0.062_782_375_951_985_91),
            (59, 0.981_100_310_871_635_9),
            (60, 1.042_023_658_329_944_3),
            (61, 1.094_910_921_208_260_8),
            (118, 1.164_208_006_082_877_7),
            (119, 1.098_721_953_861_055),
        ] {
            assert_close(&format!("sample {i}"), y[i], expected, 1e-12);
        }
    }

    /// `sosfiltfilt(cheby1(8, 0.05, 0.8/5, output='sos'), x, padlen=24)[(n - 1) % 5::5]`; SciPy 1.17.1.
    #[test]
    fn decimation_is_that_of_matlab_as_scipy_computes_it() {
        let kept = decimate(&samples(120), 5);
        assert_eq!(kept.len(), 24);
        for (i, expected) in [
            (0, 0.242_051_568_122_943_76),
            (1, 0.518_449_180_755_942),
            (11, 0.972_396_589_527_391_5),
            (12, 1.104_679_076_824_088_4),
            (22, 1.135_218_209_861_937),
            (23, 1.081_104_608_010_684_5),
        ] {
            assert_close(&format!("sample {i}"), kept[i], expected, 1e-11);
        }
        let kept = decimate(&samples(118), 5);
        assert_eq!((kept.len(), first_kept(118, 5)), (24, 2));
        for (i, expected) in [(0, 0.120_372_882_988_594_26), (23, 1.257_956_857_399_695)] {
            assert_close(&format!("of 118, sample {i}"), kept[i], expected, 1e-11);
        }
    }

    #[test]
    fn decimation_shrinks_a_constant_by_twice_the_ripple() {
        let kept = decimate(&vec![3.0; 200], 10);
        let expected = 3.0 * 10.0_f64.powf(-0.005);
        assert!(kept.iter().all(|v| (v - expected).abs() < 1e-12), "{kept:?} for {expected}");
        assert!((gain_at_rest(10) - 10.0_f64.powf(-0.005)).abs() < 1e-12);
    }

    #[test]
    fn a_straight_line_is_not_delayed() {
        let line: Vec<f64> = (0..600).map(|i| 2.0 - 0.3 * f64::from(i)).collect();
        let y = LowPass::butterworth(2, 0.1).both_ways(&line);
        let worst = (250..350).map(|i| (y[i] - line[i]).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-10, "off by {worst:e} in the middle");
    }

    #[test]
    fn differences_of_a_parabola_are_exact_inside_and_one_sided_at_the_ends() {
        let x: Vec<f64> = (0..5).map(|i| f64::from(i * i)).collect();
        assert_eq!(differences(&x, 0.5), [2.0, 4.0, 8.0, 12.0, 14.0]);
        assert_eq!(differences(&[1.0], 0.5), [0.0]);
    }
}
