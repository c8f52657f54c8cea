//! The effects that are worth a refit, and what a refit makes of them.

use super::{DOWN, GROSS, NOTHING, Walk};
use crate::{
    board::Fitted,
    decide::{Judged, shrink},
    gram::{self, Gram},
    model::{self, Candidate},
    screen::{self, Scored},
    verdict::{Options, Ranked, name},
};
use identify::{
    Rig,
    effects::{Context, Kind},
    fit::{FitError, search::Patience},
};
use rayon::prelude::*;

/// What is worth a refit takes so much off the sum of squares, in units of the floor: five standard errors are 25.
const GAIN: f64 = 12.0;

/// And brings the mean squared residual on the judging blocks down by so much, in units of the floor; near it a sum of
/// squares that falls there by as much as on the others says the same.
const FALLS: f64 = 0.01;

/// So many more are refitted where the model is far off.
const BESIDE: usize = 20;

/// Enough to come near from far off; after so many simulations on short windows so many go on. A race on the long ones
/// leaves behind what is better in the end.
const AFRESH: Patience = Patience { misfit: 20.0, share: 2e-3, simulations: 16 };
const HEAT: usize = 6;
const KEPT: usize = 8;

/// The same for what does not begin smoothly.
const BEGUN: [(usize, usize); 3] = [(2, 10), (4, 4), (HEAT, 2)];

/// What does not begin smoothly and leaves more than a right model is begun once more from so many times its amount.
const AROUND: [f64; 4] = [0.8, 0.9, 1.1, 1.25];

/// Near the floor so few are worth a look.
const FEW: usize = 2;

/// So many candidates are followed to their ends, and those that leave no more than so many times the best.
const FOLLOWED: usize = 3;
const ENDS: f64 = 1.5;

/// What leaves so many times what another does that comes down to the floor is not followed.
const HOPELESS: f64 = 10.0;

