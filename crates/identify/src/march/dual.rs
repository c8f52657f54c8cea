//! Numbers that carry derivatives.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number that may carry derivatives.
pub trait Real:
    Copy
    + std::fmt::Debug
    + PartialEq
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// The number itself.
    fn re(&self) -> f64;
    /// One over it.
    #[must_use]
    fn recip(self) -> Self;
    /// Its sine.
    #[must_use]
    fn sin(self) -> Self;
    /// Its cosine.
    #[must_use]
    fn cos(self) -> Self;
    /// The exponential function of it.
    #[must_use]
    fn exp(self) -> Self;
    /// Its natural logarithm.
    #[must_use]
    fn ln(self) -> Self;
    /// Its square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Its power.
    #[must_use]
    fn powi(self, n: i32) -> Self;
}

impl Real for f64 {
    fn re(&self) -> f64 {
        *self
    }
    fn recip(self) -> Self {
        self.recip()
    }
    fn sin(self) -> Self {
        self.sin()
    }
    fn cos(self) -> Self {
        self.cos()
    }
    fn exp(self) -> Self {
        self.exp()
    }
    fn ln(self) -> Self {
        self.ln()
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn powi(self, n: i32) -> Self {
        self.powi(n)
    }
}

/// A dual number: a value with its derivatives in P directions (Griewank and Walther, Evaluating Derivatives, SIAM
/// 2008, chapter 3).
///
/// The derivatives lie in a plain array: with num-dual, which keeps them behind an `Option`, a search for what a model
/// lacks took a quarter to a third longer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const P: usize> {
    /// The value.
    pub re: f64,
    /// Its derivatives.
    pub eps: [f64; P],
}

impl<const P: usize> Dual<P> {
    /// A value that is the variable of the direction `place`.
    pub fn variable(re: f64, place: usize) -> Self {
        let mut own = Self::from(re);
        own.eps[place] = 1.0;
        own
    }

    /// A function with the value `re` and the slope `by` here.
    fn chain(self, re: f64, by: f64) -> Self {
        self.with(re, self, |e, _| e * by)
    }

    // Plain loops: of `map` and `from_fn` of arrays some are called and not inlined, and copy the array for it.
    #[inline]
    fn with(mut self, re: f64, other: Self, eps: impl Fn(f64, f64) -> f64) -> Self {
        self.re = re;
        for (own, other) in self.eps.iter_mut().zip(&other.eps) {
            *own = eps(*own, *other);
        }
        self
    }
}

impl<const P: usize> From<f64> for Dual<P> {
    fn from(re: f64) -> Self {
        Self { re, eps: [0.0; P] }
    }
}

impl<const P: usize> Real for Dual<P> {
    fn re(&self) -> f64 {
        self.re
    }
    fn recip(self) -> Self {
        let inverse = self.re.recip();
        self.chain(inverse, -inverse * inverse)
    }
    fn sin(self) -> Self {
        self.chain(self.re.sin(), self.re.cos())
    }
    fn cos(self) -> Self {
        self.chain(self.re.cos(), -self.re.sin())
    }
    fn exp(self) -> Self {
        let value = self.re.exp();
        self.chain(value, value)
    }
    fn ln(self) -> Self {
        self.chain(self.re.ln(), self.re.recip())
    }
    fn sqrt(self) -> Self {
        let value = self.re.sqrt();
        self.chain(value, 0.5 / value)
    }
    fn powi(self, n: i32) -> Self {
        self.chain(self.re.powi(n), f64::from(n) * self.re.powi(n - 1))
    }
}

impl<const P: usize> Neg for Dual<P> {
    type Output = Self;
    fn neg(self) -> Self {
        self.with(-self.re, self, |e, _| -e)
    }
}

impl<const P: usize> Add for Dual<P> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(self.re + other.re, other, |a, b| a + b)
    }
}

impl<const P: usize> Sub for Dual<P> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.with(self.re - other.re, other, |a, b| a - b)
    }
}

impl<const P: usize> Mul for Dual<P> {
    type Output = Self;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule has a sum")]
    fn mul(self, other: Self) -> Self {
        let (x, y) = (self.re, other.re);
        self.with(x * y, other, |a, b| a * y + b * x)
    }
}

impl<const P: usize> Div for Dual<P> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let inverse = other.re.recip();
        let (value, by) = (self.re * inverse, inverse * inverse);
        let (x, y) = (self.re * by, other.re * by);
        self.with(value, other, |a, b| a * y - b * x)
    }
}

impl<const P: usize> Add<f64> for Dual<P> {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        Self { re: self.re + other, ..self }
    }
}

impl<const P: usize> Sub<f64> for Dual<P> {
    type Output = Self;
    fn sub(self, other: f64) -> Self {
        Self { re: self.re - other, ..self }
    }
}

impl<const P: usize> Mul<f64> for Dual<P> {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        self.chain(self.re * other, other)
    }
}

impl<const P: usize> Div<f64> for Dual<P> {
    type Output = Self;
    fn div(self, other: f64) -> Self {
        self.chain(self.re / other, other.recip())
    }
}

impl<const P: usize> AddAssign for Dual<P> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const P: usize> SubAssign for Dual<P> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

#[cfg(test)]
mod tests {
    use super::{Dual, Real};

    /// Every operation, in numbers of any kind.
    fn all<D: Real>(x: D, y: D) -> Vec<D> {
        let mut sum = x;
        sum += y * y;
        sum -= x * 0.5;
        let functions = [x.recip(), x.sin(), x.cos(), x.exp(), x.ln(), x.sqrt(), x.powi(3)];
        let others = [-x, x + y, x - y, x * y, x / y, x + 2.0, x - 2.0, x * 3.0, x / 3.0, sum];
        functions.into_iter().chain(others).collect()
    }

    #[test]
    fn derivatives_are_what_differences_say_of_the_values() {
        let (x, y, h) = (0.7, -1.3, 1e-5);
        let duals = all(Dual::<2>::variable(x, 0), Dual::variable(y, 1));
        let values = all(x, y);
        let [more, less] = [h, -h].map(|h| [all(x + h, y), all(x, y + h)]);
        for (k, dual) in duals.iter().enumerate() {
            // A quotient is a product with the inverse: two roundings.
            assert!((dual.re - values[k]).abs() <= 4e-16 * values[k].abs(), "{k}: {}", dual.re);
            for place in 0..2 {
                // Central differences are off by h²/6 times the third derivative, of at most 25 here, and by the values'
                // last digits over h.
                let slope = (more[place][k] - less[place][k]) / (2.0 * h);
                assert!((dual.eps[place] - slope).abs() < 5e-10, "{k}, {place}: {slope}");
            }
        }
    }
}
