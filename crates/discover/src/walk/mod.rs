//! The way from a record to an answer.

mod answer;

use crate::{
    board::{self, Board, COARSE, FINE, Fitted},
    decide::{Judged, shrink},
    gram::{self, Gram},
    model::{self, Candidate},
    screen::{self, Scored},
    verdict::{Discovery, Found, Options, Ranked, name},
};
use identify::{
    Rig,
    effects::Context,
    fit::{Data, FitError, search::Patience, starts},
};
use rayon::prelude::*;

/// The windows of a block in a first search.
const SHORT: usize = 4;

/// Enough for the nominal model.
const REFIT: Patience = Patience { misfit: 1.0, share: 5e-5, simulations: 20 };

/// Enough to come near.
const FIRST: Patience = Patience { misfit: 20.0, share: 2e-3, simulations: 20 };

/// Enough for a model that is near already.
const POLISH: Patience = Patience { misfit: 0.5, share: 2e-5, simulations: 12 };

/// An effect is taken if it is better on the judging blocks by so many standard errors.
const SURE: f64 = 3.0;

/// Of two effects the second belongs to the set if it is worse by fewer standard errors, or by less than this
/// share of the excess.
const UNSURE: f64 = 2.0;
const ALIKE: f64 = 0.03;

/// A rival takes away at least so much of what the best one does.
const CLOSE: f64 = 0.8;

/// What takes away so much of the excess need not do so in every block alike.
const MOST: f64 = 0.5;

/// It is no name either if the mean squared residual falls by less than this, in units of the floor.
const LEAST: f64 = 0.01;

/// So many more are refitted where the model is far off.
const BESIDE: usize = 20;

/// Near the floor so few are worth a look.
const FEW: usize = 2;

/// So many candidates are followed to their ends, and those that leave no more than so many times the best.
const FOLLOWED: usize = 3;
const NEAR: f64 = 1.5;

/// An effect is worth a name if it takes away so much of the excess.
const WORTH: f64 = 0.02;

/// Mean squared residual from which on a refit of the nominal model is not trusted to be near the truth.
const GROSS: f64 = 20.0;

/// Mean squared residual, in units of the floor, up to which nothing is missing.
const NOTHING: f64 = 1.25;

/// The walk, as far as it has come.
struct Walk<'a> {
    board: Board<'a>,
    /// The same record in shorter windows.
    short: Board<'a>,
    counts: Vec<f64>,
    best: Fitted,
    /// The model before its last refit: what is missing drags parameters to where no effect is itself.
    origin: Fitted,
    ranking: Vec<Ranked>,
}

/// Looks for what the model `rig` of the record `data` lacks.
pub fn discover(rig: &Rig, data: &Data, options: &Options) -> Result<Discovery, FitError> {
    let still;
    let data = if data.force.is_some() {
        still = crate::rest::rested(data);
        &still
    } else {
        data
    };
    let fixed = Rig { free: Vec::new(), ..rig.clone() };
    let mut loose = board::loose(rig);
    let mut held = board::loosened(rig, &loose);
    let (mut board, mut refit) = nominal(&held, data, &loose, options.seed)?;
    // What is given and not free may be a little off; what is far off is not the refit's to mend.
    let strayed = board.strayed(&refit);
    if !strayed.is_empty() {
        loose.retain(|(name, _)| !strayed.contains(name));
        held = board::loosened(rig, &loose);
        (board, refit) = nominal(&held, data, &loose, options.seed)?;
    }
    let rig = &held;
    let channels = refit.blocks.first().map_or(1, Vec::len) as f64;
    let counts: Vec<f64> = board.samples().into_iter().map(|n| n * channels).collect();
    let origin = board.judged(rig, None)?;
    if board.trained(&origin) < board.trained(&refit) {
        refit = from_given(&mut board, &origin, options.seed)?;
    }
    let short = Board::of(rig, data, SHORT, loose.clone())?;
    let mut walk = Walk { board, short, counts, best: refit.clone(), origin, ranking: Vec::new() };
    let context = model::context(&walk.board, &refit);
    let start = Gram::of(&walk.board, &refit, &context)?;
    let mut effects: Vec<Found> = Vec::new();
    for round in 0..options.most {
        let first = Some(&start).filter(|_| round == 0);
        let Some(found) = walk.step(&context, options, (round, first))? else { break };
        // What noise leaves is known the better the nearer the model is.
        walk.board.refloor(&walk.best, options.seed)?;
        walk.best = walk.board.again(&walk.best)?;
        effects.push(found);
    }
    walk.drop_each(&mut effects)?;
    let refit = walk.polish(&refit, options.seed)?;
    let before = walk.board.judged(&fixed, None)?;
    walk.answer((rig, &before, &refit), (effects, &start), &context)
}

