//! Of several values that moved together, the one that has to.
//!
//! Along a ridge of the misfit, as of many elements in parallel, a fit moves several parameters far where one is wrong,
//! or none: then an effect beside values that are all a little off explains the record as well.

use super::{
    GROSS, REFIT, Walk,
    answer::{moved, surely_worse},
    walked,
};
use crate::{
    board::{self, Board, Fitted},
    verdict::{Discovery, Moved, Options, Verdict},
};
use identify::{
    Rig,
    fit::{Data, FitError, binding},
};
use rayon::prelude::*;
use std::mem;

/// An answer with no moved parameter leaves no more than so many times what one with several does.
const AS_MUCH: f64 = 1.02;

/// Whether several parameters moved.
pub(super) fn several(parameters: &[Moved]) -> bool {
    parameters.iter().filter(|p| p.moved).count() > 1
}

/// The answer `first`, or where it says that several parameters are wrong one that names an effect, with all of them a
/// little off at most.
pub(super) fn fewest(
    rig: &Rig,
    data: &Data,
    options: &Options,
    first: Discovery,
) -> Result<Discovery, FitError> {
    let near = first.verdict == Verdict::NotInLibrary && first.chi_squared[2] < GROSS;
    if !(near || first.verdict == Verdict::Parameter) || !several(&first.parameters) {
        return Ok(first);
    }
    let tied = board::tied(rig);
    let mut held = rig.clone();
    held.free.retain(|name| !tied.iter().any(|(tied, _)| tied == name));
    // More than one effect would not be taken.
    let options = Options { most: 1, ..*options };
    let second = walked((&held, tied), data, &[], &options)?.found;
    let named = matches!(second.verdict, Verdict::Effect | Verdict::Partial);
    let one = named && second.effects.len() == 1;
    let left = |found: &Discovery| found.chi_squared[2];
    let as_near = left(&second) < AS_MUCH * left(&first).max(1.0);
    let off = |p: &Moved| p.moved || board::strays(p.found.value, p.given);
    let stays = !second.parameters.iter().filter(|p| p.given > 0.0).any(off);
    Ok(if one && as_near && stays { second } else { first })
}

impl Walk<'_> {
    /// Whether it must be asked which parameter is wrong: several moved together, or none is told from what all nominal
    /// values may be off, and yet some are far from theirs.
    pub(super) fn unsure_which(&self, rig: &Rig, parameters: &[Moved]) -> bool {
        let own = |p: &&Moved| self.own(&p.found.name);
        let none = parameters.iter().all(|p| !p.moved);
        several(parameters) || none && parameters.iter().filter(own).any(|p| moved(rig, &p.found))
    }

    /// What is tied to its given value and may be told as wrong.
    pub(super) fn tied(&self, rig: &Rig) -> Vec<(String, f64)> {
        let mut tied = board::tied(rig);
        tied.retain(|(name, _)| self.own(name));
        tied
    }

    /// The parameter that alone is wrong, and the model in which the others are a little off at most for the last one,
    /// if it is surely no worse.
    pub(super) fn one_wrong(&mut self, rig: &Rig) -> Result<Option<String>, FitError> {
        let tied = self.tied(rig);
        let with = |name: &str| -> Board<'_> {
            let others = self.board.loose.iter().filter(|(loose, _)| !self.own(loose));
            let loose = tied.iter().chain(others).filter(|(own, _)| own != name).cloned().collect();
            Board { loose, ..self.board.clone() }
        };
        let mut start = self.best.rig.clone();
        for (name, given) in tied.iter().chain(&self.board.loose) {
            binding::set(&mut start, name, *given);
        }
        let alone = |(name, _): &(String, f64)| -> Result<(String, Fitted), FitError> {
            let board = with(name);
            // From where it went to: the way from a value that is far off may end elsewhere.
            let mut start = start.clone();
            binding::set(&mut start, name, self.best.rig.value(name).unwrap_or(f64::NAN));
            Ok((name.clone(), board.fit_near(&start, &self.best.pieces, &REFIT)?))
        };
        let all: Vec<_> = tied.par_iter().map(alone).collect::<Result<_, _>>()?;
        let now = self.judged(&self.best.blocks);
        let stays = |(name, fitted): &(String, Fitted)| {
            let worse = surely_worse(&self.judged(&fitted.blocks), &now);
            !worse && with(name).strayed(fitted).is_empty()
        };
        let level = |fitted: &Fitted| self.judged(&fitted.blocks).level();
        let nearest = all.into_iter().filter(stays);
        let nearest = nearest.min_by(|a, b| level(&a.1).total_cmp(&level(&b.1)));
        let Some((name, fitted)) = nearest else { return Ok(None) };
        let loose = with(&name).loose;
        let best = mem::replace(&mut self.best, fitted);
        let before = mem::replace(&mut self.board.loose, loose);
        let found = self.values(rig, &|_| false)?.0.into_iter().find(|v| v.name == name);
        // Whether the others could be so in its place is asked with them as free as they were.
        let fitted = mem::replace(&mut self.best, best);
        let loose = mem::replace(&mut self.board.loose, before);
        let given = rig.value(&name).unwrap_or(f64::NAN);
        let Some(found) = found.filter(|found| moved(rig, found)) else { return Ok(None) };
        // All others can be so in place of what scales them all.
        let scales = self.board.holds(&name);
        if !scales && !self.far(&[Moved { given, found, moved: true }])? {
            return Ok(None);
        }
        self.best = fitted;
        self.board.loose.clone_from(&loose);
        self.short.loose = loose;
        Ok(Some(name))
    }
}

