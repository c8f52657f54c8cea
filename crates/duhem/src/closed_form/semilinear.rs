//! The rate-independent semilinear Duhem model and its settled loop: equations 6, 7, 9, 10 (p. 92).

use crate::{
    Dahl,
    elementary::polynomial,
    form::{negative_part, positive_part},
};
use nalgebra::{DMatrix, DVector};

/// The affine right-hand side Ax + Bu + E of one direction, in slices; A row by row.
#[derive(Debug, Clone, Copy)]
pub struct Branch<'a> {
    /// A, n × n [1/m].
    pub a: &'a [f64],
    /// B, n.
    pub b: &'a [f64],
    /// E, n.
    pub e: &'a [f64],
}

/// A rate-independent semilinear Duhem model with n states.
#[derive(Debug, Clone, PartialEq)]
pub struct Semilinear {
    plus: Affine,
    minus: Affine,
    c: DVector<f64>,
    d: f64,
}

#[derive(Debug, Clone, PartialEq)]
struct Affine {
    a: DMatrix<f64>,
    b: DVector<f64>,
    e: DVector<f64>,
}

/// Why there is no settled loop.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SemilinearError {
    /// Sizes that do not fit n, the length of C, or entries that are not finite.
    #[error("{name} has {found} finite entries: expected {expected}")]
    Size {
        /// Which matrix or vector.
        name: &'static str,
        /// Its finite entries.
        found: usize,
        /// How many there have to be.
        expected: usize,
    },
    /// The convergence condition fails.
    #[error("spectral radius {rho}: expected one below 1, condition 9, for the loop to settle")]
    NotContracting {
        /// ρ(e^(βA₊) e^(−βA₋)).
        rho: f64,
    },
}

impl Affine {
    fn new(n: usize, branch: Branch<'_>) -> Result<Self, SemilinearError> {
        for (name, list, expected) in
            [("a", branch.a, n * n), ("b", branch.b, n), ("e", branch.e, n)]
        {
            let found = list.iter().filter(|v| v.is_finite()).count();
            if found != expected || list.len() != expected {
                return Err(SemilinearError::Size { name, found, expected });
            }
        }
        Ok(Self {
            a: DMatrix::from_row_slice(n, n, branch.a),
            b: DVector::from_column_slice(branch.b),
            e: DVector::from_column_slice(branch.e),
        })
    }

    fn at(&self, x: &DVector<f64>, u: f64) -> DVector<f64> {
        &self.a * x + &self.b * u + &self.e
    }

    /// e^(A·`way`).
    fn exp(&self, way: f64) -> DMatrix<f64> {
        (&self.a * way).exp()
    }

    /// Z(u, u₀) of equation 10. It is −∫ e^(A(u−s)) (Bs + E) ds from u₀ to u, which exists also where A
    /// is singular and the print's A⁻¹ does not: one exponential of A bordered by B and E.
    fn z(&self, u: f64, u0: f64) -> DVector<f64> {
        let n = self.b.len();
        let mut bordered = DMatrix::zeros(n + 2, n + 2);
        bordered.view_mut((0, 0), (n, n)).copy_from(&self.a);
        bordered.view_mut((0, n), (n, 1)).copy_from(&self.b);
        bordered.view_mut((0, n + 1), (n, 1)).copy_from(&self.e);
        bordered[(n, n + 1)] = 1.0;
        let flow = (bordered * (u - u0)).exp();
        -(flow.column(n).rows(0, n) * u0 + flow.column(n + 1).rows(0, n))
    }
}

impl Semilinear {
    /// The model going up and going down, with the output C and D; n is the length of `c`.
    pub fn new(
        plus: Branch<'_>,
        minus: Branch<'_>,
        c: &[f64],
        d: f64,
    ) -> Result<Self, SemilinearError> {
        let n = c.len();
        let (plus, minus) = (Affine::new(n, plus)?, Affine::new(n, minus)?);
        Ok(Self { plus, minus, c: DVector::from_column_slice(c), d })
    }

    /// The Dahl model with γ = 1, whatever γ is in `dahl`: A± = ∓σ/F_C, E± = σ (p. 93).
    pub fn of_dahl(dahl: &Dahl) -> Result<Self, SemilinearError> {
        let rate = dahl.sigma / dahl.f_c;
        let plus = Branch { a: &[-rate], b: &[0.0], e: &[dahl.sigma] };
        Self::new(plus, Branch { a: &[rate], ..plus }, &[1.0], 0.0)
    }

    /// ẋ = u̇₊(A₊x + B₊u + E₊) + u̇₋(A₋x + B₋u + E₋)   (6)
    pub fn x_dot(&self, x: &[f64], u: f64, u_dot: f64) -> Vec<f64> {
        let x = DVector::from_column_slice(x);
        let up = self.plus.at(&x, u) * positive_part(u_dot);
        let down = self.minus.at(&x, u) * negative_part(u_dot);
        (up + down).as_slice().to_vec()
    }

    /// y = Cx + Du   (7)
    pub fn y(&self, x: &[f64], u: f64) -> f64 {
        self.c.dot(&DVector::from_column_slice(x)) + self.d * u
    }

    /// The left side of the convergence condition for a loop of the width `beta` [m].
    ///
    /// ρ(e^(βA₊) e^(−βA₋)) < 1   (9)
    pub fn spectral_radius(&self, beta: f64) -> f64 {
        let cycle = self.plus.exp(beta) * self.minus.exp(-beta);
        cycle.complex_eigenvalues().iter().fold(0.0_f64, |rho, value| {
            let size = value.re.hypot(value.im);
            if size.is_nan() { size } else { rho.max(size) }
        })
    }
}

