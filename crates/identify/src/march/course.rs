//! What the input does from one sample to the next.

use super::{Drive, Real};
use crate::Hold;

/// The input from one sample to the next: along a line from the first of its ends to the other, or along two that meet,
/// or do not, at a knot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Course<D> {
    /// The input at both ends [its unit].
    pub(super) ends: [D; 2],
    /// Where it bends or jumps.
    pub(super) knot: Option<Knot<D>>,
}

/// Where an input bends or jumps between two samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Knot<D> {
    /// At which share of the interval [1].
    pub(super) share: D,
    /// The input before and after it [its unit]. Their derivatives are those at a fixed time.
    pub(super) sides: [D; 2],
}

impl<D: Real> Course<D> {
    /// The parts in which it goes along a line, of an interval of length `dt` [s]: from when until when, and its ends.
    pub(super) fn parts(&self, dt: f64) -> impl Iterator<Item = ([f64; 2], [D; 2])> + use<D> {
        let [begin, end] = self.ends;
        let all = match self.knot {
            None => [([0.0, dt], self.ends), ([dt, dt], self.ends)],
            Some(Knot { share, sides: [before, after] }) => {
                let at = share.re() * dt;
                [([0.0, at], [begin, before]), ([at, dt], [after, end])]
            }
        };
        all.into_iter().filter(|([from, to], _)| to > from)
    }

    /// The input at this share of the interval.
    pub(super) fn at(&self, share: f64) -> D {
        let parts = self.parts(1.0);
        let own = parts.filter(|([from, _], _)| *from < share).last();
        own.map_or(self.ends[0], |([from, to], [begin, end])| {
            begin + (end - begin) * ((share - from) / (to - from))
        })
    }

    /// The same with the errors of recorded samples on it, the oldest first, each of which does what a unit `of` it does.
    pub(super) fn raised(self, all: &[D], of: impl Fn(usize) -> Course<f64>) -> Self {
        let mut raised = self;
        for (k, error) in all.iter().enumerate() {
            let unit = of(k);
            let plus = |own: [D; 2], by: [f64; 2]| [0, 1].map(|i| own[i] + *error * by[i]);
            // What jumps or bends on the way where the input does not is as much in the mean.
            let area = |([from, to], [a, b]): ([f64; 2], [f64; 2])| 0.5 * (to - from) * (a + b);
            let ends = match (&raised.knot, &unit.knot) {
                (None, Some(_)) => [unit.parts(1.0).map(area).sum(); 2],
                _ => unit.ends,
            };
            raised.ends = plus(raised.ends, ends);
            // Of two errors within an interval that bends or jumps a unit of each does so there as well.
            if let (Some(knot), Some(own)) = (&mut raised.knot, unit.knot) {
                knot.sides = plus(knot.sides, own.sides);
            }
        }
        raised
    }
}

/// An interval's input is counted from this of so many samples, on no others of which it depends.
const HERE: usize = 2;
const ABOUT: usize = 5;

/// On the errors of how many samples the input of an interval depends: one that is held on that of the sample before, one that
/// goes along a line on those to both sides, one that is smooth on two to either, and one that is late on one more.
pub fn errors(hold: Hold, late: bool) -> usize {
    usize::from(late) + [1, 2, 4][ahead(hold)]
}

/// How many samples ahead of an interval's first one its input depends on.
fn ahead(hold: Hold) -> usize {
    match hold {
        Hold::ZeroOrder => 0,
        Hold::Linear => 1,
        Hold::Smooth => 2,
    }
}

/// The input of an interval that a unit of the `k`-th error makes, the oldest first; late by this `share` of the interval
/// beside whole ones.
pub(super) fn unit(k: usize, hold: Hold, share: Option<f64>) -> Course<f64> {
    let mut values = [0.0; ABOUT];
    values[HERE + ahead(hold) + 1 + k - errors(hold, share.is_some())] = 1.0;
    let drive = Drive::Recorded { values: &values, first: HERE, hold };
    course(&drive, 0, &[], share.map(|share| (share, &[0.0, 1.0, 2.0][..])))
}

