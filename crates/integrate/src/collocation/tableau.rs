//! The coefficients of the Radau IIA methods, computed from their nodes.

use nalgebra::{Complex, DMatrix, DVector};
use std::sync::LazyLock;

/// Radau IIA with S stages, in W places, and (S + 1)/2 blocks, in B places, in the coordinates in which its stages decouple.
///
/// The polynomial z(θ) through z(0) = 0 and the stage increments Z has at the nodes the slopes DZ, where
/// D = A⁻¹ is the matrix of differentiation, and the method says DZ = hF. With the eigenvalues λ of D and
/// D = V Λ V⁻¹, W = V⁻¹Z obeys λW = h V⁻¹F: one equation of the size of the system for each eigenvalue,
/// of which those of a complex pair are conjugate, so that one of each pair is enough. (Hairer and
/// Wanner, *Solving Ordinary Differential Equations II*, section IV.8.)
#[derive(Debug)]
pub(super) struct Tableau<const W: usize, const B: usize> {
    /// The times of the stages as parts of the step, and after them that of the look between them, which
    /// takes the place that vectors of W have left: where a polynomial through the stages is worst.
    pub(super) c: [f64; W],
    /// Eigenvalues: the real one, then those with positive imaginary part; beyond the last it is 1.
    pub(super) lambda: ([f64; B], [f64; B]),
    /// V⁻¹, for each stage what it adds to the blocks, real and imaginary.
    pub(super) into: [([f64; B], [f64; B]); W],
    /// V, for each block what it adds to the stages by its real and by its imaginary part; and to the
    /// polynomial at the look between them.
    pub(super) back: [([f64; W], [f64; W]); B],
    /// The coefficients of θ, θ² … of z(θ) that the increment of each stage adds.
    pub(super) power: [[f64; W]; W],
    /// The weights of the increments in the error estimate.
    pub(super) error: [f64; W],
    /// The weights of the increments in the slope of the polynomial at the look between the stages.
    pub(super) slope: [f64; W],
}

/// Three stages, order 5.
static THREE: LazyLock<Tableau<4, 4>> = LazyLock::new(|| Tableau::new(3));
/// Seven stages, order 13.
static SEVEN: LazyLock<Tableau<8, 4>> = LazyLock::new(|| Tableau::new(7));

/// The methods of three and of seven stages.
pub(super) fn three() -> &'static Tableau<4, 4> {
    &THREE
}

/// See [`three`].
pub(super) fn seven() -> &'static Tableau<8, 4> {
    &SEVEN
}

impl<const W: usize, const B: usize> Tableau<W, B> {
    fn new(stages: usize) -> Self {
        let c = nodes(stages);
        let d = differentiation(&c);
        let pairs = eigenpairs(&d);
        let all: Vec<_> = pairs
            .iter()
            .flat_map(|(lambda, v)| {
                let conjugate = (lambda.conj(), v.map(|x| x.conj()));
                [Some((*lambda, v.clone())), (lambda.im != 0.0).then_some(conjugate)]
            })
            .flatten()
            .collect();
        let v = DMatrix::from_columns(&all.iter().map(|(_, v)| v.clone()).collect::<Vec<_>>());
        let inverse = v.try_inverse().unwrap_or_else(|| DMatrix::zeros(stages, stages));
        let mut tableau = Self {
            c: [0.0; W],
            lambda: ([1.0; B], [0.0; B]),
            into: [([0.0; B], [0.0; B]); W],
            back: [([0.0; W], [0.0; W]); B],
            power: [[0.0; W]; W],
            error: [0.0; W],
            slope: [0.0; W],
        };
        tableau.c[..stages].copy_from_slice(&c);
        for (b, (lambda, v)) in pairs.iter().enumerate() {
            (tableau.lambda.0[b], tableau.lambda.1[b]) = (lambda.re, lambda.im);
            // In the list with the conjugates, block b > 0 stands at 2b − 1; they double the real part.
            let (row, twice) = if b == 0 { (0, 1.0) } else { (2 * b - 1, 2.0) };
            for j in 0..stages {
                let into = inverse[(row, j)];
                (tableau.into[j].0[b], tableau.into[j].1[b]) = (into.re, into.im);
                (tableau.back[b].0[j], tableau.back[b].1[j]) = (twice * v[j].re, -twice * v[j].im);
            }
        }
        let between = worst(&c);
        tableau.c[stages] = between;
        for j in 0..stages {
            let power = powers(&c, j);
            // Horner's scheme for the value and the slope at once.
            let (value, slope) = power.iter().rev().fold((0.0, 0.0), |(value, slope), a| {
                (value * between + a, slope * between + value)
            });
            let (value, slope) = (value * between, value + slope * between);
            tableau.slope[j] = slope;
            for (re, im) in &mut tableau.back {
                re[stages] += value * re[j];
                im[stages] += value * im[j];
            }
            tableau.power[j][..stages].copy_from_slice(&power);
            let weight = |i: usize| -lagrange_at_zero(&c, i) * d[(i, j)];
            tableau.error[j] = (0..stages).map(weight).sum();
        }
        tableau
    }
}

