//! A solved plant, between its nodes too.

/// A solved plant: nodes in time with the state q, v, x₁ … x_n and its derivative, Hermite between them.
/// What it is asked for needs one node at least.
///
/// A node may stand twice at one time with another derivative, where the solution has a kink: each side
/// then uses its own. q is the quintic through q, v and v̇ at both nodes, the other states are cubics.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    n: usize,
    t: Vec<f64>,
    y: Vec<f64>,
    y_dot: Vec<f64>,
}

impl Path {
    /// A path without nodes, for `n` states, two at least.
    pub fn new(n: usize) -> Self {
        Self { n, ..Self::default() }
    }

    /// Appends a node at the time `t` [s], not before the last one.
    pub fn push(&mut self, t: f64, y: &[f64], y_dot: &[f64]) {
        debug_assert!(self.t.last().is_none_or(|last| *last <= t), "{t} s is before the last node");
        self.t.push(t);
        self.y.extend_from_slice(y);
        self.y_dot.extend_from_slice(y_dot);
    }

    /// The number of states.
    pub fn states(&self) -> usize {
        self.n
    }

    /// The times of the nodes [s].
    pub fn t(&self) -> &[f64] {
        &self.t
    }

    /// The state at node `i`.
    pub fn node(&self, i: usize) -> &[f64] {
        &self.y[i * self.n..(i + 1) * self.n]
    }

    /// The derivative of the state at node `i`.
    pub fn node_dot(&self, i: usize) -> &[f64] {
        &self.y_dot[i * self.n..(i + 1) * self.n]
    }

    /// The last time and the state there; none if there is no node.
    pub fn end(&self) -> Option<(f64, &[f64])> {
        self.t.last().map(|t| (*t, self.node(self.t.len() - 1)))
    }

    /// Writes the state at the time `t` [s]; outside the nodes it is that of the nearest.
    pub fn state(&self, t: f64, y: &mut [f64]) {
        let place = self.locate(t);
        for (j, y) in y.iter_mut().enumerate().skip(1) {
            *y = self.cubic(place, j);
        }
        y[0] = self.quintic(place);
    }

    /// The displacement q at the time `t` [m].
    pub fn q(&self, t: f64) -> f64 {
        self.quintic(self.locate(t))
    }

    /// The velocity v at the time `t` [m/s].
    pub fn v(&self, t: f64) -> f64 {
        self.cubic(self.locate(t), 1)
    }

    /// The acceleration v̇ at the time `t` [m/s²]; at a kink, just after it.
    pub fn v_dot(&self, t: f64) -> f64 {
        let (i, s) = self.locate(t);
        let (from, to) = self.ends(i, 1);
        if self.width(i) == 0.0 {
            return to.1;
        }
        let chord = (to.0 - from.0) / self.width(i);
        let (a, b) = (from.1 - chord, to.1 - chord);
        chord + a * (1.0 - s) * (1.0 - 3.0 * s) + b * s * (3.0 * s - 2.0)
    }

    /// The times at which v changes sign [s], in order, each once: a root of the interpolant, or the
    /// first of the nodes at which v is zero. To start from rest or to end in it is no reversal.
    pub fn reversals(&self) -> Vec<f64> {
        let mut times = Vec::new();
        // The last node with v ≠ 0 and, if nodes with v = 0 followed it, the first of them.
        let (mut before, mut zero): (Option<usize>, Option<usize>) = (None, None);
        for i in 0..self.t.len() {
            let v = self.node(i)[1];
            if v == 0.0 {
                zero = zero.or(before.map(|_| i));
                continue;
            }
            if let Some(last) = before.filter(|last| self.opposite(*last, v)) {
                times.push(zero.map_or_else(|| self.root(last), |zero| self.t[zero]));
            }
            (before, zero) = (Some(i), None);
        }
        times
    }

    /// Whether v at node `i` and `v`, neither of them zero, are of opposite sign.
    fn opposite(&self, i: usize, v: f64) -> bool {
        (self.node(i)[1] > 0.0) != (v > 0.0)
    }

    /// The times at which the speed |v| rises through `speed` > 0 [m/s], in order [s]: where a slip sets
    /// in, if `speed` is far above that of creep.
    pub fn onsets(&self, speed: f64) -> Vec<f64> {
        let below = |i: usize| self.node(i)[1].abs() < speed;
        let rises = (1..self.t.len()).filter(|i| below(i - 1) && !below(*i));
        rises.map(|i| self.crossing(i - 1, |v| v.abs() < speed)).collect()
    }