/// How fast the input changes at sample `i`, over a few samples; 0 where the controller makes it.
pub(super) fn rate(drive: &Drive<'_>, time: &[f64], i: usize) -> f64 {
    const FAR: usize = 2;
    let Drive::Recorded { values, first, .. } = drive else { return 0.0 };
    let values = &values[*first..];
    let (before, after) = (i.saturating_sub(FAR), (i + FAR).min(values.len() - 1));
    if after == before {
        return 0.0;
    }
    (values[after] - values[before]) / (time[after] - time[before])
}

/// The input in the interval that begins with sample `i`; late by the `delay` where there is one.
pub(super) fn course<D: Real>(
    drive: &Drive<'_>,
    i: usize,
    q: &[D],
    delay: Option<(D, &[f64])>,
) -> Course<D> {
    let line = |ends: [D; 2]| Course { ends, knot: None };
    match (drive, delay) {
        (Drive::Recorded { values, first, hold }, Some(late_by)) => {
            late((values, *first), *hold, i, late_by)
        }
        (Drive::Recorded { values, first, hold }, None) => {
            let now = first + i;
            let end = if *hold == Hold::ZeroOrder { now } else { (now + 1).min(values.len() - 1) };
            line(match hold {
                Hold::Smooth if end > now => {
                    Cubic::after(values, now).line([D::from(0.0), D::from(1.0)])
                }
                _ => [D::from(values[now]), D::from(values[end])],
            })
        }
        (Drive::Controlled(feedback), _) => {
            let at = |back: usize| q[q.len() - 1 - back.min(q.len() - 1)];
            line([feedback.command(i, [at(0), at(2)]); 2])
        }
    }
}

/// The cubic through four samples, over the interval between the two in the middle: its coefficients [the input's unit]
/// about the middle, in intervals.
#[derive(Debug, Clone, Copy)]
struct Cubic([f64; 4]);

impl Cubic {
    /// Over the interval that begins at the place `now` of the values. What is not there goes straight on.
    fn after(values: &[f64], now: usize) -> Self {
        let last = values.len() - 1;
        let [from, to] = [now, now + 1].map(|place| values[place.min(last)]);
        let before = if now > 0 { values[now - 1] } else { 2.0 * from - to };
        let after = values.get(now + 2).copied().unwrap_or(2.0 * to - from);
        let ([inner, outer], [rise, wide]) =
            ([0.5 * (from + to), 0.5 * (before + after)], [to - from, after - before]);
        let (square, cube) = (0.5 * (outer - inner), (wide - 3.0 * rise) / 6.0);
        Self([inner - square / 4.0, rise - cube / 4.0, square, cube])
    }

    /// The ends of the line that has its mean and its first moment between these shares of the interval: a plant that
    /// turns it into a motion cannot tell the two.
    fn line<D: Real>(self, [from, to]: [D; 2]) -> [D; 2] {
        let Self([constant, slope, square, cube]) = self;
        let at = |share: D| {
            let t = share - 0.5;
            ((t * cube + square) * t + slope) * t + constant
        };
        let (long, middle) = ((to - from).re(), 0.5 * (from + to).re() - 0.5);
        let bend = (2.0 * square + 6.0 * cube * middle) * long * long / 12.0;
        let twist = cube * long.powi(3) / 20.0;
        [at(from) - bend + twist, at(to) - bend - twist]
    }
}

