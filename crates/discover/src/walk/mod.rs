//! The way from a record to an answer.

mod acts;
mod alike;
mod anew;
mod answer;
mod beam;
mod begin;
mod candidates;
mod dips;
mod drifts;
mod exchange;
mod fewest;
mod forms;
mod geared;
mod given;
mod grain;
mod holds;
mod joints;
mod left;
mod loads;
#[cfg(test)]
pub(crate) mod made;
mod named;
mod places;
mod plain;
mod polish;
mod says;
mod simpler;
mod smooths;
mod springs;
mod strayed;
mod struck;
mod tone;
mod unmoved;
mod waves;

use crate::{
    board::{Board, FINE, Fitted, ROUGH},
    decide::{Judged, shrink},
    gram::Gram,
    model::{self, Candidate},
    screen::Scored,
    verdict::{Discovery, Found, Options, Ranked},
};
use begin::{Begin, begin, settled};
pub use holds::discover;
use identify::{
    Hold, Rig,
    effects::Context,
    fit::{Data, FitError, binding, search::Patience},
};
use named::{ALL, NOTHING, found};
use polish::CLOSE_TO;

/// The windows of a block in a first search.
const SHORT: usize = 4;

/// Enough for the nominal model.
const REFIT: Patience = Patience { misfit: 1.0, share: 5e-5, simulations: 20 };

/// Enough to come near.
const FIRST: Patience = Patience { misfit: 20.0, share: 2e-3, simulations: 20 };

/// Mean squared residual from which on a refit of the nominal model is not trusted to be near the truth.
const GROSS: f64 = 20.0;

/// A right model leaves no more than this.
const DOWN: f64 = 1.02;

/// What does not begin smoothly is worth a look where the model leaves so much more than the floor.
const ABOVE: f64 = 1.1;

/// Of two answers the one with fewer effects leaves no more than so many times what the other does.
const ALIKE: f64 = 1.1;

/// Dry friction and viscous friction.
const PLAIN: usize = 2;

/// The walk, as far as it has come.
struct Walk<'a> {
    board: Board<'a>,
    /// The same record in shorter windows.
    short: Board<'a>,
    counts: Vec<f64>,
    best: Fitted,
    /// What the refitted nominal model leaves [1].
    refit: f64,
    /// The model of the rig file.
    given: Rig,
    /// The model before its refit, in the first round: what is missing drags parameters to where no effect is itself.
    origin: Fitted,
    ranking: Vec<Ranked>,
    /// Whether what does not begin smoothly is looked for.
    joins: bool,
    /// The candidates of the first round, the nearest first.
    firsts: Vec<Candidate>,
    /// What is given and not free went far from there when it was a little loose: names and given values.
    strayed: Vec<(String, f64)>,
    /// The last model before what had strayed in it was held.
    before_held: Option<strayed::Loosened>,
    /// The record with its input the other ways between its samples, where that is asked.
    others: &'a [Data],
    /// The one in which it is nearer.
    turned: Option<Hold>,
    /// What a model of the record is known to leave, or the floor [1].
    reached: f64,
    /// How often the record may be simulated before no more is looked for.
    simulations: u64,
}

/// How a walk ends.
struct End {
    found: Discovery,
    /// The other way of its input in which the record may be simpler.
    other: Option<Hold>,
    /// Whether it turned to that before it came to an end of its own.
    turned: bool,
    /// How often it simulated the record.
    simulated: u64,
}

