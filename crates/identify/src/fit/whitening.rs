//! Residuals that hang together, made independent.
//!
//! What a recorded input says wrong goes through the plant and is seen in many samples at once. Along a motion its
//! deviations s go from sample to sample by s⁺ = A s + g w and are seen as y⁺ = C s + d w, with w the input's noise, white;
//! on each y lies the noise of a sensor. Where the input goes along a line from sample to sample, or is late, the errors that
//! were there before are states as well. What of a residual was not to be foretold from those before it, in units
//! of its own deviation, is white: the innovations of Kalman's filter (Anderson and Moore, Optimal Filtering, Prentice-Hall
//! 1979, chapter 5).

use super::{
    colour::Colour,
    problem::{Piece, Problem},
    window::Window,
};
use crate::Hold;
use crate::march::{Model, Passage, deviations, errors, passages};
use nalgebra::DMatrix;

/// So many columns are made white at once.
const AT_ONCE: usize = 32;

/// A step of the input is a jump for as much as it is more than so many times those beside it, or the noise.
const JUMP: f64 = 4.0;

/// The innovations of a window's residuals.
#[derive(Debug, Clone, PartialEq)]
pub struct Whitening {
    channels: usize,
    states: usize,
    /// From each sample to the next, row by row: what is foretold of the states from those before, A; what is foretold of
    /// the residuals, C, each in units of its sensor's noise; what the rest says of the states, Kalman's gain; and the
    /// inverse of Cholesky's factor of the covariance of that rest.
    passings: Vec<f64>,
}

impl Whitening {
    /// Of what goes on from sample to sample: [A; C] and [g; d] of each, with C and d in units of the sensors' noise and
    /// a column of g and d for one standard deviation of each noise. The states at the first sample have this `covariance`.
    /// None if not all is finite.
    pub fn of(
        mut covariance: DMatrix<f64>,
        all: impl Iterator<Item = (DMatrix<f64>, DMatrix<f64>)>,
    ) -> Option<Self> {
        let states = covariance.nrows();
        let mut passings = Vec::new();
        let mut channels = 0;
        for (by, noise) in all {
            channels = by.nrows() - states;
            let both = &by * &covariance * by.transpose() + &noise * noise.transpose();
            let seen = both.view((states, states), (channels, channels))
                + DMatrix::identity(channels, channels);
            let across = both.view((0, states), (states, channels)).into_owned();
            let factor = seen.clone().cholesky()?;
            let gain = factor.solve(&across.transpose()).transpose();
            covariance = both.view((0, 0), (states, states)) - &gain * across.transpose();
            // Rounding must not make it lopsided.
            covariance = 0.5 * (&covariance + covariance.transpose());
            if !covariance.iter().all(|value| value.is_finite()) {
                return None;
            }
            for part in [&by, &gain, &factor.l().try_inverse()?] {
                passings.extend(
                    part.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<f64>>()),
                );
            }
        }
        Some(Self { channels, states, passings })
    }

    /// How many numbers a passing from sample to sample has.
    fn numbers(&self) -> usize {
        let (n, c) = (self.states, self.channels);
        (n + c) * n + n * c + c * c
    }

    /// Makes the residuals of `rows` white, sample by sample, and leaves those after the last sample as they are.
    pub fn apply(&self, rows: &mut [f64]) {
        let stride = rows.len();
        self.apply_columns(rows, stride);
    }

    /// The same of every column of `all`.
    pub fn apply_all(&self, all: &mut DMatrix<f64>) {
        let rows = all.nrows();
        for columns in all.as_mut_slice().chunks_mut((AT_ONCE * rows).max(1)) {
            self.apply_columns(columns, rows);
        }
    }

    /// The same of columns of so many rows, all of them from sample to sample: what leads from one to the next is read
    /// once.
    fn apply_columns(&self, columns: &mut [f64], rows: usize) {
        let (n, c) = (self.states, self.channels);
        if rows == 0 || n == 0 || self.passings.is_empty() {
            return;
        }
        let many = columns.len() / rows;
        let (mut now, mut next) = (vec![0.0; n * many], vec![0.0; n * many]);
        let mut fresh = vec![0.0; c];
        for (sample, passing) in self.passings.chunks_exact(self.numbers()).enumerate() {
            let (on, passing) = passing.split_at(n * n);
            let (seen, passing) = passing.split_at(c * n);
            let (gain, white) = passing.split_at(n * c);
            let all = columns
                .chunks_exact_mut(rows)
                .zip(now.chunks_exact(n).zip(next.chunks_exact_mut(n)));
            for (column, (now, next)) in all {
                let residuals = &mut column[(sample + 1) * c..][..c];
                for ((fresh, row), seen) in
                    fresh.iter_mut().zip(residuals.iter()).zip(seen.chunks_exact(n))
                {
                    *fresh = row - dot(seen, now);
                }
                for ((next, on), gain) in
                    next.iter_mut().zip(on.chunks_exact(n)).zip(gain.chunks_exact(c))
                {
                    *next = dot(on, now) + dot(gain, &fresh);
                }
                for (k, (row, white)) in residuals.iter_mut().zip(white.chunks_exact(c)).enumerate()
                {
                    *row = dot(&white[..=k], &fresh[..=k]);
                }
            }
            std::mem::swap(&mut now, &mut next);
        }
    }
}