/// The zeros of the derivative of order S − 1 of x^(S−1) (x − 1)^S, rising to 1, by Newton's method from
/// those of the last number of stages: each lies between two of its neighbours.
fn nodes(stages: usize) -> Vec<f64> {
    let mut found = vec![1.0];
    for s in 2..=stages {
        // Legendre's recursion: P_s − P_(s−1) on [−1, 1] has the zeros and 1.
        let value = |c: f64| {
            let (x, mut p) = (2.0 * c - 1.0, (1.0, 2.0 * c - 1.0));
            for k in 1..s {
                let k = k as f64;
                p = (p.1, ((2.0 * k + 1.0) * x * p.1 - k * p.0) / (k + 1.0));
            }
            p.1 - p.0
        };
        let edges: Vec<f64> = [0.0].into_iter().chain(found.iter().copied()).collect();
        let inner = edges.windows(2).map(|w| bisected(w[0], w[1] * (1.0 - 1e-12), value));
        found = inner.chain([1.0]).collect();
    }
    found
}

/// A zero of `value` between `low` and `high`, to the last digit.
fn bisected(mut low: f64, mut high: f64, value: impl Fn(f64) -> f64) -> f64 {
    let side = value(low) > 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if (value(middle) > 0.0) == side {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// The derivatives at node i of the polynomial that is 0 at 0 and at all nodes but 1 at node j.
fn differentiation(c: &[f64]) -> DMatrix<f64> {
    let x: Vec<f64> = [0.0].into_iter().chain(c.iter().copied()).collect();
    let weight =
        |j: usize| -> f64 { (0..x.len()).filter(|k| *k != j).map(|k| x[j] - x[k]).product() };
    let entry = |i: usize, j: usize| {
        if i == j {
            (0..x.len()).filter(|k| *k != j).map(|k| 1.0 / (x[j] - x[k])).sum()
        } else {
            weight(i) / (weight(j) * (x[i] - x[j]))
        }
    };
    DMatrix::from_fn(c.len(), c.len(), |i, j| entry(i + 1, j + 1))
}

/// Where the polynomial with zeros at 0 and the nodes is largest on the step, to a thousandth.
fn worst(c: &[f64]) -> f64 {
    let size = |theta: f64| c.iter().fold(theta, |product, c| product * (theta - c)).abs();
    let places = (1..1000).map(|i| f64::from(i) / 1000.0);
    places.fold(0.5, |best, theta| if size(theta) > size(best) { theta } else { best })
}

/// The coefficients of θ, θ² … of that polynomial for node j.
fn powers(c: &[f64], j: usize) -> Vec<f64> {
    let mut p = vec![1.0 / c[j]];
    for (k, node) in c.iter().enumerate().filter(|(k, _)| *k != j) {
        let scale = 1.0 / (c[j] - c[k]);
        let mut next = vec![0.0; p.len() + 1];
        for (i, a) in p.iter().enumerate() {
            next[i] -= a * node * scale;
            next[i + 1] += a * scale;
        }
        p = next;
    }
    p
}

/// The polynomial that is 1 at node i and 0 at the others, at 0.
fn lagrange_at_zero(c: &[f64], i: usize) -> f64 {
    (0..c.len()).filter(|k| *k != i).map(|k| -c[k] / (c[i] - c[k])).product()
}

/// Eigenvalues with an imaginary part of 0 or more, rising with it, and their vectors: the values by the
/// library and both sharpened by two steps of inverse iteration.
fn eigenpairs(d: &DMatrix<f64>) -> Vec<(Complex<f64>, DVector<Complex<f64>>)> {
    let n = d.nrows();
    let wide = d.map(|x| Complex::new(x, 0.0));
    let values = d.complex_eigenvalues();
    let largest = values.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let mut kept: Vec<Complex<f64>> =
        values.iter().copied().filter(|v| v.im > -1e-9 * largest).collect();
    kept.sort_by(|a, b| a.im.total_cmp(&b.im));
    let real = kept[0].re;
    kept[0] = Complex::new(real, 0.0);
    kept.into_iter()
        .map(|mut lambda| {
            let mut v = DVector::from_element(n, Complex::new(1.0, 0.0));
            for _ in 0..4 {
                // A little beside the eigenvalue, so that the matrix can be inverted.
                let near = lambda * (1.0 + 1e-10);
                let shifted = &wide - DMatrix::identity(n, n) * near;
                let solved = shifted.lu().solve(&v).unwrap_or_else(|| v.clone());
                v = &solved / Complex::new(solved.norm(), 0.0);
                lambda = v.dotc(&(&wide * &v));
            }
            let im = if lambda.im.abs() < 1e-9 * largest { 0.0 } else { lambda.im };
            (Complex::new(lambda.re, im), v)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nodes_are_those_of_the_book() {
        let root = 6.0_f64.sqrt();
        let book = [(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0];
        for (own, book) in nodes(3).iter().zip(book) {
            assert!((own - book).abs() < 1e-15, "{own}, not {book}");
        }
    }

    #[test]
    fn the_error_weights_of_three_stages_are_those_of_the_book() {
        let root = 6.0_f64.sqrt();
        let book = [-(13.0 + 7.0 * root) / 3.0, (-13.0 + 7.0 * root) / 3.0, -1.0 / 3.0];
        for (own, book) in three().error.iter().zip(book) {
            assert!((own - book).abs() < 1e-13, "{own}, not {book}");
        }
    }

    #[test]
    fn the_method_integrates_powers_to_twice_its_stages_less_two() {
        // The last row of A are the weights; D Z = h F with F = θ^k has Z(1) = 1/(k + 1).
        for stages in [3, 7] {
            let c = nodes(stages);
            let a = differentiation(&c).try_inverse().unwrap();
            for k in 0..2 * stages - 1 {
                let exponent = i32::try_from(k).unwrap();
                let sum: f64 = (0..stages).map(|j| a[(stages - 1, j)] * c[j].powi(exponent)).sum();
                let right = 1.0 / f64::from(exponent + 1);
                assert!((sum - right).abs() < 1e-14, "{stages} stages, power {k}: {sum}");
            }
        }
    }

    fn check<const W: usize, const B: usize>(table: &Tableau<W, B>, stages: usize) {
        let d = differentiation(&nodes(stages));
        for j in 0..stages {
            // Back · λ · into must be D, column by column.
            let mut column = [0.0; W];
            for b in 0..B {
                let (re, im) = (table.into[j].0[b], table.into[j].1[b]);
                let (lr, li) = (table.lambda.0[b], table.lambda.1[b]);
                let w = (lr * re - li * im, lr * im + li * re);
                for (i, column) in column.iter_mut().enumerate() {
                    *column += table.back[b].0[i] * w.0 + table.back[b].1[i] * w.1;
                }
            }
            for (i, column) in column.iter().take(stages).enumerate() {
                let off = (column - d[(i, j)]).abs();
                assert!(off < 1e-11, "{stages} stages, D[{i}, {j}]: off by {off:e}");
            }
        }
    }

    #[test]
    fn the_blocks_are_the_method_in_other_coordinates() {
        check(three(), 3);
        check(seven(), 7);
    }

    #[test]
    fn the_powers_give_the_increments_back_at_the_nodes() {
        for stages in [3, 7] {
            let table = Tableau::<8, 4>::new(stages);
            for j in 0..stages {
                for (i, c) in table.c.iter().take(stages).enumerate() {
                    let horner = table.power[j].iter().rev().fold(0.0, |sum, a| sum * c + a) * c;
                    let right = f64::from(u8::from(i == j));
                    assert!((horner - right).abs() < 1e-11, "{stages} stages: {horner} at {i}");
                }
            }
        }
    }

    #[test]
    fn the_error_estimate_vanishes_up_to_the_order_of_the_stages() {
        for stages in [3, 7] {
            let table = Tableau::<8, 4>::new(stages);
            for k in 1..=stages + 1 {
                // y = θ^k: γ f(0)/γ + Σ e z must vanish for k ≤ S and not for S + 1.
                let start = if k == 1 { 1.0 } else { 0.0 };
                let exponent = i32::try_from(k).unwrap();
                let z = table.c.iter().zip(&table.error).map(|(c, e)| e * c.powi(exponent));
                let sum: f64 = start + z.sum::<f64>();
                assert_eq!(sum.abs() < 1e-11, k <= stages, "{stages} stages, power {k}: {sum:e}");
            }
        }
    }
}
