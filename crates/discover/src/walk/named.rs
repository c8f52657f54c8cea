//! Which of the candidates is named.

use super::{GROSS, Walk, answer::MORE};
use crate::{
    board::Fitted,
    decide::{Judged, shrink},
    model::Candidate,
    verdict::{Found, name},
};
use identify::effects::{Key, Kind, Shape};

/// An effect is taken if it is better on the judging blocks by so many standard errors.
pub(super) const SURE: f64 = 3.0;

/// The same near the floor.
const CERTAIN: f64 = 3.5;

/// Or if what it changes is there to so many, or to fewer where the sum of squares falls by that of ten standard errors.
pub(super) const TELLS: f64 = 5.0;
const TELLS_BESIDE: f64 = 10.0;
const TELLS_MUCH: f64 = 4.0;
const MUCH_TOLD: f64 = 100.0;

/// Of two effects the second belongs to the set if it is worse by fewer standard errors, or by less than this
/// share of the excess.
pub(super) const UNSURE: f64 = 2.0;
const ALIKE: f64 = 0.03;

/// A rival takes away at least so much of what the best one does.
const CLOSE: f64 = 0.8;

/// What takes away so much of the excess need not do so in every block alike.
pub(super) const MOST: f64 = 0.5;

/// The same where the model is far off.
const MUCH: f64 = 0.4;

/// What takes away so much of the excess explains it.
pub(super) const ALL: f64 = 0.9;

/// It is no name either if the sum of squares on the judging blocks falls by less than so many squared standard errors, or
/// than so many where what it changes tells that it is there.
pub(super) const LEAST: f64 = 60.0;
pub(super) const TOLD: f64 = 25.0;

/// Beside an effect that leaves the floor or little more, another lowers it by at least this share: a little is left by
/// every formula that is not the drive's own.
const BESIDE: f64 = 0.05;

/// A rival leaves no more than so many times what the best one does.
const NEAR: f64 = 1.5;

/// An effect that leaves more than noise takes away so much of the excess: the first one of 23 pairs that were found took
/// two thirds at least, the second one a half where it left something. What is in no library was begun with what took a
/// quarter, and gone on with for minutes.
const FIRST: f64 = 1.0 / 3.0;

/// An effect is worth a name if it takes away so much of the excess.
const WORTH: f64 = 0.02;

/// Mean squared residual, in units of the floor, up to which nothing may be missing.
pub(super) const NOTHING: f64 = 1.2;

/// A candidate as it is judged.
#[derive(Debug)]
pub(super) struct Rated {
    pub(super) candidate: Candidate,
    pub(super) judged: Judged,
    /// How sure it is that it is there, by what it changes [1].
    pub(super) evidence: f64,
    /// By how much the sum of squares is less with it on all blocks, fitted ones among them [1].
    pub(super) together: f64,
    /// Whether its values are plausible.
    pub(super) plausible: bool,
}

impl Rated {
    fn name(&self) -> &'static str {
        name(self.candidate.kind)
    }
}

