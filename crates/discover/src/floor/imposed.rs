//! What the noise of an imposed displacement leaves on its way through a contact.

use crate::board::{Board, Fitted};
use identify::{
    Rig,
    fit::{
        Data, FitError, models,
        problem::{Piece, Problem},
        shaken::Shaken,
        whitening::Whitening,
    },
    march::{Contact, Model},
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use std::sync::Arc;

/// How many times the displacement is perturbed by its own noise.
const TIMES: u64 = 16;

/// How many samples to either side tell of one sample's spread.
const AROUND: usize = 1;

/// By how much the force at every sample spreads [N], and what makes the rest independent.
type Floor = (Vec<f64>, Option<Arc<Whitening>>);

/// What the noise of an imposed displacement makes of a model's force: by how much every sample spreads beside what
/// follows from it to first order [N], and what makes the rest independent. Turns are noisier than the rest, so that
/// this is local in time.
pub(crate) fn imposed(board: &Board<'_>, fitted: &Fitted, seed: u64) -> Result<Floor, FitError> {
    let board = &Board { spread: Vec::new(), whitening: None, ..board.clone() };
    let rig = fitted.held();
    let problem = board.problem(&rig, |_| true)?;
    let turns = turns_at_once(&problem.model(&[]));
    let shown = || crate::rest::noise_of_displacement(&board.data.input);
    let Some(shaken) = problem.shaken(&[], board.data.averaged.unwrap_or_else(shown)) else {
        return Ok((timed(board.data, turns, Vec::new()), None));
    };
    let here = models::settled(&problem, &[], Some(&fitted.pieces), 1);
    let draws: Result<Vec<Vec<f64>>, FitError> = (0..TIMES)
        .into_par_iter()
        .map(|time| one(board, (&rig, &here[0]), (&shaken, seed.wrapping_add(time))))
        .collect();
    let mut squares = vec![0.0; board.data.time.len()];
    for draw in draws? {
        for (square, d) in squares.iter_mut().zip(&draw) {
            *square += d * d / TIMES as f64;
        }
    }
    let local = |i: usize| {
        let near = &squares[i.saturating_sub(AROUND)..(i + AROUND + 1).min(squares.len())];
        (near.iter().sum::<f64>() / near.len() as f64).sqrt()
    };
    let spread = timed(board.data, turns, (0..squares.len()).map(local).collect());
    let weighed = Problem { spread: &spread, ..problem };
    let whitening = shaken.whitening(&weighed).map(Arc::new);
    Ok((spread, whitening))
}

/// By what one draw of the displacement's noise moves the force of every sample, less what it does to first order [N].
fn one(
    board: &Board<'_>,
    (rig, undisturbed): (&Rig, &Piece),
    (shaken, seed): (&Shaken, u64),
) -> Result<Vec<f64>, FitError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let (errors, first) = shaken.drawn(&mut || StandardNormal.sample(&mut random));
    let mut data: Data = board.data.clone();
    for (u, error) in data.input.iter_mut().zip(errors) {
        *u += error;
    }
    let other = Board { data: &data, ..board.clone() };
    let problem = other.problem(rig, |_| true)?;
    let there = models::settled(&problem, &[], Some(std::slice::from_ref(undisturbed)), 1);
    let pairs = there[0].motion.q.iter().zip(&undisturbed.motion.q).zip(first);
    Ok(pairs.map(|((there, here), first)| there - here - first).collect())
}

/// How well the time of a sample is known, in sampling times: at a corner there are two velocities, and a friction that
/// turns at once does so between two samples.
const CORNER: f64 = 2.0;
const TURN: f64 = 0.1;

/// Whether a model has a friction that turns with the velocity, at once.
pub(crate) fn turns_at_once(model: &Model<f64>) -> bool {
    matches!(model.contact, Contact::Coulomb { .. }) || model.effects.iter().any(|e| e.kind.dry())
}

