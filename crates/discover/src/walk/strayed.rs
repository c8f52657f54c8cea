//! What is given and not free, and went far from there when it was a little loose: a model that lacks something makes
//! up for it with what it can.

use super::{REFIT, Walk, settled};
use crate::board::{self, Fitted};
use identify::{
    Rig,
    fit::{FitError, binding},
};

/// A model with what was loose in it.
#[derive(Debug)]
pub(super) struct Loosened {
    best: Fitted,
    loose: Vec<(String, f64)>,
    strayed: Vec<(String, f64)>,
}

impl Walk<'_> {
    /// What had strayed because an effect was missing is a little loose again where it no longer strays.
    pub(super) fn reclaim(&mut self) -> Result<(), FitError> {
        self.before_held = None;
        if self.strayed.is_empty() {
            return Ok(());
        }
        let rig = board::loosened(&self.best.rig, &self.strayed);
        let held = self.board.loose.clone();
        self.board.loose.extend(self.strayed.iter().cloned());
        let fitted = self.board.fit_near(&rig, &self.best.pieces, &REFIT)?;
        let better = self.board.trained(&fitted) < self.board.trained(&self.best);
        if better && self.board.strayed(&fitted).is_empty() {
            self.best = fitted;
            self.strayed.clear();
        } else {
            self.board.loose = held;
        }
        self.short.loose.clone_from(&self.board.loose);
        Ok(())
    }

    /// What strays beside an effect is held where it was given: it stands for what is still missing, and where it
    /// makes up for nearly all of that nothing would be looked for.
    pub(super) fn hold_strayed(&mut self, seed: u64) -> Result<(), FitError> {
        let names = self.board.strayed(&self.best);
        if names.is_empty() {
            return Ok(());
        }
        let before = Loosened {
            best: self.best.clone(),
            loose: self.board.loose.clone(),
            strayed: self.strayed.clone(),
        };
        let (held, loose) = before.loose.iter().cloned().partition(|own| names.contains(&own.0));
        self.board.loose = loose;
        let held: Vec<(String, f64)> = held;
        let mut rig = self.best.rig.clone();
        for (name, given) in &held {
            binding::set(&mut rig, name, *given);
        }
        let rig = Rig {
            free: rig.free.iter().filter(|free| !names.contains(free)).cloned().collect(),
            ..rig
        };
        let fitted = self.board.fit_near(&rig, &self.best.pieces, &REFIT)?;
        self.best = settled(&mut self.board, fitted, seed)?;
        self.strayed.extend(held);
        self.short.loose.clone_from(&self.board.loose);
        self.before_held = Some(before);
        Ok(())
    }

    /// Where nothing was found beside what is held, it is as it was.
    pub(super) fn loosen_held(&mut self) {
        if let Some(before) = self.before_held.take() {
            self.best = before.best;
            self.board.loose = before.loose;
            self.strayed = before.strayed;
            self.short.loose.clone_from(&self.board.loose);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        board::{loose, loosened},
        verdict::Options,
        walk::{
            made::{data, rig, walk, with},
            walked,
        },
    };
    use identify::{
        Hold, Rig,
        effects::Kind,
        fit::{Data, Seen},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn what_strays_is_held_where_it_was_given() {
        // Of 2 kg 1 is told; with the bias taken away the rest is made up for by the mass.
        let own = [("mass".to_owned(), 1.0)];
        let data = data();
        let mut walk = walk(&loosened(&rig(1.0), &own), &data, &own);
        let found = with(&loosened(&rig(2.0), &own), Kind::CurrentBias, &[0.3]);
        walk.best = walk.board.judged(&found, None).unwrap();
        let level = walk.judged(&walk.best.blocks).level();
        assert!(level < 1.5, "{level}");
        walk.hold_strayed(0).unwrap();
        let held = &walk.best.rig;
        assert_eq!((held.value("mass"), held.free.contains(&own[0].0)), (Some(1.0), false));
        assert_eq!((walk.board.loose.len(), walk.short.loose.len()), (0, 0));
        assert_eq!(walk.strayed, own);
        let there = walk.judged(&walk.best.blocks).level();
        assert!(there > 100.0 * level, "{there}");
        // Loose again it would stray again.
        walk.reclaim().unwrap();
        assert_eq!((&walk.strayed[..], walk.board.loose.len()), (&own[..], 0));
        assert!(walk.before_held.is_none());
    }

    #[test]
    fn what_was_held_for_nothing_is_as_it_was() {
        let own = [("mass".to_owned(), 1.0)];
        let data = data();
        let mut walk = walk(&loosened(&rig(1.0), &own), &data, &own);
        let found = with(&loosened(&rig(2.0), &own), Kind::CurrentBias, &[0.3]);
        walk.best = walk.board.judged(&found, None).unwrap();
        walk.hold_strayed(0).unwrap();
        walk.loosen_held();
        assert_eq!(walk.best.rig.value("mass"), Some(2.0));
        assert_eq!((walk.board.loose.len(), walk.short.loose.len()), (1, 1));
        assert!(walk.strayed.is_empty());
    }

    #[test]
    fn what_no_longer_strays_is_loose_again() {
        let own = [("mass".to_owned(), 2.02)];
        let data = data();
        let mut walk = walk(&rig(2.02), &data, &[]);
        walk.strayed = own.to_vec();
        let found = with(&rig(2.02), Kind::CurrentBias, &[0.3]);
        walk.best = walk.board.judged(&found, None).unwrap();
        walk.reclaim().unwrap();
        assert!(walk.strayed.is_empty());
        assert_eq!((&walk.board.loose[..], &walk.short.loose[..]), (&own[..], &own[..]));
        let mass = walk.best.rig.value("mass").unwrap();
        assert!((mass - 2.0).abs() < 0.005, "{mass} kg");
    }

    /// A drum with viscous friction, its two springs drawn to so many newtons and said to be drawn to 12 N.
    const DRUM: &str = "title = \"a drum\"\n[plant]\nkind = \"drum\"\ninertia = 0.01\nradius = 0.05\nk_1 = 150.0\n\
        k_2 = 150.0\nf_10 = 12.0\nf_20 = 12.0\nmotor_constant = 2.0\ngear_ratio = 10.0\n[friction]\nname = \"none\"\n\
        sigma_2 = 0.02\n[fit]\nfree = [\"sigma_2\"]\n[channels]\ntime = \"t\"\ncurrent = \"i\"\nangle = \"q\"\n\
        force_1 = \"a\"\nforce_2 = \"b\"\n";

    fn drum(pulls: [f64; 2]) -> Data {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let angle = |t: f64| 0.3 * (2.0 * t).sin() + 0.1 * (5.0 * t).sin();
        let [one, other] = [
            |pull: f64, q: f64| pull + 150.0 * 0.05 * q,
            |pull: f64, q: f64| pull - 150.0 * 0.05 * q,
        ];
        let current = time.iter().map(|t| {
            let (q, slow, fast) = (angle(*t), 2.0 * t, 5.0 * t);
            let v = 0.3 * 2.0 * slow.cos() + 0.1 * 5.0 * fast.cos();
            let v_dot = -0.3 * 4.0 * slow.sin() - 0.1 * 25.0 * fast.sin();
            (0.01 * v_dot + 0.02 * v + 0.05 * (one(pulls[0], q) - other(pulls[1], q))) / 2.0
        });
        let current = current.collect();
        let mut seen = |name: &str, noisy: f64, of: &dyn Fn(f64) -> f64| {
            Seen::new(name, time.iter().map(|t| of(*t) + noisy * noise()).collect(), 0.0)
        };
        let loads = [
            seen("force_1", 0.1, &|t| one(pulls[0], angle(t))),
            seen("force_2", 0.1, &|t| other(pulls[1], angle(t))),
        ];
        let shown = seen("angle", 1e-3, &angle);
        Data { loads: Some(loads), ..Data::driven(time, current, Hold::Linear, shown) }
    }

    #[test]
    fn of_two_springs_that_are_given_as_one_the_one_that_is_not_so_is_told() {
        let rig = Rig::parse(DRUM).unwrap();
        for (pulls, cable) in [([12.1, 12.0], 2.0), ([12.0, 12.1], 3.0)] {
            let data = drum(pulls);
            let found = walked((&rig, loose(&rig)), &data, &[], &Options::default()).unwrap().found;
            let value = |key: &str| found.rig.value(&format!("preload_asymmetry.{key}"));
            let force =
                value("force").expect("it is named") * if cable == 3.0 { -1.0 } else { 1.0 };
            assert!((force - 0.1).abs() < 0.01, "{pulls:?}: {force} N");
            assert!(found.chi_squared[2] < 1.1, "{:?}", found.chi_squared);
        }
    }
}
