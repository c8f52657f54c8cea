//! Where a simulated piece of the record begins, and in what state.

use super::{
    data::{Data, Seen},
    whitening::Whitening,
};
use crate::{
    effects::{LONG, Past},
    march::Shown,
};
use std::{ops::Range, sync::Arc};

/// A piece of the record that is simulated in one go.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Its first sample.
    pub first: usize,
    /// One past its last sample.
    pub end: usize,
    /// Its start as the samples after it, or to both sides of it, show it.
    pub start: [f64; START],
    /// The standard deviations of these.
    pub spread: [f64; START],
    /// How far the displacement has come since it last turned [m], with its sign; 0 where it is at rest, for then
    /// the contact holds what force there is, wherever it came from.
    pub run_up: f64,
    /// Where the displacement has turned [m] on its way to the window, and its start at last, without the turns inside
    /// larger ones: what a contact that slips can remember. Empty if nobody asked.
    pub path: Vec<f64>,
    /// For how long the displacement has been at rest before its start [s]; [`LONG`] if nobody asked.
    pub rested: f64,
    /// The last samples before its start: how long each took [s], and how far the displacement had come then since it
    /// last turned [m]. Empty if nobody asked.
    pub lately: Vec<[f64; 2]>,
    /// What the velocity sensor shows at its start, if there is one and it was looked at to both sides.
    pub shown: Option<Shown>,
    /// What makes its residuals independent of each other; none if they are so.
    pub whitening: Option<Arc<Whitening>>,
}

/// The numbers of a window's start: displacement [m], velocity [m/s], and how far the contact's states are from
/// what the run-up says of them [of their natural size]; where motor and load are two masses, how far these are from
/// where the one drives the other [of the joint's size], and how much faster the motor is [m/s].
pub const START: usize = 5;

/// So many of them where motor and load are one.
pub(super) const ONE_MASS: usize = 3;

/// The standard deviation of the last of them: a contact that still rings is not where it holds the force.
const UNKNOWN: f64 = 0.1;

/// The standard deviation of how much faster the motor is than the load, of the record's largest speed.
const FASTER: f64 = 0.1;

/// How many samples tell the state at a window's start.
const LOOK: usize = 9;

/// How much less the look at a window's start weighs than it might: the same samples are fitted besides.
const LOOSE: f64 = 10.0;

impl Window {
    /// The window of these samples.
    pub fn new(data: &Data, first: usize, end: usize) -> Self {
        let none = Self {
            first,
            end,
            start: [0.0; START],
            spread: [1.0; START],
            run_up: 0.0,
            path: Vec::new(),
            rested: LONG,
            lately: Vec::new(),
            shown: None,
            whitening: None,
        };
        let Some(seen) = &data.displacement else { return none };
        let (value, spread) = after(data, seen, first..end);
        none.seen(data, value, spread)
    }

    /// The [`Self::run_up`] of a window of these samples.
    pub fn come(data: &Data, first: usize, end: usize) -> f64 {
        let Some(seen) = &data.displacement else { return 0.0 };
        let (value, spread) = after(data, seen, first..end);
        begins((data, seen), first, value, spread).2
    }

    /// The same window, with where the displacement has turned before it, and with its start as the samples to both
    /// sides show it: known no better than a parabola fits them, for under a force that jumps they are none.
    #[must_use]
    pub fn remembering(self, data: &Data) -> Self {
        let Some(seen) = &data.displacement else { return self };
        let path = path(&seen.values[..=self.first], 4.0 * seen.noise);
        let (from, end) = around(data, self.first);
        let about = data.time[self.first];
        let (time, look) = (&data.time[from..end], &seen.values[from..end]);
        let wider = bent(time, look) / seen.noise.max(f64::MIN_POSITIVE);
        let wider = if wider > BENT { wider } else { 1.0 };
        let (value, spread) = straight((time, about), look, seen.noise);
        let rested = rested(data, self.first, 4.0 * seen.noise);
        let lately = lately(data, self.first, 4.0 * seen.noise);
        let mut all = self.seen(data, value, spread.map(|spread| spread * wider));
        all.path = path;
        all.rested = rested;
        all.lately = lately;
        all.shown = data.velocity.as_ref().map(|velocity| {
            let look = &velocity.values[from..end];
            let v = straight((time, about), look, velocity.noise).0[0];
            Shown { v, half: SLOWLY * data.sample_time() }
        });
        all
    }

    /// The same window with its start at a displacement and a velocity that are known with these standard deviations,
    /// if the velocity was not measured better.
    fn seen(self, data: &Data, value: [f64; 2], spread: [f64; 2]) -> Self {
        let Some(seen) = &data.displacement else { return self };
        let ([q, v], [q_spread, v_spread], run_up) =
            begins((data, seen), self.first, value, spread);
        let faster = FASTER * data.speed().max(f64::MIN_POSITIVE);
        Self {
            start: [q, v, 0.0, 0.0, 0.0],
            spread: [LOOSE * q_spread, LOOSE * v_spread, UNKNOWN, 1.0, faster],
            run_up,
            ..self
        }
    }

