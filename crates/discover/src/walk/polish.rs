//! What is done to a model that is near already.

use super::{
    DOWN, GROSS, REFIT, Walk,
    exchange::{key_of, kind_of},
    named::{MOST, NOTHING, Rated, SURE, shows},
};
use crate::{
    board::{Board, FINE, Fitted},
    decide::{Judged, shrink},
    model::Candidate,
    verdict::Found,
};
use identify::{
    Rig,
    effects::{Context, Key, Shape},
    fit::{FitError, binding, search::Patience},
};
use rayon::prelude::*;

/// Enough for a model that is near already.
const POLISH: Patience = Patience { misfit: 0.5, share: 2e-5, simulations: 12 };

/// So often at most, as long as the misfit falls by so much; a standard error makes 1.
const POLISHED: usize = 6;
const GAINED: f64 = 0.2;

/// A model without an effect is as good if it leaves no more than so many times as much; up to this it may become so.
const AS_GOOD: f64 = 1.1;
pub(super) const CLOSE_TO: f64 = 1.4;

/// What leaves no more than so many times what the best candidate does, and takes away as much of the excess but for
/// this share of it, may be nearer than that where it ends.
const CONTENDS: f64 = 3.0;
const AS_MUCH: f64 = 0.1;

/// An amount is surely more than nothing from so many standard errors on.
pub(super) const TOLD: f64 = 4.0;

impl<'a> Walk<'a> {
    /// The candidates, and those that contend for the name at their ends: which of them is the nearest, and whether it
    /// explains all, is seen only there.
    pub(super) fn told_apart(
        &mut self,
        now: &Judged,
        mut all: Vec<Candidate>,
        context: &Context,
    ) -> Result<Vec<Candidate>, FitError> {
        let rated = self.rated(all.clone(), context);
        let plausible = || rated.iter().filter(|r| r.plausible);
        let Some(best) = plausible().next() else { return Ok(all) };
        let (level, gone) = (best.judged.level(), shrink(now.level(), best.judged.level()));
        let contends = |r: &&Rated| {
            let there = r.judged.level();
            there < CONTENDS * level && shrink(now.level(), there) > gone - AS_MUCH
        };
        let mut contenders: Vec<Candidate> =
            plausible().filter(contends).map(|r| r.candidate.clone()).collect();
        // Far off only the nearest may still be on its way.
        if level > GROSS || gone < 1.0 - AS_MUCH {
            contenders.truncate(1);
        }
        if level < DOWN && contenders.len() < 2 || gone < MOST {
            return Ok(all);
        }
        let nearest = best.candidate.fitted.clone();
        let mut ends = self.ends(&contenders, &nearest)?;
        // What is nearer than before may ask for shorter steps.
        let steps = self.board.tolerance;
        if let Some((best, _)) = self.nearest(&ends) {
            let best = best.fitted.clone();
            self.board.refine(&best, FINE)?;
            if self.board.tolerance < steps {
                ends = self.ends(&ends, &self.board.again(&best)?)?;
                all.retain(|c| !contenders.iter().any(|own| own.kind == c.kind));
            }
        }
        all.extend(ends);
        Ok(all)
    }

    /// Candidates at their ends, each looked for from where the `nearest` of them is as well.
    fn ends(&self, contenders: &[Candidate], nearest: &Fitted) -> Result<Vec<Candidate>, FitError> {
        let one = |near: &Candidate| {
            let beside = self.beside_nearest(&self.board.again(&near.fitted)?, nearest)?;
            Ok(Candidate { kind: near.kind, fitted: self.ended(beside)? })
        };
        contenders.par_iter().map(one).collect()
    }

    /// A model with what is no effect's as the `nearest` of its rivals has it, if that is better: what leads along a
    /// valley leads the rivals to one place.
    fn beside_nearest(&self, fitted: &Fitted, nearest: &Fitted) -> Result<Fitted, FitError> {
        let mut rig = fitted.rig.clone();
        for name in rig.free.clone().iter().filter(|name| !name.contains('.')) {
            if let Some(value) = nearest.rig.value(name) {
                binding::set(&mut rig, name, value);
            }
        }
        let there = self.board.fit_near(&rig, &nearest.pieces, &POLISH)?;
        let better = self.board.trained(&there) < self.board.trained(fitted);
        Ok(if better { there } else { fitted.clone() })
    }

