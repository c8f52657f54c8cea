//! Numbers side by side: loops over short arrays, which the compiler turns into vector instructions.

#![expect(
    clippy::inline_always,
    reason = "called for every stage: a call costs more than what it does"
)]

/// a·b + c, in one rounding where the build knows that the processor can: elsewhere it would be a call.
#[inline(always)]
pub fn fma(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

/// The coefficients 1/k! of the exponential up to k = 12.
const INVERSE_FACTORIALS: [f64; 13] = {
    let mut c = [1.0; 13];
    let mut k = 1;
    while k < 13 {
        c[k] = c[k - 1] / k as f64;
        k += 1;
    }
    c
};

/// e^x for x ≤ 0 to three units in the last place; below −700 it is that of −700. The library's is as good
/// and a call for each number, which this method would spend a third of its time in.
#[inline(always)]
pub fn exp<const W: usize>(x: &[f64; W]) -> [f64; W] {
    /// Adding it leaves a whole number in the last bits.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    /// ln 2 in two parts, the first with zeros at its end.
    const LN_2: (f64, f64) =
        (f64::from_bits(0x3FE6_2E42_FEE0_0000), f64::from_bits(0x3DEA_39EF_3579_3C76));
    let c = &INVERSE_FACTORIALS;
    let mut result = [0.0; W];
    for (result, x) in result.iter_mut().zip(x) {
        let x = if *x < -700.0 { -700.0 } else { *x };
        let shifted = fma(x, std::f64::consts::LOG2_E, SHIFT);
        let whole = shifted - SHIFT;
        let r = fma(-whole, LN_2.1, fma(-whole, LN_2.0, x));
        // Pairs, then pairs of pairs: a chain of twelve products would be three times as slow.
        let (r2, pair) = (r * r, |k: usize| fma(r, c[k + 1], c[k]));
        let (r4, low, middle) = (r2 * r2, fma(pair(2), r2, pair(0)), fma(pair(6), r2, pair(4)));
        let high = fma(pair(10), r2, fma(r2 * r2, c[12], pair(8)));
        let p = fma(high, r4 * r4, fma(middle, r4, low));
        let power = (shifted.to_bits() << 52).wrapping_add(1023 << 52);
        *result = p * f64::from_bits(power);
    }
    result
}

/// x to the power `p`, within some four percent, of a positive x: the logarithm read off the exponent
/// bits. A step's length needs no more.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "the bits of a number as a whole number"
)]
#[inline(always)]
pub(super) fn rough_power(x: f64, p: f64) -> f64 {
    /// The bits of 1, less what balances the error.
    const ONE: i64 = 0x3FEF_5100_0000_0000;
    let logarithm = (x.to_bits() as i64 - ONE) as f64;
    f64::from_bits(((logarithm * p) as i64 + ONE) as u64)
}

/// Complex numbers side by side, one for each block.
#[derive(Debug, Clone, Copy)]
pub struct Complex<const B: usize> {
    /// Real parts.
    pub re: [f64; B],
    /// Imaginary parts.
    pub im: [f64; B],
}

impl<const B: usize> Complex<B> {
    pub(super) const ZERO: Self = Self { re: [0.0; B], im: [0.0; B] };

    #[inline(always)]
    fn of(number: impl Fn(usize) -> (f64, f64)) -> Self {
        let mut result = Self::ZERO;
        for b in 0..B {
            (result.re[b], result.im[b]) = number(b);
        }
        result
    }

    #[inline(always)]
    pub(super) fn scaled(&self, by: f64) -> Self {
        Self::of(|b| (self.re[b] * by, self.im[b] * by))
    }

    #[inline(always)]
    pub(super) fn plus_real(&self, r: f64) -> Self {
        Self { re: self.re.map(|re| re + r), im: self.im }
    }

    #[inline(always)]
    pub(super) fn times(&self, other: &Self) -> Self {
        Self::of(|b| {
            let (a, c) = ((self.re[b], self.im[b]), (other.re[b], other.im[b]));
            (fma(-a.1, c.1, a.0 * c.0), fma(a.0, c.1, a.1 * c.0))
        })
    }

    /// self − a·b.
    #[inline(always)]
    pub(super) fn less(&self, x: &Self, y: &Self) -> Self {
        Self::of(|b| {
            let (a, c) = ((x.re[b], x.im[b]), (y.re[b], y.im[b]));
            let re = fma(a.1, c.1, fma(-a.0, c.0, self.re[b]));
            (re, fma(-a.0, c.1, fma(-a.1, c.0, self.im[b])))
        })
    }

    #[inline(always)]
    pub(super) fn plus(&self, other: &Self) -> Self {
        Self::of(|b| (self.re[b] + other.re[b], self.im[b] + other.im[b]))
    }

    #[inline(always)]
    pub(super) fn inverse(&self) -> Self {
        Self::of(|b| {
            let one = 1.0 / fma(self.re[b], self.re[b], self.im[b] * self.im[b]);
            (self.re[b] * one, -self.im[b] * one)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_is_that_of_the_library_within_three_units_in_the_last_place() {
        let mut worst = 0.0_f64;
        for i in 0..200_000 {
            let x = -699.0 * (f64::from(i) / 200_000.0).powi(3);
            let ([own], right) = (exp(&[x]), x.exp());
            worst = worst.max((own - right).abs() / (right * f64::EPSILON));
        }
        assert!(worst <= 3.0, "{worst} units in the last place");
        assert_eq!(exp(&[0.0]), [1.0]);
        assert_eq!(exp(&[-1e300]), exp(&[-700.0]));
    }

    #[test]
    fn a_rough_power_is_within_four_percent() {
        for i in 1..400 {
            let x = 10.0_f64.powf(f64::from(i) / 20.0 - 10.0);
            for p in [-0.25, -1.0 / 6.0, -0.125, 0.25] {
                let (rough, right) = (rough_power(x, p), x.powf(p));
                assert!((rough / right - 1.0).abs() < 0.04, "{x}^{p}: {rough}, not {right}");
            }
        }
    }

    #[test]
    fn complex_numbers_multiply_and_divide() {
        let a = Complex { re: [1.0, -2.0, 0.5, 3.0], im: [0.0, 1.0, -4.0, 2.0] };
        let one = a.times(&a.inverse());
        for b in 0..4 {
            assert!((one.re[b] - 1.0).abs() < 1e-15 && one.im[b].abs() < 1e-15, "{one:?}");
        }
        let zero = a.times(&a).less(&a, &a);
        assert!(zero.re.iter().chain(&zero.im).all(|x| x.abs() < 1e-14), "{zero:?}");
    }
}
