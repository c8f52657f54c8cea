//! The integrator of [`crate::rosenbrock`] for as many states as planted effects need, with its Jacobian from
//! differences.

use crate::rosenbrock::{A, C, COUPLING, D, GAMMA, SHORTEST};

/// The most states.
pub(crate) const MOST: usize = 12;
/// A state; what is beyond the number in use stays 0.
pub(crate) type State = [f64; MOST];
type Matrix = [State; MOST];

/// What flows: ẏ = f(t, y).
pub(crate) trait Flow {
    /// How many states are in use.
    fn states(&self) -> usize;
    /// f(t, y).
    fn slope(&self, t: f64, y: &State) -> State;
}

/// A step is a difference of this share of a state's size.
const NEAR: f64 = 1e-7;

/// ∂f/∂y by differences of the sizes given, and ∂f/∂t; `at` is f itself.
fn jacobian(flow: &impl Flow, t: f64, y: &State, size: &State, at: &State) -> (Matrix, State) {
    let n = flow.states();
    let mut matrix = [[0.0; MOST]; MOST];
    for j in 0..n {
        let mut beside = *y;
        beside[j] += NEAR * size[j];
        let d = beside[j] - y[j];
        let slope = flow.slope(t, &beside);
        for i in 0..n {
            matrix[i][j] = (slope[i] - at[i]) / d;
        }
    }
    let later = t + NEAR * t.abs().max(1.0);
    let slope = flow.slope(later, y);
    let mut in_time = [0.0; MOST];
    for i in 0..n {
        in_time[i] = (slope[i] - at[i]) / (later - t);
    }
    (matrix, in_time)
}

/// A matrix in its triangular factors, with the order of its rows.
struct Factors {
    n: usize,
    lu: Matrix,
    rows: [usize; MOST],
}

impl Factors {
    /// Gauss's elimination with the largest pivots; `None` if there is no inverse.
    fn new(mut lu: Matrix, n: usize) -> Option<Self> {
        let mut rows = [0; MOST];
        for (i, row) in rows.iter_mut().enumerate() {
            *row = i;
        }
        for k in 0..n {
            let pivot = (k..n).max_by(|a, b| lu[*a][k].abs().total_cmp(&lu[*b][k].abs()))?;
            if !(lu[pivot][k].abs() > 0.0 && lu[pivot][k].is_finite()) {
                return None;
            }
            lu.swap(k, pivot);
            rows.swap(k, pivot);
            let upper = lu[k];
            for row in lu.iter_mut().take(n).skip(k + 1) {
                let factor = row[k] / upper[k];
                row[k] = factor;
                for j in k + 1..n {
                    row[j] -= factor * upper[j];
                }
            }
        }
        Some(Self { n, lu, rows })
    }

    fn solve(&self, right: &State) -> State {
        let mut x = [0.0; MOST];
        for i in 0..self.n {
            let known: f64 = (0..i).map(|j| self.lu[i][j] * x[j]).sum();
            x[i] = right[self.rows[i]] - known;
        }
        for i in (0..self.n).rev() {
            let known: f64 = (i + 1..self.n).map(|j| self.lu[i][j] * x[j]).sum();
            x[i] = (x[i] - known) / self.lu[i][i];
        }
        x
    }
}

/// One step of length h: the new state and an estimate of its error. `None` if the matrix cannot be solved.
pub(crate) fn step(
    flow: &impl Flow,
    t: f64,
    y: &State,
    h: f64,
    size: &State,
) -> Option<(State, State)> {
    let n = flow.states();
    let first = flow.slope(t, y);
    let (by_state, in_time) = jacobian(flow, t, y, size, &first);
    let mut matrix = by_state.map(|row| row.map(|value| -value));
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] += 1.0 / (h * GAMMA);
    }
    let factors = Factors::new(matrix, n)?;
    let mut u = [[0.0; MOST]; 6];
    let mut at = *y;
    for i in 0..6 {
        if i < 5 {
            at = *y;
            for (a, u) in A[i].iter().zip(&u) {
                add(&mut at, u, *a);
            }
        } else {
            add(&mut at, &u[4], 1.0);
        }
        let mut right = if i == 0 { first } else { flow.slope(t + C[i] * h, &at) };
        for (c, u) in COUPLING[i].iter().zip(&u) {
            add(&mut right, u, c / h);
        }
        if let Some(d) = D.get(i) {
            add(&mut right, &in_time, d * h);
        }
        u[i] = factors.solve(&right);
    }
    add(&mut at, &u[5], 1.0);
    Some((at, u[5]))
}