    /// The last model and the refitted nominal one with steps that no longer show.
    pub(super) fn polish(&mut self, refit: &Fitted, seed: u64) -> Result<Fitted, FitError> {
        self.best = self.board.refined(&self.best, FINE)?;
        self.board.refloor(&self.best, seed)?;
        self.best = self.board.again(&self.best)?;
        let refit = &self.board.again(refit)?;
        self.polished()?;
        // Without effects the two are one model: the better minimum is its.
        if self.best.rig.effects.len() == refit.rig.effects.len() {
            if self.board.trained(refit) < self.board.trained(&self.best) {
                self.best = refit.clone();
            }
            return Ok(self.best.clone());
        }
        Ok(refit.clone())
    }

    /// A model that leaves less than `most` is polished before more is looked for: what a search that stopped early
    /// leaves is no effect's.
    pub(super) fn near_the_floor(&mut self, most: f64) -> Result<(), FitError> {
        let level = self.judged(&self.best.blocks).level();
        if (DOWN..most).contains(&level) { self.polished() } else { Ok(()) }
    }

    /// Whether the last model is better than the one `before`, each with the steps that it asks for; if not, all is as
    /// it was `before`. What is near with long steps may be near with those only.
    pub(super) fn lasts(&mut self, before: (Board<'a>, Fitted)) -> bool {
        let level = |fitted: &Fitted| self.judged(&fitted.blocks).level();
        let lasts = level(&self.best) < level(&before.1);
        if !lasts {
            (self.board, self.best) = before;
        }
        lasts
    }

    /// The last model refitted until it falls by less than shows.
    fn polished(&mut self) -> Result<(), FitError> {
        self.best = self.ended(self.best.clone())?;
        Ok(())
    }

    /// A model refitted until it falls by less than shows.
    pub(super) fn ended(&self, mut fitted: Fitted) -> Result<Fitted, FitError> {
        for _ in 0..POLISHED {
            let from = (fitted.x.as_slice(), fitted.pieces.as_slice());
            let next = self.board.fit(&fitted.rig, Some(from), &POLISH)?;
            let gained = self.board.trained(&fitted) - self.board.trained(&next);
            if gained > 0.0 {
                fitted = next;
            }
            // The logarithms of the blocks fall by their shares.
            if gained * self.counts.iter().sum::<f64>() < GAINED * self.counts.len() as f64 {
                break;
            }
        }
        Ok(fitted)
    }

    /// A model refitted without one of its effects.
    pub(super) fn without(&self, fitted: &Fitted, name: &str) -> Result<Fitted, FitError> {
        let rig = lacking(&fitted.rig, name);
        self.board.fit_near(&rig, &fitted.pieces, &REFIT)
    }

    /// Takes away again, where the refitted nominal model leaves no more than the floor, every effect of which no amount
    /// is surely more than nothing: what its shapes fit besides is noise. So is one that has become implausible.
    pub(super) fn drop_unsure(
        &mut self,
        (rig, refit): (&Rig, &Fitted),
        effects: &mut Vec<Found>,
        context: &Context,
    ) -> Result<(), FitError> {
        if self.judged(&refit.blocks).level() > NOTHING {
            return Ok(());
        }
        for place in (0..effects.len()).rev() {
            let name = effects[place].name;
            let Some(kind) = kind_of(name) else { continue };
            // What goes on with a long time is the same line with many amounts, and a gear that gives way a little shows by
            // that times the mass of its load: there all the same.
            let shape = |own: &str| key_of(kind, own).is_some_and(|k| k.shape != Shape::Amount);
            let (values, _) = self.values(rig, &shape)?;
            let sure = |key: &Key| {
                let name = format!("{name}.{}", key.name);
                let own = values.iter().find(|value| value.name == name);
                own.is_none_or(|own| own.value.abs() >= TOLD * own.standard_error)
            };
            let mut amounts =
                kind.about().keys.iter().filter(|key| key.shape == Shape::Amount).peekable();
            let unsure = amounts.peek().is_some() && !amounts.any(sure);
            if unsure || !self.plausible(name, context) {
                let alone = effects.len() == 1;
                self.best = if alone { refit.clone() } else { self.without(&self.best, name)? };
                effects.remove(place);
            }
        }
        Ok(())
    }

    /// The names of the effects, the last one first, but before it what is not plausible: of two that do alike that goes.
    fn last_first(&self, effects: &[Found], context: &Context) -> Vec<&'static str> {
        let mut names: Vec<&str> = effects.iter().rev().map(|effect| effect.name).collect();
        names.sort_by_key(|name| self.plausible(name, context));
        names
    }

