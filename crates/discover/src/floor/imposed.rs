//! What the noise of an imposed displacement leaves on its way through a contact.

use crate::board::{Board, Fitted};
use identify::fit::{FitError, floor::Floor};

/// What the noise of an imposed displacement makes of a model's force.
pub(crate) fn imposed(board: &Board<'_>, fitted: &Fitted, seed: u64) -> Result<Floor, FitError> {
    let rig = fitted.held();
    Ok(board.problem(&rig, |_| true)?.floor(&[], &fitted.pieces[0], seed))
}

#[cfg(test)]
mod tests {
    use super::{Board, Fitted, imposed};
    use identify::{
        Rig,
        fit::{Data, Seen, search::Patience},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

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
        let data = identify::known::rested(&data);
        let rig = "title = \"a slide\"\n[plant]\nkind = \"prescribed\"\n[friction]\nname = \"coulomb\"\nf_c = 1.5\n\
            [channels]\ntime = \"t\"\ndisplacement = \"x\"\nforce = \"f\"\n";
        let rig = Rig::parse(rig).unwrap();
        let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let fitted = board.judged(&rig, None).unwrap();
        let all = imposed(&board, &fitted, 1).unwrap().spread;
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
        let (before, _) = off(&identify::known::rested(&data));
        let (after, level) = off(&identify::known::still(&data));
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
}
