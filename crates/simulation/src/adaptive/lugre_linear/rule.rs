//! Radau's points on [−1, 1] and the constant matrices of one panel.

/// Points of a panel; the polynomial through them and the panel's start is of this degree.
pub(super) const N: usize = 16;

/// What is the same for every panel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rule {
    /// Radau's points τ on (−1, 1], the last at 1.
    pub nodes: [f64; N],
    /// Row i: the weights of ∫ from −1 to τᵢ.
    pub integral: [[f64; N]; N],
    /// Row j: what a value at point j, the first of them −1, adds to the Chebyshev coefficients.
    pub series: [[f64; N + 1]; N + 1],
}

impl Rule {
    /// The points are the zeros of P_N − P_(N−1). A polynomial through them integrates by its Legendre
    /// coefficients, which the quadrature of the points gives exactly.
    pub(super) fn new() -> Self {
        let mut nodes = [1.0; N];
        for (i, node) in nodes[..N - 1].iter_mut().enumerate() {
            *node = zero(-((4 * i + 3) as f64 * std::f64::consts::PI / (4 * N) as f64).cos());
        }
        let p = nodes.map(legendre);
        let mut integral = [[0.0; N]; N];
        for (i, row) in integral.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let weight = (1.0 + nodes[j]) / (N as f64 * p[j][N - 1]).powi(2);
                let of_p = |k: usize| p[i][k + 1] - p[i][k - 1];
                let sum: f64 = (1..N).map(|k| p[j][k] * of_p(k)).sum();
                *entry = 0.5 * weight * (1.0 + nodes[i] + sum);
            }
        }
        let mut points = [-1.0; N + 1];
        points[1..].copy_from_slice(&nodes);
        Self { nodes, integral, series: series(&points) }
    }
}

/// P₀ … P_N at `x`.
fn legendre(x: f64) -> [f64; N + 1] {
    let mut p = [1.0; N + 1];
    p[1] = x;
    for k in 1..N {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
    }
    p
}

/// The zero of P_N − P_(N−1) near `x`, by Newton's method: (1 − x²) P_n′ = n (P_(n−1) − x P_n).
fn zero(mut x: f64) -> f64 {
    let n = N as f64;
    for _ in 0..20 {
        let p = legendre(x);
        let slope = |k: usize| k as f64 * (p[k - 1] - x * p[k]) / (1.0 - x * x);
        x -= (p[N] - p[N - 1]) / (slope(N) - slope(N - 1));
    }
    debug_assert!(x.abs() < 1.0, "{x} is no inner point of {n}");
    x
}

/// The inverse of T_k(point j), transposed, by elimination with pivots.
fn series(points: &[f64; N + 1]) -> [[f64; N + 1]; N + 1] {
    let mut left = points.map(|x| {
        let mut row = [1.0; N + 1];
        row[1] = x;
        for k in 1..N {
            row[k + 1] = 2.0 * x * row[k] - row[k - 1];
        }
        row
    });
    let mut right = [[0.0; N + 1]; N + 1];
    for (i, row) in right.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for k in 0..=N {
        let pivot = (k..=N).max_by(|a, b| left[*a][k].abs().total_cmp(&left[*b][k].abs()));
        let pivot = pivot.unwrap_or(k);
        left.swap(k, pivot);
        right.swap(k, pivot);
        let scale = 1.0 / left[k][k];
        left[k] = left[k].map(|x| scale * x);
        right[k] = right[k].map(|x| scale * x);
        for i in (0..=N).filter(|i| *i != k) {
            let part = left[i][k];
            for j in 0..=N {
                left[i][j] -= part * left[k][j];
                right[i][j] -= part * right[k][j];
            }
        }
    }
    let mut transposed = [[0.0; N + 1]; N + 1];
    for (k, row) in right.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            transposed[j][k] = *entry;
        }
    }
    transposed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_is_integrated_and_expanded_exactly() {
        let rule = Rule::new();
        for n in 0..16 {
            let power = |x: f64| x.powi(n);
            for (i, row) in rule.integral.iter().enumerate() {
                let sum: f64 = row.iter().zip(rule.nodes).map(|(w, x)| w * power(x)).sum();
                let degree = n + 1;
                let exact =
                    (rule.nodes[i].powi(degree) - (-1.0_f64).powi(degree)) / f64::from(degree);
                assert!((sum - exact).abs() < 1e-14, "x^{n} to node {i}: {:e}", sum - exact);
            }
        }
        // T₅ has one coefficient.
        let t5 = |x: f64| 16.0 * x.powi(5) - 20.0 * x.powi(3) + 5.0 * x;
        let mut c = [0.0; N + 1];
        for (j, row) in rule.series.iter().enumerate() {
            let value = t5(if j == 0 { -1.0 } else { rule.nodes[j - 1] });
            for k in 0..=N {
                c[k] += value * row[k];
            }
        }
        for (k, c) in c.iter().enumerate() {
            let exact = if k == 5 { 1.0 } else { 0.0 };
            assert!((c - exact).abs() < 1e-14, "coefficient {k} is off by {:e}", c - exact);
        }
    }
}