/// The recorded input of a time `delay` [s] ago in the interval that begins with sample `i`, whose first is at the place
/// `first` of the values. Within the interval one that is held jumps, and one that goes straight bends.
fn late<D: Real>(
    (values, first): (&[f64], usize),
    hold: Hold,
    i: usize,
    (delay, time): (D, &[f64]),
) -> Course<D> {
    let next = (i + 1).min(values.len() - 1 - first);
    let dt = if next > i { time[next] - time[i] } else { 1.0 };
    let share = delay / dt;
    let whole = share.re().floor();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative")]
    let back = whole.clamp(0.0, 1e9) as usize;
    let part = share - whole;
    let place = |i: usize, back: usize| (first + i).saturating_sub(back);
    let ago = |i: usize, back: usize| D::from(values[place(i, back)]);
    let [before, now, after] = [ago(i, back + 1), ago(i, back), ago(next, back)];
    let moved = part - part.re();
    let (ends, sides) = match hold {
        Hold::ZeroOrder => ([before, now], [before, now]),
        Hold::Linear => {
            let [rises, goes_on] = [now - before, after - now];
            let ends = [now - rises * part, after - goes_on * part];
            (ends, [now - rises * moved, now - goes_on * moved])
        }
        Hold::Smooth => {
            let one = D::from(1.0);
            let [earlier, later] =
                [back + 1, back].map(|back| Cubic::after(values, place(i, back)));
            let [begin, before] = earlier.line([one - part, one - moved]);
            let [after, end] = later.line([-moved, one - part]);
            // Late by whole intervals it is one cubic, of which nothing is left of the one before.
            let begin = if part.re() == 0.0 { after } else { begin };
            ([begin, end], [before, after])
        }
    };
    let straight = match hold {
        Hold::ZeroOrder => before.re() == now.re(),
        Hold::Linear | Hold::Smooth => part.re() == 0.0,
    };
    Course { ends, knot: (!straight).then_some(Knot { share: part, sides }) }
}

#[cfg(test)]
mod tests {
    use super::{super::Dual, Course, Drive, Hold, course, unit};

    #[test]
    fn a_held_input_that_comes_late_jumps_where_it_does() {
        let values = [1.0, 1.0, 3.0, 2.0, 2.0];
        let drive = Drive::Recorded { values: &values, first: 1, hold: Hold::ZeroOrder };
        let time = [0.0, 0.1, 0.2, 0.3];
        let at = |i: usize, delay: f64| course(&drive, i, &[], Some((delay, &time[..])));
        let parts = |c: Course<f64>| c.parts(0.1).collect::<Vec<_>>();
        // Until 0.03 s after the sample it is what it was before.
        let jump = at(1, 0.03);
        assert_eq!((jump.at(0.2), jump.at(0.4)), (1.0, 3.0));
        let all = parts(jump);
        assert!((all[0].0[1] - 0.03).abs() < 1e-15 && all[1].0 == [all[0].0[1], 0.1]);
        assert_eq!([all[0].1, all[1].1], [[1.0; 2], [3.0; 2]]);
        // Where it stays it does not, one that comes an interval later is late by that, and one not late is as recorded.
        assert_eq!(parts(at(0, 0.03)), [([0.0, 0.1], [1.0; 2])]);
        assert_eq!(at(2, 0.13).ends, [1.0, 3.0]);
        assert_eq!(parts(at(1, 0.0)), [([0.0, 0.1], [3.0; 2])]);
        // Later by dτ it jumps later.
        let later = course(&drive, 1, &[], Some((Dual::<1>::variable(0.03, 0), &time[..])));
        assert!((later.knot.unwrap().share.eps[0] - 10.0).abs() < 1e-12);
    }

