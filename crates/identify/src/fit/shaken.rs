//! The noise of an imposed displacement on its way through a contact.
//!
//! The error of each sample moves the ways to the samples beside it and the velocities there, and what it does to the
//! contact's states lasts until these forget it: as with the noise of a recorded input, many residuals are off together,
//! and [`Whitening`] tells what of each is new. While the motion rests the displacement is the mean of all samples of the
//! rest, which share its error; where it was cut to its band what is left of its noise hangs together as that says.

use super::{
    data::Band,
    displacement::{corners, velocity, way},
    imposed::{Sliding, Step, near},
    linked::{Link, errors},
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
    /// How many states the contact and the effects have.
    states: usize,
    /// The standard deviation of the displacement at each sample [m].
    noise: Vec<f64>,
    /// How the error of every sample follows from those before it.
    links: Vec<Link>,
    /// What each error of the first displacements, by one standard deviation, makes of the states at the first sample.
    errors: Vec<DVector<f64>>,
    /// And that of the first force, by which the contact is begun.
    begun: DVector<f64>,
    /// From each sample to the next: [A; C] and [g; d] as of [`Whitening::of`], C and d in newtons. The states are those of
    /// the contact and the effects and, in standard deviations, the errors of the displacement two samples ahead, one
    /// ahead, here and one behind; the new one is two samples ahead.
    passings: Vec<(DMatrix<f64>, DVector<f64>)>,
}

impl Problem<'_> {
    /// The same for the imposed displacement with so much `noise` [m], at the variables `x`; none if it has none, or
    /// drives the plant.
    pub fn shaken(&self, x: &[f64], noise: f64) -> Option<Shaken> {
        let force = self.data.force.as_ref().filter(|_| noise > 0.0)?;
        let record = (self.data.time.as_slice(), self.data.input.as_slice());
        let known = (noise, self.data.band.as_ref());
        Some(Shaken::of(&self.model(x), record, (force.values[0], self.weights.force), known))
    }
}

/// An imposed motion and what slides along it.
struct Motion<'a> {
    model: &'a Model<f64>,
    time: &'a [f64],
    /// Where it has corners: no error makes one, or takes one away.
    corners: &'a [bool],
    /// The displacement [m].
    u: Vec<f64>,
}

impl<'a> Motion<'a> {
    /// What slides, at the first sample, with this force [N].
    fn begun(&self, force: f64) -> Sliding<'a, f64> {
        Sliding::begun(self.model, force, velocity(self.time, (&self.u, self.corners), 0))
    }

    /// The states and the force once it has come to sample `i`.
    fn sample(&self, sliding: &mut Sliding<'_, f64>, i: usize) -> Vec<f64> {
        let (time, u) = (self.time, (self.u.as_slice(), self.corners));
        let way = if i > 0 { way(time, u, i) } else { Vec::new() };
        let (time, u, velocity) = (near(time, i), near(u.0, i), velocity(time, u, i));
        let force = sliding.step(&Step { time, u, velocity, way: &way });
        sliding.states().copied().chain([force]).collect()
    }

    /// By how much what is seen differs with an error of this size at these samples [m].
    fn shaken(
        &mut self,
        of: &Range<usize>,
        size: f64,
        see: &dyn Fn(&Self) -> Vec<f64>,
    ) -> DVector<f64> {
        let own = self.u[of.clone()].to_vec();
        let [up, down] = [size, -size].map(|by| {
            for (u, own) in self.u[of.clone()].iter_mut().zip(&own) {
                *u = own + by;
            }
            see(self)
        });
        self.u[of.clone()].copy_from_slice(&own);
        half(&up, &down)
    }
}

impl Shaken {
    /// `seen` is the first force and its standard deviation [N], `known` the noise of the displacement and its band.
    fn of(
        model: &Model<f64>,
        (time, u): (&[f64], &[f64]),
        seen: (f64, f64),
        known: (f64, Option<&Band>),
    ) -> Self {
        let (noise, links) = errors(u, known);
        let corners = corners(u);
        let mut motion = Motion { model, time, corners: &corners, u: u.to_vec() };
        let mut sliding = motion.begun(seen.0);
        motion.sample(&mut sliding, 0);
        let states = sliding.states().count();
        let begun = DVector::zeros(states + KEPT);
        let mut all =
            Self { states, noise, links, errors: Vec::new(), begun, passings: Vec::new() };
        all.start(&mut motion, seen);
        // By how much the states have differed with an error, at most.
        let mut sizes = vec![0.0; states];
        for i in 1..u.len() {
            let passing = all.passed((&mut motion, &sliding), i, &mut sizes);
            all.passings.push(passing);
            motion.sample(&mut sliding, i);
        }
        all
    }

