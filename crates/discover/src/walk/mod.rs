//! The way from a record to an answer.

mod answer;
mod candidates;
mod places;
mod polish;

use crate::{
    board::{self, Board, FINE, Fitted, ROUGH},
    decide::{Judged, shrink},
    gram::Gram,
    model::{self, Candidate},
    screen::Scored,
    verdict::{Discovery, Found, Options, Ranked, name},
};
use identify::{
    Rig,
    effects::Context,
    fit::{Data, FitError, search::Patience, starts},
};

/// The windows of a block in a first search.
const SHORT: usize = 4;

/// Enough for the nominal model.
const REFIT: Patience = Patience { misfit: 1.0, share: 5e-5, simulations: 20 };

/// A model is refitted so often at most, as long as the mean squared residual falls below so much of what it was.
const SETTLED: usize = 5;
const AS_BEFORE: f64 = 0.8;

/// Enough to come near.
const FIRST: Patience = Patience { misfit: 20.0, share: 2e-3, simulations: 20 };

/// An effect is taken if it is better on the judging blocks by so many standard errors.
const SURE: f64 = 3.0;

/// The same near the floor.
const CERTAIN: f64 = 3.5;

/// Of two effects the second belongs to the set if it is worse by fewer standard errors, or by less than this
/// share of the excess.
const UNSURE: f64 = 2.0;
const ALIKE: f64 = 0.03;

/// A rival takes away at least so much of what the best one does.
const CLOSE: f64 = 0.8;

/// What takes away so much of the excess need not do so in every block alike.
const MOST: f64 = 0.5;

/// It is no name either if the sum of squares on the judging blocks falls by less than so many squared standard errors.
const LEAST: f64 = 60.0;

/// A rival leaves no more than so many times what the best one does.
const NEAR: f64 = 1.5;

/// An effect is worth a name if it takes away so much of the excess.
const WORTH: f64 = 0.02;

/// Mean squared residual from which on a refit of the nominal model is not trusted to be near the truth.
const GROSS: f64 = 20.0;

/// A right model leaves no more than this.
const DOWN: f64 = 1.02;

/// What takes away so much of the excess explains it.
const ALL: f64 = 0.9;

/// What does not begin smoothly is worth a look where the model leaves so much more than the floor.
const ABOVE: f64 = 1.1;

/// Mean squared residual, in units of the floor, up to which nothing may be missing.
const NOTHING: f64 = 1.4;

/// The walk, as far as it has come.
struct Walk<'a> {
    board: Board<'a>,
    /// The same record in shorter windows.
    short: Board<'a>,
    counts: Vec<f64>,
    best: Fitted,
    /// The model before its refit, in the first round: what is missing drags parameters to where no effect is itself.
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
    let mut strayed: Vec<(String, f64)> =
        loose.iter().filter(|(name, _)| strayed.contains(name)).cloned().collect();
    if !strayed.is_empty() {
        loose.retain(|own| !strayed.contains(own));
        held = board::loosened(rig, &loose);
        (board, refit) = nominal(&held, data, &loose, options.seed)?;
    }
    let rig = &held;
    let channels = refit.blocks.first().map_or(1, Vec::len) as f64;
    let counts: Vec<f64> = board.samples().into_iter().map(|n| n * channels).collect();
    let mut origin = board.judged(rig, None)?;
    if board.trained(&origin) < board.trained(&refit) || astray(&board, &refit, &origin) {
        refit = from_given(&mut board, &origin, options.seed)?;
        origin = board.again(&origin)?;
    }
    let short = Board::of(rig, data, SHORT, loose.clone())?;
    let mut walk = Walk { board, short, counts, best: refit, origin, ranking: Vec::new() };
    walk.near_the_floor()?;
    let refit = walk.best.clone();
    let context = model::context(&walk.board, &refit);
    // To say how little of each would show.
    let start = Gram::of(&walk.board, &refit, (&context, true))?;
    let mut effects: Vec<Found> = Vec::new();
    for round in 0..options.most {
        let first = Some(&start).filter(|_| round == 0);
        let Some(found) = walk.step(&context, options, (round, first))? else { break };
        // A refit of what was taken is not the next effect's to claim.
        walk.best = settled(&mut walk.board, walk.best, options.seed)?;
        walk.near_the_floor()?;
        walk.origin = walk.best.clone();
        walk.reclaim(&mut strayed)?;
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
    let first = board.refined(&first, FINE)?;
    board.refloor(&first, seed)?;
    let refit = board.again(&first)?;
    let refit = settled(&mut board, refit, seed)?;
    Ok((board, refit))
}

