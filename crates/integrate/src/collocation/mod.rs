//! Our own fast method for small stiff systems with kinks: Radau IIA of order 5 or 13, compiled for its
//! system, all stages of a step side by side.
//!
//! It is [`crate::radau()`]'s method and none of its code, so that each can check the other. What makes it
//! fast is that the right-hand sides of all stages are evaluated at once, that the linear equations of
//! a step decouple into small complex ones solved side by side, and that Newton's matrix is taken in
//! the middle of the step as extrapolated, not at its start: with friction the speed changes severalfold in
//! a step, and the iteration converges while it is within a factor of the matrix's.
//!
//! What makes it safe at loose tolerance is what it asks of the system: where the kink is, within which
//! distance of it the equations change most ([`Kink::zone`]), and how fast its fastest instability grows
//! ([`Kinked::growth`]). A step that passes through the zone or ends where something has grown by much
//! more than e is taken again: a slip that a step would leap over is a fast growth first.

mod kink;
mod lanes;
mod march;
mod newton;
mod step;
mod tableau;

pub use lanes::{Complex, exp, fma};
pub use march::collocate;
pub use newton::{General, Moving, Newton};

use crate::{Limits, Outcome, Work};

/// A system y' = f(u(t), y) of N equations, whose only dependence on the time is through a forcing u. It has
/// at most one kink: where a state changes its sign.
pub trait Kinked<const N: usize> {
    /// How the equations of a step are solved: [`General`], or what knows the Jacobian matrix better.
    type Matrix<const B: usize>: Newton<N, B>;

    /// Takes `t` as the time from which [`Self::forcing`] counts.
    fn start_at(&mut self, t: f64);

    /// The forcing at the parts `c` of the time `h` after the start.
    fn forcing<const W: usize>(&self, h: f64, c: &[f64; W]) -> [f64; W];

    /// f for the forcings `u`, on the side of the kink last taken, continued smoothly beyond it: in the
    /// row of each state its derivatives side by side.
    fn derivatives<const W: usize>(&self, u: &[f64; W], y: &[[f64; W]; N]) -> [[f64; W]; N];

    /// ∂fᵢ/∂yⱼ in row i and column j, on that side.
    fn jacobian(&self, y: &[f64; N]) -> [[f64; N]; N];

    /// The kink; without one the system is smooth.
    fn kink(&self) -> Option<Kink> {
        None
    }

    /// Goes to the side of the kink where its state has this sign, 1 or −1.
    fn take_side(&mut self, _side: f64) {}

    /// Whether a state can be one of a solution. A step that ends in one that cannot is taken again, shorter,
    /// and a run in which no step is short enough fails.
    fn admits(&self, _y: &[f64; N]) -> bool {
        true
    }

    /// The rate [1/s] at which the fastest instability grows at the end of a step between these states; 0
    /// if there is none.
    fn growth(&self, _start: &[f64; N], _end: &[f64; N]) -> f64 {
        0.0
    }
}

/// Where a system has a kink: at the zeros of one state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kink {
    /// Which state.
    pub state: usize,
    /// Below this value of it the equations change most; 0 if they change everywhere alike.
    pub zone: f64,
}

/// How many stages the method has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stages {
    /// Three, order 5: cheapest down to an error of some 1e-4.
    Three,
    /// Seven, order 13.
    Seven,
}

/// How closely to solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closeness<const N: usize> {
    /// Relative tolerance of the estimated error of a step, which is of an order one above the number of
    /// stages, while the step itself is of twice that number less one.
    pub rtol: f64,
    /// Absolute tolerance of each state, in its unit.
    pub atol: [f64; N],
    /// How many stages.
    pub stages: Stages,
    /// Where to stop.
    pub limits: Limits,
}

/// An accepted step: its polynomial, of S powers.
#[derive(Debug, Clone)]
pub struct Piece<const N: usize, const S: usize> {
    /// When it starts.
    pub t: f64,
    /// When it ends.
    pub end: f64,
    /// The state at its start.
    pub y: [f64; N],
    /// The state at its end.
    pub y_end: [f64; N],
    /// Whether it ends on the kink.
    pub at_kink: bool,
    h: f64,
    powers: [[f64; S]; N],
}

impl<const N: usize, const S: usize> Piece<N, S> {
    /// The state at the time `t`.
    #[inline]
    pub fn at(&self, t: f64) -> [f64; N] {
        let part = (t - self.t) / self.h;
        std::array::from_fn(|i| self.y[i] + step::horner::<S, S>(&self.powers[i], part))
    }
}

/// Who is shown the accepted steps.
pub trait Observer<const N: usize> {
    /// Sees a step, before the next is tried.
    fn see<const S: usize>(&mut self, piece: &Piece<N, S>);
}

/// What a run took and how it ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Collocation {
    /// What it took; the stages of a step that are evaluated at once count one by one.
    pub work: Work,
    /// Times it ended a step on the kink.
    pub kinks: u64,
    /// How it ended.
    pub outcome: Outcome,
}