    /// Where `of`, a function of the time [s], is largest between `from` and `to`, and how large: the best
    /// of the nodes, three points between each two and the ends of the span, refined by golden section
    /// between its neighbours. None if the span is
    /// turned round or outside the nodes.
    pub fn largest(&self, (from, to): (f64, f64), of: impl Fn(f64) -> f64) -> Option<(f64, f64)> {
        /// Between two nodes far apart the largest value may be far from both.
        const PARTS: u32 = 4;
        if *self.t.first()? > to || *self.t.last()? < from || from > to {
            return None;
        }
        let first = self.t.partition_point(|t| *t <= from);
        let last = self.t.partition_point(|t| *t < to).max(first);
        let nodes = &self.t[first..last];
        let ends: Vec<f64> = [from].into_iter().chain(nodes.iter().copied()).chain([to]).collect();
        let part =
            |pair: &[f64], i: u32| pair[0] + (pair[1] - pair[0]) * f64::from(i) / f64::from(PARTS);
        let looks = ends.windows(2).flat_map(|pair| (0..PARTS).map(move |i| part(pair, i)));
        let looks: Vec<f64> = looks.chain([to]).collect();
        let values: Vec<f64> = looks.iter().map(|t| of(*t)).collect();
        let best = (0..looks.len()).reduce(|a, b| if values[b] > values[a] { b } else { a })?;
        let (mut low, mut high) =
            (looks[best.saturating_sub(1)], looks[(best + 1).min(looks.len() - 1)]);
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        // Thirty narrowings leave 1e-6 of the interval, and 1e-12 of the height above its ends.
        for _ in 0..30 {
            let (a, b) = (high - golden * (high - low), low + golden * (high - low));
            if of(a) > of(b) { high = b } else { low = a }
        }
        let middle = 0.5 * (low + high);
        let (coarse, refined) = ((looks[best], values[best]), (middle, of(middle)));
        Some(if refined.1 > coarse.1 { refined } else { coarse })
    }

    /// The time between nodes `i` and `i + 1` at which v is zero [s].
    fn root(&self, i: usize) -> f64 {
        let negative = self.node(i)[1] < 0.0;
        self.crossing(i, |v| (v < 0.0) == negative)
    }

    /// The time [s] between nodes `i` and `i + 1` at which v, `before` it at the first and not at the
    /// second, has just ceased to be so: by bisection to the last digit.
    fn crossing(&self, i: usize, before: impl Fn(f64) -> bool) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return self.t[i] + high * self.width(i);
            }
            if before(self.cubic((i, middle), 1)) {
                low = middle;
            } else {
                high = middle;
            }
        }
    }

    /// The interval that holds just after `t` and the part of it before `t`.
    fn locate(&self, t: f64) -> (usize, f64) {
        let after = self.t.partition_point(|node| *node <= t);
        if after == 0 {
            return (0, 0.0);
        }
        if after == self.t.len() {
            // At the end, the interval that ends there: a doubled last node is its own interval.
            return (after.saturating_sub(2), 1.0);
        }
        let i = after - 1;
        (i, (t - self.t[i]) / self.width(i))
    }

    fn width(&self, i: usize) -> f64 {
        self.t.get(i + 1).map_or(0.0, |next| next - self.t[i])
    }

    /// State j and its derivative at both ends of interval `i`.
    fn ends(&self, i: usize, j: usize) -> ((f64, f64), (f64, f64)) {
        let next = (i + 1).min(self.t.len() - 1);
        ((self.node(i)[j], self.node_dot(i)[j]), (self.node(next)[j], self.node_dot(next)[j]))
    }

    fn cubic(&self, (i, s): (usize, f64), j: usize) -> f64 {
        let (from, to) = self.ends(i, j);
        let (h, d) = (self.width(i), to.0 - from.0);
        let (a, b) = (h * from.1 - d, h * to.1 - d);
        if s == 1.0 {
            return to.0;
        }
        from.0 + d * s + s * (1.0 - s) * (a * (1.0 - s) - b * s)
    }

    /// The cubic of q plus s²(1 − s)² times the line that also meets v̇ at both ends.
    fn quintic(&self, (i, s): (usize, f64)) -> f64 {
        let (from, to) = self.ends(i, 0);
        let (v_dot, next_v_dot) = {
            let ends = self.ends(i, 1);
            (ends.0.1, ends.1.1)
        };
        let (h, d) = (self.width(i), to.0 - from.0);
        let (a, b) = (h * from.1 - d, h * to.1 - d);
        // The cubic's second derivatives in s at 0 and 1 are −4a − 2b and 2a + 4b.
        let (left, right) =
            (h * h * v_dot + 4.0 * a + 2.0 * b, h * h * next_v_dot - 2.0 * a - 4.0 * b);
        let bump = s * s * (1.0 - s) * (1.0 - s);
        self.cubic((i, s), 0) + 0.5 * bump * (left * (1.0 - s) + right * s)
    }
}
