//! What makes the noise of the recorded input smooth.
//!
//! An input that comes late by a part of a sample is a mean of two, and what a sensor shows late is one of what was: with
//! either the model is moved less by the noise that was recorded, and leaves less, whether or not it is there. What is there
//! is nearer as well where that noise is taken away before.
//!
//! So is any model through which less of that noise gets, as one with more drag or more mass: what noise leaves is weighed as the
//! model before foretold it. The least of ‖W r(θ)‖² over θ at a fixed W is not at the truth, for r holds what the noise of
//! the input does in the very model that is asked (errors in variables); with W(θ) of each model's own its expectation is the
//! number of residuals there, to first order, whatever the noise.

use super::{
    Walk,
    named::{NOTHING, TOLD},
};
use crate::{board::Fitted, model::Candidate};
use identify::{
    effects::Kind,
    fit::{Data, FitError},
};

/// A model that leaves so many floors is moved by more than noise.
const FAR: f64 = 3.0;

/// A sample of the input is put on the parabola through so many on either side, none of which is further from it than so
/// many standard deviations of their noise.
const BESIDE: usize = 4;
const WITHIN: f64 = 4.0;

/// So much of what it gains it gains without that noise. Of noise of which a quarter is left, along a parabola, a mean of two
/// samples takes a fiftieth of what it takes of all.
const STAYS: f64 = 0.1;

/// Weighed by its own noise a model gains so much of what it gains, or so many squared standard errors, as are asked of what is
/// told: of three effects that were there nine tenths and more were left, of four that were not a fifth at most, and mostly
/// they lost.
const OWN: f64 = 0.5;

impl Walk<'_> {
    /// A model near the floor, weighed by what the noise of the input makes of itself; none elsewhere.
    pub(super) fn weighed(&self, fitted: &Fitted) -> Option<Fitted> {
        if self.board.imposed() || self.judged(&fitted.blocks).level() > NOTHING {
            return None;
        }
        let mut board = self.board.clone();
        board.refloor(fitted, 0).ok()?;
        board.again(fitted).ok()
    }

    /// Whether a candidate is nearer not only because less noise gets through it, where the last model, weighed by its own noise,
    /// is this one.
    pub(super) fn beyond_noise(&self, weighed: Option<&Fitted>, candidate: &Candidate) -> bool {
        let there = &candidate.fitted;
        let gains = |a: &Fitted, b: &Fitted| {
            [self.judged(&a.blocks).gained(&self.judged(&b.blocks)), a.sum() - b.sum()]
        };
        let (Some(without), with) = (weighed, gains(&self.best, there)) else { return true };
        if with.iter().all(|gain| *gain < TOLD) {
            return true;
        }
        let Some(there) = self.weighed(there) else { return true };
        let own = gains(without, &there);
        let stays = |k: usize, worth: f64| own[k] > (OWN * with[k]).clamp(0.0, worth);
        stays(0, TOLD) || own[0] > 0.0 && stays(1, 2.0 * TOLD)
    }

    /// Whether a candidate is nearer not only because it makes noise smooth.
    pub(super) fn sharper(&self, candidate: &Candidate) -> bool {
        let smooths = matches!(candidate.kind, Kind::InputDelay | Kind::VelocityLag);
        if !smooths || self.board.imposed() || self.judged(&candidate.fitted.blocks).level() > FAR {
            return true;
        }
        let input = smooth(&self.board.data.input, self.board.data.noise_of_input());
        let data = Data { input, ..self.board.data.clone() };
        let mut board = self.board.clone();
        board.data = &data;
        let judged = |fitted| Ok::<_, FitError>(self.judged(&board.again(fitted)?.blocks));
        let without =
            judged(&self.best).and_then(|best| Ok(best.gained(&judged(&candidate.fitted)?)));
        let with = self.judged(&self.best.blocks).gained(&self.judged(&candidate.fitted.blocks));
        without.is_ok_and(|without| without > STAYS * with)
    }
}

/// The values, as far apart from each other in time, each on the parabola through those beside it where these lie along one
/// but for their `noise`.
fn smooth(values: &[f64], noise: f64) -> Vec<f64> {
    let far = BESIDE as f64;
    let n = 2.0 * far + 1.0;
    // Over -far..far the sums of squares and of fourth powers.
    let squares = far * (far + 1.0) * n / 3.0;
    let fourths = squares * (3.0 * far * far + 3.0 * far - 1.0) / 5.0;
    let mut smooth = values.to_vec();
    for (i, near) in values.windows(2 * BESIDE + 1).enumerate() {
        let at = |k: usize| k as f64 - far;
        let sum = |power: i32| -> f64 {
            near.iter().enumerate().map(|(k, u)| at(k).powi(power) * u).sum()
        };
        let bend = (n * sum(2) - squares * sum(0)) / (n * fourths - squares * squares);
        let (middle, slope) = ((sum(0) - bend * squares) / n, sum(1) / squares);
        let off = |(k, u): (usize, &f64)| (u - middle - (slope + bend * at(k)) * at(k)).abs();
        if near.iter().enumerate().map(off).all(|off| off <= WITHIN * noise) {
            smooth[i + BESIDE] = middle;
        }
    }
    smooth
}

