//! Where a velocity given by a series first changes its sign.

use super::series::Series;
use integrate::collocation::fma;

/// A velocity that is only this many units of rounding beyond zero touches it and does not turn.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// What is well above zero, in units of how far the velocity may change in a third of a part.
const CLEAR: f64 = 0.05;

/// The span of a series is looked at in so many parts.
const PARTS: usize = 8;

/// A place τ with the velocity in the direction of motion and its derivative there.
#[derive(Debug, Clone, Copy)]
struct Place {
    tau: f64,
    p: f64,
    d: f64,
}

/// The first τ in (0, `end`] at which the motion turns; none if it does not. The velocity must begin in
/// the direction of motion or at zero.
///
/// The span is cut so finely that what is resolved by the series has one extremum of v̇ in a part at
/// most. Two turns in one part show as a minimum of the velocity beyond zero.
pub(super) fn first(series: &Series, end: f64) -> Option<f64> {
    let (s, part) = (series.from.s, end / PARTS as f64);
    let mut tau = [0.0; PARTS];
    for (i, tau) in tau.iter_mut().enumerate() {
        *tau = part * (i + 1) as f64;
    }
    let [p, d] = series.velocity(&tau);
    let size = p.iter().fold(series.v[0].abs(), |size, p| size.max(p.abs()));
    let mut a = Place { tau: 0.0, p: s * series.v[0], d: s * series.v[1] };
    for i in 0..PARTS {
        let b = Place { tau: tau[i], p: s * p[i], d: s * d[i] };
        if !clear(a, b) {
            let root = within(series, a, b, -ROUNDING * size);
            if root.is_some() {
                return root;
            }
        }
        a = b;
    }
    None
}

/// Whether the velocity stays well above zero between two places: the cubic through both and their slopes
/// does where its Bézier points do, and in so short a part it is the velocity but for a thousandth.
fn clear(a: Place, b: Place) -> bool {
    let third = (b.tau - a.tau) / 3.0;
    let least = fma(third, a.d, a.p).min(fma(-third, b.d, b.p)).min(b.p);
    least > CLEAR * third * a.d.abs().max(b.d.abs())
}

/// The first turn between two places.
fn within(series: &Series, a: Place, b: Place, beyond: f64) -> Option<f64> {
    // Where v̇ has one sign at both ends it may still lose it between them, if it is less there.
    if a.d * b.d > 0.0 {
        let (at_a, at_b) = (curve(series, a.tau), curve(series, b.tau));
        if a.d * at_a < 0.0 && b.d * at_b > 0.0 {
            let middle = extremum(series, a, b, |tau, _| (curve(series, tau), f64::NAN));
            if middle.d * a.d < 0.0 {
                let first = simple(series, a, middle, beyond);
                return first.or_else(|| simple(series, middle, b, beyond));
            }
        }
    }
    simple(series, a, b, beyond)
}

/// The same where v̇ changes its sign once at most.
fn simple(series: &Series, a: Place, b: Place, beyond: f64) -> Option<f64> {
    if a.d < 0.0 && b.d > 0.0 {
        let lowest = extremum(series, a, b, |tau, here| (here.d, curve(series, tau)));
        return (lowest.p < beyond).then(|| root(series, a, lowest));
    }
    (b.p < beyond).then(|| root(series, a, b))
}

/// Where v̈, or else v̇, is zero between two places at which it is not of one sign: a few digits do.
fn extremum(series: &Series, a: Place, b: Place, of: impl Fn(f64, &Place) -> (f64, f64)) -> Place {
    let (sign, mut here) = (of(b.tau, &b).0.signum(), place(series, 0.5 * (a.tau + b.tau)));
    let (mut low, mut high) = (a.tau, b.tau);
    for _ in 0..60 {
        let (f, slope) = of(here.tau, &here);
        if sign * f < 0.0 {
            low = here.tau;
        } else {
            high = here.tau;
        }
        let newton = here.tau - f / slope;
        let tau = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let near = (tau - here.tau).abs() < 1e-6 * tau;
        here = place(series, tau);
        if near {
            break;
        }
    }
    here
}