    /// Takes away again every effect without which a refit is as good: it had only shown the way.
    pub(super) fn drop_each(
        &mut self,
        effects: &mut Vec<Found>,
        context: &Context,
    ) -> Result<(), FitError> {
        for name in self.last_first(effects, context) {
            let Some(place) = effects.iter().position(|effect| effect.name == name) else {
                continue;
            };
            let mut without = self.alike(self.without(&self.best, name)?)?;
            let now = self.judged(&self.best.blocks);
            let told = effects.len() < 2 || self.joint_told(name)?;
            let needless = |without: &Fitted| {
                let there = self.judged(&without.blocks);
                let evidence = self.evidence(without, &self.best);
                let as_good = as_good(&there, &now, effects.len() - 1, evidence);
                (as_good || !told && near(&there, &now)) && self.board.strayed(without).is_empty()
            };
            // What comes near at once may come all the way.
            if !needless(&without) && self.judged(&without.blocks).level() < CLOSE_TO * now.level()
            {
                let from = (without.x.as_slice(), without.pieces.as_slice());
                without = self.board.fit(&without.rig, Some(from), &REFIT)?;
            }
            // What was found later was found beside it, and may be in a minimum of its own.
            if !needless(&without) && effects.len() > 1 {
                let anew = self.anew(&without.rig)?;
                if self.board.trained(&anew) < self.board.trained(&without) {
                    without = anew;
                }
            }
            if needless(&without) {
                self.best = without;
                effects.remove(place);
            }
        }
        Ok(())
    }
}

/// Whether a model is as good `without` an effect as `with` it, beside so many others. What is taken for what it gains in
/// many blocks is kept for it.
fn as_good(without: &Judged, with: &Judged, others: usize, evidence: f64) -> bool {
    near(without, with) && !shows(without, with, others, evidence)
}

/// Whether a model is hardly further off than another.
fn near(without: &Judged, with: &Judged) -> bool {
    without.against(with) < SURE && without.level() < AS_GOOD * with.level()
}

/// `rig` without one of its effects.
pub(super) fn lacking(rig: &Rig, name: &str) -> Rig {
    let mut rig = rig.clone();
    rig.effects.retain(|effect| effect.name != name);
    rig.free.retain(|free| !free.starts_with(&format!("{name}.")));
    rig
}

#[cfg(test)]
mod tests {
    use crate::{
        decide::Judged,
        model::Candidate,
        walk::made::{BIAS, context, data, found, rig, walk, with},
    };
    use identify::effects::{Context, Kind};

