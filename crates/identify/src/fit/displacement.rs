//! The way between the samples of an imposed displacement, and its velocity at them.

/// Samples that are this evenly spaced tell the velocity to fourth order [of the sampling time].
const EVEN: f64 = 1e-3;

/// A second difference so many times as large as those around it is a corner.
const SHARP: f64 = 8.0;

/// Second differences of a straight line are so much of its values, by rounding [1].
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// So many samples of the same displacement are a rest.
pub(super) const REST: usize = 10;

/// Whether the displacement `u` has a corner at each sample: a rest begins or ends there, or its second difference stands
/// out from those two and three samples away. No smooth curve is led across it.
pub fn corners(u: &[f64]) -> Vec<bool> {
    let bend = |i: usize| match (i.checked_sub(1), u.get(i + 1)) {
        (Some(before), Some(after)) => (after - 2.0 * u[i] + u[before]).abs(),
        _ => 0.0,
    };
    let around = |i: usize| {
        let far = [2, 3].into_iter().flat_map(|k| [i.checked_sub(k), Some(i + k)]);
        far.flatten().map(bend).fold(0.0, f64::max)
    };
    let rounding = |i: usize| ROUNDING * (u[i].abs() + bend(i));
    let mut corners: Vec<bool> =
        (0..u.len()).map(|i| bend(i) > SHARP * around(i) && bend(i) > rounding(i)).collect();
    let mut first = 0;
    for rest in u.chunk_by(|a, b| a == b) {
        let last = first + rest.len() - 1;
        if rest.len() >= REST {
            corners[first] |= first > 0;
            corners[last] |= last + 1 < u.len();
        }
        first = last + 1;
    }
    corners
}

/// An imposed motion as every model sees it: its velocity at the samples, and the pieces between them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Course {
    /// The velocity at every sample [m/s].
    pub(super) velocity: Vec<f64>,
    /// The pieces of constant velocity: where each ends [m], and its velocity [m/s].
    pieces: Vec<(f64, f64)>,
    /// How many of them there are up to each sample.
    until: Vec<usize>,
}

impl Course {
    /// That of the displacement `u` [m] at `time` [s].
    pub fn of(time: &[f64], u: &[f64]) -> Self {
        let corners = corners(u);
        let mut course = Self::default();
        for i in 0..u.len() {
            course.velocity.push(velocity(time, (u, &corners), i));
            if i > 0 {
                course.pieces.extend(way(time, (u, &corners), i));
            }
            course.until.push(course.pieces.len());
        }
        course
    }

    /// The pieces from sample `i − 1` to `i`.
    pub(super) fn way(&self, i: usize) -> &[(f64, f64)] {
        &self.pieces[self.until[i - 1]..self.until[i]]
    }
}

/// The velocity [m/s] at sample `i`: of the quartic through five samples, or of the parabola through three where they
/// are too few, not evenly spaced, or a corner is among them; next to a corner, of the line on this side of it.
pub(super) fn velocity(time: &[f64], (u, corners): (&[f64], &[bool]), i: usize) -> f64 {
    let (mut before, mut after) = (i.saturating_sub(1), (i + 1).min(u.len() - 1));
    if corners[after] && !corners[before] && i > before {
        after = i;
    } else if corners[before] && !corners[after] && after > i {
        before = i;
    }
    if before == after {
        return 0.0;
    }
    let near = (u[after] - u[before]) / (time[after] - time[before]);
    if i < 2 || i + 2 >= u.len() || after - before != 2 {
        return near;
    }
    let (far, wide) = (time[i + 2] - time[i - 2], time[after] - time[before]);
    if (far - 2.0 * wide).abs() > EVEN * wide || corners[i - 1..i + 2].contains(&true) {
        return near;
    }
    (4.0 * near - (u[i + 2] - u[i - 2]) / far) / 3.0
}

/// The pieces of constant velocity from sample to sample.
const PIECES: usize = 4;

/// The displacement at a `share` of the way from sample `i − 1` to `i`, by the cubic through four samples; the way is
/// straight at the ends of a record, next to a corner, and where nothing moves.
fn between((u, corners): (&[f64], &[bool]), i: usize, share: f64) -> f64 {
    let (a, b) = (u[i - 1], u[i]);
    let straight = a + (b - a) * share;
    if i < 2 || i + 1 >= u.len() || a == b || corners[i] || corners[i - 1] {
        return straight;
    }
    let (before, after) = (u[i - 2], u[i + 1]);
    // Newton's form: second differences on both sides.
    let (left, right) = (before - 2.0 * a + b, a - 2.0 * b + after);
    let bend = share * (share - 1.0) / 6.0;
    straight + bend * ((2.0 - share) * left + (1.0 + share) * right)
}

/// The pieces of constant velocity on the way from sample `i − 1` to `i`: where each ends [m], and its velocity [m/s].
pub(super) fn way(time: &[f64], (u, corners): (&[f64], &[bool]), i: usize) -> Vec<(f64, f64)> {
    let dt = time[i] - time[i - 1];
    if let Some(turn) = turned(time, (u, corners), i) {
        return turn.to_vec();
    }
    let mut last = u[i - 1];
    let piece = |piece: usize| {
        let share = piece as f64 / PIECES as f64;
        let next = if piece == PIECES { u[i] } else { between((u, corners), i, share) };
        let speed = (next - last) * PIECES as f64 / dt;
        last = next;
        (next, speed)
    };
    (1..=PIECES).map(piece).collect()
}

/// The same where the way has its corner: where the lines before and after it meet. The motion goes further than any
/// sample shows, and a contact with it.
fn turned(time: &[f64], (u, corners): (&[f64], &[bool]), i: usize) -> Option<[(f64, f64); 2]> {
    if i < 2 || i + 1 >= u.len() || !(corners[i - 1] || corners[i]) {
        return None;
    }
    let slope = |k: usize| (u[k] - u[k - 1]) / (time[k] - time[k - 1]);
    let (before, after, dt) = (slope(i - 1), slope(i + 1), time[i] - time[i - 1]);
    let at = (u[i] - u[i - 1] - after * dt) / (before - after);
    (at > 0.0 && at < dt).then(|| [(u[i - 1] + before * at, before), (u[i], after)])
}
