//! The effects that are worth a refit, and what a refit makes of them.

use super::{
    GROSS, Walk,
    named::{NOTHING, Rated},
};
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
    effects::{Context, Kind, Shape},
    fit::{FitError, search::Patience},
};
use rayon::prelude::*;

/// What is worth a refit takes so much off the sum of squares, in units of the floor: five standard errors are 25.
const GAIN: f64 = 12.0;

/// And brings the mean squared residual on the judging blocks down by so much, in units of the floor; near it a sum of
/// squares that falls there by as much as on the others says the same.
const FALLS: f64 = 0.01;

/// Near the floor what gains so much is worth a refit.
const TELLS: f64 = 36.0;
const CLOSE: f64 = 2.0;

/// So many of the best are worth a refit whatever the judging blocks say, if they gain ten standard errors.
const FIRST_OF_ALL: usize = 2;
const SURELY: f64 = 100.0;

/// So many more are refitted where the model is far off.
const BESIDE: usize = 20;

/// Enough to come near from far off; after so many simulations on short windows so many go on. A race on the long ones
/// leaves behind what is better in the end.
pub(super) const AFRESH: Patience = Patience { misfit: 20.0, share: 2e-3, simulations: 16 };
const HEAT: usize = 6;
const KEPT: usize = 8;

/// The same for smooth effects, of which the worst are seen sooner.
pub(super) const HEATS: [(usize, usize); 2] = [(3, 14), (HEAT, KEPT)];

