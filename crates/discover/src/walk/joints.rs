//! What does not begin smoothly: a load behind a joint.

use super::{
    ABOVE, DOWN, Walk,
    candidates::AFRESH,
    dips::{amounts, dips},
    loads::{is_soft, lightened, shared},
    named::NOTHING,
};
use crate::{
    board::{Ahead, Board, Fitted},
    decide::Judged,
    gram,
    model::{self, Candidate},
    screen::Scored,
    wind::wind,
};
use identify::{
    Rig,
    effects::{Context, Kind, LAWS},
    fit::{FitError, binding},
};
use rayon::prelude::*;

/// What does not begin smoothly is looked for in so many rounds: where there is a play nothing else comes near, so that it is
/// found first, or beside what was.
const ROUNDS: usize = 2;

/// So many beginnings of each kind are fitted beside each model; after so many simulations so many go on, and twice as many
/// where there are two models.
const FIRST: usize = 6;
const HEATS: [(usize, usize); 2] = [(3, 3), (8, 2)];
const LOST: [(usize, usize); 2] = [(3, 6), (8, 2)];

/// After its race it goes on if it has taken away so much of the logarithm of what the model leaves above the floor: of 13 that
/// were found it was a quarter at least. Below so many floors a race says nothing: of one, at 1.8, it saw a hundredth. On
/// short windows, most of which show nothing of a play, it says which is nearer and no more.
const SEEN: f64 = 0.1;
const CLEARLY: f64 = 3.0;

/// What leaves so many times what the nearest does is followed no further.
const BEHIND: f64 = 3.0;

/// Near the floor it is fitted if it takes so much of the logarithm of what the windows leave: on twelve records that lack
/// nothing it took 0.006 at most, on three in which a gear gives way beside another effect 0.009 at least.
const GIVES: f64 = 0.008;

/// A play is tried there where the model leaves so much: right models of records leave less as a rule.
const PLAYS: f64 = 1.04;

/// The windows of a block where that of the short ones lead to nothing, and what a record must show of a joint for them, in
/// standard deviations of its displacement.
const SHORTEST: usize = 16;
const GIVES_WAY: f64 = 5.0;

/// It is begun once more from so many times its amount, where it leaves more than a right model.
const AROUND: [f64; 4] = [0.8, 0.9, 1.1, 1.25];

/// And from so many times its load, and the damping or the time in which that comes to rest on it.
const SHAPES: [&str; 3] = ["ratio", "damping", "teeth"];
const TIMES: [f64; 2] = [0.5, 2.0];

/// Of these so many are fitted.
const KEPT: usize = 2;

/// So is one of another kind that leaves no more than so many times what the nearest does.
const RIVAL: f64 = 1.3;

/// What is begun once more is as good as a model with an effect more if it leaves no more than so many times as much.
pub(super) const AS_NEAR: f64 = 1.005;