    #[test]
    fn those_that_contend_are_told_apart_where_they_end() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        // On a way so long the wave below repeats.
        let context = Context { span: 200.0, ..context(&walk) };
        let now = walk.judged(&walk.best.blocks);
        let near = |kind: Kind, values: &[f64]| {
            let fitted = walk.board.judged(&with(&rig(2.0), kind, values), None).unwrap();
            Candidate { kind, fitted }
        };
        let bias = near(Kind::CurrentBias, &[0.75 * BIAS]);
        // So long a wave is as good as a constant force on this record, and here nearer to the right one.
        let cogging = near(Kind::Cogging, &[0.0, -0.8 * BIAS, 0.1]);
        let [before, there] = [&bias, &cogging].map(|c| walk.judged(&c.fitted.blocks).level());
        assert!(there < before && before < super::CONTENDS * there, "{there} {before}");
        let all = walk.told_apart(&now, vec![bias, cogging], &context).unwrap();
        for kind in [Kind::CurrentBias, Kind::Cogging] {
            let levels = all.iter().filter(|c| c.kind == kind);
            let levels = levels.map(|c| walk.judged(&c.fitted.blocks).level());
            let end = levels.fold(f64::INFINITY, f64::min);
            assert!(end < 1.05, "{kind:?} ends at {end}");
        }
    }

    #[test]
    fn an_effect_that_is_not_surely_more_than_nothing_is_dropped_near_the_floor() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let bias = with(&walk.best.rig, Kind::CurrentBias, &[BIAS]);
        let none = with(&bias, Kind::ViscousAsymmetry, &[1e-9]);
        let refit = walk.board.judged(&bias, None).unwrap();
        let both = walk.board.judged(&none, None).unwrap();
        let context = context(&walk);
        for (before, left) in [(refit.clone(), 1), (walk.best.clone(), 2)] {
            walk.best = both.clone();
            let mut effects = vec![found("current_bias"), found("viscous_asymmetry")];
            walk.drop_unsure((&rig(2.0), &before), &mut effects, &context).unwrap();
            assert_eq!(effects.len(), left, "the nominal model is near, or far off");
            assert_eq!((effects[0].name, walk.best.rig.effects.len()), ("current_bias", left));
        }
    }

    #[test]
    fn an_effect_that_has_become_implausible_is_dropped_near_the_floor() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let bias = with(&rig(2.0), Kind::CurrentBias, &[BIAS]);
        let refit = walk.board.judged(&bias, None).unwrap();
        let context = context(&walk);
        // A drag, and a drag that drives.
        for (drag, left) in [(0.05, 2), (-0.05, 1)] {
            let both = with(&bias, Kind::QuadraticDrag, &[drag]);
            walk.best = walk.board.judged(&both, None).unwrap();
            let mut effects = vec![found("current_bias"), found("quadratic_drag")];
            walk.drop_unsure((&rig(2.0), &refit), &mut effects, &context).unwrap();
            assert_eq!((effects.len(), effects[0].name), (left, "current_bias"), "{drag}");
        }
    }

    #[test]
    fn of_several_that_is_taken_away_first_which_is_not_plausible() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let context = context(&walk);
        let bias = with(&rig(2.0), Kind::CurrentBias, &[BIAS]);
        let effects = [found("quadratic_drag"), found("current_bias")];
        for (drag, first) in [(0.05, "current_bias"), (-0.05, "quadratic_drag")] {
            let both = with(&bias, Kind::QuadraticDrag, &[drag]);
            walk.best = walk.board.judged(&both, None).unwrap();
            assert_eq!(walk.last_first(&effects, &context)[0], first, "{drag}");
        }
    }

    #[test]
    fn what_gains_in_a_few_blocks_is_kept() {
        // In so many of 20 blocks it is 75 squared standard errors each, in the others nothing.
        let of = |far: usize, most: f64| {
            let blocks = (0..20).map(|k| if k < far { most } else { 1.0 + 0.001 * k as f64 });
            Judged { blocks: blocks.collect(), counts: vec![300.0; 20] }
        };
        let kept = |far| !super::as_good(&of(far, 1.25), &of(far, 1.0), 0, 0.0);
        assert!(of(6, 1.25).against(&of(6, 1.0)) < super::SURE);
        assert!(kept(6) && !kept(2));
    }

    #[test]
    fn what_is_far_off_is_begun_anew() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let mut off = with(&rig(2.0), Kind::CurrentBias, &[BIAS]);
        off.free.push("mass".to_owned());
        identify::fit::binding::set(&mut off, "mass", 2.3);
        walk.best = walk.board.judged(&off, None).unwrap();
        let level = |walk: &crate::walk::Walk<'_>| walk.judged(&walk.best.blocks).level();
        assert!(level(&walk) > 2.0, "{}", level(&walk));
        walk.begun_anew().unwrap();
        assert!(level(&walk) < 1.05, "{}", level(&walk));
        let mass = walk.best.rig.value("mass");
        walk.begun_anew().unwrap();
        assert_eq!(walk.best.rig.value("mass"), mass, "what is near stays as it is");
    }

    #[test]
    fn what_is_no_better_with_the_steps_it_asks_for_does_not_last() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let with = with(&rig(2.0), Kind::CurrentBias, &[BIAS]);
        let [right, wrong] = [&with, &rig(2.0)].map(|rig| walk.board.judged(rig, None).unwrap());
        let (steps, shorter) = (walk.board.tolerance, 0.1 * walk.board.tolerance);
        let board = walk.board.clone();
        (walk.best, walk.board.tolerance) = (wrong.clone(), shorter);
        assert!(!walk.lasts((board.clone(), right.clone())));
        assert_eq!((walk.best.rig.effects.len(), walk.board.tolerance), (1, steps));
        (walk.best, walk.board.tolerance) = (right, shorter);
        assert!(walk.lasts((board, wrong)));
        assert_eq!((walk.best.rig.effects.len(), walk.board.tolerance), (1, shorter));
    }
}