impl Walk<'_> {
    /// Where effects are looked for from: where the model is and, before it, where it was before its refit if that went
    /// far and may have gone astray.
    pub(super) fn points(&self, round: usize) -> Vec<&Fitted> {
        let level = self.judged(&self.best.blocks).level();
        let lost =
            level > GROSS || (level > NOTHING && model::dragged(&self.best.rig, &self.origin.rig));
        if round == 0 && lost { vec![&self.origin, &self.best] } else { vec![&self.best] }
    }

    /// The effects worth a refit, each refitted as far as a glance goes: from where the model is and, where that is
    /// far off or was dragged far, from where it was before its own refit as well.
    pub(super) fn candidates(
        &self,
        context: &Context,
        options: &Options,
        (round, start): (usize, Option<&Gram>),
    ) -> Result<Vec<Candidate>, FitError> {
        let now = self.judged(&self.best.blocks);
        let points = self.points(round);
        let far = points.len() > 1;
        let mut all: Vec<Candidate> = Vec::new();
        for (place, point) in points.iter().enumerate() {
            let gram = match start {
                Some(gram) if place + 1 == points.len() => gram.clone(),
                _ => Gram::of(&self.board, point, (context, false))?,
            };
            let there = self.judged(&point.blocks);
            let mut short = self.short_list(&gram, &there, context, options);
            if round > 0 && now.level() < NOTHING {
                short.truncate(FEW);
            }
            // Far from the truth the derivatives say little of where the other parameters are.
            if far && place == 0 && !self.board.imposed() {
                all.extend(self.afresh(point, &short));
            } else {
                let near = |scored: &Scored| model::refit(&self.board, point, scored).ok();
                all.extend(short.par_iter().filter_map(near).collect::<Vec<Candidate>>());
            }
        }
        Ok(all)
    }

    /// What does not begin smoothly, and so has no score, refitted from a `point` by way of short windows, from each
    /// amount and shape at which it is tried.
    pub(super) fn begun(&self, point: &Fitted, context: &Context) -> Vec<Candidate> {
        let mut near = Vec::new();
        for (kind, probes) in gram::lacking(&self.board, &self.best.rig, context) {
            let one = |(probe, tried): (&Vec<f64>, &f64)| {
                let values = gram::tried(kind, probe, *tried, context);
                (kind, model::with(point, &Scored::unscored(kind, values)))
            };
            let each = probes.iter().flat_map(|p| kind.tried().iter().map(move |t| (p, t)));
            let all: Vec<(Kind, Rig)> = each.map(one).collect();
            near.extend(self.short.raced(&all, &BEGUN, &AFRESH));
        }
        self.longer(near)
    }

    /// What does not begin smoothly once more, if it is the nearest of all and not down at the floor, from a little more
    /// and a little less of it: wherever the load meets its tooth between other samples there is a minimum of its own.
    pub(super) fn beside(&self, all: &[Candidate]) -> Vec<Candidate> {
        let Some((best, level)) = self.nearest(all) else { return Vec::new() };
        if best.kind.tried().is_empty() || level < DOWN {
            return Vec::new();
        }
        let about = best.kind.about();
        let name = format!("{}.{}", about.name, about.keys[0].name);
        let with = |share: &f64| {
            let mut rig = best.fitted.rig.clone();
            let value = rig.value(&name).unwrap_or(0.0);
            identify::fit::binding::set(&mut rig, &name, share * value);
            (best.kind, rig)
        };
        let all: Vec<(Kind, Rig)> = AROUND.iter().map(with).collect();
        self.longer(self.short.raced(&all, &[(HEAT, 2)], &AFRESH))
    }

    /// The effects refitted from a `point` far from the truth by way of short windows; those go on that are near there.
    fn afresh(&self, point: &Fitted, list: &[Scored]) -> Vec<Candidate> {
        let all: Vec<(Kind, Rig)> =
            list.iter().map(|scored| (scored.kind, model::with(point, scored))).collect();
        self.longer(self.short.raced(&all, &[(HEAT, KEPT)], &AFRESH))
    }

    /// What came near on short windows, refitted on the long ones.
    fn longer(&self, near: Vec<(Kind, Rig)>) -> Vec<Candidate> {
        let one = |(kind, rig): (Kind, Rig)| {
            Some(Candidate { kind, fitted: self.board.fit(&rig, None, &AFRESH).ok()? })
        };
        near.into_par_iter().filter_map(one).collect()
    }

    /// Whether a candidate is plausible.
    pub(super) fn fits(&self, candidate: &Candidate, context: &Context) -> bool {
        let others = [&self.best.rig, &self.origin.rig];
        model::plausible(&candidate.fitted.rig, candidate.kind, context, &others)
    }

    /// The plausible candidates, the best first, each effect once; all of them go to the ranking.
    pub(super) fn rated(
        &mut self,
        candidates: Vec<Candidate>,
        context: &Context,
        (round, now): (usize, &Judged),
    ) -> Vec<(Candidate, Judged)> {
        let mut rated: Vec<(Candidate, Judged, bool)> = candidates
            .into_iter()
            .map(|c| {
                let judged = self.judged(&c.fitted.blocks);
                let fits = self.fits(&c, context);
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
    pub(super) fn followed(&self, candidates: Vec<Candidate>) -> Vec<Candidate> {
        let mut rated: Vec<(f64, Candidate)> =
            candidates.into_iter().map(|c| (self.judged(&c.fitted.blocks).level(), c)).collect();
        rated.sort_by(|a, b| a.0.total_cmp(&b.0));
        let best = rated.first().map_or(0.0, |(level, _)| *level);
        // Where one comes down to the floor, what is far above it will not.
        let far = if best < NOTHING { HOPELESS * best } else { f64::INFINITY };
        let all: Vec<(usize, (f64, Candidate))> = rated.into_iter().enumerate().collect();
        let one = |(place, (level, candidate)): (usize, (f64, Candidate))| {
            if level < ENDS * best || (place < FOLLOWED && level < far) {
                model::follow(&self.board, candidate).ok()
            } else {
                Some(candidate)
            }
        };
        all.into_par_iter().filter_map(one).collect()
    }

    /// The effects worth a full refit: the best scores, and those that have none.
    fn short_list(
        &self,
        gram: &Gram,
        now: &Judged,
        context: &Context,
        options: &Options,
    ) -> Vec<Scored> {
        let far = now.level() > GROSS;
        let scores = screen::scores(gram, !far, &self.board.trains);
        let gains = |s: &Scored| {
            let there = self.scored(s);
            let near = now.level() < NOTHING && now.gained(&there) > GAIN;
            s.gain > GAIN && (near || there.level() < now.level() - FALLS)
        };
        let mut all: Vec<Scored> = scores
            .into_iter()
            .filter(|s| s.kind.tried().is_empty() && s.plausible && gains(s))
            .collect();
        let rest = all.split_off(options.short_list.min(all.len()));
        let mut list = all;
        // Far from the truth a gain along a straight line says little; what the judging blocks say of it, more.
        let mut rest: Vec<(f64, Scored)> =
            rest.into_iter().map(|s| (self.scored(&s).level(), s)).collect();
        rest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let more = if far { BESIDE } else { 0 };
        list.extend(rest.into_iter().take(more).map(|(_, s)| s));
        for (kind, probes) in gram::lacking(&self.board, &self.best.rig, context) {
            if gram::has_amount(kind) || now.level() < NOTHING {
                continue;
            }
            list.extend(probes.into_iter().map(|values| Scored::unscored(kind, values)));
        }
        list
    }
}