/// The sum of the products.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Problem<'_> {
    /// What makes the residuals of a driven window independent, where the recorded input has this much `noise` [its
    /// unit], and when it jumped is not known; none where there is neither, where a controller makes it anew, or the window has no motion.
    pub fn whitening(
        &self,
        x: &[f64],
        (window, piece): (&Window, &Piece),
        noise: f64,
    ) -> Option<Whitening> {
        let moves = piece.motion.tape.samples() == window.len();
        let late = self.late(window, noise);
        if noise <= 0.0 && late.iter().all(|late| *late <= 0.0) || self.closed_loop || !moves {
            return None;
        }
        let model = self.model(x);
        match deviations(&model) + self.errors(&model) + 1 {
            0..=8 => self.whitened::<8>(&model, (window, piece), (noise, &late)),
            9..=12 => self.whitened::<12>(&model, (window, piece), (noise, &late)),
            13..=20 => self.whitened::<20>(&model, (window, piece), (noise, &late)),
            21..=40 => self.whitened::<40>(&model, (window, piece), (noise, &late)),
            _ => None,
        }
    }

    /// By how much the input may be off all along each interval of a window that has so much `noise` [its unit]. What goes
    /// on from sample to sample may have jumped at any time between two of them: as an impulse that is white noise of the
    /// jump over √12.
    fn late(&self, window: &Window, noise: f64) -> Vec<f64> {
        let input = &self.data.input[window.first..window.end];
        let steps: Vec<f64> = input.windows(2).map(|u| (u[1] - u[0]).abs()).collect();
        let at = |k: Option<usize>| k.and_then(|k| steps.get(k)).copied().unwrap_or(0.0);
        let jump = |k: usize| {
            let beside = at(k.checked_sub(1)).max(at(Some(k + 1)));
            (steps[k] - JUMP * beside.max(noise)).max(0.0)
        };
        let late = |k: usize| if self.held() { 0.0 } else { jump(k) / 12f64.sqrt() };
        (0..steps.len()).map(late).collect()
    }

    /// Whether the input is held from sample to sample.
    fn held(&self) -> bool {
        self.data.hold == Hold::ZeroOrder
    }

    /// On the errors of how many samples an interval's input depends.
    fn errors(&self, model: &Model<f64>) -> usize {
        errors(self.data.hold, model.delay().is_some())
    }

    /// The same with numbers that have room for P − 1 deviations and errors.
    fn whitened<const P: usize>(
        &self,
        model: &Model<f64>,
        (window, piece): (&Window, &Piece),
        (noise, late): (f64, &[f64]),
    ) -> Option<Whitening> {
        let n = deviations(model);
        let errors = self.errors(model);
        let colour = Colour::of(self.data, window, noise);
        // All but the last error were there before, and two where they hang together.
        let kept = colour.remembers(errors - 1);
        let states = n + kept;
        let state = self.state(model, window, piece.start);
        let time = &self.data.time[window.first..window.end];
        let channels = self.channels();
        let mut all = Vec::with_capacity(window.len());
        passages::<P>(
            model,
            (&self.drive(window), time),
            &piece.motion.tape,
            &state,
            &mut |passage: Passage<P>| {
                let weights = self.weights_at(window.first + all.len() + 1);
                let row = |i: usize| match i.checked_sub(states) {
                    None if i >= n => ([0.0; P], 1.0),
                    None => (passage.states[i], 1.0),
                    Some(c) => (passage.seen[c], weights[c].recip()),
                };
                let newest = |i: usize| row(i).0[n + errors - 1] * row(i).1;
                let of = |i: usize, j: usize| match j.checked_sub(n) {
                    None => row(i).0[j] * row(i).1,
                    Some(back) => match (back + errors).checked_sub(kept + 1) {
                        Some(error) => row(i).0[n + error] * row(i).1,
                        None => 0.0,
                    },
                };
                let mut by = DMatrix::from_fn(states + channels, states, of);
                let late = late.get(all.len()).copied().unwrap_or(0.0);
                let mut new = DMatrix::from_fn(states + channels, 2, |i, j| match j {
                    0 => newest(i) * colour.new,
                    _ => row(i).0[n..n + errors].iter().sum::<f64>() * row(i).1 * late,
                });
                // They move on by one.
                if kept > 0 {
                    new[(states - 1, 0)] = colour.new;
                }
                for i in 1..kept {
                    by[(n + i - 1, n + i)] = 1.0;
                }
                // The newest hangs on the last two.
                for (back, by_last) in (1..).zip(colour.by).take(kept) {
                    for i in 0..states + channels {
                        by[(i, states - back)] += newest(i) * by_last;
                    }
                    by[(states - 1, states - back)] += by_last;
                }
                all.push((by, new));
            },
        );
        let mut covariance = DMatrix::zeros(states, states);
        let before = DMatrix::from_fn(kept, kept, |i, j| colour.together(i.abs_diff(j)));
        covariance.view_mut((n, n), (kept, kept)).copy_from(&before);
        Whitening::of(covariance, all.into_iter())
    }
}