/// A model refitted for as long as it comes much nearer. The nearer it is the less its steps may be wrong by, and what
/// noise leaves is known the better.
fn settled(board: &mut Board<'_>, mut fitted: Fitted, seed: u64) -> Result<Fitted, FitError> {
    for _ in 0..SETTLED {
        let before = board.trained_level(&fitted);
        fitted = board.fit(&fitted.rig, Some((&fitted.x, &fitted.pieces)), &REFIT)?;
        fitted = board.refined(&fitted, FINE)?;
        board.refloor(&fitted, seed)?;
        fitted = board.again(&fitted)?;
        if board.trained_level(&fitted) > AS_BEFORE * before {
            break;
        }
    }
    Ok(fitted)
}

/// The model refitted from the given values alone: where they are right already, a search by way of short windows
/// may lead away from them.
fn from_given(board: &mut Board<'_>, given: &Fitted, seed: u64) -> Result<Fitted, FitError> {
    let given = board.refined(given, FINE)?;
    board.refloor(&given, seed)?;
    let given = board.again(&given)?;
    let refit = board.fit(&given.rig, Some((&given.x, &given.pieces)), &REFIT)?;
    let better = board.trained(&refit) < board.trained(&given);
    Ok(if better && !astray(board, &refit, &given) { refit } else { given })
}

/// Whether a refit says nothing: the model is far off with it, and a parameter went to what is absurd. A mass without
/// friction that is to come to rest is best as heavy as can be.
fn astray(board: &Board<'_>, refit: &Fitted, given: &Fitted) -> bool {
    board.trained_level(refit) > GROSS && !model::reasonable(&refit.rig, &given.rig)
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
        if now.level() > GROSS {
            self.board.refine(&self.best, ROUGH)?;
        }
        let candidates = self.candidates(context, options, (round, start))?;
        let mut all = self.finely(candidates)?;
        // The race of what does not begin smoothly takes as long as all else: what comes down to the floor needs none.
        let down = |c: &Candidate| {
            let level = self.judged(&c.fitted.blocks).level();
            level < ABOVE && shrink(now.level(), level) > ALL && self.fits(c, context)
        };
        if now.level() > ABOVE && !all.iter().any(down) {
            let joints = self.begun(self.points(round)[0], context);
            all.extend(self.finely(joints)?);
            let beside = self.beside(&all);
            all.extend(self.finely(beside)?);
        }
        let rated = self.rated(all, context, (round, &now));
        let Some((best, found)) = found(&now, &rated) else { return Ok(None) };
        self.best = best.fitted.clone();
        Ok(Some(found))
    }

    /// The nearest of the candidates, and what it leaves.
    fn nearest<'c>(&self, candidates: &'c [Candidate]) -> Option<(&'c Candidate, f64)> {
        let level = |c: &'c Candidate| (c, self.judged(&c.fitted.blocks).level());
        candidates.iter().map(level).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The candidates followed to their ends, with steps as short as the nearest asks for.
    fn finely(&mut self, candidates: Vec<Candidate>) -> Result<Vec<Candidate>, FitError> {
        if let Some((best, _)) = self.nearest(&candidates) {
            self.board.refine(&best.fitted, FINE)?;
        }
        Ok(self.followed(candidates))
    }

    /// What had strayed because an effect was missing is a little loose again where it no longer strays.
    fn reclaim(&mut self, strayed: &mut Vec<(String, f64)>) -> Result<(), FitError> {
        if strayed.is_empty() {
            return Ok(());
        }
        let rig = board::loosened(&self.best.rig, strayed);
        let held = self.board.loose.len();
        self.board.loose.append(&mut strayed.clone());
        let x = starts::nominal(&self.board.problem(&rig, |_| true)?);
        let fitted = self.board.fit(&rig, Some((&x, &self.best.pieces)), &REFIT)?;
        let better = self.board.trained(&fitted) < self.board.trained(&self.best);
        if better && self.board.strayed(&fitted).is_empty() {
            self.best = fitted;
            self.origin = self.best.clone();
            strayed.clear();
        } else {
            self.board.loose.truncate(held);
        }
        Ok(())
    }
}