/// The blocks of `data` with their floor, and the nominal model refitted on them.
fn nominal<'a>(
    rig: &Rig,
    data: &'a Data,
    loose: &[(String, f64)],
    seed: u64,
) -> Result<(Board<'a>, Fitted), FitError> {
    let mut board = Board::of(rig, data, 1, loose.to_vec())?;
    let short = Board::of(rig, data, SHORT, loose.to_vec())?;
    let first = board.refit(rig, Some(&short).filter(|s| !s.imposed()), &FIRST)?;
    let first = board.refined(&first, COARSE)?;
    board.refloor(&first, seed)?;
    let refit = board.fit(&first.rig, Some((&first.x, &first.pieces)), &REFIT)?;
    let refit = board.refined(&refit, COARSE)?;
    board.refloor(&refit, seed)?;
    let refit = board.again(&refit)?;
    Ok((board, refit))
}

/// The model refitted from the given values alone: where they are right already, a search by way of short windows
/// may lead away from them.
fn from_given(board: &mut Board<'_>, given: &Fitted, seed: u64) -> Result<Fitted, FitError> {
    let given = board.refined(given, COARSE)?;
    board.refloor(&given, seed)?;
    let given = board.again(&given)?;
    let refit = board.fit(&given.rig, Some((&given.x, &given.pieces)), &REFIT)?;
    Ok(if board.trained(&refit) < board.trained(&given) { refit } else { given })
}

