//! Elementary functions in plain arithmetic, without a branch or a call: in a loop over many numbers the
//! compiler does them side by side, several at once, which it cannot do with the library's.
//!
//! They are right to a few units in the last place, which the tests measure, and are the same to the
//! last bit on every processor.

use std::f64::consts::{FRAC_1_PI, FRAC_1_SQRT_2, LN_2, LOG2_E, PI};

/// 1.5 · 2⁵²: a number of moderate size plus this is rounded to an integer, which then stands in the low
/// bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// The leading 33 bits of π: a multiple below 2²⁰ of it is exact.
const PI_HEAD: f64 = f64::from_bits(PI.to_bits() >> 20 << 20);
/// The rest of [`PI`].
const PI_MIDDLE: f64 = PI - PI_HEAD;
/// π − [`PI`], which is sin [`PI`].
const PI_TAIL: f64 = 1.224_646_799_147_353_2e-16;

/// The leading 33 bits of ln 2: a multiple below 2²⁰ of it is exact.
const LN_2_HEAD: f64 = f64::from_bits(LN_2.to_bits() >> 20 << 20);
/// ln 2 − [`LN_2_HEAD`], the last term being ln 2 − [`LN_2`].
const LN_2_TAIL: f64 = (LN_2 - LN_2_HEAD) + 2.319_046_813_846_299_6e-17;

/// Beyond this phase [rad] the reduction by π is no longer exact.
const FARTHEST: f64 = 1e6;

/// Below this e^x − 1 is −1 to the last digit.
const LOWEST: f64 = -64.0;

/// ±1/3!, 1/5!, … of the sine; on [−π/2, π/2] the next term is 1e-18.
const SINE: [f64; 10] = {
    let (mut series, mut factorial, mut i) = ([0.0; 10], 1.0, 0);
    while i < 10 {
        let n = 2.0 * i as f64 + 2.0;
        factorial *= -n * (n + 1.0);
        series[i] = 1.0 / factorial;
        i += 1;
    }
    series
};

/// 1/2!, 1/3!, … of the exponential; on [−ln 2/2, ln 2/2] the next term is 3e-19 of x.
const EXPONENTIAL: [f64; 13] = {
    let (mut series, mut factorial, mut i) = ([0.0; 13], 1.0, 0);
    while i < 13 {
        factorial *= i as f64 + 2.0;
        series[i] = 1.0 / factorial;
        i += 1;
    }
    series
};

/// 1/3, 1/5, … of artanh; for |s| ≤ tan²(π/8) the next term is 6e-19 of s.
const ARTANH: [f64; 11] = {
    let (mut series, mut i) = ([0.0; 11], 0);
    while i < 11 {
        series[i] = 1.0 / (2.0 * i as f64 + 3.0);
        i += 1;
    }
    series
};

