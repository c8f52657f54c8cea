//! Long lines made short without changing the picture.

type Place = (f64, f64);

/// The lines that are left of a series inside a box, thinned to what a screen can show.
/// `grain` is 1 for what the eye can see, and more where that is too much to keep.
pub(crate) fn visible(series: &[Place], ends: (Place, Place), grain: f64) -> Vec<Vec<Place>> {
    let lines = clip(&min_max(series, grain), ends.0, ends.1);
    lines.into_iter().map(|line| straighten(&line, 0.07 * grain)).collect()
}

/// Of every run of places in one column of this width: the first, the lowest, the highest, the last, in their order.
pub(crate) fn min_max(series: &[Place], width: f64) -> Vec<Place> {
    let mut out = Vec::new();
    let column = |p: &Place| (p.0 / width).floor();
    for run in series.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |a: &usize, b: &usize| run[*a].1.total_cmp(&run[*b].1);
        let lowest = (0..run.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..run.len()).max_by(by_height).unwrap_or(0);
        let mut keep = [0, lowest, highest, run.len() - 1];
        keep.sort_unstable();
        let mut last = None;
        for i in keep {
            if last != Some(i) {
                out.push(run[i]);
            }
            last = Some(i);
        }
    }
    out
}

/// Leaves out places that lie on the way between others, to within `tolerance` (Douglas and Peucker).
fn straighten(line: &[Place], tolerance: f64) -> Vec<Place> {
    if line.len() < 3 {
        return line.to_vec();
    }
    let mut keep = vec![false; line.len()];
    (keep[0], keep[line.len() - 1]) = (true, true);
    let mut spans = vec![(0, line.len() - 1)];
    while let Some((a, b)) = spans.pop() {
        let far = (a + 1..b)
            .map(|i| (distance(line[i], line[a], line[b]), i))
            .max_by(|x, y| x.0.total_cmp(&y.0));
        if let Some((_, i)) = far.filter(|(d, _)| *d > tolerance) {
            keep[i] = true;
            spans.extend([(a, i), (i, b)]);
        }
    }
    line.iter().zip(keep).filter(|(_, keep)| *keep).map(|(place, _)| *place).collect()
}

/// From `p` to the straight piece between `a` and `b`.
fn distance(p: Place, a: Place, b: Place) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length = dx * dx + dy * dy;
    let t = if length == 0.0 { 0.0 } else { ((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length };
    let t = t.clamp(0.0, 1.0);
    (p.0 - a.0 - t * dx).hypot(p.1 - a.1 - t * dy)
}

/// The pieces of a line inside a box.
fn clip(line: &[Place], low: Place, high: Place) -> Vec<Vec<Place>> {
    let mut pieces: Vec<Vec<Place>> = Vec::new();
    for pair in line.windows(2) {
        let Some((a, b)) = inside(pair[0], pair[1], low, high) else { continue };
        match pieces.last_mut().filter(|piece| piece.last() == Some(&a)) {
            Some(piece) => piece.push(b),
            None => pieces.push(vec![a, b]),
        }
    }
    pieces
}

/// The part of one straight piece inside a box (Liang and Barsky).
fn inside(a: Place, b: Place, low: Place, high: Place) -> Option<(Place, Place)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut start, mut end) = (0.0_f64, 1.0_f64);
    let edges = [(-dx, a.0 - low.0), (dx, high.0 - a.0), (-dy, a.1 - low.1), (dy, high.1 - a.1)];
    for (p, q) in edges {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            start = start.max(q / p);
        } else {
            end = end.min(q / p);
        }
    }
    let at = |t: f64| {
        if t == 0.0 {
            a
        } else if t == 1.0 {
            b
        } else {
            (a.0 + t * dx, a.1 + t * dy)
        }
    };
    (start <= end).then(|| (at(start), at(end)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_the_extremes_of_every_column() {
        let series: Vec<Place> =
            (0..100_000).map(|i| (f64::from(i) * 1e-3, (f64::from(i) * 0.7).sin())).collect();
        let thin = min_max(&series, 1.0);
        assert!(thin.len() <= 400, "{} places in 100 columns", thin.len());
        for column in 0..100 {
            let of = |line: &[Place]| {
                let run = line.iter().filter(|p| p.0.floor() == f64::from(column));
                run.fold((1.0_f64, -1.0_f64), |(l, h), p| (l.min(p.1), h.max(p.1)))
            };
            assert_eq!(of(&series), of(&thin), "column {column}");
        }
        assert_eq!((thin[0], thin[thin.len() - 1]), (series[0], series[series.len() - 1]));
    }

    #[test]
    fn a_line_is_cut_at_the_box_and_straight_parts_lose_their_middle() {
        let line = [(-1.0, 0.5), (0.5, 0.5), (0.7, 0.5), (0.9, 0.5), (0.9, 5.0), (0.95, 0.1)];
        let cut = visible(&line, ((0.0, 0.0), (1.0, 1.0)), 1.0);
        assert!(cut.iter().flatten().all(|p| (0.0..=1.0).contains(&p.0) && p.1 <= 1.0), "{cut:?}");
        assert_eq!(straighten(&line[..4], 0.01), [(-1.0, 0.5), (0.9, 0.5)]);
    }
}
