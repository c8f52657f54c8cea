//! The first zero of the velocity on an arc, found so that none before it can have been missed.
//!
//! An interval is passed over only if a Taylor bound proves that the velocity keeps its sign in it, and
//! searched for the zero only if one proves that it falls through it once. Anything else is halved.

use super::arc::{Arc, Point};

/// Below this share of a step an interval is not halved any more: the velocity touches zero to rounding.
const FLOOR: f64 = 1e-15;

/// The time τ [s] of the first zero of v in (a, b], where v has the sign `s` just after a.
pub(super) fn first_turn(arc: &Arc, s: f64, a: Point, b: Point) -> Option<f64> {
    let floor = FLOOR * (b.tau - a.tau) + f64::MIN_POSITIVE;
    let mut intervals = vec![(a, b)];
    while let Some((a, b)) = intervals.pop() {
        let (second, third) = arc.bounds(&a, b.tau - a.tau);
        let h = b.tau - a.tau;
        if keeps_sign(s, &a, &b, (second, third)) {
            continue;
        }
        let crosses = s * b.v <= 0.0;
        let slowest = (-s * a.a).min(-s * b.a);
        if crosses && (slowest > third * h * h / 8.0 || h <= floor) {
            return Some(crossing(a.tau, b.tau, |tau| s * arc.at(tau).v));
        }
        let middle = arc.at(a.tau + 0.5 * h);
        if h <= floor || middle.tau <= a.tau || middle.tau >= b.tau {
            continue;
        }
        intervals.push((middle, b));
        intervals.push((a, middle));
    }
    None
}

/// Whether s v > 0 is proved on (a, b].
fn keeps_sign(s: f64, a: &Point, b: &Point, (second, third): (f64, f64)) -> bool {
    let h = b.tau - a.tau;
    // Above the chord less what a curvature can take off.
    let chord = (s * a.v).min(s * b.v) > second * h * h / 8.0;
    // Taylor from the left, v + aσ + jσ²/2 − Mσ³/6 with σ in (0, h]: the bracket after σ is concave.
    let rest = third * h * h / 6.0;
    let left = s * a.v >= 0.0 && s * a.a >= 0.0 && s * (a.a + 0.5 * a.j * h) > rest;
    // And from the right, where v itself has to be positive.
    let right = s * b.v > 0.0 && -s * b.a >= 0.0 && s * (-b.a + 0.5 * b.j * h) > rest;
    chord || left || right
}

/// So many secants are tried before the zero is searched by bisection.
const SECANTS: u32 = 40;

/// The point of [low, high] where `f` is no longer positive, to the last digit, on its far side.
///
/// By secants, where an end that stays counts half the next time (Illinois). They are kept off both ends
/// by some digits, twice as many each time the same end stays: so both ends come together, and rounding
/// next to the zero cannot hold one of them.
pub(super) fn crossing(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let digit = 2.0 * f64::EPSILON * high.abs();
    let (mut at_low, mut at_high, mut off) = (f(low), f(high), digit);
    let (mut last, mut secants) = (None, 0);
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return high;
        }
        let apart = secants < SECANTS && at_low > 0.0 && low + off < middle && middle < high - off;
        let secant = low + (high - low) * (at_low / (at_low - at_high));
        let next = if apart { secant.clamp(low + off, high - off) } else { middle };
        let here = f(next);
        let holds = here > 0.0;
        let same = last == Some(holds);
        off = if same { 2.0 * off } else { digit };
        if holds {
            (low, at_low) = (next, here);
            at_high = if same { 0.5 * at_high } else { at_high };
        } else {
            (high, at_high) = (next, here);
            at_low = if same { 0.5 * at_low } else { at_low };
        }
        last = Some(holds);
        secants += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::crossing;
    use std::cell::Cell;

    #[test]
    fn a_zero_is_found_to_the_last_digit_in_few_looks() {
        let functions: [(fn(f64) -> f64, f64, f64); 6] = [
            (|x| 0.3 - x, 0.3, 20.0),
            (|x| x.cos(), std::f64::consts::FRAC_PI_2, 20.0),
            (|x| (-9.0 * x).exp() - 1e-4, 4.0 * 10.0_f64.ln() / 9.0, 40.0),
            // From a zero at the start, of third order, and one that has no zero but an end.
            (|x| x * (0.7 - x), 0.7, 25.0),
            (|x| (0.5 - x).powi(3), 0.5, 95.0),
            (|x| if x < 1.1 { 1.0 } else { -1e-9 }, 1.1, 95.0),
        ];
        for (i, (f, zero, most)) in functions.into_iter().enumerate() {
            let looks = Cell::new(0.0);
            let found = crossing(0.0, 2.0, |x| {
                looks.set(looks.get() + 1.0);
                f(x)
            });
            assert!((found - zero).abs() < 4e-16 * 4.0, "{i}: {found}, not {zero}");
            assert!(f(found) <= 0.0 && f(found.next_down()) > 0.0, "{i}: not at the sign's change");
            assert!(looks.get() < most, "{i}: {} looks", looks.get());
        }
    }
}
