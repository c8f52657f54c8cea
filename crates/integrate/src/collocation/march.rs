//! Step after step to the end: which step is accepted and how long the next one is.

#![expect(clippy::inline_always, reason = "what a step hands on stays in registers")]

use super::{
    Closeness, Collocation, Kinked, Observer, Piece, Stages,
    lanes::rough_power,
    step::{Blocks, Equations, Increments, Solved, horner, powers, slope_at_end},
    tableau::{self, Tableau},
};
use crate::{Failure, Outcome, Work};

/// A step grows by no more than this and shrinks by no more than the other.
const GROWTH: f64 = 8.0;
const SHRINKAGE: f64 = 0.2;
const SAFETY: f64 = 0.9;
/// By no more than e to this may an instability grow in a step that ends where it grows that fast.
pub(super) const GROWN: f64 = 1.5;
/// The factor per iteration by which Newton's updates are to shrink: a step is not made so long that they
/// would shrink less.
const CONVERGENCE: f64 = 0.3;
/// The part of the time to a blow-up or a standstill, as foreseen, that a step may take.
const BLOW_UP: f64 = 0.7;
/// How close to the kink counts as on it, and beyond it as past it, in units of the absolute tolerance.
pub(super) const ON_KINK: f64 = 1e-3;

/// Solves y' = f(u(t), y) from `span.0` to `span.1`, which is later, and shows `observer` every accepted
/// step. Where the state of the kink changes its sign a step ends, and the next one is on the other side.
///
/// Whatever goes wrong is the outcome; the steps up to there have been shown.
pub fn collocate<T: Kinked<N>, const N: usize>(
    system: &mut T,
    span: (f64, f64),
    y0: [f64; N],
    closeness: &Closeness<N>,
    observer: &mut impl Observer<N>,
) -> Collocation {
    match closeness.stages {
        Stages::Three => {
            run::<T, N, 3, 4, 4>(system, tableau::three(), (span, y0), closeness, observer)
        }
        Stages::Seven => {
            run::<T, N, 7, 8, 4>(system, tableau::seven(), (span, y0), closeness, observer)
        }
    }
}

fn run<T: Kinked<N>, const N: usize, const S: usize, const W: usize, const B: usize>(
    system: &mut T,
    tableau: &'static Tableau<W, B>,
    ((start, end), y): ((f64, f64), [f64; N]),
    closeness: &Closeness<N>,
    observer: &mut impl Observer<N>,
) -> Collocation {
    let tolerance = closeness.rtol;
    let mut march = March::<T, N, S, W, B> {
        system,
        tableau,
        rtol: tolerance,
        atol: closeness.atol,
        enough: (10.0 * f64::EPSILON / tolerance).max(tolerance.sqrt().min(0.1)),
        work: Work { rejected: Some(0), ..Work::default() },
        evaluations_left: closeness.limits.evaluations,
        t: start,
        y,
        y_dot: [0.0; N],
        h: 0.0,
        side: 1.0,
        last: None,
        control: None,
        rejected: false,
        turned: false,
        kinks: 0,
    };
    let outcome = match march.go(end, observer) {
        Ok(()) => Outcome::Solved,
        Err(why) => Outcome::Failed { at: march.t, why },
    };
    Collocation { work: march.work, kinks: march.kinks, outcome }
}

/// The run so far.
pub(super) struct March<'a, T, const N: usize, const S: usize, const W: usize, const B: usize> {
    pub(super) system: &'a mut T,
    pub(super) tableau: &'static Tableau<W, B>,
    rtol: f64,
    pub(super) atol: [f64; N],
    pub(super) enough: f64,
    work: Work,
    evaluations_left: u64,
    pub(super) t: f64,
    pub(super) y: [f64; N],
    pub(super) y_dot: [f64; N],
    pub(super) h: f64,
    pub(super) side: f64,
    /// The last step if none has restarted since: its length, its powers and its increment.
    last: Option<(f64, Increments<N, W>, [f64; N])>,
    /// Length and error of the last accepted step; none after a restart.
    control: Option<(f64, f64)>,
    rejected: bool,
    /// Whether the side was changed since the last accepted step.
    pub(super) turned: bool,
    kinks: u64,
}

/// A step as solved, before it is accepted.
pub(super) struct Trial<const N: usize, const W: usize> {
    pub(super) h: f64,
    pub(super) jacobian: [[f64; N]; N],
    pub(super) weights: [f64; N],
    pub(super) solved: Solved<N, W>,
    pub(super) at_kink: bool,
}

/// What the kink makes of a step.
pub(super) enum Verdict<const N: usize, const W: usize> {
    /// It does not meet it.
    Clear,
    /// It is to be tried again with this length.
    Again(f64),
    /// It is replaced by one that ends on it.
    Ends(Box<Trial<N, W>>),
}