impl Walk<'_> {
    /// Whether what does not begin smoothly is worth a look in this round, where the model leaves this `level`.
    pub(super) fn may_begin(&self, level: f64, round: usize) -> bool {
        self.joins && round < ROUNDS && level > ABOVE && !self.explained(level)
    }

    /// What does not begin smoothly, and so has no score, refitted from the amounts of each shape that go along best with
    /// a model. Far from the truth the model itself and what it was before its refit are begun with, on short windows: a
    /// load that meets its tooth too early takes another way from there on, and on long windows each amount is a minimum
    /// of its own; where the record itself shows that there is a joint, on still shorter ones as well.
    pub(super) fn begun(&self, context: &Context) -> Vec<Candidate> {
        let lost = self.judged(&self.best.blocks).level() > CLEARLY;
        let mut all = self.begun_on(if lost { &self.short } else { &self.board }, lost, context);
        let near = self.nearest(&all).is_some_and(|(_, least)| least < ABOVE);
        if lost && !near && self.gives() {
            all.extend(self.begun_on(&self.short.cut(SHORTEST), lost, context));
        }
        if let Some((_, least)) = self.nearest(&all) {
            all.retain(|c| self.judged(&c.fitted.blocks).level() < BEHIND * least);
        }
        all
    }

    /// The same on the windows of one board.
    fn begun_on(&self, board: &Board<'_>, lost: bool, context: &Context) -> Vec<Candidate> {
        let now = self.judged(&self.best.blocks);
        let gross = self.points().len() > 1;
        let points = if lost { vec![&self.origin, &self.best] } else { self.points() };
        let heats = if lost { &LOST } else { &HEATS };
        let there = |fitted: &Fitted| {
            if lost { board.judged(&fitted.rig, None) } else { Ok(fitted.clone()) }
        };
        let shown = self.shown(context);
        let many = |kind| amounts(kind, shown).len();
        let mut near: Vec<(usize, Ahead)> = Vec::new();
        for (place, point) in points.iter().enumerate() {
            let rigs = self.tried(point, context);
            if let Ok((alone, all)) = there(point).and_then(|point| board.ahead(&point, &rigs)) {
                let dips = || dips(&rigs, (alone, &all), many);
                let (place, all) = if lost { (place, dips()) } else { (0, all) };
                near.extend(all.into_iter().map(|a| (place, a)));
            }
        }
        near.sort_by(|(_, a), (_, b)| a.far.total_cmp(&b.far));
        let raced = LAWS.iter().flat_map(|kind| {
            let [stiff, soft] = firsts(&near, points.len(), *kind);
            let all = [stiff, soft, self.slow(*kind, context)];
            all.map(|begun| board.raced(&begun, heats, &AFRESH)).into_iter().flatten()
        });
        let alone = there(&self.best).map_or(f64::INFINITY, |best| board.far(&best));
        let least = match now.level() {
            level if level < CLEARLY => f64::INFINITY,
            _ if gross => alone,
            level => alone - SEEN * level.ln(),
        };
        let raced: Vec<(f64, Kind, Rig)> = raced.filter(|(far, ..)| *far < least).collect();
        if lost && !gross { self.by_short(&raced) } else { self.longer(raced, (&now, context)) }
    }

    /// What came near on short windows, refitted from the given values of what is no effect's, on short windows first: in a
    /// race these go where a play that is still another one is less wrong. From far off they are right to go.
    fn by_short(&self, near: &[(f64, Kind, Rig)]) -> Vec<Candidate> {
        let one = |(_, kind, rig): &(f64, Kind, Rig)| {
            let fitted = self.board.refit(&self.at_given(rig), Some(&self.short), &AFRESH).ok()?;
            Some(Candidate { kind: *kind, fitted })
        };
        near.par_iter().filter_map(one).collect()
    }

    /// A gear that gives way, where the model leaves little more than noise, and a play where it leaves a little more than that:
    /// the amount and load of each that go along best with the model, fitted if that gains something.
    pub(super) fn nearly_rigid(&self, context: &Context) -> Vec<Candidate> {
        let now = self.judged(&self.best.blocks);
        let mut rigs = self.tried(&self.best, context);
        rigs.retain(|(kind, _)| begun_near(*kind, now.level()));
        let Ok((alone, all)) = self.board.ahead(&self.best, &rigs) else { return Vec::new() };
        let nearest = |kind: &Kind| all.iter().find(|a| a.kind == *kind && alone - a.far > GIVES);
        let near = LAWS.iter().filter_map(nearest).map(|a| (a.far, a.kind, a.rig.clone()));
        self.longer(near.collect(), (&now, context))
    }

    /// The model with each of what does not begin smoothly, in each amount and shape at which it is tried.
    pub(super) fn tried(&self, point: &Fitted, context: &Context) -> Vec<(Kind, Rig)> {
        let lacking = gram::lacking(&self.board, &self.best.rig, context);
        let shown = self.shown(context);
        let one = |kind: Kind, probe: &[f64], tried: f64| {
            let values = gram::tried(kind, probe, tried, context);
            let rig = model::with(point, &Scored::unscored(kind, values));
            (kind, shared(lightened(kind, rig), kind))
        };
        let each = |(kind, probes): &(Kind, Vec<Vec<f64>>)| -> Vec<(Kind, Rig)> {
            let amounts = amounts(*kind, shown);
            let along = |probe: &Vec<f64>| -> Vec<(Kind, Rig)> {
                amounts.iter().map(|tried| one(*kind, probe, *tried)).collect()
            };
            probes.iter().flat_map(along).collect()
        };
        lacking.iter().flat_map(each).collect()
    }

    /// Whether the record itself shows that motor and load are not one.
    fn gives(&self) -> bool {
        let noise = self.board.weights.displacement;
        wind(self.board.data).is_some_and(|wide| wide > GIVES_WAY * noise)
    }

    /// How wide a play the record itself shows, of its natural size.
    fn shown(&self, context: &Context) -> Option<f64> {
        wind(self.board.data).map(|wide| wide / context.span)
    }

    /// What does not begin smoothly once more, if it is the nearest of all and not down at the floor, and its rivals of
    /// another kind.
    pub(super) fn beside(&self, all: &[Candidate], context: &Context) -> Vec<Candidate> {
        let Some((best, least)) = self.nearest(all) else { return Vec::new() };
        if best.kind.tried().is_empty() || least < DOWN {
            return Vec::new();
        }
        let joints = LAWS.iter().filter(|kind| !kind.tried().is_empty());
        let rivals = joints.filter_map(|kind| {
            let own: Vec<Candidate> = all.iter().filter(|c| c.kind == *kind).cloned().collect();
            let (nearest, level) = self.nearest(&own)?;
            (level < RIVAL * least).then(|| nearest.clone())
        });
        let rivals: Vec<Candidate> = rivals.collect();
        rivals.iter().flat_map(|rival| self.around(rival.kind, &rival.fitted, context)).collect()
    }

    /// What does not begin smoothly once more from a little more and a little less of it than a model has, and from another
    /// load: wherever the load meets its tooth between other samples there is a minimum of its own.
    fn around(&self, kind: Kind, fitted: &Fitted, context: &Context) -> Vec<Candidate> {
        let about = kind.about();
        let with = |(key, share): (&str, f64)| {
            let name = format!("{}.{key}", about.name);
            let mut rig = fitted.rig.clone();
            let value = rig.value(&name)?;
            binding::set(&mut rig, &name, share * value);
            Some((kind, rig))
        };
        let amounts = AROUND.map(|share| (about.keys[0].name, share));
        let shapes = SHAPES.iter().flat_map(|key| TIMES.map(|share| (*key, share)));
        let all: Vec<(Kind, Rig)> = amounts.into_iter().chain(shapes).filter_map(with).collect();
        let Ok((_, all)) = self.board.ahead(fitted, &all) else { return Vec::new() };
        let near = all.into_iter().take(KEPT).map(|a| (a.far, a.kind, a.rig)).collect();
        self.longer(near, (&self.judged(&self.best.blocks), context))
    }

    /// The last model, if it is near the floor and has what does not begin smoothly, with that begun once more: if it
    /// then leaves no more than what has an effect more, `found`.
    pub(super) fn joint_anew(
        &self,
        now: &Judged,
        found: &Fitted,
        context: &Context,
    ) -> Result<Option<Fitted>, FitError> {
        let has = |kind: &&Kind| {
            let name = kind.about().name;
            !kind.tried().is_empty() && self.best.rig.effects.iter().any(|e| e.name == name)
        };
        let Some(kind) = LAWS.iter().find(has).filter(|_| now.level() < NOTHING) else {
            return Ok(None);
        };
        let all = self.around(*kind, &self.best, context);
        let Some((nearest, _)) = self.nearest(&all) else { return Ok(None) };
        let anew = self.ended(nearest.fitted.clone())?;
        let level = |fitted: &Fitted| self.judged(&fitted.blocks).level();
        let as_good = level(&anew) < AS_NEAR * level(found);
        Ok(Some(anew).filter(|_| as_good))
    }
}

