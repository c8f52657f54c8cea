//! The noise of an imposed displacement on its way through a contact.
//!
//! The error of each sample moves the ways to the samples beside it and the velocities there, and what it does to the
//! contact's states lasts until these forget it: as with the noise of a recorded input, many residuals are off together,
//! and [`Whitening`] tells what of each is new. While the motion rests the displacement is the mean of all samples of the
//! rest, which share its error.

use super::{
    displacement::{REST, corners, velocity, way},
    imposed::{Sliding, Step, near},
    problem::Problem,
    whitening::Whitening,
};
use crate::march::Model;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// A sample's force depends on the displacements of so many samples after it, and before it.
const REACH: usize = 2;

/// The displacements on which what comes next depends, beside that whose error is new: so many samples.
const KEPT: usize = 2 * REACH;

/// How small deviations go on from sample to sample under an imposed motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaken {
    /// How many states the contact has.
    states: usize,
    /// The standard deviation of the displacement at each sample [m].
    noise: Vec<f64>,
    /// Whether a sample has the error of that before it.
    same: Vec<bool>,
    /// From each sample to the next: [A; C] and [g; d] as of [`Whitening::of`], C and d in newtons. The states are those of
    /// the contact and, in standard deviations, the errors of the displacement two samples ahead, one ahead, here and one
    /// behind; the new one is two samples ahead.
    passings: Vec<(DMatrix<f64>, DVector<f64>)>,
}

impl Problem<'_> {
    /// The same for the imposed displacement with so much `noise` [m], at the variables `x`; none if it has none, or
    /// drives the plant.
    pub fn shaken(&self, x: &[f64], noise: f64) -> Option<Shaken> {
        let force = self.data.force.as_ref().filter(|_| noise > 0.0)?;
        let record = (self.data.time.as_slice(), self.data.input.as_slice());
        Some(Shaken::of(&self.model(x), record, force.values[0], noise))
    }
}

