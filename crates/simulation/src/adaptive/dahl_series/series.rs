//! The power series of the motion between two reversals.

use duhem::{Dahl, Harmonic, Plant};
use integrate::collocation::fma;

/// Most coefficients of a series.
pub(super) const TERMS: usize = 32;

/// Points read off at once, side by side.
pub(super) const LANES: usize = 8;

/// Where the motion is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    /// Time [s].
    pub t: f64,
    /// Displacement [m].
    pub q: f64,
    /// Velocity [m/s].
    pub v: f64,
    /// What is left of the way to F_C: w = 1 − sF/F_C.
    pub w: f64,
    /// Direction s of the motion.
    pub s: f64,
}

/// The plant with its friction and its drive.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Equations {
    pub dahl: Dahl,
    pub plant: Plant,
    pub drive: Harmonic,
}

impl Equations {
    /// The friction F [N].
    pub(super) fn friction(&self, at: &State) -> f64 {
        at.s * self.dahl.f_c * (1.0 - at.w)
    }

    /// The first three derivatives of the drive, from the zeroth: w(t) [N], ẇ, ẅ.
    pub(super) fn drive(&self, t: f64) -> [f64; 3] {
        let Harmonic { amplitude, omega, phase, constant } = self.drive;
        let (gain, (sin, cos)) = (self.plant.gain * amplitude, (omega * t + phase).sin_cos());
        let force = self.plant.drive(constant) + gain * sin;
        [force, gain * omega * cos, -gain * omega * omega * sin]
    }
}

/// Coefficients of q, v and w in powers of τ = (t − t₀)/h.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    pub order: usize,
    /// The unit of τ [s].
    pub h: f64,
    /// Where the series begins.
    pub from: State,
    pub q: [f64; TERMS],
    pub v: [f64; TERMS],
    pub w: [f64; TERMS],
    /// (γ − 2) i ℓᵢ and (1 − γ) ℓᵢ at i − 1, ℓ the travel in units of F_C/σ w₀^(1−γ).
    a: [f64; TERMS],
    b: [f64; TERMS],
}

impl Series {
    pub(super) fn new(order: usize, h: f64, from: State) -> Self {
        let zero = [0.0; TERMS];
        Self { order, h, from, q: zero, v: zero, w: zero, a: zero, b: zero }
    }

    /// Expands the motion from a state. If it `slides`, F stays what it is.
    ///
    /// Dahl's w is (1 + (γ − 1)ℓ)^(−1/(γ − 1)) w₀ and e^(−ℓ) w₀ for γ = 1, both of which have
    /// wₙ = −Σ (i + (γ − 1)(n − i))/n ℓᵢ wₙ₋ᵢ.
    pub(super) fn expand(&mut self, equations: &Equations, from: State, slides: bool) {
        self.from = from;
        let Equations { dahl, plant, drive } = equations;
        let h = self.h;
        let force = equations.drive(from.t);
        let (by_mass, turn) = (h / plant.mass, -(drive.omega * h).powi(2));
        let mut sine = [force[0] - plant.drive(drive.constant), force[1] * h];
        let of_w = from.s * dahl.f_c;
        let gamma = dahl.gamma;
        let steep = if gamma == 1.0 { 1.0 } else { from.w.powf(gamma - 1.0) };
        let travel = from.s * dahl.sigma / dahl.f_c * steep * h;
        let (by_n, whole) = ((gamma - 2.0) * travel, (1.0 - gamma) * travel);
        (self.q[0], self.v[0], self.w[0]) = (from.q, from.v, from.w);
        let mut rest = plant.drive(drive.constant) - of_w;
        // The newest coefficients are kept at hand: the next ones wait for them.
        let (mut q, mut v, mut w) = (from.q, from.v, from.w);
        for n in 1..=self.order {
            let part = RECIPROCAL[n];
            let others = fma(-plant.stiffness, q, rest + sine[0]);
            rest = 0.0;
            sine = [sine[1], sine[0] * turn * part * RECIPROCAL[n + 1]];
            let a = by_n * v;
            self.a[n - 1] = a;
            let balance = fma(of_w, w, others);
            if slides {
                w = 0.0;
            } else {
                let sum = convolve(&self.a[..n], &self.w[..n], [a, w]);
                w = part * sum;
                if gamma != 1.0 {
                    let b = whole * part * v;
                    self.b[n - 1] = b;
                    w += convolve(&self.b[..n], &self.w[..n], [b, self.w[n - 1]]);
                }
                self.w[n] = w;
            }
            q = h * part * v;
            v = balance * (by_mass * part);
            (self.q[n], self.v[n]) = (q, v);
        }
        if slides {
            self.w[1..].fill(0.0);
        }
    }

    /// The polynomial of v and its derivative in τ at these places.
    pub(super) fn velocity<const N: usize>(&self, tau: &[f64; N]) -> [[f64; N]; 2] {
        let (mut p, mut d) = ([0.0; N], [0.0; N]);
        for v in self.v[..=self.order].iter().rev() {
            for lane in 0..N {
                d[lane] = fma(d[lane], tau[lane], p[lane]);
                p[lane] = fma(p[lane], tau[lane], *v);
            }
        }
        [p, d]
    }

    /// q, v and w at these places.
    pub(super) fn states(&self, tau: &[f64; LANES]) -> [[f64; LANES]; 3] {
        [&self.q, &self.v, &self.w].map(|c| polynomial(&c[..=self.order], tau))
    }

    /// The state at τ, reached in the same direction.
    pub(super) fn at(&self, tau: f64) -> State {
        let mut y = [0.0; 3];
        for n in (0..=self.order).rev() {
            let c = [self.q[n], self.v[n], self.w[n]];
            for (y, c) in y.iter_mut().zip(c) {
                *y = fma(*y, tau, c);
            }
        }
        State { t: self.from.t + tau * self.h, q: y[0], v: y[1], w: y[2], s: self.from.s }
    }
}

/// The polynomial of these coefficients at these places.
fn polynomial<const N: usize>(c: &[f64], tau: &[f64; N]) -> [f64; N] {
    let mut sum = [0.0; N];
    for c in c.iter().rev() {
        for lane in 0..N {
            sum[lane] = fma(sum[lane], tau[lane], *c);
        }
    }
    sum
}

/// 1/n.
const RECIPROCAL: [f64; TERMS + 2] = {
    let (mut list, mut n) = ([0.0; TERMS + 2], 1);
    while n < TERMS + 2 {
        list[n] = 1.0 / n as f64;
        n += 1;
    }
    list
};

/// Σ aᵢwₙ₋ᵢ over `a` = a₁ … aₙ and `w` = w₀ … wₙ₋₁, the `newest` of both last.
fn convolve(a: &[f64], w: &[f64], newest: [f64; 2]) -> f64 {
    let n = a.len().min(w.len());
    if n < 2 {
        return newest[0] * w[0];
    }
    let (older_a, older_w) = (&a[1..n - 1], &w[1..n - 1]);
    let (fours_a, fours_w) = (older_a.chunks_exact(4), older_w.rchunks_exact(4));
    let rest = fours_a.remainder().iter().zip(fours_w.remainder().iter().rev());
    let mut sums = [0.0; 4];
    for (sum, (a, w)) in sums.iter_mut().zip(rest) {
        *sum = a * w;
    }
    for (a, w) in fours_a.zip(fours_w) {
        for i in 0..4 {
            sums[i] = fma(a[i], w[3 - i], sums[i]);
        }
    }
    let older = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    fma(newest[0], w[0], fma(a[0], newest[1], older))
}