impl<T: Kinked<N>, const N: usize, const S: usize, const W: usize, const B: usize>
    March<'_, T, N, S, W, B>
{
    fn go(&mut self, end: f64, observer: &mut impl Observer<N>) -> Result<(), Failure> {
        self.begin(end)?;
        while self.t < end {
            self.approach();
            let left = end - self.t;
            // What the clock does not resolve would be left for a step of its own.
            let clock = 8.0 * f64::EPSILON * end.abs().max(self.t.abs());
            let arrives = self.h >= left * (1.0 - 1e-12) - clock;
            self.h = if arrives { left } else { (self.t + self.h) - self.t };
            if self.h <= 4.0 * f64::EPSILON * self.t.abs() || self.h <= f64::MIN_POSITIVE {
                let finite = self.y_dot.iter().all(|y_dot| y_dot.is_finite());
                return Err(if finite { Failure::StepTooSmall } else { Failure::NotFinite });
            }
            let Some((trial, next)) = self.attempt()? else {
                self.rejected = true;
                *self.work.rejected.get_or_insert(0) += 1;
                continue;
            };
            let arrives = arrives && trial.h == self.h;
            self.accept(trial, if arrives { Some(end) } else { None }, observer)?;
            self.h = next;
        }
        Ok(())
    }

    /// The first side, derivative and step: a hundredth of the time in which the state changes by its size.
    fn begin(&mut self, end: f64) -> Result<(), Failure> {
        self.system.start_at(self.t);
        if let Some(kink) = self.system.kink() {
            self.side = if self.y[kink.state] < 0.0 { -1.0 } else { 1.0 };
            self.system.take_side(self.side);
        }
        self.differentiate()?;
        let span = end - self.t;
        let weights = self.weights(&self.y);
        let square = |i: usize| (self.y_dot[i] * weights[i] * self.rtol).powi(2);
        let rate = (0..N).map(square).sum::<f64>().sqrt();
        self.h = if rate * span > 1e4 { 0.01 / rate } else { 1e-6 * span };
        Ok(())
    }

    pub(super) fn spend(&mut self, evaluations: u64) -> Result<(), Failure> {
        self.work.evaluations += evaluations;
        let left = self.evaluations_left.checked_sub(evaluations);
        self.evaluations_left = left.ok_or(Failure::TooManyEvaluations)?;
        Ok(())
    }

    /// f at the state where the run is.
    pub(super) fn differentiate(&mut self) -> Result<(), Failure> {
        self.spend(1)?;
        let u = self.system.forcing(0.0, &[0.0]);
        self.y_dot = self.system.derivatives(&u, &self.y.map(|y| [y])).map(|[y_dot]| y_dot);
        let finite = self.y_dot.iter().all(|y_dot| y_dot.is_finite());
        if finite { Ok(()) } else { Err(Failure::NotFinite) }
    }

    /// One over the tolerance of each state, around its larger value at `y` and at the start.
    #[inline(always)]
    fn weights(&self, y: &[f64; N]) -> [f64; N] {
        let size = |i: usize| self.y[i].abs().max(y[i].abs());
        std::array::from_fn(|i| 1.0 / (self.atol[i] + self.rtol * size(i)))
    }

    /// The state at the part 1 + θ of the last step, less that at its end; none after a restart.
    fn beyond(&self, theta: f64) -> Option<[f64; N]> {
        let (_, powers, whole) = self.last.as_ref()?;
        Some(std::array::from_fn(|i| horner::<S, W>(&powers[i], 1.0 + theta) - whole[i]))
    }

    /// A guess of the stages on the polynomial of the last step, and the state in the middle of it.
    #[inline(always)]
    fn guess(&self) -> (Increments<N, W>, [f64; N]) {
        let mut z = [[0.0; W]; N];
        let Some((h, powers, whole)) = &self.last else { return (z, self.y) };
        let ratio = self.h / h;
        for i in 0..N {
            for (z, c) in z[i].iter_mut().zip(&self.tableau.c) {
                *z = horner::<S, W>(&powers[i], 1.0 + ratio * c) - whole[i];
            }
        }
        let mut middle = self.y;
        if let Some(change) = self.beyond(0.5 * ratio) {
            middle = std::array::from_fn(|i| self.y[i] + change[i]);
        }
        if let Some(kink) = self.system.kink()
            && self.side * middle[kink.state] < 0.0
        {
            middle[kink.state] = 0.0;
        }
        (z, middle)
    }

    /// Tries a step. None if it is to be tried again with the length then set; else the step and the length
    /// of the next.
    #[inline(always)]
    fn attempt(&mut self) -> Result<Option<(Trial<N, W>, f64)>, Failure> {
        let (z, middle) = self.guess();
        self.work.jacobians += 1;
        let jacobian = self.system.jacobian(&middle);
        let (h, mut weights) = (self.h, self.weights(&self.y));
        let u = self.system.forcing(h, &self.tableau.c);
        let blocks = Blocks::<T::Matrix<B>, B>::new(self.tableau, h, &jacobian);
        let solved = self.stages((u, &blocks, &weights), z, self.enough)?;
        if !solved.converged {
            self.h *= 0.5;
            return Ok(None);
        }
        let end: [f64; N] = std::array::from_fn(|i| self.y[i] + solved.z[i][S - 1]);
        weights = self.weights(&end);
        let error = blocks.error::<N, S, W>(self.tableau, (h, &self.y_dot, &weights), &solved);
        let cautious = SAFETY * 25.0 / (24.0 + f64::from(solved.iterations));
        if error.is_nan() || error >= 1.0 {
            let shorter = (cautious * rough_power(error, Self::EXPONENT)).clamp(0.1, 0.9);
            self.h *= if error.is_finite() { shorter } else { 0.1 };
            return Ok(None);
        }
        if !self.system.admits(&end) {
            self.h *= 0.5;
            return Ok(None);
        }
        let grows = self.grows(&solved, &end, error, cautious);
        let mut trial = Trial { h, jacobian, weights, solved, at_kink: false };
        let mut next = h * grows;
        match self.meet_kink(&trial)? {
            Verdict::Again(shorter) => {
                self.h = shorter;
                return Ok(None);
            }
            Verdict::Ends(on_kink) => {
                trial = *on_kink;
                next = trial.h;
            }
            Verdict::Clear => {
                if self.system.growth(&self.y, &end) * h > GROWN {
                    self.h *= 0.5;
                    return Ok(None);
                }
                self.control = Some((h, error.max(1e-2)));
            }
        }
        Ok(Some((trial, next)))
    }

    const EXPONENT: f64 = -1.0 / (S as f64 + 1.0);

    /// The stages of a step with the forcing `u`, Newton's matrix `blocks` and these weights.
    #[inline(always)]
    pub(super) fn stages(
        &mut self,
        (u, blocks, weights): ([f64; W], &Blocks<T::Matrix<B>, B>, &[f64; N]),
        z: Increments<N, W>,
        enough: f64,
    ) -> Result<Solved<N, W>, Failure> {
        let equations = Equations { tableau: self.tableau, y: &self.y, u, blocks, weights, enough };
        let solved = equations.solve::<T, S>(self.system, z);
        self.spend(u64::from(solved.iterations.unsigned_abs()) * S as u64)?;
        Ok(solved)
    }

    /// By how much the next step may be longer: what the error allows, with Gustafsson's look at its trend;
    /// not so long that Newton's iteration would converge too slowly; and not beyond the time at which a
    /// speed that rises as 1/(T − t) would be infinite, nor that at which one that falls would be zero.
    #[inline(always)]
    fn grows(&self, solved: &Solved<N, W>, end: &[f64; N], error: f64, cautious: f64) -> f64 {
        let e = error.max(1e-10);
        let mut grows = (cautious * rough_power(e, Self::EXPONENT)).clamp(SHRINKAGE, GROWTH);
        if let Some((h, before)) = self.control {
            let trend = SAFETY * self.h / h * rough_power(before / (e * e), -Self::EXPONENT);
            grows = grows.min(trend.clamp(SHRINKAGE, GROWTH));
        }
        if solved.theta > 0.0 {
            grows = grows.min((CONVERGENCE / solved.theta).max(0.5));
        }
        if let Some(kink) = self.system.kink() {
            let (from, to) = (self.side * self.y[kink.state], self.side * end[kink.state]);
            let ratio = to / from;
            if from > 0.0 && ratio > 1.0 {
                grows = grows.min((BLOW_UP / (ratio - 1.0)).max(0.3));
            } else if kink.zone > 0.0 && from > kink.zone && ratio > 0.0 {
                grows = grows.min((BLOW_UP * ratio / (1.0 - ratio)).max(0.3));
            }
        }
        if self.rejected { grows.min(1.0) } else { grows }
    }

    #[inline(always)]
    fn accept(
        &mut self,
        trial: Trial<N, W>,
        arrives: Option<f64>,
        observer: &mut impl Observer<N>,
    ) -> Result<(), Failure> {
        let Trial { h, solved, at_kink, .. } = trial;
        let end = arrives.unwrap_or(self.t + h);
        let powers = powers::<N, S, W, B>(self.tableau, &solved.z);
        let whole: [f64; N] = std::array::from_fn(|i| solved.z[i][S - 1]);
        let mut y_end: [f64; N] = std::array::from_fn(|i| self.y[i] + whole[i]);
        if let Some(kink) = self.system.kink()
            && at_kink
        {
            y_end[kink.state] = 0.0;
        }
        let exact = powers.map(|powers| std::array::from_fn(|k| powers[k]));
        let piece = Piece::<N, S> { t: self.t, end, y: self.y, y_end, at_kink, h, powers: exact };
        observer.see(&piece);
        self.work.accepted += 1;
        (self.t, self.y, self.rejected, self.turned) = (end, y_end, false, false);
        self.system.start_at(end);
        self.last = Some((h, powers, whole));
        if at_kink {
            self.kinks += 1;
            self.side = -self.side;
            self.system.take_side(self.side);
            (self.last, self.control) = (None, None);
            return self.differentiate();
        }
        // The last stage is the end, where the polynomial has the slope f.
        self.y_dot = std::array::from_fn(|i| slope_at_end::<S, W>(&powers[i]) / h);
        let finite = self.y_dot.iter().all(|y_dot| y_dot.is_finite());
        if finite { Ok(()) } else { Err(Failure::NotFinite) }
    }
}
