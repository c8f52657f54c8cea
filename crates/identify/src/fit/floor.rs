//! What the noise of an imposed displacement leaves on its way through a contact.

use super::{
    Data, Problem,
    displacement::{Course, corners},
    models,
    problem::Piece,
    shaken::Shaken,
    whitening::Whitening,
    window::Window,
};
use crate::march::{Contact, Model};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use std::{borrow::Cow, sync::Arc};

/// How many times the displacement is perturbed by its own noise.
const TIMES: u64 = 16;

/// How many samples to either side tell of one sample's spread.
const AROUND: usize = 1;

/// What the noise of an imposed displacement makes of a model's force.
#[derive(Debug, Clone)]
pub struct Floor {
    /// By how much every sample spreads beside what follows from that noise to first order [N].
    pub spread: Vec<f64>,
    /// What makes the rest independent.
    pub whitening: Option<Arc<Whitening>>,
}

impl Problem<'_> {
    /// What the noise of the imposed displacement makes of the force of the model at `x`, whose motion is `piece`. Turns are
    /// noisier than the rest, so that the spread is local in time.
    pub fn floor(&self, x: &[f64], piece: &Piece, seed: u64) -> Floor {
        let problem = self.plain();
        let turns = turns_at_once(&problem.model(x));
        let shown = || crate::known::noise_of_displacement(&self.data.input);
        let Some(shaken) = problem.shaken(x, self.data.averaged.unwrap_or_else(shown)) else {
            return Floor { spread: timed(self.data, turns, Vec::new()), whitening: None };
        };
        let here = models::settled(&problem, x, Some(std::slice::from_ref(piece)), 1);
        let draws: Vec<Vec<f64>> = (0..TIMES)
            .into_par_iter()
            .map(|time| problem.beyond((x, &here[0]), (&shaken, seed.wrapping_add(time))))
            .collect();
        let mut squares = vec![0.0; self.data.time.len()];
        for draw in draws {
            for (square, d) in squares.iter_mut().zip(&draw) {
                *square += d * d / TIMES as f64;
            }
        }
        let local = |i: usize| {
            let near = &squares[i.saturating_sub(AROUND)..(i + AROUND + 1).min(squares.len())];
            (near.iter().sum::<f64>() / near.len() as f64).sqrt()
        };
        let spread = timed(self.data, turns, (0..squares.len()).map(local).collect());
        let weighed = Problem { spread: Cow::Borrowed(&spread), ..problem };
        let whitening = shaken.whitening(&weighed).map(Arc::new);
        Floor { spread, whitening }
    }

    /// The problem without the floor of an imposed motion.
    pub(super) fn plain(&self) -> Self {
        Problem { spread: Cow::default(), windows: self.windows_with(None), ..self.clone() }
    }

    /// Its windows, with what makes the residuals of an imposed motion independent.
    fn windows_with(&self, whitening: Option<&Arc<Whitening>>) -> Vec<Window> {
        let own = |w: &Window| Window { whitening: whitening.cloned(), ..w.clone() };
        self.windows.iter().map(own).collect()
    }

    /// The problem with the floor of the model at `x`, whose motion is `piece`.
    pub(super) fn floored(self, x: &[f64], piece: &Piece, seed: u64) -> Self {
        let Floor { spread, whitening } = self.floor(x, piece, seed);
        let windows = self.windows_with(whitening.as_ref());
        Problem { spread: Cow::Owned(spread), windows, ..self }
    }

    /// By what one draw of the displacement's noise moves the force of every sample, less what it does to first order [N].
    fn beyond(
        &self,
        (x, undisturbed): (&[f64], &Piece),
        (shaken, seed): (&Shaken, u64),
    ) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let (errors, first) = shaken.drawn(&mut || StandardNormal.sample(&mut random));
        let mut data: Data = self.data.clone();
        for (u, error) in data.input.iter_mut().zip(errors) {
            *u += error;
        }
        let course = Arc::new(Course::of(&data.time, &data.input));
        let other = Problem { data: &data, course, ..self.clone() };
        let there = models::settled(&other, x, Some(std::slice::from_ref(undisturbed)), 1);
        let pairs = there[0].motion.q.iter().zip(&undisturbed.motion.q).zip(first);
        pairs.map(|((there, here), first)| there - here - first).collect()
    }
}

/// How well the time of a sample is known, in sampling times: at a corner there are two velocities, and a friction that
/// turns at once does so between two samples.
const CORNER: f64 = 2.0;
const TURN: f64 = 0.1;

/// Whether a model has a friction that turns with the velocity, at once.
pub fn turns_at_once(model: &Model<f64>) -> bool {
    matches!(model.contact, Contact::Coulomb { .. }) || model.effects.iter().any(|e| e.kind.dry())
}

/// The spread with that of a force that changes from sample to sample: at a corner, and where it `turns_at_once`, it is
/// worth what its time is.
pub fn timed(data: &Data, turns_at_once: bool, spread: Vec<f64>) -> Vec<f64> {
    let Some(force) = &data.force else { return spread };
    let f = &force.values;
    let corners = corners(&data.input);
    let turn = if turns_at_once { TURN } else { 0.0 };
    let u = &data.input;
    let step = |i: usize| u.get(i + 1).map_or(0.0, |next| next - u[i]);
    let turned = |i: usize| i > 0 && step(i - 1) * step(i) <= 0.0;
    let turns = |i: usize| (i.saturating_sub(1)..i + 2).any(turned);
    let known = |i: usize| {
        if corners[i] {
            CORNER
        } else if turns(i) {
            turn
        } else {
            0.0
        }
    };
    let of =
        |i: usize| known(i) * 0.5 * (f[(i + 1).min(f.len() - 1)] - f[i.saturating_sub(1)]).abs();
    (0..f.len()).map(|i| spread.get(i).map_or_else(|| of(i), |own| own.hypot(of(i)))).collect()
}

#[cfg(test)]
mod tests {
    use super::{Data, timed};
    use crate::fit::Seen;

    #[test]
    fn what_turns_at_once_is_worth_its_time_at_the_turn() {
        let time: Vec<f64> = (0..200).map(|i| 0.005 * f64::from(i)).collect();
        let input: Vec<f64> = time.iter().map(|t| (8.0 * t).cos()).collect();
        let force = time.iter().map(|t| if (8.0 * t).sin() > 0.0 { -1.5 } else { 1.5 }).collect();
        let seen = Seen::new("force", force, 0.0);
        let driven = Data::driven(time, input, crate::Hold::Linear, seen.clone());
        let data = Data { displacement: None, force: Some(seen), ..driven };
        let [dry, other] = [true, false].map(|at_once| timed(&data, at_once, Vec::new()));
        // It turns at π/8 s, 78.5 samples; by 3 N over two sampling times, a tenth of one of them known.
        assert!((dry[78] - 0.15).abs() < 1e-12 && dry[40] == 0.0, "{} N", dry[78]);
        assert!(other.iter().all(|own| *own == 0.0));
    }
}
