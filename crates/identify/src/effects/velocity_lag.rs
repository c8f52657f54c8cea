//! `velocity_lag`: The velocity sensor follows late, as behind a filter.

use super::{About, Channel, Key, Law, Measure, Sense, family::{has_tachometer}};
use crate::march::Real;

/// The velocity sensor follows late, as behind a filter.
pub(super) struct VelocityLag;

/// A filter that has forgotten all but exp(−40) of a sample before.
const QUICK: f64 = 40.0;

/// Below this share of its time a sample is so short that a series is better than its sum.
const SHORT: f64 = 0.5;

/// What is shown at the end of a sample of so many time constants, `a`, of a velocity that bulges in it as 6 s(1 − s), one in the
/// mean: 6a ∫ exp(−au) u(1 − u) du from 0 to 1.
fn bulging<D: Real>(a: D) -> D {
    if a.re() < SHORT {
        // Σ (−a)ⁿ/n!/((n + 2)(n + 3))
        let (mut sum, mut term) = (D::from(0.0), D::from(1.0));
        for n in 0..10 {
            let n = f64::from(n);
            sum += term / ((n + 2.0) * (n + 3.0));
            term = -term * a / (n + 1.0);
        }
        return a * sum * 6.0;
    }
    let left = (-a).exp();
    let first = (-(left * (a + 1.0)) + 1.0) / a;
    let second = (-(left * (a * a + a * 2.0 + 2.0)) + 2.0) / (a * a);
    (first - second) * 6.0
}

impl Law for VelocityLag {
    const ABOUT: About = About {
        name: "velocity_lag",
        physics: "The velocity sensor follows late, as behind a filter.",
        equation: "tau w' = q' − w, w what the sensor shows",
        channel: Channel::Kinematics,
        keys: &[Key::positive("tau", Measure::Time, 50.0)],
        probes: About::no_shape,
        applies: has_tachometer,
        confused: &["input_delay", "compliance"],
        separated_by: "steps of the drive",
        test: 0.1,
    };

    fn sense<D: Real>(p: &[D], sense: &mut Sense<D>, memory: &mut D) {
        // Exact where the velocity is a parabola from sample to sample, and was one for long before the first.
        let (tau, slope) = (p[0], sense.slope);
        let follows = sense.v - (slope - sense.bend * tau) * tau;
        sense.v = if sense.dt == 0.0 || tau.re() * QUICK < sense.dt {
            // What was before the first is in what is shown there, which is known the better the longer it lasts.
            sense.shown.map_or(follows, |shown| {
                let square = tau * tau;
                follows + (-follows + shown.v) * (square / (square + shown.half * shown.half))
            })
        } else {
            let kept = (-tau.recip() * sense.dt).exp();
            let line = follows + kept * (*memory - follows + slope * sense.dt);
            line + sense.bulge * bulging(tau.recip() * sense.dt)
        };
        *memory = sense.v;
    }
}

#[cfg(test)]
mod tests {
    use super::{Law, Sense, VelocityLag};
    use crate::march::Dual;

    /// What is shown after a sample of `dt` [s] in which the velocity goes from 1 to 2 m/s, 0.7 m/s more in the mean than
    /// along a line, with its derivative by the time `tau` [s] of the sensor, which showed 0.5 m/s before.
    fn shown(tau: f64, dt: f64) -> [f64; 2] {
        let now = |x: f64| Dual::<1>::from(x);
        let mut sense = Sense {
            q: now(0.0),
            v: now(2.0),
            bulge: now(0.7),
            slope: now(1.0 / dt),
            bend: now(0.0),
            rate: 0.0,
            dt,
            shown: None,
        };
        let mut memory = now(0.5);
        VelocityLag::sense(&[Dual::variable(tau, 0)], &mut sense, &mut memory);
        assert_eq!(sense.v, memory);
        [sense.v.re, sense.v.eps[0]]
    }

    /// The same by small steps of τẏ = v − y.
    fn followed(tau: f64, dt: f64) -> f64 {
        let steps = 100_000;
        let kept = (-dt / tau / f64::from(steps)).exp();
        (0..steps).fold(0.5, |y, k| {
            let s = (f64::from(k) + 0.5) / f64::from(steps);
            let v = 1.0 + s + 0.7 * 6.0 * s * (1.0 - s);
            v + kept * (y - v)
        })
    }

    #[test]
    fn a_velocity_that_bulges_between_two_samples_is_followed_as_it_goes() {
        // Far longer than a sample, on both sides of where the series ends, and far shorter.
        for tau in [0.1, 0.010_01, 0.009_99, 0.004, 2e-4] {
            let [y, slope] = shown(tau, 0.005);
            assert!((y - followed(tau, 0.005)).abs() < 1e-8, "{y} m/s after {tau} s");
            let by = 1e-6 * tau;
            let [less, more] = [tau - by, tau + by].map(|tau| shown(tau, 0.005)[0]);
            let expected = (more - less) / (2.0 * by);
            assert!((slope - expected).abs() < 1e-5 * expected.abs(), "{slope} for {expected}");
        }
    }
}