#[cfg(test)]
mod tests {
    use super::Whitening;
    use crate::{
        Hold, Rig,
        fit::{
            Data, Seen,
            data::Band,
            problem::{Problem, Weights},
            window::{START, Window},
        },
    };
    use nalgebra::DMatrix;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn the_covariance_of_what_is_white_is_one() {
        // Two states that are seen twice, over six samples, each passage another.
        let entry = |k: usize, i: usize, j: usize| (1.0 + (3 * k + i + 2 * j) as f64).sin();
        let by = |k: usize| DMatrix::from_fn(4, 2, |i, j| entry(k, i, j));
        let noise = |k: usize| DMatrix::from_fn(4, 1, |i, _| 2.0 * entry(k, i, 5));
        let whitening =
            Whitening::of(DMatrix::zeros(2, 2), (0..5).map(|k| (by(k), noise(k)))).unwrap();
        // What one deviation of each interval's noise does to all samples, followed by hand.
        let mut b = DMatrix::zeros(12, 5);
        for of in 0..5 {
            let mut state = DMatrix::zeros(2, 1);
            for k in 0..5 {
                let mut next = by(k) * &state;
                if k == of {
                    next += noise(k);
                }
                b.view_mut((2 * (k + 1), of), (2, 1)).copy_from(&next.rows(2, 2));
                state = next.rows(0, 2).into_owned();
            }
        }
        let mut w = DMatrix::identity(12, 12);
        whitening.apply_all(&mut w);
        let white = &w * (DMatrix::identity(12, 12) + &b * b.transpose()) * w.transpose();
        assert!((&white - DMatrix::identity(12, 12)).amax() < 1e-12, "{white}");
        assert!((b.norm() - 1.0).abs() > 1.0, "the noise is seen");
    }

    /// A mass of 1 kg with a drag in which it comes to its speed in 2 ms, far less than a sample.
    const QUICK: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 1.0\nstiffness = 20.0\n\
        [friction]\nname = \"none\"\nsigma_2 = 500.0\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n\
        velocity = \"v\"\n";