/// Whether a joint of this kind is begun where a model leaves so little.
fn begun_near(kind: Kind, level: f64) -> bool {
    kind == Kind::Compliance || level > PLAYS
}

/// The first ones of a kind beside each of so many models, of all in the order in which they leave little: with stiff teeth, and
/// with soft ones, which are far behind these before they are fitted, or far ahead.
fn firsts(near: &[(usize, Ahead)], models: usize, kind: Kind) -> [Vec<(Kind, Rig)>; 2] {
    let own = |place: usize, soft: bool| {
        let own = near.iter().filter(move |(p, a)| *p == place && a.kind == kind);
        let own = own.filter(move |(_, a)| is_soft(kind, &a.rig) == soft);
        own.take(FIRST).map(|(_, a)| (kind, a.rig.clone()))
    };
    [false, true].map(|soft| (0..models).flat_map(|place| own(place, soft)).collect())
}

#[cfg(test)]
mod tests {
    use super::{FIRST, begun_near, firsts};
    use crate::{board::Ahead, walk::made};
    use identify::{Rig, effects::Kind, fit::Data};

    #[test]
    fn what_does_not_begin_smoothly_is_looked_for_first_or_beside_what_was() {
        let data = made::data();
        let mut walk = made::walk(&made::rig(2.0), &data, &[]);
        assert!(walk.may_begin(8.0, 0) && walk.may_begin(8.0, 1) && !walk.may_begin(8.0, 2));
        assert!(!walk.may_begin(1.05, 0), "near the floor");
        walk.refit = 200.0;
        assert!(!walk.may_begin(1.5, 1), "noise that is not white after all was explained");
        walk.joins = false;
        assert!(!walk.may_begin(8.0, 0));
    }