    /// What was before it.
    pub fn past(&self) -> Past<'_> {
        Past { path: &self.path, rested: self.rested, lately: &self.lately }
    }

    /// How well a parabola fits the samples around sample `i`, in units of their noise [1].
    pub fn smooth(data: &Data, i: usize) -> f64 {
        let Some(seen) = &data.displacement else { return 0.0 };
        let (from, end) = around(data, i);
        bent(&data.time[from..end], &seen.values[from..end]) / seen.noise.max(f64::MIN_POSITIVE)
    }

    /// Its first samples alone, so many.
    #[must_use]
    pub fn beginning(&self, samples: usize) -> Self {
        let end = self.end.min(self.first + samples.max(1));
        Self { end, whitening: None, ..self.clone() }
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

/// Displacement and velocity as the first samples of a window show them, and their standard deviations.
fn after(data: &Data, seen: &Seen, window: Range<usize>) -> ([f64; 2], [f64; 2]) {
    let look = window.start..(window.start + LOOK).min(window.end);
    straight((&data.time[look.clone()], data.time[window.start]), &seen.values[look], seen.noise)
}

/// Displacement and velocity at sample `first` [m, m/s], their standard deviations, and [`Window::run_up`] [m], of what the
/// displacement tells of both; the velocity as it was measured, if that is better.
fn begins(
    (data, seen): (&Data, &Seen),
    first: usize,
    [q, slope]: [f64; 2],
    [q_spread, slope_spread]: [f64; 2],
) -> ([f64; 2], [f64; 2], f64) {
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
    let run_up = if v.abs() > MOVING * v_spread { come * same(come, v) } else { 0.0 };
    ([q, v], [q_spread, v_spread], run_up)
}

/// A velocity sensor that takes so many samples is begun half with what it shows.
const SLOWLY: f64 = 2.0;

/// So many samples to either side tell the state at a window's start, where there are so many before it.
const BESIDE: usize = 4;

/// The samples around sample `i`, from the first to one past the last.
fn around(data: &Data, i: usize) -> (usize, usize) {
    let count = data.time.len();
    if i < BESIDE { (i, (i + LOOK).min(count)) } else { (i - BESIDE, (i + BESIDE + 1).min(count)) }
}

/// Samples that are off their parabola by so many times their noise are on none.
const BENT: f64 = 3.0;

/// By how much the values are off the parabola that fits them best, root mean square.
fn bent(time: &[f64], values: &[f64]) -> f64 {
    let scale = time.last().map_or(1.0, |t| (t - time[0]).max(f64::MIN_POSITIVE));
    let a = nalgebra::DMatrix::from_fn(values.len(), 3, |i, j| {
        let t = (time[i] - time[0]) / scale;
        [1.0, t, t * t][j]
    });
    let b = nalgebra::DVector::from_fn(values.len(), |i, _| values[i] - values[0]);
    let Ok(fitted) = a.clone().svd(true, true).solve(&b, 1e-12) else { return 0.0 };
    let left = b - a * fitted;
    (left.norm_squared() / (values.len() as f64 - 3.0).max(1.0)).sqrt()
}

/// 1 for two numbers of one sign, else 0.
fn same(a: f64, b: f64) -> f64 {
    if a * b > 0.0 { 1.0 } else { 0.0 }
}

/// So many standard deviations of the velocity are a motion.
const MOVING: f64 = 5.0;

/// Value and slope at a time of the parabola (of the line, the constant, if there are not enough) that
/// fits best, and their standard deviations for values with this `noise`.
fn straight((time, about): (&[f64], f64), values: &[f64], noise: f64) -> ([f64; 2], [f64; 2]) {
    let order = values.len().min(3);
    let scale = time.last().map_or(1.0, |t| (t - time[0]).max(f64::MIN_POSITIVE));
    let a = nalgebra::DMatrix::from_fn(values.len(), order, |i, j| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "below 3")]
        let power = j as i32;
        ((time[i] - about) / scale).powi(power)
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

/// For how long the displacement has not been further than `dead` from where it is at sample `i` [s].
fn rested(data: &Data, i: usize, dead: f64) -> f64 {
    let Some(seen) = &data.displacement else { return 0.0 };
    let away = |k: &usize| (seen.values[*k] - seen.values[i]).abs() > dead;
    let since = (0..i).rev().find(away).unwrap_or(0);
    data.time[i] - data.time[since]
}

/// So many samples are the last ones.
const LATELY: usize = 400;

/// The last samples up to sample `i`: how long each took [s], and how far the displacement had come then since it last
/// turned by more than `dead` [m].
fn lately(data: &Data, i: usize, dead: f64) -> Vec<[f64; 2]> {
    let Some(seen) = &data.displacement else { return Vec::new() };
    let from = i.saturating_sub(LATELY);
    let (mut turn, mut tip) = (seen.values[from], seen.values[from]);
    let run = |k: usize| {
        let value = seen.values[k];
        if (value - tip) * (tip - turn) > 0.0 {
            tip = value;
        } else if (value - tip).abs() > dead {
            (turn, tip) = (tip, value);
        }
        [data.time[k] - data.time[k - 1], (tip - turn).abs()]
    };
    (from + 1..=i).map(run).collect()
}

/// The first value, the turns by more than `dead` that are not inside larger ones that followed, and the last value.
///
/// A loop that is closed leaves nothing behind (Madelung's rule), so that only turns of ever smaller swings are kept.
fn path(values: &[f64], dead: f64) -> Vec<f64> {
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else { return Vec::new() };
    let (mut path, mut tip) = (vec![first], first);
    for &value in values {
        let back = path.last().map_or(0.0, |before| tip - before);
        if (value - tip) * back >= 0.0 && (back != 0.0 || (value - tip).abs() > dead) {
            tip = value;
        } else if (value - tip).abs() > dead {
            path.push(tip);
            tip = value;
        }
        // The swing to the tip is as large as the one before: both turns between are wiped out.
        while let [.., a, b] = path[..] {
            if path.len() < 3 || (tip - b).abs() < (a - b).abs() {
                break;
            }
            path.truncate(path.len() - 2);
        }
    }
    path.push(tip);
    if (last - tip).abs() > 0.0 {
        path.push(last);
    }
    path
}

#[cfg(test)]
mod tests {
    use super::{START, Window, lately, path};
    use crate::{
        Hold,
        fit::data::{Data, Seen},
    };

    #[test]
    fn the_samples_to_both_sides_tell_a_start_of_a_motion_that_bends() {
        // A cubic: its third derivative is what a parabola does not see.
        let time: Vec<f64> = (0..40).map(|i| 0.005 * f64::from(i)).collect();
        let way = |t: f64| 0.2 * t + 3.0 * t * t + 40.0 * t.powi(3);
        let values: Vec<f64> = time.iter().map(|t| way(*t)).collect();
        let position = Seen::new("position", values, 0.0);
        let data = Data::driven(time, vec![0.0; 40], Hold::ZeroOrder, position);
        let t = data.time[20];
        let truth = [way(t), 0.2 + 6.0 * t + 120.0 * t * t];
        let off = |start: [f64; START]| (start[1] - truth[1]).abs();
        let one_sided = Window::new(&data, 20, 40);
        let central = one_sided.clone().remembering(&data);
        // By Taylor: the slope of a parabola through t³ at −4h … 4h is off by 59/5 h² times its coefficient.
        let expected = 40.0 * 59.0 / 5.0 * 0.005_f64.powi(2);
        assert!((off(central.start) / expected - 1.0).abs() < 1e-6, "{}", off(central.start));
        assert!(
            (central.start[0] - truth[0]).abs() < 1e-12 && off(one_sided.start) > 3.0 * expected
        );
    }

    #[test]
    fn the_last_samples_tell_how_far_a_motion_had_come_since_it_turned() {
        let values = vec![0.0, 1.0, 3.0, 2.9, 3.5, 2.0, 1.9, 1.0];
        let time: Vec<f64> = (0..8).map(f64::from).collect();
        let data = |values: Vec<f64>| {
            let position = Seen::new("position", values, 0.0);
            Data::driven(time.clone(), vec![0.0; 8], Hold::ZeroOrder, position)
        };
        let runs: Vec<f64> = lately(&data(values), 7, 0.2).iter().map(|[_, run]| *run).collect();
        // From 3 back to 2.9 is no turn.
        let expected = [1.0, 3.0, 3.0, 3.5, 1.5, 1.6, 2.5];
        assert!(
            runs.iter().zip(expected).all(|(run, there)| (run - there).abs() < 1e-12),
            "{runs:?}"
        );
        assert_eq!(lately(&data(vec![0.0; 8]), 3, 0.2), vec![[1.0, 0.0]; 3]);
    }

    #[test]
    fn a_slipping_element_remembers_the_same_from_the_turns_as_from_the_way() {
        // Swings of many sizes, by three incommensurable tones.
        let tone = |i: usize, w: f64| (w * i as f64).sin();
        let way: Vec<f64> = (0..3000)
            .map(|i| tone(i, 0.013) + 0.6 * tone(i, 0.0497) + 0.3 * tone(i, 0.171))
            .collect();
        let slipped = |way: &[f64], delta: f64| {
            way.windows(2).fold(0.0, |z: f64, w| (z + w[1] - w[0]).clamp(-delta, delta))
        };
        for end in [500, 1234, 2000, 2999] {
            let turns = path(&way[..=end], 0.0);
            assert!(turns.len() < 40, "{} turns", turns.len());
            for delta in [0.05, 0.2, 0.5, 0.9] {
                let (long, short) = (slipped(&way[..=end], delta), slipped(&turns, delta));
                assert!(
                    (long - short).abs() < 1e-9,
                    "{end} {delta}: {long} by the way, {short} by its turns"
                );
            }
        }
    }
}