/// The best of the candidates that is surely there, with those that cannot be told from it; of these the simplest
/// goes first, for what needs more numbers fits more than there is. `rated` begins with the best.
pub(super) fn found<'r>(
    now: &Judged,
    rated: &'r [Rated],
    round: usize,
) -> Option<(&'r Candidate, Found)> {
    let mut plausible = rated.iter().filter(|r| r.plausible);
    // What noise leaves is known to a tenth or so: what lies below is no excess.
    let floor = plausible.clone().next()?.judged.level().min(1.0);
    let share = |other: &Judged| share_of(now, other, floor);
    let best = plausible.find(|r| sure(now, &r.judged, (share(&r.judged), round), r.evidence))?;
    let gone = share(&best.judged);
    let as_much = |r: &Rated| {
        let near = r.judged.level() < NEAR * best.judged.level();
        gone - share(&r.judged) < ALIKE * gone && near
    };
    let rival = |r: &&Rated| {
        let as_good = r.judged.against(&best.judged) < UNSURE || as_much(r);
        // Near the floor half of the blocks say little of which of two is nearer.
        let near = now.level() < NOTHING && r.together > CLOSE * best.together;
        as_good && (near || share(&r.judged) > CLOSE * gone)
    };
    let alike: Vec<&Rated> = [best].into_iter().chain(plausible.filter(rival)).collect();
    // What needs more numbers than a simpler one must be worth a name beside it; where much is left the little that a
    // law's form changes is no sign of it.
    let far = best.judged.level() > GROSS;
    let no_worse = |r: &&&Rated| {
        let unsure = r.judged.against(&best.judged) < UNSURE;
        unsure || r.judged.gained(&best.judged) < LEAST || far && as_much(r)
    };
    let simplest = |r: &&&Rated| numbers(r.candidate.kind);
    let named = alike.iter().filter(no_worse).min_by_key(simplest).unwrap_or(&best);
    let others = alike.iter().map(|r| r.name()).filter(|other| *other != named.name());
    let set: Vec<&'static str> = [named.name()].into_iter().chain(others).collect();
    let about = named.candidate.kind.about();
    let separated_by = if set.len() > 1 { about.separated_by.to_owned() } else { String::new() };
    let (shrink, t) = (share(&named.judged), now.against(&named.judged));
    let found = Found { name: named.name(), set, values: Vec::new(), shrink, t, separated_by };
    Some((&named.candidate, found))
}

impl Walk<'_> {
    /// Whether what takes away the share `gone` of what is left now is one of a few that are missing: not if it takes away
    /// little and what it leaves is more than noise. Far above the floor a little is plenty.
    pub(super) fn leads(&self, now: &Judged, (with, gone): (&Fitted, f64)) -> bool {
        gone > FIRST || now.level() > GROSS || self.leaves(with) < MORE
    }
}

/// How many numbers of an effect are fitted from the first on.
pub(super) fn numbers(kind: Kind) -> usize {
    let fitted = |key: &&Key| matches!(key.shape, Shape::Amount | Shape::Fitted);
    kind.about().keys.iter().filter(fitted).count()
}

/// Whether an effect beside so many others is surely there, by what is left without and with it.
pub(super) fn shows(without: &Judged, with: &Judged, others: usize, evidence: f64) -> bool {
    sure(without, with, (share_of(without, with, with.level().min(1.0)), others), evidence)
}

/// The share of the excess over a floor that is gone with an effect.
fn share_of(without: &Judged, with: &Judged, floor: f64) -> f64 {
    shrink(without.level() / floor, with.level() / floor)
}

/// Whether what takes away the share `gone` of the excess is surely there.
fn sure(now: &Judged, judged: &Judged, (gone, round): (f64, usize), evidence: f64) -> bool {
    let t = now.against(judged);
    // What an effect leaves in a few blocks because it does not begin as the record does is no other effect's, unless that
    // takes all of it.
    let few = if round == 0 { 2.0 } else { 4.0 };
    let rarely = || (round == 0 || gone > ALL) && now.gained_besides(judged) > few * LEAST;
    // Near the floor a few dozen effects are tried on nothing, and the best of them is better by chance.
    let by_blocks = if now.level() < NOTHING {
        t >= CERTAIN || (gone > MOST && (now.everywhere(judged) >= CERTAIN || rarely()))
    } else {
        let most = if now.level() > GROSS { MUCH } else { MOST };
        t >= SURE
            || (gone > most && t >= UNSURE)
            || (gone > ALL && (rarely() || now.everywhere(judged) >= CERTAIN))
    };
    let shows = round == 0
        || evidence >= TELLS_BESIDE
        || now.level() > NOTHING
        || judged.level() < (1.0 - BESIDE) * now.level();
    let gained = now.gained(judged);
    let told = evidence >= if gained < MUCH_TOLD { TELLS } else { TELLS_MUCH };
    let least = if told { TOLD } else { LEAST };
    (by_blocks || told) && shows && gone >= WORTH && gained >= least
}