impl Shaken {
    fn of(model: &Model<f64>, (time, u): (&[f64], &[f64]), seen: f64, noise: f64) -> Self {
        let (noise, same) = errors(u, noise);
        // No error makes a corner, or takes one away.
        let corners = corners(u);
        let sample = |sliding: &mut Sliding<'_, f64>, u: &[f64], i: usize| {
            let way = if i > 0 { way(time, (u, &corners), i) } else { Vec::new() };
            let velocity = velocity(time, (u, &corners), i);
            let step = Step { time: near(time, i), u: near(u, i), velocity, way: &way };
            let force = sliding.step(&step);
            sliding.z.iter().copied().chain([force]).collect::<Vec<f64>>()
        };
        let mut sliding = Sliding::begun(model, seen, velocity(time, (u, &corners), 0));
        sample(&mut sliding, u, 0);
        let mut moved = u.to_vec();
        let states = sliding.z.len();
        let mut all = Self { states, noise, same, passings: Vec::new() };
        for i in 1..u.len() {
            let mut passing = all.passing(i);
            let see = |at: &mut Vec<f64>, z: Option<(usize, f64)>| {
                let mut probe = sliding.clone();
                if let Some((k, by)) = z {
                    probe.z[k] += by;
                }
                sample(&mut probe, at, i)
            };
            for k in 0..states {
                let size = all.noise[i] * model.contact.stiff();
                let [up, down] = [size, -size].map(|by| see(&mut moved, Some((k, by))));
                all.write(&mut passing, Some(k), (&up, &down), 2.0 * size);
            }
            for (of, column) in all.asked(i) {
                let size = all.noise[of.start];
                let [up, down] = [size, -size].map(|by| {
                    for u in &mut moved[of.clone()] {
                        *u += by;
                    }
                    let seen = see(&mut moved, None);
                    moved[of.clone()].copy_from_slice(&u[of.clone()]);
                    seen
                });
                all.write(&mut passing, column, (&up, &down), 2.0);
            }
            sample(&mut sliding, u, i);
            all.passings.push(passing);
        }
        all
    }

    /// What leads to sample `i` as far as it is the same for every contact: the errors move on by one.
    fn passing(&self, i: usize) -> (DMatrix<f64>, DVector<f64>) {
        let n = self.states;
        let mut by = DMatrix::zeros(n + KEPT + 1, n + KEPT);
        let mut new = DVector::zeros(n + KEPT + 1);
        match self.same.get(i + REACH) {
            Some(true) => by[(n, n)] = 1.0,
            Some(false) => new[n] = 1.0,
            None => {}
        }
        for k in 1..KEPT {
            by[(n + k, n + k - 1)] = 1.0;
        }
        (by, new)
    }

    /// On which errors sample `i` depends: of the samples that share it those within reach, and the column of their
    /// derivatives, none for that of the new one.
    fn asked(&self, i: usize) -> Vec<(Range<usize>, Option<usize>)> {
        let (first, last) = (i.saturating_sub(REACH), (i + REACH).min(self.same.len() - 1));
        let mut asked = Vec::new();
        let mut from = first;
        for j in first..=last {
            if j < last && self.same[j + 1] {
                continue;
            }
            let new = j == i + REACH && !self.same[j];
            // That of sample i + 1 is the first that is kept.
            let column = self.states + (i + 1).saturating_sub(j);
            asked.push((from..j + 1, Some(column).filter(|_| !new)));
            from = j + 1;
        }
        asked
    }

    /// Writes what the states and the force change by between two motions, divided by so much.
    fn write(
        &self,
        (by, new): &mut (DMatrix<f64>, DVector<f64>),
        column: Option<usize>,
        (up, down): (&[f64], &[f64]),
        apart: f64,
    ) {
        for (k, (up, down)) in up.iter().zip(down).enumerate() {
            let row = if k < self.states { k } else { self.states + KEPT };
            let slope = (up - down) / apart;
            match column {
                Some(column) => by[(row, column)] = slope,
                None => new[row] = slope,
            }
        }
    }

    /// What makes the residuals of the force independent, which are weighed as in this problem.
    pub fn whitening(&self, problem: &Problem<'_>) -> Option<Whitening> {
        self.weighed(&|i| problem.weights_at(i)[0])
    }

    /// The same where each sample has its weight [N].
    fn weighed(&self, weight: &dyn Fn(usize) -> f64) -> Option<Whitening> {
        let seen = self.states + KEPT;
        let weighed = self.passings.iter().enumerate().map(|(i, (by, new))| {
            let (mut by, mut new) = (by.clone(), new.clone());
            by.row_mut(seen).unscale_mut(weight(i + 1));
            new[seen] /= weight(i + 1);
            (by, new)
        });
        Whitening::of(seen, weighed)
    }

    /// An error of the displacement [m], of which every part that is new is drawn by `normal`, and what it does to the
    /// force to first order [N].
    pub fn drawn(&self, normal: &mut dyn FnMut() -> f64) -> (Vec<f64>, Vec<f64>) {
        let n = self.noise.len();
        let (mut error, mut force) = (vec![0.0; n], vec![0.0; n]);
        let mut state = DVector::zeros(self.states + KEPT);
        for (i, (by, new)) in self.passings.iter().enumerate() {
            let next = by * &state + new * normal();
            state.copy_from(&next.rows(0, self.states + KEPT));
            if let Some(error) = error.get_mut(i + 1 + REACH) {
                *error = self.noise[i + 1 + REACH] * state[self.states];
            }
            force[i + 1] = next[self.states + KEPT];
        }
        (error, force)
    }
}

/// The standard deviation of every sample of the displacement `u` [m], each sample having so much `noise`, and which of
/// them have the error of that before them.
fn errors(u: &[f64], noise: f64) -> (Vec<f64>, Vec<bool>) {
    let (mut own, mut same) = (vec![noise; u.len()], vec![false; u.len()]);
    let mut first = 0;
    for rest in u.chunk_by(|a, b| a == b) {
        let end = first + rest.len();
        if rest.len() >= REST {
            own[first..end].fill(noise / (rest.len() as f64).sqrt());
            same[first + 1..end].fill(true);
        }
        first = end;
    }
    (own, same)
}

