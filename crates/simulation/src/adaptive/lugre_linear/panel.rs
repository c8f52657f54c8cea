//! One panel of time: collocation of a linear equation, its series, and points read off it.

use super::rule::{N, Rule};
use integrate::collocation::fma;

/// Points read off a series at once, side by side.
pub(super) const LANES: usize = 16;

/// What drives a panel at its points: r [m] and ∫-free rate |v|/r times half the panel [1].
#[derive(Debug, Clone, Copy)]
pub(super) struct Driven {
    /// r at the points [m].
    pub r: [f64; N],
    /// ½h |v|/r at the points.
    pub rate: [f64; N],
}

/// The Chebyshev series over a panel of y with y′ = rate (r − y) from `y0`.
///
/// Solved for z = y − r, which is small where y follows r, however fast: z + S(rate z) = y₀ − r with S
/// the integral. The elimination needs no pivots: those of Radau's integral are at least 1 for any rate ≥ 0.
pub(super) fn series(rule: &Rule, driven: &Driven, y0: f64) -> ([f64; N + 1], f64) {
    let Driven { r, rate } = driven;
    let mut m = rule.integral;
    for (i, row) in m.iter_mut().enumerate() {
        for (entry, rate) in row.iter_mut().zip(rate) {
            *entry *= rate;
        }
        row[i] += 1.0;
    }
    let mut z = r.map(|r| y0 - r);
    for k in 0..N {
        // A copy, so that the compiler sees that the rows do not overlap.
        let (row, z_k) = (m[k], z[k]);
        // What lies left of the pivot is not asked for again, and left alone by whole registers.
        let from = k / 8 * 8;
        let inverse = 1.0 / row[k];
        for (below, z) in m[k + 1..].iter_mut().zip(&mut z[k + 1..]) {
            let part = below[k] * inverse;
            for (entry, above) in below[from..].iter_mut().zip(&row[from..]) {
                *entry = fma(-part, *above, *entry);
            }
            *z -= part * z_k;
        }
    }
    for k in (0..N).rev() {
        z[k] /= m[k][k];
        let known = z[k];
        for (z, row) in z[..k].iter_mut().zip(&m) {
            *z -= row[k] * known;
        }
    }
    let mut c = rule.series[0].map(|entry| entry * y0);
    for j in 0..N {
        let y = r[j] + z[j];
        for (c, entry) in c.iter_mut().zip(&rule.series[j + 1]) {
            *c = fma(y, *entry, *c);
        }
    }
    (c, r[N - 1] + z[N - 1])
}

/// The series at the places `x` on [−1, 1], by Clenshaw's recurrence.
pub(super) fn at(c: &[f64; N + 1], x: &[f64; LANES]) -> [f64; LANES] {
    let (mut one, mut two) = ([0.0; LANES], [0.0; LANES]);
    for c in c[1..].iter().rev() {
        for lane in 0..LANES {
            let next = fma(2.0 * x[lane], one[lane], c - two[lane]);
            two[lane] = one[lane];
            one[lane] = next;
        }
    }
    let mut y = [0.0; LANES];
    for lane in 0..LANES {
        y[lane] = fma(x[lane], one[lane], c[0] - two[lane]);
    }
    y
}
