//! An imposed motion at rest: a measured displacement never rests, and a bristle that is shaken by its noise forgets.

use identify::fit::Data;
use std::borrow::Cow;

/// What lies within so many standard deviations of the noise, over at least so many samples, may be at rest.
const WITHIN: f64 = 7.0;
pub(crate) const LEAST: usize = 10;

/// A slope of so many standard errors is a motion.
const MOVING: f64 = 4.0;

/// `data` as its motion is simulated: an imposed one rests where it does, a driven one is as it is.
pub(crate) fn still(data: &Data) -> Cow<'_, Data> {
    if data.force.is_some() { Cow::Owned(rested(data)) } else { Cow::Borrowed(data) }
}

/// `data` with the imposed displacement replaced by its mean wherever it rests.
pub(crate) fn rested(data: &Data) -> Data {
    let noise = identify::doctor::noise(&data.input);
    let mut rested = data.clone();
    let u = &data.input;
    let mut first = 0;
    while first < u.len() {
        let end = quiet(u, first, WITHIN * noise);
        let run = &u[first..end];
        if run.len() >= LEAST && !moves(run, noise) {
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
    use super::moves;

    #[test]
    fn a_slow_ramp_is_no_rest() {
        let noise = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let still: Vec<f64> = (0..40).map(noise).collect();
        let creeping: Vec<f64> = (0..40).map(|i| noise(i) + 0.1 * i as f64).collect();
        assert!(!moves(&still, 1.0) && moves(&creeping, 1.0));
    }
}
