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

    /// The same with `more` all along it.
    pub(super) fn raised(self, more: D) -> Self {
        let knot = self.knot.map(|knot| Knot { sides: knot.sides.map(|side| side + more), ..knot });
        Self { ends: self.ends.map(|end| end + more), knot }
    }
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
            let end = if *hold == Hold::Linear { (now + 1).min(values.len() - 1) } else { now };
            line([D::from(values[now]), D::from(values[end])])
        }
        (Drive::Controlled(feedback), _) => {
            let at = |back: usize| q[q.len() - 1 - back.min(q.len() - 1)];
            line([feedback.command(i, [at(0), at(2)]); 2])
        }
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
    let ago = |place: usize, back: usize| D::from(values[(first + place).saturating_sub(back)]);
    let at = |place: usize| ago(place, back);
    let [before, now, after] = [ago(i, back + 1), at(i), at(next)];
    let moved = part - part.re();
    let (ends, sides) = match hold {
        Hold::ZeroOrder => ([before, now], [before, now]),
        Hold::Linear => {
            let [rises, goes_on] = [now - before, after - now];
            let ends = [now - rises * part, after - goes_on * part];
            (ends, [now - rises * moved, now - goes_on * moved])
        }
    };
    let straight = match hold {
        Hold::ZeroOrder => before.re() == now.re(),
        Hold::Linear => part.re() == 0.0,
    };
    Course { ends, knot: (!straight).then_some(Knot { share: part, sides }) }
}

#[cfg(test)]
mod tests {
    use super::{super::Dual, Course, Drive, Hold, course};

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