#[cfg(test)]
mod tests {
    use super::smooth;
    use crate::{
        board::{FINE, Fitted},
        model::Candidate,
        walk::made::{walk, with},
    };
    use identify::{
        Hold, Rig,
        effects::Kind,
        fit::{Data, Seen},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// A mass of 1 kg on a spring of 20 N/m with a drag of 2500 N·s/m, in which it comes to its speed in 0.4 ms, under a force
    /// of 100 N, of so many radians a second, that comes so late [s] and is recorded with noise of 2.5 N.
    fn late(omega: f64, delay: f64) -> (Rig, Data) {
        let rig = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 1.0\nstiffness = 20.0\n\
            [friction]\nname = \"none\"\nsigma_2 = 2500.0\n[channels]\ntime = \"t\"\nforce = \"f\"\n\
            position = \"x\"\nvelocity = \"v\"\n";
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let input = time.iter().map(|t| 100.0 * (omega * t).sin() + 2.5 * noise()).collect();
        // x = 100/|z| sin(ω(t − delay) − arg z) with z = k − mω² + icω.
        let (real, imaginary) = (20.0 - omega * omega, 2500.0 * omega);
        let (long, behind) = (100.0 / real.hypot(imaginary), imaginary.atan2(real) + omega * delay);
        let x = time.iter().map(|t| long * (omega * t - behind).sin() + 1e-4 * noise()).collect();
        let v = time.iter().map(|t| long * omega * (omega * t - behind).cos() + 1e-4 * noise());
        let v = Seen::new("velocity", v.collect(), 0.0);
        let driven = Data::driven(time, input, Hold::Linear, Seen::new("position", x, 0.0));
        (Rig::parse(rig).unwrap(), Data { velocity: Some(v), ..driven })
    }

    #[test]
    fn what_makes_noise_smooth_is_not_there_for_that() {
        // What is slow shows nothing of 2 ms but the noise.
        for (omega, delay, there) in [(0.5, 0.0, false), (5.0, 2e-3, true)] {
            let (rig, data) = late(omega, delay);
            let mut walk = walk(&rig, &data, &[]);
            let best = walk.board.refined(&walk.best.clone(), FINE).unwrap();
            walk.board.refloor(&best, 0).unwrap();
            walk.best = walk.board.again(&best).unwrap();
            let rig = with(&rig, Kind::InputDelay, &[2e-3]);
            let fitted = walk.board.judged(&rig, Some(&walk.best.pieces)).unwrap();
            let [alone, late] = [&walk.best, &fitted].map(|f| walk.judged(&f.blocks).level());
            assert!(late < 0.9 * alone && late < super::FAR, "{late} {alone}");
            let candidate = Candidate { kind: Kind::InputDelay, fitted };
            assert_eq!(walk.sharper(&candidate), there);
            assert!(walk.beyond_noise(None, &candidate), "far off nobody asks");
        }
    }

    #[test]
    fn what_lets_less_noise_through_is_not_there_for_that() {
        // 2 kg on 3 N/m with 0.5 N·s/m, that come 2 cm far under a force recorded with 0.3 N of noise: a mass that is too large
        // leaves less of it, as the right one does.
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..8000).map(|i| 0.005 * f64::from(i)).collect();
        let force = |t: f64| {
            let (s, c) = f64::sin_cos(2.0 * t);
            0.02 * ((3.0 - 2.0 * 4.0) * s + 0.5 * 2.0 * c)
        };
        let input = time.iter().map(|t| force(*t) + 0.3 * noise()).collect();
        let seen = time.iter().map(|t| 0.02 * (2.0 * t).sin() + 1e-4 * noise()).collect();
        let data = Data::driven(time, input, Hold::Linear, Seen::new("position", seen, 0.0));
        for (mass, ratio) in [(2.0, 0.4), (1.0, 1.0), (0.8, 1.5)] {
            let rig = crate::walk::made::rig(mass);
            let mut walk = walk(&rig, &data, &[]);
            walk.board.refloor(&walk.best.clone(), 0).unwrap();
            walk.best = walk.board.again(&walk.best).unwrap();
            let weighed = walk.weighed(&walk.best);
            let level = |fitted: &Fitted| walk.judged(&fitted.blocks).level();
            let heavier = with(&rig, Kind::Inertia, &[ratio]);
            let fitted = walk.board.judged(&heavier, Some(&walk.best.pieces)).unwrap();
            let left = [level(&walk.best), level(&fitted)];
            assert!(left[1] < 0.98 * left[0] && weighed.is_some(), "{left:?} of {mass} kg");
            let candidate = Candidate { kind: Kind::Inertia, fitted };
            assert_eq!(walk.beyond_noise(weighed.as_ref(), &candidate), mass < 2.0, "{mass} kg");
        }
    }

    #[test]
    fn what_lies_along_a_parabola_loses_its_noise_and_a_step_stays() {
        let noise = |i: i32| 0.01 * (f64::from(i * i) * 1.7).sin();
        let parabola = |i: i32| 1.0 + 0.02 * f64::from(i) - 1e-4 * f64::from(i * i);
        let seen: Vec<f64> = (0..400).map(|i| parabola(i) + noise(i)).collect();
        let off = |values: &[f64]| {
            let all = (0..).zip(values).skip(4).take(392);
            all.map(|(i, u)| (u - parabola(i)).powi(2)).sum::<f64>().sqrt()
        };
        // A parabola through 9 samples leaves 59/231 of the variance of white noise at the middle one.
        let left = off(&smooth(&seen, 0.01)) / off(&seen);
        assert!((left - (59.0_f64 / 231.0).sqrt()).abs() < 0.06, "{left}");
        let step: Vec<f64> = (0..40).map(|i| if i < 20 { 0.0 } else { 1.0 }).collect();
        assert_eq!(smooth(&step, 0.01), step);
    }
}
