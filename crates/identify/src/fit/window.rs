//! Where a simulated piece of the record begins, and in what state.

use super::data::Data;

/// A piece of the record that is simulated in one go.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Its first sample.
    pub first: usize,
    /// One past its last sample.
    pub end: usize,
    /// Its start as the samples after it show it.
    pub start: [f64; START],
    /// The standard deviations of these.
    pub spread: [f64; START],
    /// How far the displacement has come since it last turned [m], with its sign; 0 where it is at rest, for then
    /// the contact holds what force there is, wherever it came from.
    pub run_up: f64,
}

/// The numbers of a window's start: displacement [m], velocity [m/s], and how far the contact's states are from
/// what the run-up says of them [of their natural size].
pub const START: usize = 3;

/// The standard deviation of the last of them: a contact that still rings is not where it holds the force.
const UNKNOWN: f64 = 0.1;

/// How many samples tell the state at a window's start.
const LOOK: usize = 9;

/// How much less the look at a window's start weighs than it might: the same samples are fitted besides.
const LOOSE: f64 = 10.0;

impl Window {
    /// The window of these samples.
    pub fn new(data: &Data, first: usize, end: usize) -> Self {
        let Some(seen) = &data.displacement else {
            return Self { first, end, start: [0.0; START], spread: [1.0; START], run_up: 0.0 };
        };
        let look = &seen.values[first..(first + LOOK).min(end)];
        let time = &data.time[first..(first + LOOK).min(end)];
        let ([q, slope], [q_spread, slope_spread]) = straight(time, look, seen.noise);
        let (mut v, mut v_spread) = (slope, slope_spread);
        if let Some(velocity) = &data.velocity
            && velocity.noise < v_spread
        {
            (v, v_spread) = (velocity.values[first], velocity.noise);
        }
        if v.abs() < 2.0 * v_spread {
            v = 0.0;
        }
        let come = run_up(&seen.values[..=first], 4.0 * seen.noise);
        Self {
            first,
            end,
            start: [q, v, 0.0],
            spread: [LOOSE * q_spread, LOOSE * v_spread, UNKNOWN],
            run_up: if v.abs() > MOVING * v_spread { come * same(come, v) } else { 0.0 },
        }
    }

    /// How many samples it has.
    pub fn len(&self) -> usize {
        self.end - self.first
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.end <= self.first
    }
}

/// 1 for two numbers of one sign, else 0.
fn same(a: f64, b: f64) -> f64 {
    if a * b > 0.0 { 1.0 } else { 0.0 }
}

/// So many standard deviations of the velocity are a motion.
const MOVING: f64 = 5.0;

/// Value and slope at the first time of the parabola (of the line, the constant, if there are not enough) that
/// fits best, and their standard deviations for values with this `noise`.
fn straight(time: &[f64], values: &[f64], noise: f64) -> ([f64; 2], [f64; 2]) {
    let order = values.len().min(3);
    let scale = time.last().map_or(1.0, |t| (t - time[0]).max(f64::MIN_POSITIVE));
    let a = nalgebra::DMatrix::from_fn(values.len(), order, |i, j| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "below 3")]
        let power = j as i32;
        ((time[i] - time[0]) / scale).powi(power)
    });
    let inverse = (a.transpose() * &a).try_inverse();
    let Some(inverse) = inverse.filter(|_| order > 0) else {
        return ([values.first().copied().unwrap_or(0.0), 0.0], [noise, noise / scale]);
    };
    let fitted = &inverse * a.transpose() * nalgebra::DVector::from_column_slice(values);
    let at = |j: usize| if j < order { fitted[j] } else { 0.0 };
    let spread = |j: usize| if j < order { noise * inverse[(j, j)].sqrt() } else { noise };
    ([at(0), at(1) / scale], [spread(0), spread(1) / scale])
}

/// The distance, with its sign, from the last turn to the last of these values; a turn is one of more than
/// `dead`.
fn run_up(values: &[f64], dead: f64) -> f64 {
    let Some(&last) = values.last() else { return 0.0 };
    let (mut low, mut high) = (last, last);
    for &value in values.iter().rev() {
        low = low.min(value);
        high = high.max(value);
        let (down, up) = (last - low, high - last);
        // Back in time it went below and then came back up by more than the noise: there it turned.
        if down > up && value - low > dead {
            return down;
        }
        if up > down && high - value > dead {
            return -up;
        }
    }
    if last - low > high - last { last - low } else { -(high - last) }
}