/// Looks for what the model `rig` lacks, and asks whether the record is nearer with its input as in one of the `others`.
fn walked(
    (given, loose): (&Rig, Vec<(String, f64)>),
    data: &Data,
    others: &[Data],
    options: &Options,
) -> Result<End, FitError> {
    let data = &identify::known::still(data);
    let Begin { rig, loose, board, refit, origin, strayed } =
        begin((given, loose), data, options.seed)?;
    let rig = &rig;
    let channels = refit.blocks.first().map_or(1, Vec::len) as f64;
    let counts: Vec<f64> = board.samples().into_iter().map(|n| n * channels).collect();
    let short = Board { work: board.work.clone(), ..Board::of(rig, data, SHORT, loose)? };
    let mut walk = Walk {
        board,
        short,
        counts,
        best: refit,
        refit: f64::INFINITY,
        given: given.clone(),
        origin,
        ranking: Vec::new(),
        joins: true,
        firsts: Vec::new(),
        strayed,
        before_held: None,
        others,
        turned: None,
        reached: 1.0,
        simulations: options.simulations,
    };
    walk.begun_anew()?;
    walk.near_the_floor(CLOSE_TO)?;
    let refit = walk.best.clone();
    walk.refit = walk.judged(&refit.blocks).level();
    options.tell(|| format!("refitted it leaves χ² {:.4}", walk.refit));
    let context = walk.waved(&refit, &model::context(&walk.board, &refit));
    // To say how little of each would show.
    let start = Gram::of(&walk.board, &refit, (&context, true))?;
    let mut effects = walk.rounds(&context, options, &start)?;
    walk.looked_over(&mut effects, &context, options)?;
    let complete = !walk.tired();
    let refit = walk.polish(&refit, options.seed)?;
    walk.drop_unsure((rig, &refit), &mut effects, &context)?;
    let refit = walk.wrong_given(rig, &mut effects)?.unwrap_or(refit);
    let before = walk.board.judged(given, None)?;
    let other = if walk.turned.is_some() {
        walk.turned
    } else if complete {
        walk.may_be_other()?
    } else {
        None
    };
    let turned = walk.turned.is_some();
    let simulated = walk.simulated();
    let found = walk.answer((rig, &before, &refit), (effects, &start), &context)?;
    let found = Discovery { complete, ..found };
    Ok(End { found, other, turned, simulated })
}