#[cfg(test)]
mod tests {
    use super::{Candidate, FIRST, Judged, Rated, found};
    use crate::{board::Fitted, walk::made};
    use identify::{Rig, effects::LAWS};

    const RIG: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n\
        [friction]\nname = \"none\"\nsigma_2 = 0.5\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n";

    /// Twenty blocks of 300 residuals about this mean square, one a little above and one below it in turn.
    fn judged(mean: f64, apart: f64) -> Judged {
        let block = |k: usize| mean + if k.is_multiple_of(2) { apart } else { -apart };
        Judged { blocks: (0..20).map(block).collect(), counts: vec![300.0; 20] }
    }

    fn rated(place: usize, judged: Judged) -> Rated {
        Rated { candidate: candidate(place), judged, evidence: 0.0, together: 0.0, plausible: true }
    }

    fn candidate(place: usize) -> Candidate {
        let rig = Rig::parse(RIG).unwrap();
        let fitted = Fitted { rig, x: Vec::new(), pieces: Vec::new(), blocks: Vec::new() };
        Candidate { kind: LAWS[place], fitted }
    }

    /// The places of the laws with the fewest keys and with the most.
    fn fewest_and_most() -> [usize; 2] {
        let keys = |place: &usize| LAWS[*place].about().keys.len();
        let places = 0..LAWS.len();
        [places.clone().min_by_key(keys).unwrap(), places.max_by_key(keys).unwrap()]
    }

    #[test]
    fn what_takes_little_and_leaves_much_leads_nowhere() {
        let data = made::data();
        let walk = made::walk(&made::rig(2.0), &data, &[]);
        let of = |bias: f64| {
            let rig = made::with(&made::rig(2.0), super::Kind::CurrentBias, &[bias]);
            walk.board.judged(&Rig { free: Vec::new(), ..rig }, None).unwrap()
        };
        let (far, near) = (of(0.4 * made::BIAS), of(made::BIAS));
        let leads =
            |now: f64, with: &Fitted, gone: f64| walk.leads(&judged(now, 0.1), (with, gone));
        assert!(walk.judged(&far.blocks).level() > 1.5 && !leads(8.0, &far, 0.9 * FIRST));
        assert!(leads(8.0, &far, 1.1 * FIRST) && leads(30.0, &far, 0.9 * FIRST));
        assert!(leads(8.0, &near, 0.9 * FIRST), "what comes down to the floor");
    }

    #[test]
    fn what_a_floor_told_too_high_hides_is_found() {
        // 0.03 of 6000 residuals are 180: thirteen standard errors, though all of it lies below the floor.
        let now = judged(0.9, 0.01);
        let all = [rated(0, judged(0.87, 0.008)), rated(1, judged(0.899, 0.01))];
        let (_, taken) = found(&now, &all, 0).expect("an effect");
        assert_eq!((taken.set.len(), taken.shrink), (1, 1.0));
        // And 0.005 of them 30, which the best of a few dozen effects may come to.
        let all = [rated(0, judged(0.895, 0.01))];
        assert!(found(&now, &all, 0).is_none());
    }