    #[test]
    fn a_smooth_input_has_the_mean_and_the_first_moment_of_its_cubic() {
        // u = s³ − 2 s² + s + 1 with s counted from the second sample; 0.3 of an interval late as well.
        let u = |s: f64| ((s - 2.0) * s + 1.0) * s + 1.0;
        let values: Vec<f64> = (0..6).map(|i| u(f64::from(i) - 2.0)).collect();
        let drive = Drive::Recorded { values: &values, first: 2, hold: Hold::Smooth };
        let time = [0.0, 0.1, 0.2, 0.3];
        let moments = |f: &dyn Fn(f64) -> f64| {
            let n = 20_000;
            let sums =
                (0..n).map(|k| (f64::from(k) + 0.5) / f64::from(n)).map(|s| [f(s), s * f(s)]);
            sums.fold([0.0; 2], |sum, f| [0, 1].map(|i| sum[i] + f[i] / f64::from(n)))
        };
        for (delay, i) in [(0.0, 0_u8), (0.0, 1), (0.03, 0), (0.03, 1)] {
            let late = Some((delay, &time[..])).filter(|(delay, _)| *delay > 0.0);
            let course = course::<f64>(&drive, usize::from(i), &[], late);
            let [seen, truly] =
                [moments(&|s| course.at(s)), moments(&|s| u(s + f64::from(i) - 10.0 * delay))];
            for (seen, truly) in seen.iter().zip(truly) {
                assert!((seen - truly).abs() < 1e-4, "{seen} for {truly}, {delay} s late");
            }
        }
        let by = course(&drive, 1, &[], Some((Dual::<1>::variable(0.03, 0), &time[..])));
        let slope = |s: f64| (3.0 * s - 4.0) * s + 1.0;
        let [begin, end] = [0.7, 1.7].map(|s| -10.0 * slope(s));
        assert!((by.ends[0].eps[0] - begin).abs() < 1e-9 && (by.ends[1].eps[0] - end).abs() < 1e-9);
    }

    #[test]
    fn an_input_that_is_late_by_nothing_is_not_late() {
        let values = [1.0, 1.5, 3.0, 2.0, 0.5, 1.0];
        let time = [0.0, 0.1, 0.2, 0.3];
        for hold in [Hold::Linear, Hold::Smooth, Hold::ZeroOrder] {
            let drive = Drive::Recorded { values: &values, first: 1, hold };
            for i in 0..3 {
                let [late, own] =
                    [Some((0.0, &time[..])), None].map(|by| course(&drive, i, &[], by));
                assert_eq!(late.at(1e-9), own.at(1e-9), "{hold:?} {i}");
                assert_eq!(late.at(1.0), own.at(1.0), "{hold:?} {i}");
            }
        }
    }

    #[test]
    fn an_error_that_jumps_where_the_input_does_not_is_as_much_in_the_mean() {
        let values = [2.0; 5];
        let drive = Drive::Recorded { values: &values, first: 1, hold: Hold::ZeroOrder };
        let late = course(&drive, 1, &[], Some((0.03, &[0.0, 0.1, 0.2][..])));
        let raised = late.raised(&[1.0, 10.0], |k| unit(k, Hold::ZeroOrder, Some(0.3)));
        // Of the sample before it has three tenths, of its own seven.
        for share in [0.1, 0.5, 1.0] {
            assert!((raised.at(share) - 9.3).abs() < 1e-12, "{}", raised.at(share));
        }
    }

    #[test]
    fn an_input_that_goes_straight_and_comes_late_bends_where_it_does() {
        let values = [1.0, 1.0, 3.0, 2.0, 2.0];
        let drive = Drive::Recorded { values: &values, first: 1, hold: Hold::Linear };
        let time = [0.0, 0.1, 0.2, 0.3];
        let at = |share: f64, delay: f64| {
            course(&drive, 1, &[], Some((Dual::<1>::variable(delay, 0), &time[..]))).at(share)
        };
        // Between the samples it was 1 + 20 t, and then 3 − 10 t.
        for (share, seen, slope) in [(0.1, 2.6, 20.0), (0.3, 3.0, 20.0), (0.5, 2.8, -10.0)] {
            let input = at(share, 0.03);
            assert!((input.re - seen).abs() < 1e-12, "{share}: {} for {seen}", input.re);
            assert!((input.eps[0] + slope).abs() < 1e-9, "{share}: {} by the delay", input.eps[0]);
        }
        assert_eq!(at(0.5, 0.0).re, 2.5);
    }
}