/// The spread with that of a force that changes from sample to sample: at a corner, and where it `turns_at_once`, it is
/// worth what its time is.
pub(crate) fn timed(data: &Data, turns_at_once: bool, spread: Vec<f64>) -> Vec<f64> {
    let Some(force) = &data.force else { return spread };
    let f = &force.values;
    let corners = identify::fit::corners(&data.input);
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
    use super::{
        Board, ChaCha8Rng, Data, Distribution, Fitted, Rig, SeedableRng, StandardNormal, imposed,
        timed,
    };
    use identify::fit::{Seen, search::Patience};

    #[test]
    fn noise_does_not_shake_an_imposed_motion_at_rest() {
        // Half a second of rest and half a second of motion in turn, forth and back; displacement to 1 µm.
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut noise = |size: f64| -> f64 {
            let drawn: f64 = StandardNormal.sample(&mut random);
            size * drawn
        };
        let rests = |i: usize| i % 200 < 100;
        let way = |i: usize| if i % 400 < 200 { 1.0 } else { -1.0 };
        let (mut x, mut last) = (0.0, 0.0);
        let (mut input, mut force) = (Vec::new(), Vec::new());
        for i in 0..8000 {
            if !rests(i) {
                (x, last) = (x + 1e-4 * way(i), way(i));
            }
            input.push(x + noise(1e-6));
            force.push(1.5 * last + noise(1e-3));
        }
        let time = (0..8000).map(|i| 0.005 * f64::from(i)).collect();
        let seen = Seen::new("force", force, 0.0);
        let driven = Data::driven(time, input, identify::Hold::Linear, seen.clone());
        let data = Data { displacement: None, force: Some(seen), ..driven };
        let data = crate::rest::rested(&data);
        let rig = "title = \"a slide\"\n[plant]\nkind = \"prescribed\"\n[friction]\nname = \"coulomb\"\nf_c = 1.5\n\
            [channels]\ntime = \"t\"\ndisplacement = \"x\"\nforce = \"f\"\n";
        let rig = Rig::parse(rig).unwrap();
        let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let fitted = board.judged(&rig, None).unwrap();
        let (all, _) = imposed(&board, &fitted, 1).unwrap();
        // Away from the turns, whose time noise does move.
        let resting = (0..8000).filter(|i| (20..80).contains(&(i % 200)));
        let worst = resting.map(|i| all[i]).fold(0.0, f64::max);
        assert!(worst < 1e-3, "{worst} N of 1.5 N");
    }

    /// A sine of 3 mm under a bristle's friction, seen with this noise [m] and to 1 mN, and its rig.
    fn trembling(noise: f64) -> (Rig, Data) {
        let rig = "title = \"a slide\"\n[plant]\nkind = \"prescribed\"\n[friction]\nname = \"lugre\"\nf_c = 1.0\nf_s = 1.3\n\
            v_s = 0.01\nsigma_0 = 2e3\nsigma_1 = 3.0\nsigma_2 = 4.0\n[fit]\nfree = [\"f_c\", \"sigma_0\", \"sigma_2\"]\n\
            [channels]\ntime = \"t\"\ndisplacement = \"x\"\nforce = \"f\"\n";
        let rig = Rig::parse(rig).unwrap();
        let time: Vec<f64> = (0..6000).map(|i| 0.005 * f64::from(i)).collect();
        let input: Vec<f64> = time.iter().map(|t| 3e-3 * (4.0 * t).sin()).collect();
        let record = |input: Vec<f64>, force: Vec<f64>| {
            let seen = Seen::new("force", force, 0.0);
            let driven = Data::driven(time.clone(), input, identify::Hold::Linear, seen.clone());
            Data { displacement: None, force: Some(seen), ..driven }
        };
        // Its own force, from a first one of nothing.
        let any = (0..time.len()).map(|i| if i == 0 { 0.0 } else { 1.0 }).collect();
        let still = record(input.clone(), any);
        let clean = Board::of(&rig, &still, 1, Vec::new()).unwrap();
        let force = clean.judged(&Fitted::holding(&rig), None).unwrap().pieces.remove(0).motion.q;
        let mut random = ChaCha8Rng::seed_from_u64(8);
        let mut noisy = |all: Vec<f64>, size: f64| -> Vec<f64> {
            let one = |value: f64| {
                let drawn: f64 = StandardNormal.sample(&mut random);
                value + size * drawn
            };
            all.into_iter().map(one).collect()
        };
        let (input, force) = (noisy(input, noise), noisy(force, 1e-3));
        (rig, record(input, force))
    }

    #[test]
    fn a_friction_is_not_smaller_for_the_noise_of_an_imposed_motion() {
        // Bristles that 3 µm of noise shakes by 6 mN are weaker than they are, by many standard errors, but where the sine is
        // known by its band.
        let (rig, data) = trembling(3e-6);
        let off = |data: &Data| {
            let mut board = Board::of(&rig, data, 1, Vec::new()).unwrap();
            let mut fitted = board.judged(&rig, None).unwrap();
            for _ in 0..2 {
                board.refloor(&fitted, 0).unwrap();
                let from = Some((&fitted.x[..], &fitted.pieces[..]));
                let patience = Patience { misfit: 0.01, share: 1e-6, simulations: 20 };
                fitted = board.fit(&fitted.rig, from, &patience).unwrap();
            }
            let found = ["f_c", "sigma_0", "sigma_2"].map(|k| fitted.rig.value(k).unwrap());
            let truth = [1.0, 2e3, 4.0];
            let off = found.iter().zip(truth).map(|(found, truth)| (found / truth - 1.0).abs());
            (off.fold(0.0, f64::max), board.trained_level(&fitted))
        };
        let (before, _) = off(&crate::rest::rested(&data));
        let (after, level) = off(&crate::rest::still(&data));
        assert!(before > 0.01 && after < 0.2 * before, "{after} off, {before} as recorded");
        assert!((level - 1.0).abs() < 0.1, "{level} floors");
    }

    #[test]
    fn a_right_model_of_an_imposed_motion_leaves_its_floor() {
        let (rig, data) = trembling(5e-7);
        let mut board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let level =
            |fitted: &Fitted| fitted.blocks.iter().flatten().sum::<f64>() / data.time.len() as f64;
        let fitted = board.judged(&rig, None).unwrap();
        let without = level(&fitted);
        board.refloor(&fitted, 1).unwrap();
        let with = level(&board.again(&fitted).unwrap());
        // Of 6000 samples a mean square is off by 0.018; how large the noise is is known to a twentieth.
        assert!(without > 2.0 && (with - 1.0).abs() < 0.1, "{with}, without a floor {without}");
    }

    #[test]
    fn derivatives_of_what_was_made_white_are_those_of_its_residuals() {
        let (rig, data) = trembling(5e-7);
        let mut board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let fitted = board.judged(&rig, None).unwrap();
        board.refloor(&fitted, 1).unwrap();
        let problem = board.problem(&rig, |k| board.trains[k]).unwrap();
        let (window, start) = (&problem.windows[0], fitted.pieces[0].start);
        let piece = problem.piece(&fitted.x, window, start);
        let slopes = problem.slopes(&fitted.x, window, &piece).jacobian;
        for i in 0..fitted.x.len() {
            let [up, down] = [1e-5, -1e-5].map(|by| {
                let mut x = fitted.x.clone();
                x[i] += by;
                problem.piece(&x, window, start).residuals
            });
            let most = slopes.column(i).amax();
            for (k, (up, down)) in up.iter().zip(&down).enumerate() {
                let off = slopes[(k, i)] - (up - down) / 2e-5;
                assert!(off.abs() < 1e-4 * most, "{off} of {most} at sample {k}");
            }
        }
        let judged = problem.piece(&fitted.x, window, start).residuals;
        assert!(judged.contains(&0.0), "the judging blocks have no share");
    }

    #[test]
    fn what_turns_at_once_is_worth_its_time_at_the_turn() {
        let time: Vec<f64> = (0..200).map(|i| 0.005 * f64::from(i)).collect();
        let input: Vec<f64> = time.iter().map(|t| (8.0 * t).cos()).collect();
        let force = time.iter().map(|t| if (8.0 * t).sin() > 0.0 { -1.5 } else { 1.5 }).collect();
        let seen = Seen::new("force", force, 0.0);
        let driven = Data::driven(time, input, identify::Hold::Linear, seen.clone());
        let data = Data { displacement: None, force: Some(seen), ..driven };
        let [dry, other] = [true, false].map(|at_once| timed(&data, at_once, Vec::new()));
        // It turns at π/8 s, 78.5 samples; by 3 N over two sampling times, a tenth of one of them known.
        assert!((dry[78] - 0.15).abs() < 1e-12 && dry[40] == 0.0, "{} N", dry[78]);
        assert!(other.iter().all(|own| *own == 0.0));
    }
}