/// Within a cell ‖A Δu‖ ≤ ½, so that its power series is right to the last digit after so many terms.
const TERMS: usize = 16;

impl Semilinear {
    /// How many states.
    pub fn states(&self) -> usize {
        self.c.len()
    }

    /// How many cells the way from one displacement to the other [m] takes, at least one.
    pub fn cells(&self, (from, to): (f64, f64)) -> f64 {
        let rows = self.branch(from, to).a.row_iter();
        let norm = rows.map(|row| row.iter().map(|a| a.abs()).sum()).fold(0.0, f64::max);
        (2.0 * norm * (to - from).abs()).ceil().max(1.0)
    }

    /// Takes the state `x` along the monotone way from one displacement to the other [m], and writes the
    /// states at the displacements `u` [m] on the way into `states`, row by row.
    ///
    /// It is e^(A(u−u₀))x − Z(u, u₀) of equation 10 in powers of u − u₀, cell after cell, which needs
    /// neither A⁻¹ nor an exponential for every u.
    pub fn follow(&self, x: &mut [f64], way: (f64, f64), u: &[f64], states: &mut [f64]) {
        let (branch, n, cells) = (self.branch(way.0, way.1), x.len(), self.cells(way));
        let h = (way.1 - way.0) / cells;
        let (mut series, mut cell, mut first) = (vec![[0.0; TERMS + 1]; n], 0.0, 0);
        while cell < cells {
            let (start, end) = (way.0 + cell * h, way.0 + (cell + 1.0) * h);
            branch.series(x, start, &mut series);
            cell += 1.0;
            let inside = |u: &f64| cell == cells || (u - end) * h < 0.0;
            let later = first + u[first..].partition_point(inside);
            let rows = &mut states[n * first..n * later];
            for (i, series) in series.iter().enumerate() {
                for (x, u) in rows.iter_mut().skip(i).step_by(n).zip(&u[first..later]) {
                    *x = polynomial(series, u - start);
                }
                x[i] = polynomial(series, h);
            }
            first = later;
        }
    }

    fn branch(&self, from: f64, to: f64) -> &Affine {
        if to >= from { &self.plus } else { &self.minus }
    }
}

impl Affine {
    /// Writes the powers of u − `u0` that the state is from `x` at `u0`: each term A times the one before
    /// over its order, the first two also with Bu + E.
    fn series(&self, x: &[f64], u0: f64, series: &mut [[f64; TERMS + 1]]) {
        for (series, x) in series.iter_mut().zip(x) {
            series[0] = *x;
        }
        for k in 0..TERMS {
            for i in 0..x.len() {
                let forced = match k {
                    0 => self.b[i] * u0 + self.e[i],
                    1 => self.b[i],
                    _ => 0.0,
                };
                let linear = series.iter().enumerate().map(|(j, x)| self.a[(i, j)] * x[k]);
                series[i][k + 1] = (linear.sum::<f64>() + forced) / (k + 1) as f64;
            }
        }
    }
}

/// The settled loop of Theorem 1, from every initial state the same.
#[derive(Debug, Clone, PartialEq)]
pub struct Loop {
    model: Semilinear,
    /// Left turning point [m].
    pub u_min: f64,
    /// Right turning point [m].
    pub u_max: f64,
    /// x̂₊, the state at u_min.
    x_plus: DVector<f64>,
    /// x̂₋, the state at u_max.
    x_minus: DVector<f64>,
}

impl Loop {
    /// The loop between these extremes [m], if the condition of equation 9 holds.
    ///
    /// x̂₊ = −(I − e^(−βA₋) e^(βA₊))⁻¹ (e^(−βA₋) Z₊(u_max, u_min) + Z₋(u_min, u_max)), and x̂₋ with the
    /// two directions exchanged, of equation 10.
    pub fn new(model: &Semilinear, (u_min, u_max): (f64, f64)) -> Result<Self, SemilinearError> {
        let beta = u_max - u_min;
        let rho = model.spectral_radius(beta);
        let up = (model.plus.exp(beta), model.plus.z(u_max, u_min));
        let down = (model.minus.exp(-beta), model.minus.z(u_min, u_max));
        match (fixed_point(&up, &down), fixed_point(&down, &up)) {
            (Some(x_plus), Some(x_minus)) if rho < 1.0 => {
                Ok(Self { model: model.clone(), u_min, u_max, x_plus, x_minus })
            }
            _ => Err(SemilinearError::NotContracting { rho }),
        }
    }

    /// y₊(u) = C e^(A₊(u−u_min)) x̂₊ − C Z₊(u, u_min) + Du, y₋ likewise from u_max   (10)
    pub fn y(&self, u: f64, rising: bool) -> f64 {
        let (branch, x, u0) = if rising {
            (&self.model.plus, &self.x_plus, self.u_min)
        } else {
            (&self.model.minus, &self.x_minus, self.u_max)
        };
        let c = &self.model.c;
        c.dot(&(branch.exp(u - u0) * x)) - c.dot(&branch.z(u, u0)) + self.model.d * u
    }
}

/// The state that `first` and then `second` lead back to, each an e^(±βA) and a Z.
fn fixed_point(
    first: &(DMatrix<f64>, DVector<f64>),
    second: &(DMatrix<f64>, DVector<f64>),
) -> Option<DVector<f64>> {
    let n = first.1.len();
    let rest = DMatrix::identity(n, n) - &second.0 * &first.0;
    rest.lu().solve(&-(&second.0 * &first.1 + &second.1))
}