/// The root between a velocity ≥ 0 and one below, by secants kept between them.
fn root(series: &Series, a: Place, b: Place) -> f64 {
    let (mut low, mut high) = (a.tau, b.tau);
    let (step, drop) = (b.tau - a.tau, b.p - a.p);
    let (first, last) = (drop / (step * a.d), drop / (step * b.d));
    let mut next = 0.5 * (low + high);
    if first.min(last) > 0.0 && first.max(last) < 3.0 {
        // So nearly straight, τ is a cubic of the velocity.
        let u = -a.p / drop;
        let bend = (1.0 - u) * (first - 1.0) - u * (last - 1.0);
        next = fma(step, u * (1.0 + (1.0 - u) * bend), low).clamp(low, high);
    }
    let mut here = (b.tau, b.p);
    for _ in 0..200 {
        let before = here;
        here = (next, velocity(series, next));
        if here.1 >= 0.0 {
            low = next;
        } else {
            high = next;
        }
        next = here.0 - here.1 * (here.0 - before.0) / (here.1 - before.1);
        // The error left is of the order of the last two steps multiplied: the secant must be short too.
        let short = (here.0 - before.0).abs() <= 1e-4 * here.0;
        if short && (next - here.0).abs() <= 1e-11 * here.0 {
            return next.clamp(low, high);
        }
        if !(next > low && next < high) {
            next = 0.5 * (low + high);
            if next <= low || next >= high {
                return high;
            }
        }
    }
    high
}

/// The velocity in the direction of motion at τ.
fn velocity(series: &Series, tau: f64) -> f64 {
    let v = &series.v[..=series.order];
    series.from.s * v.iter().rev().fold(0.0, |sum, v| fma(sum, tau, *v))
}

fn place(series: &Series, tau: f64) -> Place {
    let [[p], [d]] = series.velocity(&[tau]);
    let s = series.from.s;
    Place { tau, p: s * p, d: s * d }
}

/// The second derivative in the direction of motion at τ.
fn curve(series: &Series, tau: f64) -> f64 {
    let mut sum = 0.0;
    for (n, v) in series.v[..=series.order].iter().enumerate().skip(2).rev() {
        sum = fma(sum, tau, (n * (n - 1)) as f64 * v);
    }
    series.from.s * sum
}

#[cfg(test)]
mod tests {
    use super::{super::series::State, *};

    /// A velocity with these roots and no others, positive before the first.
    fn with_roots(roots: &[f64]) -> Series {
        let from = State { t: 0.0, q: 0.0, v: 0.0, w: 1.0, s: 1.0 };
        let mut series = Series::new(20, 1.0, from);
        series.v[0] = 1.0;
        for root in roots {
            for n in (0..20).rev() {
                series.v[n + 1] -= series.v[n] / root;
            }
        }
        series
    }

    #[test]
    fn of_two_turns_close_together_the_first_is_found() {
        for apart in [0.3, 1e-2, 1e-4, 1e-6] {
            for first_root in [0.01, 0.2, 0.25, 0.374_999, 0.6] {
                let series = with_roots(&[first_root, first_root + apart, 5.0]);
                let root = first(&series, 1.0);
                let off = root.map(|root| (root - first_root).abs());
                // A rounding of v moves a root as far as v is flat there.
                let most = 1e-15 / apart;
                assert!(off.is_some_and(|off| off < most), "{first_root} + {apart}: {root:?}");
            }
        }
    }

    #[test]
    fn what_only_touches_zero_or_lies_beyond_the_end_is_no_turn() {
        for touch in [0.3, 0.5, 0.7] {
            assert_eq!(first(&with_roots(&[touch, touch, 3.0]), 1.0), None, "touches at {touch}");
        }
        assert_eq!(first(&with_roots(&[1.01]), 1.0), None);
        assert_eq!(first(&with_roots(&[]), 1.0), None);
    }

    #[test]
    fn a_start_at_rest_is_no_turn() {
        for root in [1e-3, 0.1, 0.9] {
            let mut series = with_roots(&[root]);
            for n in (0..20).rev() {
                series.v[n + 1] = series.v[n];
            }
            series.v[0] = 0.0;
            let found = first(&series, 1.0);
            assert!(found.is_some_and(|found| (found - root).abs() < 1e-14), "{root}: {found:?}");
        }
    }
}
