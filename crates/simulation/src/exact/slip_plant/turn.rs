//! The first zero of the velocity on an arc, found so that none before it can have been missed.
//!
//! An interval is passed over only if a Taylor bound proves that the velocity keeps its sign in it, and
//! searched by bisection only if one proves that it falls through zero once. Anything else is halved.

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
            return Some(bisect(a.tau, b.tau, |tau| s * arc.at(tau).v > 0.0));
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

/// The point of [low, high] where `holds` turns false, to the last digit, on its far side.
pub(super) fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return high;
        }
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}