    /// What is not known at the first sample.
    fn start(&mut self, motion: &mut Motion<'_>, (seen, noise): (f64, f64)) {
        let states = |force: f64, motion: &Motion<'_>| -> Vec<f64> {
            motion.begun(force).states().copied().collect()
        };
        let by = half(&states(seen + noise, motion), &states(seen - noise, motion));
        self.begun.rows_mut(0, self.states).copy_from(&by);
        for (of, _) in self.asked(0) {
            let by = motion.shaken(&of, self.noise[of.start], &|motion| states(seen, motion));
            let mut error = DVector::zeros(self.states + KEPT);
            error.rows_mut(0, self.states).copy_from(&by);
            of.for_each(|j| error[self.states + REACH - j] = 1.0);
            self.errors.push(error);
        }
    }

    /// What leads to sample `i`; a state is moved by as much as an error has done up to there, for what slips is not smooth.
    fn passed(
        &self,
        (motion, sliding): (&mut Motion<'_>, &Sliding<'_, f64>),
        i: usize,
        sizes: &mut [f64],
    ) -> (DMatrix<f64>, DVector<f64>) {
        let mut passing = self.passing(i);
        for (of, column) in self.asked(i) {
            let see = |motion: &Motion<'_>| motion.sample(&mut sliding.clone(), i);
            let by = motion.shaken(&of, self.noise[of.start], &see);
            for (size, by) in sizes.iter_mut().zip(by.iter()) {
                *size = f64::max(*size, by.abs());
            }
            self.write(&mut passing, column, &by);
        }
        self.link(&mut passing, i);
        for (k, size) in sizes.iter().enumerate().filter(|(_, size)| **size > 0.0) {
            let [up, down] = [*size, -size].map(|by| {
                let mut other = sliding.clone();
                *other.state(k) += by;
                motion.sample(&mut other, i)
            });
            self.write(&mut passing, Some(k), &(half(&up, &down) / *size));
        }
        passing
    }

    /// What leads to sample `i` as far as it is the same for every contact: the errors move on by one.
    fn passing(&self, i: usize) -> (DMatrix<f64>, DVector<f64>) {
        let n = self.states;
        let mut by = DMatrix::zeros(n + KEPT + 1, n + KEPT);
        let mut new = DVector::zeros(n + KEPT + 1);
        if i + REACH < self.links.len() {
            new[n] = 1.0;
        }
        for k in 1..KEPT {
            by[(n + k, n + k - 1)] = 1.0;
        }
        (by, new)
    }

    /// Writes what comes of the newest error as what comes of those before it and of what is new.
    fn link(&self, (by, new): &mut (DMatrix<f64>, DVector<f64>), i: usize) {
        let Some(link) = self.links.get(i + REACH) else { return };
        for (column, share) in link.by.iter().enumerate() {
            by.column_mut(self.states + column).axpy(*share, new, 1.0);
        }
        *new *= link.new;
    }

    /// On which errors sample `i` depends: of the samples that share it those within reach, and the column of their
    /// derivatives, none for that of the new one.
    fn asked(&self, i: usize) -> Vec<(Range<usize>, Option<usize>)> {
        let (first, last) = (i.saturating_sub(REACH), (i + REACH).min(self.links.len() - 1));
        let mut asked = Vec::new();
        let mut from = first;
        for j in first..=last {
            if j < last && self.links[j + 1] == Link::SAME {
                continue;
            }
            let new = j == i + REACH && self.links[j] != Link::SAME;
            // That of sample i + 1 is the first that is kept.
            let column = self.states + (i + 1).saturating_sub(j);
            asked.push((from..j + 1, Some(column).filter(|_| !new)));
            from = j + 1;
        }
        asked
    }

    /// Writes what the states and the force change by.
    fn write(
        &self,
        (by, new): &mut (DMatrix<f64>, DVector<f64>),
        column: Option<usize>,
        slopes: &DVector<f64>,
    ) {
        for (k, slope) in slopes.iter().enumerate() {
            let row = if k < self.states { k } else { self.states + KEPT };
            match column {
                Some(column) => by[(row, column)] = *slope,
                None => new[row] = *slope,
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
            (by, DMatrix::from_columns(&[new]))
        });
        let start = self.errors.iter().chain([&self.begun]).map(|b| b * b.transpose());
        Whitening::of(start.sum(), weighed)
    }

    /// An error of the displacement [m], of which every part that is new is drawn by `normal`, and what it does to the
    /// force to first order [N].
    pub fn drawn(&self, normal: &mut dyn FnMut() -> f64) -> (Vec<f64>, Vec<f64>) {
        let n = self.noise.len();
        let (mut error, mut force) = (vec![0.0; n], vec![0.0; n]);
        let mut state = DVector::zeros(self.states + KEPT);
        for own in &self.errors {
            state += own * normal();
        }
        for (j, error) in error.iter_mut().enumerate().take(REACH + 1) {
            *error = self.noise[j] * state[self.states + REACH - j];
        }
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

/// Half of what two motions differ by.
fn half(up: &[f64], down: &[f64]) -> DVector<f64> {
    DVector::from_iterator(up.len(), up.iter().zip(down).map(|(up, down)| 0.5 * (up - down)))
}

#[cfg(test)]
mod tests {
    use super::{Band, Shaken, errors};
    use crate::fit::{
        displacement::Course,
        imposed::{forces, tests::model},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    const LUGRE: &str = "name = \"lugre\"\nf_c = 1.0\nf_s = 1.4\nv_s = 0.02\nsigma_0 = 3e3\nsigma_1 = 5.0\nsigma_2 = 2.0";

    /// Springs that slip, and a contact that ages, beside another friction.
    const SPRING: &str = "name = \"coulomb\"\nf_c = 1e-9\nsigma_2 = 0.1\n[[effect]]\nname = \"maxwell_slip\"\nk = 500.0\n\
        delta = 6e-4";
    const AGE: &str = "name = \"lugre\"\nf_c = 1.0\nf_s = 1.0\nv_s = 0.02\nsigma_0 = 3e3\nsigma_1 = 1.0\nsigma_2 = 0.1\n\
        [[effect]]\nname = \"dwell_stiction\"\ndrop = 0.8\ntau = 0.3\nwear = 2.0";

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
            SPRING,
            AGE,
        ] {
            let shaken = Shaken::of(&model(friction), (&time, &u), (0.0, 0.0), (1e-11, None));
            let (error, first) = shaken.drawn(&mut || StandardNormal.sample(&mut random));
            let moved: Vec<f64> = u.iter().zip(&error).map(|(u, e)| u + e).collect();
            let (here, there) = (forced(friction, (&time, &u)), forced(friction, (&time, &moved)));
            // A contact begins with the first force, whatever its velocity.
            let rms = |of: &dyn Fn(usize) -> f64| {
                ((1..u.len()).map(|i| of(i).powi(2)).sum::<f64>() / u.len() as f64).sqrt()
            };
            let (all, left) =
                (rms(&|i| there[i] - here[i]), rms(&|i| there[i] - here[i] - first[i]));
            assert!(left < 0.02 * all, "{friction}: {left} N of {all} N");
        }
    }

    #[test]
    fn what_noise_leaves_is_white_and_as_large_as_is_said() {
        // As it was recorded, and 1/√20 of it, which hangs together, in a band of a twentieth of all.
        let (time, u) = motion();
        let band = Band { edge: std::f64::consts::PI / 20.0, inside: vec![true; u.len()] };
        for band in [None, Some(band)] {
            let mut random = ChaCha8Rng::seed_from_u64(2);
            let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
            let known = (if band.is_some() { 4e-6 } else { 4e-7 }, band.as_ref());
            let weight = 2e-4;
            let (own, links) = errors(&u, known);
            let mut error = vec![0.0; u.len()];
            for (i, link) in links.iter().enumerate() {
                let before = |k: usize| i.checked_sub(k).map_or(0.0, |j| error[j] / own[j]);
                let new = link.new * normal();
                error[i] = own[i] * (link.by[0] * before(1) + link.by[1] * before(2) + new);
            }
            let seen: Vec<f64> = u.iter().zip(&error).map(|(u, e)| u + e).collect();
            let shaken = Shaken::of(&model(LUGRE), (&time, &seen), (0.0, 0.0), known);
            let whitening = shaken.weighed(&|_| weight).unwrap();
            let pairs = forced(LUGRE, (&time, &seen)).into_iter().zip(forced(LUGRE, (&time, &u)));
            let mut left: Vec<f64> = pairs.map(|(a, b)| (a - b) / weight + normal()).collect();
            let square = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>() / r.len() as f64;
            let hangs = |r: &[f64]| {
                r.windows(2).map(|r| r[0] * r[1]).sum::<f64>() / r.len() as f64 / square(r)
            };
            assert!(square(&left) > 4.0 && hangs(&left).abs() > 0.2, "{}", hangs(&left));
            whitening.apply(&mut left);
            // Of 1600 samples a mean square is off by √(2/1600) = 0.035, a correlation by 0.025.
            assert!((square(&left) - 1.0).abs() < 0.14, "{}", square(&left));
            assert!(hangs(&left).abs() < 0.1, "{}", hangs(&left));
        }
    }
}