/// Σ cᵢ xⁱ.
#[inline]
pub fn polynomial(series: &[f64], x: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The sine of a phase within ±10⁶ rad.
#[inline]
fn sin(x: f64) -> f64 {
    let rounded = x * FRAC_1_PI + ROUND;
    let n = rounded - ROUND;
    let r = ((x - n * PI_HEAD) - n * PI_MIDDLE) - n * PI_TAIL;
    let square = r * r;
    let sine = r + r * (square * polynomial(&SINE, square));
    // The sine changes its sign with each odd multiple of π.
    f64::from_bits(sine.to_bits() ^ (rounded.to_bits() << 63))
}

/// Puts f(x) in the place of each x.
#[inline]
pub fn in_place(values: &mut [f64], f: impl Fn(f64) -> f64) {
    for x in values {
        *x = f(*x);
    }
}

/// Puts the sines of the phases [rad] in their places.
pub fn sines(phases: &mut [f64]) {
    // A phase that is not a number falls through every maximum and stays what it is.
    let farthest = phases.iter().fold(0.0, |most, x| if x.abs() > most { x.abs() } else { most });
    if farthest > FARTHEST {
        in_place(phases, f64::sin);
    } else {
        in_place(phases, sin);
    }
}

/// e^x − 1 for x ≤ 0.
#[inline]
pub fn exp_m1(x: f64) -> f64 {
    let x = if x > LOWEST { x } else { LOWEST };
    let rounded = x * LOG2_E + ROUND;
    let k = rounded - ROUND;
    let r = (x - k * LN_2_HEAD) - k * LN_2_TAIL;
    let grown = r + r * (r * polynomial(&EXPONENTIAL, r));
    let power = f64::from_bits((rounded.to_bits().wrapping_add(1023)) << 52);
    power * grown + (power - 1.0)
}

/// ln(1 + x) for finite x > −1.
#[inline]
pub fn ln_1p(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    let y = 1.0 + x;
    // y = 2ᵉ m with m from √½ to √2, and what rounding took from y.
    let shifted = y.to_bits().wrapping_add(1.0_f64.to_bits() - FRAC_1_SQRT_2.to_bits());
    let m = f64::from_bits((shifted & MANTISSA) + FRAC_1_SQRT_2.to_bits());
    let e = f64::from_bits((shifted >> 52) | (1075 << 52)) - ((1_u64 << 52) as f64 + 1023.0);
    let lost = (x - (y - 1.0)) / y;
    // ln m = 2 artanh s.
    let s = (m - 1.0) / (m + 1.0);
    let square = s * s;
    let ln_m = 2.0 * s + 2.0 * s * (square * polynomial(&ARTANH, square));
    e * LN_2_HEAD + (ln_m + (e * LN_2_TAIL + lost))
}

#[cfg(test)]
mod tests {
    use super::{FARTHEST, LN_2_HEAD, LN_2_TAIL, PI, PI_TAIL, exp_m1, ln_1p, sin, sines};

    /// The largest error in units in the last place, and where.
    fn worst(
        x: impl Iterator<Item = f64>,
        ours: fn(f64) -> f64,
        other: fn(f64) -> f64,
    ) -> (f64, f64) {
        let units = |x: f64| {
            let right = other(x);
            let unit = right.abs().next_up() - right.abs();
            ((ours(x) - right).abs() / unit, x)
        };
        x.map(units).fold((0.0, 0.0), |most, one| if one.0 <= most.0 { most } else { one })
    }

    fn through(low: f64, high: f64) -> impl Iterator<Item = f64> {
        (0..=200_000).map(move |i| low + (high - low) * f64::from(i) / 200_000.0)
    }

    #[test]
    fn the_sine_is_that_of_the_library() {
        for reach in [1e-3, 2.0, 60.0, 1e4, FARTHEST] {
            let (units, x) = worst(through(-reach, reach), sin, f64::sin);
            assert!(units <= 2.0, "{units} units in the last place at {x} rad");
        }
        // Next to the multiples of π all digits of the phase cancel; what is left is right to the last
        // digit of what rounding the phase is worth.
        for x in (1..300_000).map(|k| f64::from(k) * PI) {
            let worth = x.next_up() - x;
            let off = (sin(x) - x.sin()).abs() / worth;
            assert!(off <= f64::EPSILON, "off by {off:e} roundings of the phase at {x} rad");
        }
        assert_eq!(PI.sin(), PI_TAIL);
    }

    #[test]
    fn a_phase_too_far_for_exact_reduction_is_left_to_the_library() {
        let mut phases = [0.5, 3e9, f64::NAN];
        sines(&mut phases);
        assert_eq!(phases[..2], [0.5_f64.sin(), 3e9_f64.sin()]);
        assert!(phases[2].is_nan());
        let mut alone = [f64::NAN];
        sines(&mut alone);
        assert!(alone[0].is_nan());
    }

    #[test]
    fn the_exponential_is_that_of_the_library() {
        for reach in [1e-9, 0.3, 2.0, 40.0, 64.0] {
            let (units, x) = worst(through(-reach, 0.0), exp_m1, f64::exp_m1);
            assert!(units <= 3.0, "{units} units in the last place at {x}");
        }
        assert_eq!([exp_m1(-1e3), exp_m1(f64::NEG_INFINITY), exp_m1(0.0)], [-1.0, -1.0, 0.0]);
    }

    #[test]
    fn the_logarithm_is_that_of_the_library() {
        for (low, high) in [(-1e-9, 1e-9), (-0.3, 0.5), (-1.0 + 1e-9, 5.0), (0.0, 1e12)] {
            let (units, x) = worst(through(low, high), ln_1p, f64::ln_1p);
            assert!(units <= 4.0, "{units} units in the last place at {x}");
        }
        assert_eq!(ln_1p(0.0), 0.0);
        assert_eq!(LN_2_HEAD + LN_2_TAIL, std::f64::consts::LN_2);
    }
}