/// The best of the candidates, if it is surely there, with those that cannot be told from it; of these the simplest
/// goes first, for what needs more numbers fits more than there is.
fn found<'c>(now: &Judged, rated: &'c [(Candidate, Judged)]) -> Option<(&'c Candidate, Found)> {
    let (best, judged) = rated.first()?;
    // What noise leaves is known to a tenth or so: what lies below is no excess.
    let floor = judged.level().min(1.0);
    let share = |other: &Judged| shrink(now.level() / floor, other.level() / floor);
    let gone = share(judged);
    // Near the floor a few dozen effects are tried on nothing, and the best of them is better by chance.
    let quiet = now.level() < NOTHING;
    let t = now.against(judged);
    let sure = if quiet {
        t >= CERTAIN || (gone > MOST && now.everywhere(judged) >= CERTAIN)
    } else {
        t >= SURE || (gone > MOST && t >= UNSURE)
    };
    if !sure || gone < WORTH || now.gained(judged) < LEAST {
        return None;
    }
    let rival = |(_, other): &&(Candidate, Judged)| {
        let worse = share(other);
        let alike = gone - worse < ALIKE * gone && other.level() < NEAR * judged.level();
        (other.against(judged) < UNSURE || alike) && worse > CLOSE * gone
    };
    let mut alike = vec![(best, judged)];
    alike.extend(rated.iter().skip(1).filter(rival).map(|(c, judged)| (c, judged)));
    alike.sort_by_key(|(c, _)| c.kind.about().keys.len());
    let (best, judged) = alike[0];
    let set: Vec<&'static str> = alike.iter().map(|(c, _)| name(c.kind)).collect();
    let separated_by =
        if set.len() > 1 { best.kind.about().separated_by.to_owned() } else { String::new() };
    let (shrink, t) = (share(judged), now.against(judged));
    Some((best, Found { name: set[0], set, values: Vec::new(), shrink, t, separated_by }))
}

#[cfg(test)]
mod tests {
    use super::{Candidate, Fitted, Judged, found};
    use identify::{Rig, effects::LAWS};

    const RIG: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n\
        [friction]\nname = \"none\"\nsigma_2 = 0.5\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n";

    /// Twenty blocks of 300 residuals about this mean square, one a little above and one below it in turn.
    fn judged(mean: f64, apart: f64) -> Judged {
        let block = |k: usize| mean + if k.is_multiple_of(2) { apart } else { -apart };
        Judged { blocks: (0..20).map(block).collect(), counts: vec![300.0; 20] }
    }

    fn candidate(place: usize) -> Candidate {
        let rig = Rig::parse(RIG).unwrap();
        let fitted = Fitted { rig, x: Vec::new(), pieces: Vec::new(), blocks: Vec::new() };
        Candidate { kind: LAWS[place], fitted }
    }

    #[test]
    fn what_a_floor_told_too_high_hides_is_found() {
        // 0.03 of 6000 residuals are 180: thirteen standard errors, though all of it lies below the floor.
        let now = judged(0.9, 0.01);
        let rated = [(candidate(0), judged(0.87, 0.008)), (candidate(1), judged(0.899, 0.01))];
        let (_, taken) = found(&now, &rated).expect("an effect");
        assert_eq!((taken.set.len(), taken.shrink), (1, 1.0));
        // And 0.005 of them 30, which the best of a few dozen effects may come to.
        let rated = [(candidate(0), judged(0.895, 0.01))];
        assert!(found(&now, &rated).is_none());
    }

    #[test]
    fn what_is_better_in_every_block_is_found_however_unlike_these_are() {
        let with = |first: f64, rest: f64| {
            let blocks = (0..20).map(|k| if k == 0 { first } else { rest + 0.001 * f64::from(k) });
            Judged { blocks: blocks.collect(), counts: vec![300.0; 20] }
        };
        let (now, then) = (with(50.0, 1.1), with(0.6, 1.0));
        assert!(now.level() < super::NOTHING && now.against(&then) < super::CERTAIN);
        assert!(found(&now, &[(candidate(0), then)]).is_some());
        // In half of the blocks only it is chance.
        let mut half = with(0.6, 1.0);
        half.blocks.iter_mut().skip(1).step_by(2).for_each(|block| *block += 0.2);
        assert!(found(&now, &[(candidate(0), half)]).is_none());
    }
}