#[cfg(test)]
mod tests {
    use super::{Shaken, errors};
    use crate::fit::{
        displacement::Course,
        imposed::{forces, tests::model},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    const LUGRE: &str = "name = \"lugre\"\nf_c = 1.0\nf_s = 1.4\nv_s = 0.02\nsigma_0 = 3e3\nsigma_1 = 5.0\nsigma_2 = 2.0";

    /// A sine of 2 mm that rests at 1.2 s for half a second, and 8 s of it.
    fn motion() -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..1600).map(|i| 0.005 * f64::from(i)).collect();
        let way = |t: f64| 2e-3 * (3.0 * (t.min(1.2) + (t - 1.7).max(0.0))).sin();
        let u = time.iter().map(|t| way(*t)).collect();
        (time, u)
    }

    fn forced(friction: &str, (time, u): (&[f64], &[f64])) -> Vec<f64> {
        let mut seen = Vec::new();
        let course = Course::of(time, u);
        forces(&model(friction), (time, u, &course), 0.0, &mut |_, f| seen.push(f));
        seen
    }

    #[test]
    fn a_small_error_of_the_displacement_does_to_first_order_what_it_does() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let (time, u) = motion();
        for friction in [
            "name = \"none\"\nsigma_2 = 3.0",
            "name = \"dahl\"\nf_c = 1.5\nsigma = 3e3\ngamma = 1.0\nsigma_2 = 1.0",
            "name = \"maxwell-slip\"\nk = [9e2, 4e2]\ndelta = [2e-4, 9e-4]\nsigma_2 = 1.0",
            LUGRE,
        ] {
            let shaken = Shaken::of(&model(friction), (&time, &u), 0.0, 1e-11);
            let (error, first) = shaken.drawn(&mut || StandardNormal.sample(&mut random));
            let moved: Vec<f64> = u.iter().zip(&error).map(|(u, e)| u + e).collect();
            let (here, there) = (forced(friction, (&time, &u)), forced(friction, (&time, &moved)));
            let rms = |of: &dyn Fn(usize) -> f64| {
                ((0..u.len()).map(|i| of(i).powi(2)).sum::<f64>() / u.len() as f64).sqrt()
            };
            let (all, left) =
                (rms(&|i| there[i] - here[i]), rms(&|i| there[i] - here[i] - first[i]));
            assert!(left < 0.02 * all, "{friction}: {left} N of {all} N");
        }
    }

    #[test]
    fn what_noise_leaves_is_white_and_as_large_as_is_said() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        let (time, u) = motion();
        let (noise, weight) = (4e-7, 2e-4);
        let (own, same) = errors(&u, noise);
        let mut seen = u.clone();
        let mut error = 0.0;
        for i in 0..u.len() {
            if !same[i] {
                error = own[i] * normal();
            }
            seen[i] += error;
        }
        let shaken = Shaken::of(&model(LUGRE), (&time, &seen), 0.0, noise);
        let whitening = shaken.weighed(&|_| weight).unwrap();
        let pairs = forced(LUGRE, (&time, &seen)).into_iter().zip(forced(LUGRE, (&time, &u)));
        let mut left: Vec<f64> = pairs.map(|(a, b)| (a - b) / weight + normal()).collect();
        let square = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>() / r.len() as f64;
        let hangs =
            |r: &[f64]| r.windows(2).map(|r| r[0] * r[1]).sum::<f64>() / r.len() as f64 / square(r);
        assert!(square(&left) > 4.0 && hangs(&left).abs() > 0.2, "{}", hangs(&left));
        whitening.apply(&mut left);
        // Of 1600 samples a mean square is off by √(2/1600) = 0.035, a correlation by 0.025.
        assert!((square(&left) - 1.0).abs() < 0.14, "{}", square(&left));
        assert!(hangs(&left).abs() < 0.1, "{}", hangs(&left));
    }
}