impl Walk<'_> {
    /// Whether the record was simulated as often as was asked for: then what was found is answered.
    fn tired(&self) -> bool {
        self.simulated() > self.simulations
    }

    /// How often the record was simulated.
    fn simulated(&self) -> u64 {
        self.board.work.steps() / self.board.data.time.len() as u64
    }

    fn judged(&self, blocks: &[Vec<f64>]) -> Judged {
        Judged::of(blocks, &self.counts, &self.board.trains)
    }

    fn scored(&self, scored: &Scored) -> Judged {
        let mutes = self.board.mutes();
        let blocks = scored.left.iter().zip(mutes).map(|(sum, mute)| vec![*sum + mute]);
        let blocks: Vec<Vec<f64>> = blocks.collect();
        self.judged(&blocks)
    }

    /// The last model with the given values of what is no effect's, of which it may have been dragged away by what is
    /// still missing; itself where it is near.
    fn beside_given(&self) -> Result<Fitted, FitError> {
        if self.judged(&self.best.blocks).level() < NOTHING {
            return Ok(self.best.clone());
        }
        let mut rig = self.best.rig.clone();
        for name in self.best.rig.free.iter().filter(|name| !name.contains('.')) {
            if let Some(given) = self.given.value(name) {
                binding::set(&mut rig, name, given);
            }
        }
        self.board.judged(&rig, None)
    }

    /// Effect after effect, for as long as there is one more.
    fn rounds(
        &mut self,
        context: &Context,
        options: &Options,
        start: &Gram,
    ) -> Result<Vec<Found>, FitError> {
        let mut effects: Vec<Found> = Vec::new();
        // Its two plain parts are no effects beside others then.
        let bare = self.bare();
        let most = options.most + if bare { PLAIN } else { 0 };
        while effects.len() < most && !self.tired() {
            let round = effects.len();
            let first = Some(start).filter(|_| round == 0);
            let before = (self.board.clone(), self.best.clone());
            let found = self.step(context, options, (round, first))?;
            let found = if bare && round == 0 && self.turned.is_none() {
                self.plain(found.as_ref(), context, &before.1)?
            } else {
                found.into_iter().collect()
            };
            if found.is_empty() {
                break;
            }
            // A refit of what was taken is not the next effect's to claim.
            self.best = settled(&mut self.board, self.best.clone(), options.seed)?;
            self.begun_anew()?;
            self.near_the_floor(GROSS)?;
            if !self.lasts(before) {
                break;
            }
            self.all_springs(context.span, options.seed)?;
            self.reclaim()?;
            self.hold_strayed(options.seed)?;
            self.origin = self.beside_given()?;
            options.tell(|| self.comes_to(&found));
            effects.extend(found);
        }
        self.loosen_held();
        Ok(effects)
    }

    /// The effects once more, beside each other, and others in their place.
    fn looked_over(
        &mut self,
        effects: &mut Vec<Found>,
        context: &Context,
        options: &Options,
    ) -> Result<(), FitError> {
        if self.turned.is_some() {
            return Ok(());
        }
        let others = std::mem::take(&mut self.others);
        loop {
            self.drop_each(effects, context)?;
            self.exchange_each(effects, context, options)?;
            if !self.widened(effects, context, options)? {
                break;
            }
        }
        self.others = others;
        Ok(())
    }

    /// One effect more, if there is one that is surely there.
    fn step(
        &mut self,
        context: &Context,
        options: &Options,
        (round, start): (usize, Option<&Gram>),
    ) -> Result<Option<Found>, FitError> {
        let context = &if start.is_some() { *context } else { self.waved(&self.best, context) };
        let now = self.judged(&self.best.blocks);
        if now.level() > GROSS {
            self.board.refine(&self.best, ROUGH)?;
        }
        let candidates = self.candidates(context, options, (round, start))?;
        let all = self.finely(candidates)?;
        let now = self.judged(&self.best.blocks);
        let mut all = self.told_apart(&now, all, context)?;
        self.turned = self.turns(&all)?;
        if self.turned.is_some() {
            return Ok(None);
        }
        // The race of what does not begin smoothly takes as long as all else: what comes down to the floor needs none.
        let level = now.level();
        let begins = self.may_begin(level, round);
        let joints = if self.tired() {
            Vec::new()
        } else if begins && !all.iter().any(|c| self.down(&now, c, context)) {
            self.begun(context)
        } else if self.joins && (level <= ABOVE || self.explained(level)) {
            self.nearly_rigid(context)
        } else {
            Vec::new()
        };
        if !joints.is_empty() {
            all.extend(self.finely(joints)?);
            let beside = self.beside(&all, context);
            all.extend(self.finely(beside)?);
            all = self.told_apart(&now, all, context)?;
        }
        if !self.tired() {
            let others = self.other_forms(&all, context);
            all.extend(self.finely(others)?);
        }
        let simpler = self.simpler(&now, &all, context);
        all.extend(self.finely(simpler)?);
        let rated = self.rated(all, context);
        self.rank(&rated, (round, &now));
        if round == 0 {
            self.keep_firsts(&rated);
        }
        let leads =
            |(best, found): &(&Candidate, Found)| self.leads(&now, (&best.fitted, found.shrink));
        let Some((best, found)) = found(&now, &rated, round).filter(leads) else { return Ok(None) };
        // What takes away the little that a play leaves may be what its own minimum besides the best leaves.
        let anew = self.joint_anew(&now, &best.fitted, context)?;
        let anew = if anew.is_some() { anew } else { self.reformed(&best.fitted, context)? };
        if let Some(anew) = anew {
            self.best = anew;
            return self.step(context, options, (round, None));
        }
        self.best = best.fitted.clone();
        Ok(Some(found))
    }

    /// Whether a candidate explains all that is missing.
    fn down(&self, now: &Judged, candidate: &Candidate, context: &Context) -> bool {
        let level = self.judged(&candidate.fitted.blocks).level();
        level < ABOVE * self.reached
            && shrink(now.level(), level) > ALL
            && self.fits(candidate, context)
    }

    /// The nearest of the candidates, and what it leaves.
    fn nearest<'c>(&self, candidates: &'c [Candidate]) -> Option<(&'c Candidate, f64)> {
        let level = |c: &'c Candidate| (c, self.judged(&c.fitted.blocks).level());
        candidates.iter().map(level).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The candidates followed to their ends, with steps as short as the nearest asks for, and begun as the last model.
    fn finely(&mut self, candidates: Vec<Candidate>) -> Result<Vec<Candidate>, FitError> {
        if let Some((best, _)) = self.nearest(&candidates) {
            self.board.refine(&best.fitted, FINE)?;
        }
        let all = self.followed(candidates);
        self.begun_alike(all)
    }
}

#[cfg(test)]
mod tests {
    use super::made;

    #[test]
    fn every_motion_counts_and_every_derivative() {
        let data = made::data();
        let walk = made::walk(&made::rig(2.0), &data, &[]);
        let problem = walk.board.problem(&walk.best.rig, |_| true).unwrap();
        let x = identify::fit::starts::nominal(&problem);
        let before = walk.board.work.steps();
        let all = problem.windows.iter().map(|w| problem.piece(&x, w, w.start)).collect::<Vec<_>>();
        let steps: usize = all.iter().map(|piece| piece.motion.tape.steps()).sum();
        assert!(steps >= data.time.len() - all.len());
        let counted = walk.board.work.steps() - before;
        assert!((steps as u64..=steps as u64 + all.len() as u64).contains(&counted), "{counted}");
        problem.all_slopes(&x, &all);
        assert!(walk.board.work.steps() > before + counted, "derivatives take their time");
    }
}
