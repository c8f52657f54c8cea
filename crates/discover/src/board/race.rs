//! Several models fitted at once, of which the worse ones are left behind.

use super::{Board, Fitted, with_values};
use identify::{
    Rig,
    effects::Kind,
    fit::{
        descent::Descent,
        problem::{Piece, Problem},
        search::Patience,
        starts,
    },
};
use rayon::prelude::*;

/// Some of the training blocks are one in so many.
const FEW: usize = 3;

/// The first heat is run on some, but on no fewer than so many.
const LEAST: usize = 6;

impl Board<'_> {
    /// Fits models on the training blocks, each from its own values; after each of the `heats`, of so many simulations in
    /// all, only so many of the best are kept. Those, the best first by the logarithms of their windows' misfits, with
    /// the mean of these. What cannot be simulated is none of them.
    ///
    /// Where a search ends is seen long before it ends: successive halving (Jamieson and Talwalkar, Proceedings of
    /// Machine Learning Research 51, 2016).
    pub(crate) fn raced(
        &self,
        rigs: &[(Kind, Rig)],
        heats: &[(usize, usize)],
        patience: &Patience,
    ) -> Vec<(f64, Kind, Rig)> {
        let mut heats: Vec<(usize, usize)> = heats.to_vec();
        heats.push((patience.simulations, usize::MAX));
        let (training, few) = (self.training(), self.few(LEAST));
        let (simulations, kept) = heats[0];
        // An imposed motion is one run whatever is taken of it.
        if self.imposed() || few.len() == training.len() || rigs.len() <= kept {
            return self.run(rigs, &training, &heats, patience);
        }
        let left = self.run(rigs, &few, &heats[..1], patience);
        let left: Vec<(Kind, Rig)> = left.into_iter().map(|(_, kind, rig)| (kind, rig)).collect();
        for (so_many, _) in &mut heats {
            *so_many -= simulations;
        }
        self.run(&left, &training, &heats[1..], patience)
    }

    /// What a model leaves, in the measure of a race.
    pub(crate) fn far(&self, fitted: &Fitted) -> f64 {
        let trains = |w: &usize| self.imposed() || self.trains[self.block(*w)];
        far((0..fitted.pieces.len()).filter(trains).map(|w| &fitted.pieces[w]))
    }

    /// The training blocks.
    fn training(&self) -> Vec<usize> {
        (0..self.trains.len()).filter(|k| self.trains[*k]).collect()
    }

    /// Some of them, or all where these would be fewer than `least`: who is last is seen on some.
    pub(super) fn few(&self, least: usize) -> Vec<usize> {
        let all = self.training();
        let few: Vec<usize> = all.iter().copied().step_by(FEW).collect();
        if few.len() < least { all } else { few }
    }

    /// The heats of a race on these blocks.
    fn run(
        &self,
        rigs: &[(Kind, Rig)],
        blocks: &[usize],
        heats: &[(usize, usize)],
        patience: &Patience,
    ) -> Vec<(f64, Kind, Rig)> {
        let problems: Vec<(Kind, Problem<'_>)> = rigs
            .iter()
            .filter_map(|(kind, rig)| {
                Some((*kind, self.problem(rig, |k| blocks.contains(&k)).ok()?))
            })
            .collect();
        let mut all: Vec<(Kind, &Problem<'_>, Descent<'_, '_>)> = problems
            .par_iter()
            .map(|(kind, problem)| {
                (*kind, problem, Descent::of(problem, &starts::nominal(problem), None))
            })
            .collect();
        let far = |descent: &Descent<'_, '_>| far(descent.pieces().iter());
        for (simulations, kept) in heats.iter().copied() {
            let heat = Patience { simulations, ..*patience };
            all.par_iter_mut().for_each(|(.., descent)| descent.go(&heat));
            all.sort_by(|a, b| far(&a.2).total_cmp(&far(&b.2)));
            all.truncate(kept);
        }
        let fitted = all.into_iter().map(|(kind, problem, descent)| {
            (far(&descent), kind, with_values(problem.rig, problem, &descent.found().x))
        });
        fitted.collect()
    }
}

/// The mean logarithm of the windows' misfits.
fn far<'p>(pieces: impl Iterator<Item = &'p Piece>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for piece in pieces {
        sum += piece.logarithm();
        count += 1.0;
    }
    sum / f64::max(count, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gram;
    use identify::fit::{Data, Seen};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    const RIG: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n\
        [friction]\nname = \"none\"\nsigma_2 = 0.5\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n";

    #[test]
    fn what_the_record_lacks_is_not_left_behind() {
        // x = sin ωt under the force that the rig's equation asks for, but for a bias of 0.3 N; noise of 1 mm.
        let (omega, bias) = (2.0, 0.3);
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let input = time.iter().map(|t| {
            let (s, c) = f64::sin_cos(omega * t);
            (3.0 - 2.0 * omega * omega) * s + 0.5 * omega * c - bias
        });
        let input = input.collect();
        let seen = time.iter().map(|t| (omega * t).sin() + 1e-3 * noise()).collect();
        let position = Seen::new("position", seen, 0.0);
        let data = Data::driven(time, input, identify::Hold::Linear, position);
        let rig = Rig::parse(RIG).unwrap();
        let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let all = [Kind::QuadraticDrag, Kind::CubicSpring, Kind::CurrentBias].map(|kind| {
            let mut rig = rig.clone();
            gram::with(&mut rig, kind, &[], 0);
            (kind, rig)
        });
        let patience = Patience { misfit: 0.1, share: 0.0, simulations: 20 };
        let left = board.raced(&all, &[(6, 1)], &patience);
        assert_eq!(left.len(), 1);
        assert_eq!(left[0].1, Kind::CurrentBias);
        let found = left[0].2.value("current_bias.bias").unwrap();
        // An acceleration is known from n samples of noise σ within a time T to σ √(720/n)/T², the start being free: of
        // 2 kg in the 16 windows of 0.625 s that are fitted to 3.1 mN.
        assert!((found - bias).abs() < 4.0 * 3.1e-3, "{found} N of {bias} N");
    }
}