    #[test]
    fn what_changes_the_right_thing_is_found_though_it_takes_little() {
        // A hundred squared standard errors in two of twenty blocks, and noise in the others.
        let blocks = |gain: f64| {
            let own = |k: usize| 1.0 + 0.01 * (k as f64).sin() - if k < 2 { gain } else { 0.0 };
            Judged { blocks: (0..20).map(own).collect(), counts: vec![300.0; 20] }
        };
        let now = blocks(0.0);
        let with = |gain: f64, evidence: f64, round: usize| {
            let all = [Rated { evidence, ..rated(0, blocks(gain)) }];
            found(&now, &all, round).is_some()
        };
        let told = |evidence: f64, round: usize| with(0.17, evidence, round);
        assert!(now.against(&blocks(0.17)) < super::SURE && !told(0.0, 0));
        let some = |gain: f64| with(gain, 1.01 * super::TELLS, 0);
        assert!(some(0.06) && !some(0.04), "36 squared standard errors in all, or 24");
        let few = |gain: f64| with(gain, 1.01 * super::TELLS_MUCH, 0);
        assert!(few(0.17) && !few(0.16), "102 squared standard errors, or 96");
        assert!(told(1.01 * super::TELLS, 0) && !told(1.01 * super::TELLS, 1));
        assert!(told(1.01 * super::TELLS_BESIDE, 1), "beside another effect");
    }

    #[test]
    fn what_a_formula_leaves_beside_an_effect_is_no_other_one() {
        let now = judged(0.95, 0.01);
        for (level, named) in [(0.92, false), (0.88, true)] {
            let all = [rated(0, judged(level, 0.009))];
            assert!(found(&now, &all, 0).is_some(), "{level} alone");
            assert_eq!(found(&now, &all, 1).is_some(), named, "{level} beside an effect");
        }
    }

    #[test]
    fn what_acts_in_a_few_blocks_is_found_and_one_that_went_astray_is_not() {
        // 1.5 floors in each of so many blocks, and the others as a right model leaves them.
        let with = |far: usize, most: f64| {
            let blocks = (0..20).map(|k| if k < far { most } else { 1.0 + 0.001 * k as f64 });
            Judged { blocks: blocks.collect(), counts: vec![300.0; 20] }
        };
        let named =
            |before: &Judged, left: Judged, k| found(before, &[rated(0, left)], k).is_some();
        let after = || with(0, 1.0);
        assert!(with(3, 2.5).against(&after()) < super::UNSURE);
        assert!(named(&with(3, 2.5), after(), 0) && !named(&with(2, 2.5), after(), 0));
        // Beside another effect only what gains twice as much besides these two, and leaves nothing.
        assert!(named(&with(3, 1.85), after(), 1) && !named(&with(3, 1.75), after(), 1));
        assert!(!named(&with(3, 2.5), with(20, 1.06), 1));
        // There it takes nearly all that is left in one block, and a little in every other one.
        let mut all = with(1, 5e4);
        all.blocks[1..].iter_mut().for_each(|block| *block *= 1.02);
        assert!(all.against(&after()) < super::UNSURE && named(&all, after(), 1));
        assert!(!named(&with(1, 5e4), after(), 1), "one gone astray");
    }

    #[test]
    fn the_simplest_is_named_where_it_is_no_worse() {
        let [simple, other] = fewest_and_most();
        let now = judged(30.0, 1.0);
        let both =
            |level: f64| [rated(other, judged(1.0, 0.05)), rated(simple, judged(level, -0.05))];
        let all = both(1.001);
        let (best, taken) = found(&now, &all, 0).unwrap();
        assert_eq!((best.kind, taken.set.len()), (LAWS[simple], 2));
        // Surely worse, it is still what takes away nearly as much.
        let all = both(1.2);
        let (best, taken) = found(&now, &all, 0).unwrap();
        assert_eq!((best.kind, taken.set.len()), (LAWS[other], 2));
    }

    #[test]
    fn where_much_is_left_the_form_of_a_law_decides_nothing() {
        let [simple, other] = fewest_and_most();
        // Surely worse by a hundredth of the excess: of 900 floors that leave 30, or of 9 that leave one.
        for (before, [better, worse], named) in
            [(900.0, [30.0, 39.0], simple), (9.0, [1.0, 1.1], other)]
        {
            let now = judged(before, 1.0);
            let all = [rated(other, judged(better, 0.05)), rated(simple, judged(worse, 0.05))];
            let (best, taken) = found(&now, &all, 0).unwrap();
            assert_eq!((best.kind, taken.set.len()), (LAWS[named], 2), "{before}");
        }
    }