#[cfg(test)]
mod tests {
    use super::{fewest, several};
    use crate::{
        verdict::{Discovery, Moved, Options, Value, Verdict},
        walk::made,
    };
    use identify::{
        Hold, Rig,
        effects::Kind,
        fit::{Data, Seen, binding},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn of_several_that_moved_along_a_valley_the_one_that_has_to_is_wrong() {
        // Under one sine only k - 4m is seen: 3 - 8 N/m is that of 5.4 and 10.4. The drag of 0.5 N·s/m was given as 0.8.
        let data = made::data();
        let given = made::with(&made::rig(2.0), Kind::CurrentBias, &[made::BIAS]);
        let free = ["mass", "stiffness", "sigma_2"].map(str::to_owned);
        let mut given = Rig { free: free.to_vec(), ..given };
        binding::set(&mut given, "sigma_2", 0.8);
        let mut found = given.clone();
        for (name, value) in [("mass", 2.6), ("stiffness", 5.4), ("sigma_2", 0.5)] {
            binding::set(&mut found, name, value);
        }
        let mut walk = made::walk(&given, &data, &[]);
        walk.best = walk.board.judged(&found, None).unwrap();
        assert_eq!(walk.one_wrong(&given).unwrap().as_deref(), Some("sigma_2"));
        let value = |name: &str| walk.best.rig.value(name).unwrap();
        assert!((value("sigma_2") - 0.5).abs() < 0.01, "{}", value("sigma_2"));
        assert!((value("mass") - 2.0).abs() < 0.05, "{}", value("mass"));
        // Where none has to, all stays.
        let mut right = given.clone();
        binding::set(&mut right, "sigma_2", 0.5);
        let mut walk = made::walk(&right, &data, &[]);
        walk.best = walk.board.judged(&found, None).unwrap();
        assert_eq!(walk.one_wrong(&right).unwrap(), None);
        assert!((walk.best.rig.value("mass").unwrap() - 2.6).abs() < 1e-12);
        assert!(!several(&[]));
    }

    #[test]
    fn a_value_that_shows_in_a_few_blocks_alone_is_wrong_too() {
        // Of 2 kg on 3 N/m that move for a second in every five, to 0.1 mm and 0.1 mN.
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut noisy = |value: f64| -> f64 {
            let drawn: f64 = StandardNormal.sample(&mut random);
            value + 1e-4 * drawn
        };
        let way =
            |t: f64| 0.2 * (-((t.rem_euclid(5.0) - 2.4) / 0.3).powi(2)).exp() * (9.0 * t).sin();
        let force = |t: f64| {
            let [before, here, after] = [t - 1e-4, t, t + 1e-4].map(way);
            2.0 * (after - 2.0 * here + before) / 1e-8 + 0.5 * (after - before) / 2e-4 + 3.0 * here
        };
        let time: Vec<f64> = (0..8000).map(|i| 0.005 * f64::from(i)).collect();
        let input = time.iter().map(|t| noisy(force(*t))).collect();
        let seen = Seen::new("position", time.iter().map(|t| noisy(way(*t))).collect(), 0.0);
        let data = Data::driven(time, input, Hold::Linear, seen);
        let rig = Rig { free: vec!["stiffness".to_owned()], ..made::rig(2.0) };
        let walk = made::walk(&rig, &data, &[]);
        for (given, far) in [(3.0, false), (2.0, true)] {
            let found =
                Value { name: "stiffness".to_owned(), value: 3.0, standard_error: 0.01, unit: "" };
            let moved = Moved { given, found, moved: true };
            let mut there = rig.clone();
            binding::set(&mut there, "stiffness", given);
            let [with, here] = [&there, &rig].map(|rig| {
                let held = Rig { free: Vec::new(), ..rig.clone() };
                walk.judged(&walk.board.judged(&held, None).unwrap().blocks)
            });
            // Many squared standard errors, and few blocks.
            let (gained, t) = (with.gained_besides(&here), with.against(&here));
            assert!(!far || gained > 1e3 && t < 3.0, "{gained}, t = {t}");
            assert_eq!(walk.far(&[moved]).unwrap(), far, "from {given} N/m");
        }
    }

    /// An answer with two wrong parameters that leaves so much.
    fn two_wrong(rig: &Rig, verdict: Verdict, left: f64) -> Discovery {
        let one = |name: &str| {
            let value = Value { name: name.to_owned(), value: 9.0, standard_error: 0.1, unit: "" };
            Moved { given: 2.0, found: value, moved: true }
        };
        let parameters = ["mass", "stiffness"].map(one).to_vec();
        Discovery { parameters, ..made::answer(rig, verdict, left) }
    }

    #[test]
    fn one_effect_with_all_values_near_theirs_is_nearer_than_two_wrong_parameters() {
        let (data, rig) = (made::data(), made::rig(2.02));
        let rig = Rig { free: ["mass", "stiffness"].map(str::to_owned).to_vec(), ..rig };
        let of = |verdict: Verdict, left: f64| {
            let first = two_wrong(&rig, verdict, left);
            let found = fewest(&rig, &data, &Options::default(), first).unwrap();
            (found.verdict, found.effects.iter().map(|e| e.name).collect::<Vec<_>>())
        };
        let bias = (Verdict::Effect, vec!["current_bias"]);
        assert_eq!(of(Verdict::Parameter, 1.0), bias);
        assert_eq!(of(Verdict::NotInLibrary, 1.1), bias);
        // Far from the record nothing is known of the parameters, and a name stays one.
        assert_eq!(of(Verdict::NotInLibrary, 90.0).0, Verdict::NotInLibrary);
        assert_eq!(of(Verdict::Effect, 1.1).1, ["current_bias"; 0]);
    }
}