    #[test]
    fn noise_hangs_together_where_all_of_a_window_is_in_the_band() {
        let rig = Rig::parse(QUICK).unwrap();
        let time: Vec<f64> = (0..100).map(|i| 0.005 * f64::from(i)).collect();
        let wave = || time.iter().map(|t| (20.0 * t).sin()).collect::<Vec<f64>>();
        let seen = |name: &str| Seen::new(name, wave(), 0.0);
        let driven = Data::driven(time.clone(), wave(), Hold::Linear, seen("position"));
        let driven = Data { velocity: Some(seen("velocity")), ..driven };
        let white = |band: Option<Band>| {
            let data = Data { band, ..driven.clone() };
            let weights = Weights {
                displacement: 1e-5,
                velocity: 4e-4,
                input: 1.0,
                force: 1.0,
                loads: [1.0; 2],
            };
            let problem = Problem { weights, ..Problem::unfree(&rig, &data).unwrap() };
            let window = Window::new(&data, 20, 80);
            let piece = problem.piece(&[], &window, [0.0; START]);
            let whitening = problem.whitening(&[], (&window, &piece), 0.5).unwrap();
            let mut rows = vec![1.0; 120];
            whitening.apply(&mut rows);
            rows
        };
        let outside = |i: usize| {
            let mut inside = vec![true; 100];
            inside[i] = false;
            white(Some(Band { edge: 0.2, inside }))
        };
        assert_eq!(outside(50), white(None));
        assert_ne!(outside(90), white(None));
    }

    #[test]
    fn what_the_noise_of_an_input_leaves_is_white_and_as_large_as_is_said() {
        let mut random = ChaCha8Rng::seed_from_u64(6);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let clean: Vec<f64> = time.iter().map(|t| 20.0 * (0.5 * t).sin()).collect();
        let noise = 0.5;
        let noisy: Vec<f64> = clean.iter().map(|u| u + noise * normal()).collect();
        let weights =
            Weights { displacement: 1e-5, velocity: 4e-4, input: 1.0, force: 1.0, loads: [1.0; 2] };
        let late = format!("{QUICK}[[effect]]\nname = \"input_delay\"\ndelay = 7e-3\n");
        for (hold, text) in [
            (Hold::ZeroOrder, QUICK),
            (Hold::Linear, QUICK),
            (Hold::ZeroOrder, late.as_str()),
            (Hold::Linear, late.as_str()),
        ] {
            let rig = Rig::parse(text).unwrap();
            let seen = |name: &str, values: Vec<f64>| Seen::new(name, values, 0.0);
            let data = |input: &[f64], [q, v]: [Vec<f64>; 2]| {
                let position = seen("position", q);
                let driven = Data::driven(time.clone(), input.to_vec(), hold, position);
                Data { velocity: Some(seen("velocity", v)), ..driven }
            };
            let nothing = data(&clean, [clean.clone(), clean.clone()]);
            let window = Window::new(&nothing, 0, time.len());
            let truth = Problem { weights, ..Problem::unfree(&rig, &nothing).unwrap() };
            let truth = truth.piece(&[], &window, [0.0; START]).motion;
            let mut off = |values: &[f64], by: f64| -> Vec<f64> {
                values.iter().map(|value| value + by * normal()).collect()
            };
            let shown = [off(&truth.q, weights.displacement), off(&truth.v, weights.velocity)];
            let data = data(&noisy, shown);
            let problem =
                Problem { weights, tolerance: 1e-4, ..Problem::unfree(&rig, &data).unwrap() };
            let mut left = problem.piece(&[], &window, [0.0; START]);
            let whitening = problem.whitening(&[], (&window, &left), noise).unwrap();
            let rows = &mut left.residuals[..2 * time.len()];
            let square = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>() / r.len() as f64;
            assert!(square(rows) > 3.0, "the noise is seen");
            whitening.apply(rows);
            let hangs = |r: &[f64], apart: usize| {
                r.iter().zip(&r[apart..]).map(|(a, b)| a * b).sum::<f64>() / r.len() as f64
            };
            // Of 8000 residuals a mean square is off by √(2/8000) = 0.016, a correlation by 0.011.
            let [one, beside] = [square(rows), hangs(rows, 2)];
            assert!(
                (one - 1.0).abs() < 0.05 && beside.abs() < 0.04,
                "{hold:?} {text}: {one} {beside}"
            );
        }
    }
}
