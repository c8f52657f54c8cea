//! Where a step meets the kink: it is taken again until it ends there.

use super::{
    Kinked,
    march::{March, ON_KINK, Trial, Verdict},
    step::{Blocks, Solved, horner, powers, slope_at_end},
};
use crate::Failure;

/// Steps tried for one crossing.
const TRIES: u32 = 6;
/// How much closer than usual the stages are solved for: the crossing is a root of the computed end.
const CLOSE: f64 = 1e-2;
/// The part of the zone's width at which a step lands that would pass through it, and the largest at
/// which a step is taken to be in it already.
const LANDING: f64 = 0.8;
const OUTSIDE: f64 = 1.2;

impl<T: Kinked<N>, const N: usize, const S: usize, const W: usize, const B: usize>
    March<'_, T, N, S, W, B>
{
    /// Shortens a step that heads for the zone from outside so that it lands at its border.
    pub(super) fn approach(&mut self) {
        let Some(kink) = self.system.kink().filter(|kink| kink.zone > 0.0) else { return };
        let (v, slope) = (self.side * self.y[kink.state], self.side * self.y_dot[kink.state]);
        if v > OUTSIDE * kink.zone && slope < 0.0 && v + slope * self.h < LANDING * kink.zone {
            self.h = (v - LANDING * kink.zone) / -slope;
        }
    }

    /// Whether a step passes through the zone or the kink, and what then.
    pub(super) fn meet_kink(&mut self, trial: &Trial<N, W>) -> Result<Verdict<N, W>, Failure> {
        let Some(kink) = self.system.kink() else { return Ok(Verdict::Clear) };
        let (j, h) = (kink.state, trial.h);
        let from = self.side * self.y[j];
        let at = |s: usize| self.side * (self.y[j] + trial.solved.z[j][s]);
        if kink.zone > 0.0 && from > OUTSIDE * kink.zone && at(S - 1) < 0.5 * LANDING * kink.zone {
            let part = self.falls_to(&trial.solved, j, LANDING * kink.zone);
            if part < 0.9 {
                return Ok(Verdict::Again(part * h));
            }
        }
        let past = -ON_KINK * self.atol[j];
        let Some(first) = (0..S).find(|s| at(*s) < past) else { return Ok(Verdict::Clear) };
        if from <= -past {
            // It starts on the kink and goes to the other side: that is its side.
            if !self.turned {
                self.turned = true;
                self.side = -self.side;
                self.system.take_side(self.side);
                self.differentiate()?;
                return Ok(Verdict::Again(h));
            }
            if at(0) < 0.0 {
                return Ok(Verdict::Again(0.5 * h));
            }
        }
        if at(S - 1) >= past {
            return Ok(Verdict::Again(0.5 * self.tableau.c[first] * h));
        }
        self.end_on_kink(trial, j)
    }

    /// The part of a step after which the state `j` has fallen to `level`, on its polynomial.
    fn falls_to(&self, solved: &Solved<N, W>, j: usize, level: f64) -> f64 {
        let powers = powers::<N, S, W, B>(self.tableau, &solved.z);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if self.side * (self.y[j] + horner::<S, W>(&powers[j], middle)) > level {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// The step taken again until the state `j` is zero at its end: first to where the polynomial says,
    /// then by Newton's method on the length.
    fn end_on_kink(&mut self, trial: &Trial<N, W>, j: usize) -> Result<Verdict<N, W>, Failure> {
        let mut solved = trial.solved.clone();
        let (mut before, mut h) = (trial.h, trial.h * self.falls_to(&solved, j, 0.0));
        for tried in 1..=TRIES {
            let there = powers::<N, S, W, B>(self.tableau, &solved.z);
            let ratio = h / before;
            let z = std::array::from_fn(|i| {
                self.tableau.c.map(|c| horner::<S, W>(&there[i], ratio * c))
            });
            let enough = CLOSE * self.enough;
            let u = self.system.forcing(h, &self.tableau.c);
            let blocks = Blocks::<T::Matrix<B>, B>::new(self.tableau, h, &trial.jacobian);
            solved = self.stages((u, &blocks, &trial.weights), z, enough)?;
            if !solved.converged {
                return Ok(Verdict::Again(0.5 * trial.h));
            }
            let left = self.y[j] + solved.z[j][S - 1];
            let here = powers::<N, S, W, B>(self.tableau, &solved.z);
            let slope = slope_at_end::<S, W>(&here[j]) / h;
            let change = -left / slope;
            let done = left.abs() < ON_KINK * self.atol[j] || tried == TRIES;
            if done || change.is_nan() || change.abs() >= 0.5 * h {
                break;
            }
            (before, h) = (h, h + change);
        }
        let Trial { jacobian, weights, .. } = *trial;
        Ok(Verdict::Ends(Box::new(Trial { h, jacobian, weights, solved, at_kink: true })))
    }
}