impl Walk<'_> {
    fn judged(&self, blocks: &[Vec<f64>]) -> Judged {
        Judged::of(blocks, &self.counts, &self.board.trains)
    }

    fn scored(&self, scored: &Scored) -> Judged {
        let blocks: Vec<Vec<f64>> = scored.left.iter().map(|sum| vec![*sum]).collect();
        self.judged(&blocks)
    }

    /// One effect more, if there is one that is surely there.
    fn step(
        &mut self,
        context: &Context,
        options: &Options,
        (round, start): (usize, Option<&Gram>),
    ) -> Result<Option<Found>, FitError> {
        let now = self.judged(&self.best.blocks);
        let candidates = self.candidates(context, options, (round, start))?;
        let nearest = |a: &&Candidate, b: &&Candidate| {
            let level = |c: &Candidate| self.judged(&c.fitted.blocks).level();
            level(a).total_cmp(&level(b))
        };
        let Some(best) = candidates.iter().min_by(nearest).cloned() else { return Ok(None) };
        self.board.refine(&best.fitted, COARSE)?;
        let rated = self.rated(self.followed(candidates), context, (round, &now));
        let Some((best, _)) = rated.first() else { return Ok(None) };
        let Some(found) = found(&now, &rated) else { return Ok(None) };
        let from = (best.fitted.x.as_slice(), best.fitted.pieces.as_slice());
        let further = self.board.fit(&best.fitted.rig, Some(from), &REFIT)?;
        let better = self.board.trained(&further) < self.board.trained(&best.fitted);
        self.best = if better { further } else { best.fitted.clone() };
        self.origin = self.best.clone();
        Ok(Some(found))
    }

    /// The effects worth a refit, each refitted as far as a glance goes: from where the model is and, where that is
    /// far off, from where it was before its own refit as well.
    fn candidates(
        &self,
        context: &Context,
        options: &Options,
        (round, start): (usize, Option<&Gram>),
    ) -> Result<Vec<Candidate>, FitError> {
        let now = self.judged(&self.best.blocks);
        let far = round == 0 && now.level() > GROSS;
        let points = if far { vec![&self.origin, &self.best] } else { vec![&self.best] };
        let mut list: Vec<(usize, Scored)> = Vec::new();
        for (place, point) in points.iter().enumerate() {
            let gram = match start {
                Some(gram) if place + 1 == points.len() => gram.clone(),
                _ => Gram::of(&self.board, point, context)?,
            };
            let there = self.judged(&point.blocks);
            let mut short = self.short_list(&gram, &there, context, options);
            if round > 0 && now.level() < NOTHING {
                short.truncate(FEW);
            }
            list.extend(short.into_iter().map(|scored| (place, scored)));
        }
        let one = |(place, scored): &(usize, Scored)| {
            // Far from the truth the derivatives say little of where the other parameters are.
            if far && *place == 0 && !self.board.imposed() {
                model::afresh(&self.board, &self.short, (points[*place], scored)).ok()
            } else {
                model::refit(&self.board, points[*place], scored).ok()
            }
        };
        Ok(list.par_iter().filter_map(one).collect())
    }

    /// The plausible candidates, the best first, each effect once; all of them go to the ranking.
    fn rated(
        &mut self,
        candidates: Vec<Candidate>,
        context: &Context,
        (round, now): (usize, &Judged),
    ) -> Vec<(Candidate, Judged)> {
        let mut rated: Vec<(Candidate, Judged, bool)> = candidates
            .into_iter()
            .map(|c| {
                let judged = self.judged(&c.fitted.blocks);
                let fits = model::plausible(&c.fitted.rig, c.kind, context, &self.best.rig);
                (c, judged, fits)
            })
            .collect();
        rated.sort_by(|a, b| a.1.level().total_cmp(&b.1.level()));
        let mut seen = Vec::new();
        rated.retain(|(c, _, plausible)| {
            let first = !seen.contains(&(c.kind, *plausible));
            seen.push((c.kind, *plausible));
            first
        });
        self.ranking.extend(rated.iter().map(|(c, judged, plausible)| Ranked {
            name: name(c.kind),
            shrink: shrink(now.level(), judged.level()),
            t: now.against(judged),
            plausible: *plausible,
            round,
        }));
        rated.into_iter().filter(|(.., plausible)| *plausible).map(|(c, j, _)| (c, j)).collect()
    }

    /// The candidates that may still be the best, followed to their ends.
    fn followed(&self, candidates: Vec<Candidate>) -> Vec<Candidate> {
        let mut rated: Vec<(f64, Candidate)> =
            candidates.into_iter().map(|c| (self.judged(&c.fitted.blocks).level(), c)).collect();
        rated.sort_by(|a, b| a.0.total_cmp(&b.0));
        let near = NEAR * rated.first().map_or(0.0, |(level, _)| *level);
        let all: Vec<(usize, (f64, Candidate))> = rated.into_iter().enumerate().collect();
        let one = |(place, (level, candidate)): (usize, (f64, Candidate))| {
            if place < FOLLOWED || level < near {
                model::follow(&self.board, candidate).ok()
            } else {
                Some(candidate)
            }
        };
        all.into_par_iter().filter_map(one).collect()
    }

    /// The last model and the refitted nominal one with steps that no longer show.
    fn polish(&mut self, refit: &Fitted, seed: u64) -> Result<Fitted, FitError> {
        self.best = self.board.refined(&self.best, FINE)?;
        self.board.refloor(&self.best, seed)?;
        self.best = self.board.again(&self.best)?;
        let refit = &self.board.again(refit)?;
        let best =
            self.board.fit(&self.best.rig, Some((&self.best.x, &self.best.pieces)), &POLISH)?;
        if self.board.trained(&best) < self.board.trained(&self.best) {
            self.best = best;
        }
        // Without effects the two are one model: the better minimum is its.
        if self.best.rig.effects.len() == refit.rig.effects.len() {
            if self.board.trained(refit) < self.board.trained(&self.best) {
                self.best = refit.clone();
            }
            return Ok(self.best.clone());
        }
        Ok(refit.clone())
    }

    /// Takes away again every effect without which a refit is as good: it had only shown the way.
    fn drop_each(&mut self, effects: &mut Vec<Found>) -> Result<(), FitError> {
        // A single one was better than none when it was found.
        if effects.len() < 2 {
            return Ok(());
        }
        for place in (0..effects.len()).rev() {
            let name = effects[place].name;
            let mut rig = self.best.rig.clone();
            rig.effects.retain(|effect| effect.name != name);
            rig.free.retain(|free| !free.starts_with(&format!("{name}.")));
            let x = starts::nominal(&self.board.problem(&rig, |_| true)?);
            let without = self.board.fit(&rig, Some((&x, &self.best.pieces)), &REFIT)?;
            let (now, there) = (self.judged(&self.best.blocks), self.judged(&without.blocks));
            if there.against(&now) < SURE && there.level() < 1.05 * now.level() {
                self.best = without;
                effects.remove(place);
            }
        }
        Ok(())
    }

    /// The effects worth a full refit: the best scores, and those that have none.
    fn short_list(
        &self,
        gram: &Gram,
        now: &Judged,
        context: &Context,
        options: &Options,
    ) -> Vec<Scored> {
        let scores = screen::scores(gram, &self.board.trains);
        let gains = |s: &Scored| s.gain > 12.0 && self.scored(s).level() < now.level() - LEAST;
        let mut all: Vec<Scored> = scores.into_iter().filter(|s| s.plausible && gains(s)).collect();
        let rest = all.split_off(options.short_list.min(all.len()));
        let mut list = all;
        // Far from the truth a gain along a straight line says little; what the judging blocks say of it, more.
        let mut rest: Vec<(f64, Scored)> =
            rest.into_iter().map(|s| (self.scored(&s).level(), s)).collect();
        rest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let more = if now.level() > GROSS { BESIDE } else { 0 };
        list.extend(rest.into_iter().take(more).map(|(_, s)| s));
        for (kind, probes) in gram::lacking(&self.board, &self.best.rig, context) {
            if gram::has_amount(kind) || now.level() < NOTHING {
                continue;
            }
            list.extend(probes.into_iter().map(|values| Scored {
                kind,
                values,
                nominal: Vec::new(),
                gain: 0.0,
                left: Vec::new(),
                plausible: true,
            }));
        }
        list
    }
}

/// The best of the candidates, if it is surely there, with those that cannot be told from it.
fn found(now: &Judged, rated: &[(Candidate, Judged)]) -> Option<Found> {
    let (best, judged) = rated.first()?;
    let gone = shrink(now.level(), judged.level());
    let t = now.against(judged);
    let sure = t >= SURE || (gone > MOST && t >= UNSURE);
    if !sure || gone < WORTH || now.level() - judged.level() < LEAST {
        return None;
    }
    let rival = |(_, other): &&(Candidate, Judged)| {
        let worse = shrink(now.level(), other.level());
        let alike = gone - worse < ALIKE * gone && other.level() < NEAR * judged.level();
        (other.against(judged) < UNSURE || alike) && worse > CLOSE * gone
    };
    let rivals = rated.iter().skip(1).filter(rival).map(|(c, _)| name(c.kind));
    let set: Vec<&'static str> = [name(best.kind)].into_iter().chain(rivals).collect();
    let separated_by =
        if set.len() > 1 { best.kind.about().separated_by.to_owned() } else { String::new() };
    Some(Found { name: set[0], set, values: Vec::new(), shrink: gone, t, separated_by })
}