    #[test]
    fn far_off_two_fifths_of_the_excess_are_plenty() {
        let named = |far: f64| {
            let of = |gains: [f64; 2]| Judged {
                blocks: (0..6).map(|k| far * gains[k % 2]).collect(),
                counts: vec![300.0; 6],
            };
            found(&of([1.0; 2]), &[rated(0, of([0.3, 1.0]))], 0).is_some()
        };
        // 0.45 and 0.48 of it, in three of six blocks.
        assert!(named(1000.0) && !named(15.0));
    }

    #[test]
    fn what_needs_more_numbers_is_named_where_it_is_worth_it() {
        let [simple, other] = fewest_and_most();
        // Surely a little better in every block: 18 squared standard errors of 6000, and 120.
        for (better, named) in [(0.003, simple), (0.02, other)] {
            let all = [rated(other, judged(1.0 - better, 0.05)), rated(simple, judged(1.0, 0.05))];
            assert!(all[1].judged.against(&all[0].judged) > super::UNSURE);
            let (best, _) = found(&judged(30.0, 1.0), &all, 0).unwrap();
            assert_eq!(best.kind, LAWS[named], "better by {better}");
        }
    }

    #[test]
    fn what_is_surely_there_is_named_though_another_is_nearer() {
        let now = judged(30.0, 1.0);
        // One block is far better, the others are worse.
        let mut lucky = judged(31.0, 1.0);
        lucky.blocks[3] = 1e-40;
        let mut all = [rated(0, lucky), rated(1, judged(1.2, 0.01))];
        let (best, _) = found(&now, &all, 0).unwrap();
        assert_eq!(best.kind, LAWS[1]);
        all[1].plausible = false;
        assert!(found(&now, &all, 0).is_none());
    }

    #[test]
    fn what_is_nearer_by_chance_bars_nothing() {
        let now = judged(0.86, 0.01);
        // Nearer on the whole, and worse in every other block.
        let all = [rated(0, judged(0.8, 0.2)), rated(1, judged(0.83, 0.008))];
        assert!(found(&now, &all[..1], 0).is_none());
        let (best, _) = found(&now, &all, 0).expect("the second");
        assert_eq!(best.kind, LAWS[1]);
    }

    #[test]
    fn what_is_found_is_kept() {
        // All that is gained is in six blocks, 150 squared standard errors each, or 50.
        let with = |most: f64| {
            let blocks = (0..20).map(|k| if k < 6 { most } else { 1.0 + 0.001 * f64::from(k) });
            Judged { blocks: blocks.collect(), counts: vec![300.0; 20] }
        };
        let (more, without, with) = (with(1.5), with(1.166), with(1.0));
        assert!(more.against(&with) < super::SURE);
        assert!(found(&more, &[rated(0, with.clone())], 0).is_some());
        let beside =
            |before: &Judged| [0, 1].map(|others| super::shows(before, &with, others, 0.0));
        assert_eq!((beside(&more), beside(&without)), ([true, true], [true, false]));
    }

    #[test]
    fn what_is_better_in_every_block_is_found_however_unlike_these_are() {
        let with = |first: f64, rest: f64| {
            let blocks = (0..20).map(|k| if k == 0 { first } else { rest + 0.001 * f64::from(k) });
            Judged { blocks: blocks.collect(), counts: vec![300.0; 20] }
        };
        let (now, then) = (with(20.0, 0.98), with(0.6, 0.9));
        assert!(now.level() < super::NOTHING && now.against(&then) < super::CERTAIN);
        assert!(found(&now, &[rated(0, then)], 0).is_some());
        // In half of the blocks only it is chance.
        let mut half = with(0.6, 1.0);
        half.blocks.iter_mut().skip(1).step_by(2).for_each(|block| *block += 0.2);
        assert!(found(&now, &[rated(0, half)], 0).is_none());
    }
}