    #[test]
    fn what_a_race_does_not_bring_nearer_goes_no_further() {
        // What is missing is a tone: neither a play nor a soft gear comes near.
        let mut data = made::data();
        for (u, t) in data.input.iter_mut().zip(&data.time) {
            *u += made::BIAS + 1.5 * (11.0 * t).sin();
        }
        let walk = made::walk(&made::rig(2.0), &data, &[]);
        let context = made::context(&walk);
        let lacking = crate::gram::lacking(&walk.board, &walk.best.rig, &context);
        assert!(lacking.iter().any(|(kind, _)| !kind.tried().is_empty()));
        let level = walk.judged(&walk.best.blocks).level();
        let begun: Vec<_> = walk.begun(&context).iter().map(|c| c.kind).collect();
        assert!(level > super::CLEARLY && begun.is_empty(), "{level}: {begun:?}");
    }

    #[test]
    fn a_play_is_begun_with_near_the_floor_too_but_not_on_it() {
        let begun = |level: f64| [Kind::Compliance, Kind::Backlash].map(|k| begun_near(k, level));
        assert_eq!((begun(1.02), begun(1.07)), ([true, false], [true, true]));
    }

    #[test]
    fn soft_teeth_are_begun_with_however_many_stiff_ones_leave_less() {
        let play = [1e-3, 0.2, 0.3, 1e-3];
        let stiff = made::with(&made::rig(2.0), Kind::Backlash, &play);
        let mut soft = stiff.clone();
        soft.free.push("backlash.zeta".to_owned());
        let of = |rig: &Rig| Ahead { far: 0.0, kind: Kind::Backlash, place: 0, rig: rig.clone() };
        let mut near: Vec<(usize, Ahead)> = (0..20).map(|i| (i % 2, of(&stiff))).collect();
        near.extend([(0, of(&soft)), (1, of(&soft))]);
        let [begun, bouncing] = firsts(&near, 2, Kind::Backlash).map(|of| of.len());
        assert_eq!((begun, bouncing), (2 * FIRST, 2));
        assert!(firsts(&near, 2, Kind::Compliance).iter().all(Vec::is_empty));
    }

    /// The load of 0.4 of 2 kg as in [`made::data`], driven through a gear that gives way by so much [m/N].
    fn driven(flexibility: f64) -> Data {
        let mut data = made::data();
        // It takes (3 − 4·0.4) sin 2t N, by which the motor of 1.6 kg with a drag of 0.5 N·s/m is ahead.
        let ahead = 1.4 * flexibility;
        for (u, t) in data.input.iter_mut().zip(&data.time) {
            let (s, c) = f64::sin_cos(2.0 * t);
            *u += ahead * (-4.0 * 1.6 * s + 0.5 * 2.0 * c);
        }
        data
    }

    #[test]
    fn a_gear_that_gives_way_a_little_is_looked_for_near_the_floor() {
        let rig = made::with(&made::rig(2.0), Kind::CurrentBias, &[made::BIAS]);
        let levels = |flexibility: f64| {
            let data = driven(flexibility);
            let walk = made::walk(&rig, &data, &[]);
            let all = walk.nearly_rigid(&made::context(&walk));
            let level = |fitted| walk.judged(fitted).level();
            let kinds: Vec<Kind> = all.iter().map(|c| c.kind).collect();
            (level(&walk.best.blocks), kinds, all.first().map(|c| level(&c.fitted.blocks)))
        };
        let (alone, kinds, with) = levels(1e-2);
        assert!(alone > 1.1 && alone < 1.5, "{alone}");
        assert!(kinds == [Kind::Compliance] && with.unwrap() < 1.05, "{kinds:?}: {with:?}");
        assert!(levels(0.0).1.is_empty());
    }
}