/// Of those that go on so many do at once; what leaves so many times what the nearest does on short windows is behind.
const AT_ONCE: usize = 2;
const BEHIND: f64 = 2.0;

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
    pub(super) fn points(&self) -> Vec<&Fitted> {
        let level = self.judged(&self.best.blocks).level();
        let lost =
            level > GROSS || (level > NOTHING && model::dragged(&self.best.rig, &self.origin.rig));
        if lost { vec![&self.origin, &self.best] } else { vec![&self.best] }
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
        let points = self.points();
        let far = points.len() > 1;
        let mut all: Vec<Candidate> = Vec::new();
        for (place, point) in points.iter().enumerate() {
            // What went far takes the waves along, and what it leaves shows others.
            let elsewhere = far && place == 0;
            let context = &if elsewhere { self.waved(point, context) } else { *context };
            let gram = match start {
                Some(gram) if place + 1 == points.len() => gram.clone(),
                _ => Gram::of(&self.board, point, (context, false))?,
            };
            let there = self.judged(&point.blocks);
            let mut short = self.short_list(&gram, &there, context, options);
            if elsewhere {
                short.extend(self.turned(&gram, &short));
            }
            if round > 0 && now.level() < NOTHING {
                short.truncate(FEW.max(short.iter().take_while(|s| s.gain > TELLS).count().min(4)));
            }
            // Far from the truth the derivatives say little of where the other parameters are.
            if far && place == 0 && !self.board.imposed() {
                all.extend(self.afresh(point, &short, (&now, context)));
                if all.iter().any(|c| self.down(&now, c, context)) {
                    break;
                }
            } else {
                let near = |scored: &Scored| model::refit(&self.board, point, scored).ok();
                all.extend(short.par_iter().filter_map(near).collect::<Vec<Candidate>>());
            }
        }
        Ok(all)
    }

    /// The effects refitted from a `point` far from the truth by way of short windows; those go on that are near there.
    fn afresh(
        &self,
        point: &Fitted,
        list: &[Scored],
        (now, context): (&Judged, &Context),
    ) -> Vec<Candidate> {
        let all: Vec<(Kind, Rig)> =
            list.iter().map(|scored| (scored.kind, model::with(point, scored))).collect();
        self.longer(self.short.raced(&all, &HEATS, &AFRESH), (now, context))
    }

    /// What came near on short windows, refitted on the long ones, the nearest first; what is far behind there is not
    /// where one of these explains all.
    pub(super) fn longer(
        &self,
        mut near: Vec<(f64, Kind, Rig)>,
        (now, context): (&Judged, &Context),
    ) -> Vec<Candidate> {
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let behind = near.first().map_or(0.0, |(nearest, ..)| nearest + BEHIND.ln());
        let mut all: Vec<Candidate> = Vec::new();
        for some in near.chunks(AT_ONCE) {
            if some[0].0 > behind && all.iter().any(|c| self.down(now, c, context)) {
                break;
            }
            let one = |(_, kind, rig): &(f64, Kind, Rig)| {
                Some(Candidate { kind: *kind, fitted: self.board.fit(rig, None, &AFRESH).ok()? })
            };
            all.extend(some.par_iter().filter_map(one).collect::<Vec<Candidate>>());
        }
        all
    }

    /// Whether a candidate is plausible.
    pub(super) fn fits(&self, candidate: &Candidate, context: &Context) -> bool {
        let others = [&self.best.rig, &self.origin.rig, &self.given];
        model::plausible(&candidate.fitted.rig, candidate.kind, context, &others)
    }

    /// How sure it is that an effect is there, by what it changes of a model that is not far off [1]; 0 elsewhere, where what is
    /// left is not noise, and where the motion is imposed, whose sensor's noise is in what an effect changes as well as in
    /// what is left.
    pub(super) fn evidence(&self, without: &Fitted, with: &Fitted) -> f64 {
        let near = !self.board.imposed() && self.judged(&without.blocks).level() < GROSS;
        if near { self.board.evidence(without, with).unwrap_or(0.0) } else { 0.0 }
    }

    /// The candidates as they are judged, the best first, each effect once as far as it is plausible and once else.
    pub(super) fn rated(&self, candidates: Vec<Candidate>, context: &Context) -> Vec<Rated> {
        let weighed = self.weighed(&self.best);
        let one = |candidate: Candidate| {
            let judged = self.judged(&candidate.fitted.blocks);
            // What begins where it was tried fits what a break-away leaves wherever it can.
            let smooth = candidate.kind.tried().is_empty();
            let evidence = if smooth { self.evidence(&self.best, &candidate.fitted) } else { 0.0 };
            let plausible = self.fits(&candidate, context)
                && self.sharper(&candidate)
                && self.beyond_noise(weighed.as_ref(), &candidate);
            let together = self.best.sum() - candidate.fitted.sum();
            Rated { candidate, judged, evidence, together, plausible }
        };
        let mut rated: Vec<Rated> = candidates.into_iter().map(one).collect();
        rated.sort_by(|a, b| a.judged.level().total_cmp(&b.judged.level()));
        let mut seen = Vec::new();
        rated.retain(|r| {
            let own = (r.candidate.kind, r.plausible);
            let first = !seen.contains(&own);
            seen.push(own);
            first
        });
        rated
    }

    /// Puts candidates down in the ranking.
    pub(super) fn rank(&mut self, rated: &[Rated], (round, now): (usize, &Judged)) {
        self.ranking.extend(rated.iter().map(|r| Ranked {
            name: name(r.candidate.kind),
            shrink: shrink(now.level(), r.judged.level()),
            t: now.against(&r.judged),
            plausible: r.plausible,
            round,
        }));
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

    /// Effects of which a straight line far from the truth asks for less than nothing, with as much of the other sign:
    /// where the nominal parameters are wrong as well it says little of that.
    fn turned(&self, gram: &Gram, list: &[Scored]) -> Vec<Scored> {
        let scores = screen::scores(gram, false, &self.board.trains);
        let listed = |kind: Kind| list.iter().any(|s| s.kind == kind);
        let smooth = |s: &Scored| s.kind.tried().is_empty() && s.gain > SURELY;
        let all = scores.into_iter().filter(|s| !s.plausible && smooth(s) && !listed(s.kind));
        let turned = |s: Scored| {
            let keys = s.kind.about().keys.iter().zip(&s.values);
            let values = keys.map(|(key, v)| if key.shape == Shape::Amount { -v } else { *v });
            Scored::unscored(s.kind, values.collect())
        };
        all.map(turned).collect()
    }

    /// The effects worth a full refit: the best scores, and those that have none.
    fn short_list(
        &self,
        gram: &Gram,
        there: &Judged,
        context: &Context,
        options: &Options,
    ) -> Vec<Scored> {
        let (far, quiet) = (there.level() > GROSS, there.level() < NOTHING);
        let scores = screen::scores(gram, !far, &self.board.trains);
        let gains = |than: &Judged| -> Vec<Scored> {
            let gains = |s: &&Scored| {
                let with = self.scored(s);
                let near = quiet && than.gained(&with) > GAIN;
                s.gain > GAIN && (near || with.level() < than.level() - FALLS)
            };
            let smooth = |s: &&Scored| s.kind.tried().is_empty() && s.plausible;
            // Where a straight line leads too far only a refit can tell.
            let first = scores.iter().filter(smooth).take(FIRST_OF_ALL);
            let surely: Vec<Kind> = first.filter(|s| s.gain > SURELY).map(|s| s.kind).collect();
            let tells = |s: &&Scored| there.level() < CLOSE && s.gain > TELLS;
            let worth = |s: &&Scored| gains(s) || surely.contains(&s.kind) || tells(s);
            scores.iter().filter(smooth).filter(worth).cloned().collect()
        };
        let mut all = gains(there);
        if all.is_empty() && far {
            // Far off straight lines lead the other parameters astray as well: beside what they give without an effect.
            all = gains(&self.judged(&screen::without(gram, !far, &self.board.trains)));
        }
        let rest = all.split_off(options.short_list.min(all.len()));
        let mut list = all;
        // Far from the truth a gain along a straight line says little; what the judging blocks say of it, more.
        let mut rest: Vec<(f64, Scored)> =
            rest.into_iter().map(|s| (self.scored(&s).level(), s)).collect();
        rest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let more = if far { BESIDE } else { 0 };
        list.extend(rest.into_iter().take(more).map(|(_, s)| s));
        for (kind, probes) in gram::lacking(&self.board, &self.best.rig, context) {
            if gram::has_amount(kind) || quiet {
                continue;
            }
            list.extend(probes.into_iter().map(|values| Scored::unscored(kind, values)));
        }
        list
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        gram::Gram,
        walk::made::{self, BIAS, context, data, rig, walk, with},
    };
    use identify::{effects::Kind, fit::Seen};

    #[test]
    fn a_model_that_is_far_off_is_left_from_the_given_values_as_well() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        walk.given.free = vec!["mass".to_owned()];
        let found = with(&walk.given, Kind::CurrentBias, &[0.1]);
        let mut dragged = found.clone();
        identify::fit::binding::set(&mut dragged, "mass", 1.3);
        walk.best = walk.board.judged(&dragged, None).unwrap();
        walk.origin = walk.beside_given().unwrap();
        let masses: Vec<Option<f64>> = walk.points().iter().map(|p| p.rig.value("mass")).collect();
        assert_eq!(masses, [Some(2.0), Some(1.3)]);
        assert_eq!(walk.origin.rig.value("current_bias.bias"), Some(0.1), "as it was found");
        // What is near is left from where it is.
        walk.best =
            walk.board.judged(&with(&walk.given, Kind::CurrentBias, &[BIAS]), None).unwrap();
        walk.origin = walk.beside_given().unwrap();
        assert_eq!(walk.points().len(), 1);
    }

    #[test]
    fn what_a_straight_line_asks_the_other_sign_of_is_tried_far_from_the_truth() {
        // With three times the drag that there is less than none more is asked for.
        let data = data();
        let mut nominal = rig(2.0);
        nominal.friction.sigma_2 = 1.5;
        let walk = walk(&nominal, &data, &[]);
        let gram = Gram::of(&walk.board, &walk.best, (&context(&walk), false)).unwrap();
        let turned = walk.turned(&gram, &[]);
        let drag = turned.iter().find(|s| s.kind == Kind::QuadraticDrag).unwrap();
        assert!(drag.values[0] > 0.1, "{:?}", drag.values);
        let again = walk.turned(&gram, &turned);
        assert!(again.is_empty(), "what is listed is not turned: {again:?}");
    }

    #[test]
    fn what_is_far_behind_is_left_where_one_explains_all() {
        let data = data();
        let walk = walk(&rig(2.0), &data, &[]);
        let (context, now) = (context(&walk), walk.judged(&walk.best.blocks));
        let near = |first: f64, bias: f64| {
            let right = with(&rig(2.0), Kind::CurrentBias, &[bias]);
            let others = [Kind::QuadraticDrag, Kind::CubicSpring, Kind::ViscousAsymmetry];
            let others = others.map(|kind| (first + 1.0, kind, with(&rig(2.0), kind, &[0.0])));
            let all = others.into_iter().chain([(first, Kind::CurrentBias, right)]).collect();
            walk.longer(all, (&now, &context)).len()
        };
        // e times as far are two of four more than twice.
        assert_eq!(near(0.0, BIAS), 2);
    }

    #[test]
    fn what_is_missing_is_told_by_what_it_changes_and_what_is_not_is_not() {
        let data = data();
        let told = |kind: Kind, amount: f64| {
            let walk = walk(&with(&rig(2.0), Kind::CurrentBias, &[0.9 * BIAS]), &data, &[]);
            let from = if kind == Kind::CurrentBias { &rig(2.0) } else { &walk.best.rig };
            let other = walk.board.judged(&with(from, kind, &[amount]), None).unwrap();
            walk.evidence(&walk.best, &other)
        };
        let right = told(Kind::CurrentBias, BIAS);
        assert!(right > super::super::named::TELLS, "{right}");
        assert!(told(Kind::CurrentBias, 0.8 * BIAS) < 0.0, "the other way");
        for kind in [Kind::QuadraticDrag, Kind::CubicSpring] {
            let wrong = told(kind, 1e-3);
            assert!(wrong.abs() < super::super::named::TELLS, "{kind:?} {wrong}");
        }
    }

    #[test]
    fn an_imposed_motion_whose_sensor_trembles_tells_nothing_by_what_changes() {
        // One way all along, so that the model comes to the floor of 1 mN.
        let mut data = made::slide(0.0);
        (0_u32..).zip(&mut data.input).for_each(|(i, x)| *x = 1e-4 * f64::from(i));
        let force = data.force.take().unwrap();
        let onward = force.values.iter().map(|f| f.abs()).collect();
        data.force = Some(Seen::new("force", onward, 0.0));
        let walk = made::walk(&made::slides(1.497), &data, &[]);
        let right = walk.board.judged(&made::slides(1.5), None).unwrap();
        assert!(walk.judged(&walk.best.blocks).level() < super::GROSS);
        let more = walk.board.evidence(&walk.best, &right).unwrap();
        assert!(more > super::super::named::TELLS, "{more}");
        assert_eq!(walk.evidence(&walk.best, &right), 0.0);
    }
}