fn add(sum: &mut State, term: &State, factor: f64) {
    for (sum, term) in sum.iter_mut().zip(term) {
        *sum += term * factor;
    }
}

/// The length of steps, and what they are judged by.
#[derive(Debug, Clone)]
pub(crate) struct Pace {
    h: f64,
    tolerance: f64,
    /// The largest values seen so far, which the tolerance is relative to.
    pub(crate) scale: State,
    /// What each state is differenced over, at least.
    typical: State,
}

impl Pace {
    /// A pace that begins with steps of 1 µs; errors are relative to the largest values seen, and to a
    /// millionth of what is typical.
    pub(crate) fn new(tolerance: f64, typical: State) -> Self {
        Self { h: 1e-6, tolerance, scale: typical.map(|v| 1e-6 * v), typical }
    }

    /// The state has been of this size.
    pub(crate) fn saw(&mut self, state: &State) {
        for (scale, value) in self.scale.iter_mut().zip(state) {
            *scale = scale.max(value.abs());
        }
    }

    /// What each state is differenced over.
    pub(crate) fn size(&self) -> State {
        let mut size = self.typical;
        for (size, scale) in size.iter_mut().zip(&self.scale) {
            *size = size.max(*scale);
        }
        size
    }

    /// One accepted step from t towards `end`: its length, and the state then.
    pub(crate) fn step(
        &mut self,
        flow: &impl Flow,
        t: f64,
        y: &State,
        end: f64,
    ) -> Option<(f64, State)> {
        let (n, size) = (flow.states(), self.size());
        loop {
            // A step that nearly reaches the end reaches it.
            let h = if self.h * 1.01 >= end - t { end - t } else { self.h };
            let (error, next) = match step(flow, t, y, h, &size) {
                Some((next, off)) if next.iter().all(|v| v.is_finite()) => {
                    let of = |i: usize| off[i].abs() / self.scale[i];
                    ((0..n).map(of).fold(0.0, f64::max) / self.tolerance, next)
                }
                _ => (f64::INFINITY, *y),
            };
            let factor = (0.9 * error.powf(-0.25)).clamp(0.1, 5.0);
            if error <= 1.0 {
                self.h = if h < self.h { self.h.max(h * factor) } else { h * factor };
                return Some((h, next));
            }
            self.h = h * factor.min(0.9);
            if self.h < SHORTEST * t.abs().max(1.0) {
                return None;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A smooth problem that is not linear and knows the time: y = (sin t, cos t, e^(sin t)).
    struct Smooth;

    impl Flow for Smooth {
        fn states(&self) -> usize {
            3
        }
        fn slope(&self, t: f64, y: &State) -> State {
            let mut slope = [0.0; MOST];
            slope[0] = y[1];
            slope[1] = -y[0] + (t.cos() - y[1]);
            slope[2] = y[2] * y[1] + 0.1 * (y[0] * y[0] - t.sin().powi(2));
            slope
        }
    }

    fn error_with(steps: u32) -> f64 {
        let h = 2.0 / f64::from(steps);
        let mut y = [0.0; MOST];
        (y[1], y[2]) = (1.0, 1.0);
        for k in 0..steps {
            y = step(&Smooth, f64::from(k) * h, &y, h, &[1.0; MOST]).unwrap().0;
        }
        let exact = [2f64.sin(), 2f64.cos(), 2f64.sin().exp()];
        exact.iter().zip(&y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn the_method_keeps_its_order_with_a_jacobian_from_differences() {
        for steps in [20, 40] {
            let order = (error_with(steps) / error_with(2 * steps)).log2();
            assert!((order - 4.0).abs() < 0.3, "{steps} steps: order {order:.2}");
        }
    }

    #[test]
    fn a_matrix_times_the_solution_is_the_right_side() {
        let mut matrix = [[0.0; MOST]; MOST];
        for (i, row) in matrix.iter_mut().enumerate().take(7) {
            for (j, value) in row.iter_mut().enumerate().take(7) {
                *value = ((3 * i + 5 * j * j) as f64).sin() + if i + j == 6 { 0.0 } else { 0.3 };
            }
        }
        let right: State = std::array::from_fn(|i| if i < 7 { 1.0 + i as f64 } else { 0.0 });
        let x = Factors::new(matrix, 7).unwrap().solve(&right);
        for i in 0..7 {
            let found: f64 = (0..7).map(|j| matrix[i][j] * x[j]).sum();
            assert!((found - right[i]).abs() < 1e-11, "row {i}: {found}");
        }
    }
}
