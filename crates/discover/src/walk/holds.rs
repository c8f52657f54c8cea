//! What the input does between its samples, where the record is not sure of it: of two answers the simpler.

use super::{
    ABOVE, ALIKE, End, FIRST, Walk,
    answer::{MORE, WRONG},
    fewest::fewest,
    given::off_by,
    named::{SURE, UNSURE},
    polish::lacking,
    walked,
};
use crate::{
    board::{self, Board, Fitted},
    model::{self, Candidate},
    screen::Scored,
    verdict::{Discovery, Moved, Options, Verdict},
};
use identify::{
    Hold, Rig,
    effects::Kind,
    fit::{Data, FitError, hold},
};
use rayon::prelude::*;
use std::cmp::Ordering;

/// Of two ways that hold nothing the nearer one leaves so many times less, if it is to count.
const NOTABLY: f64 = 1.02;

/// So many candidates are asked for their input's other ways, of those that leave no more than so many times the least.
const RIVALS: usize = 3;
const RIVAL: f64 = 1.5;

/// Looks for what the model `rig` of the record `data` lacks. Where the rig file does not say what the input does between
/// its samples the record does: beside the nominal model, beside the nearest of every round, and once more beside the
/// last one.
pub fn discover(rig: &Rig, data: &Data, options: &Options) -> Result<Discovery, FitError> {
    let Some(told) = hold::told(rig, data)? else {
        let first = walked((rig, board::loose(rig)), data, &[], options)?;
        return fewest(rig, data, &options.after(first.simulated), first.found);
    };
    let as_in = |hold: Hold| Data { hold, ..data.clone() };
    let (mut again, mut simulated) = (false, 0);
    let walk = |hold: Hold, others: &[Hold]| {
        if std::mem::replace(&mut again, true) {
            options.tell(|| format!("once more, with hold = \"{}\" for the input", hold.name()));
        }
        let others: Vec<Data> = others.iter().map(|other| as_in(*other)).collect();
        let (rig, data) = (rig.clone().saying(Some(hold)), as_in(hold));
        let options = options.after(simulated);
        let end = walked((&rig, board::loose(&rig)), &data, &others, &options)?;
        simulated += end.simulated;
        Ok(end)
    };
    let (hold, found) = simplest((told.hold, told.others.to_vec()), &rig.free, walk)?;
    let found =
        fewest(&rig.clone().saying(Some(hold)), &as_in(hold), &options.after(simulated), found)?;
    Ok(Discovery { hold: Some(hold), ..found })
}

/// The simplest of the answers that `walked` finds for the way that is `told` and those that it asks for, of the others that it
/// may ask for; with its way. What is `free` may be anywhere.
fn simplest(
    (told, mut others): (Hold, Vec<Hold>),
    free: &[String],
    mut walked: impl FnMut(Hold, &[Hold]) -> Result<End, FitError>,
) -> Result<(Hold, Discovery), FitError> {
    let first = walked(told, &others)?;
    // What took as long as was asked for is not begun anew.
    let mut tired = !first.found.complete;
    let mut left: Vec<Hold> = first.turned.then_some(told).into_iter().collect();
    let (mut hold, mut found, mut asked) = (told, first.found, first.other);
    while let Some(other) = asked.filter(|_| !tired) {
        others.retain(|own| *own != other);
        let next = walked(other, &others)?;
        left.extend(next.turned.then_some(other));
        asked = next.other;
        tired |= !next.found.complete;
        if simpler(&next.found, &found, free) {
            (hold, found) = (other, next.found);
        }
    }
    // What is turned from far from the truth may be right all the same.
    for other in left {
        if tired || !matches!(found.verdict, Verdict::Partial | Verdict::NotInLibrary) {
            break;
        }
        let whole = walked(other, &[])?.found;
        tired |= !whole.complete;
        if simpler(&whole, &found, free) {
            (hold, found) = (other, whole);
        }
    }
    Ok((hold, found))
}

/// A model refitted to the record with its input another way.
struct Otherwise {
    hold: Hold,
    /// By how many standard errors it is nearer so.
    t: f64,
    /// What it leaves, of what it leaves this way [1].
    share: f64,
}

/// The way that leaves least of those for which it is so.
fn nearest(ways: Vec<Otherwise>, so: impl Fn(&Otherwise) -> bool) -> Option<Hold> {
    let ways = ways.into_iter().filter(so);
    ways.min_by(|a, b| a.share.total_cmp(&b.share)).map(|other| other.hold)
}

/// The way that leaves least of those that are notably nearer, if one of these is surely so.
fn notably_nearer(ways: Vec<Otherwise>) -> Option<Hold> {
    let notably = |other: &Otherwise| other.t > UNSURE && ALIKE * other.share < 1.0;
    let surely = ways.iter().any(|other| notably(other) && other.t > SURE);
    nearest(ways, |other| surely && notably(other))
}

impl Walk<'_> {
    /// A model `near` this one with its input each of the other ways, where they are asked, beside another model this way.
    fn other_ways(
        &self,
        (rig, near): (&Rig, &Fitted),
        here: &Fitted,
    ) -> Result<Vec<Otherwise>, FitError> {
        let one = |other: &Data| {
            let board = Board { data: other, ..self.board.clone() };
            let there = board.fit_near(rig, &near.pieces, &FIRST)?;
            let [here, there] = [here, &there].map(|fitted| self.judged(&fitted.blocks));
            let share = there.level() / here.level();
            Ok(Otherwise { hold: other.hold, t: here.against(&there), share })
        };
        self.others.par_iter().map(one).collect()
    }

    /// The way in which one of the nearest candidates, or without any the last model, is surely much nearer to the record
    /// than all are this way, if there is one: then this is the wrong one, and what is missing with it is another thing. What
    /// is at the floor is there already.
    pub(super) fn turns(&self, all: &[Candidate]) -> Result<Option<Hold>, FitError> {
        if self.others.is_empty() {
            return Ok(None);
        }
        let level = |fitted: &Fitted| self.judged(&fitted.blocks).level();
        let all = all.iter().map(|candidate| &candidate.fitted).chain([&self.best]);
        let mut all: Vec<(f64, &Fitted)> = all.map(|fitted| (level(fitted), fitted)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let nearest = all.first().map_or(f64::INFINITY, |(nearest, _)| *nearest);
        all.retain(|(own, _)| *own <= RIVAL * nearest);
        all.truncate(RIVALS);
        // Refitted as far as the others will be: a candidate may still be on its way.
        let fit = |(_, near): &(f64, &Fitted)| {
            self.board.fit(&near.rig, Some((&near.x, &near.pieces)), &FIRST)
        };
        let all: Vec<Fitted> = all.par_iter().map(fit).collect::<Result<_, _>>()?;
        let here = all.iter().min_by(|a, b| level(a).total_cmp(&level(b))).unwrap_or(&self.best);
        if level(here) < ABOVE {
            return Ok(None);
        }
        let mut ways = Vec::new();
        for near in &all {
            ways.extend(self.other_ways((&near.rig, near), here)?);
        }
        if let Some(late) = self.late(&here.rig) {
            ways.extend(self.other_ways((&late, here), here)?);
        }
        Ok(notably_nearer(ways))
    }

    /// The model with its input half a sample late, as an input that is held is on the whole: one that is not held, and
    /// comes late by about so much, is nearer to that than to one that is on time.
    fn late(&self, rig: &Rig) -> Option<Rig> {
        let data = self.board.data;
        let delay = Kind::InputDelay;
        if data.hold != Hold::ZeroOrder || !delay.applies(rig) {
            return None;
        }
        let values = vec![data.sample_time() / 2.0];
        let near = Fitted { rig: rig.clone(), ..self.best.clone() };
        Some(model::with(&near, &Scored::unscored(delay, values)))
    }

    /// The way in which the record may be simpler, if there is one: the last model is nearer so, or is as near without
    /// one of its effects, or leaves something and is not surely further off. A line and a smooth curve may differ by
    /// nothing that counts.
    pub(super) fn may_be_other(&self) -> Result<Option<Hold>, FitError> {
        let best = &self.best;
        // What comes late between samples looks like an effect: that is asked first.
        for effect in &best.rig.effects {
            if self.given.effects.iter().any(|own| own.name == effect.name) {
                continue;
            }
            let all = self.other_ways((&lacking(&best.rig, &effect.name), best), best)?;
            if let Some(hold) = nearest(all, |other| other.share < ALIKE) {
                return Ok(Some(hold));
            }
        }
        let leaves = self.leaves(best) > MORE || self.struck();
        let held = |hold: Hold| hold == Hold::ZeroOrder;
        let nearer = |other: &Otherwise| {
            let differs = held(other.hold) != held(self.board.data.hold);
            let by = if differs { 1.0 } else { NOTABLY };
            other.share * by < 1.0 && other.t > UNSURE || differs && leaves && other.t > -SURE
        };
        Ok(nearest(self.other_ways((&best.rig, best), best)?, nearer))
    }
}

/// Whether an answer leaves less than another, or as much with fewer effects; a value that is not `free` and yet far from
/// what was given is as much as an effect.
fn simpler(one: &Discovery, other: &Discovery, free: &[String]) -> bool {
    let [own, its] = [one, other].map(|found| found.chi_squared[2]);
    let far = |p: &&Moved| !free.contains(&p.found.name) && off_by(p.found.value, p.given) > WRONG;
    let asks =
        |found: &Discovery| found.rig.effects.len() + found.parameters.iter().filter(far).count();
    let [few, many] = [one, other].map(asks);
    match few.cmp(&many) {
        Ordering::Less => own < ALIKE * its,
        Ordering::Equal => own < its,
        Ordering::Greater => ALIKE * own < its,
    }
}

#[cfg(test)]
mod tests {
    use super::{
        Candidate, Data, Discovery, End, Hold, Kind, Moved, Options, Rig, simpler, simplest, walked,
    };
    use crate::{
        verdict::{Value, Verdict},
        walk::made,
    };
    use identify::fit::Seen;

    /// An answer with so many effects that leaves so much.
    fn answer(effects: usize, left: f64) -> Discovery {
        let mut rig = made::rig(2.0);
        let bias = made::with(&rig, identify::effects::Kind::CurrentBias, &[made::BIAS]);
        rig.effects = vec![bias.effects[0].clone(); effects];
        made::answer(&rig, Verdict::Effect, left)
    }

    #[test]
    fn a_search_that_takes_too_long_is_ended_with_what_it_has() {
        let (data, rig) = (made::data(), made::rig(2.0));
        let found = |simulations: u64| {
            let options = Options { simulations, ..Options::default() };
            walked((&rig, Vec::new()), &data, &[], &options).unwrap().found
        };
        let (all, none) = (found(Options::default().simulations), found(0));
        assert!(all.complete && all.verdict == Verdict::Effect);
        assert!(!none.complete && none.effects.is_empty());
        assert_ne!(none.verdict, Verdict::NothingMissing);
        // Nor is it begun anew with the input another way.
        let mut runs = 0;
        let walk = |_, _: &[Hold]| {
            runs += 1;
            let found = Discovery { complete: false, ..answer(0, 3.3) };
            let other = (runs == 1).then_some(Hold::Linear);
            Ok(End { found, other, turned: false, simulated: 1 })
        };
        simplest((Hold::ZeroOrder, vec![Hold::Linear]), &[], walk).unwrap();
        assert_eq!(runs, 1);
    }

    /// Whether a model turns, and whether it may be simpler otherwise.
    fn asked<'a>(bias: &'a Rig, own: &'a Data, others: &'a [Data]) -> [Option<Hold>; 2] {
        let mut walk = made::walk(bias, own, &[]);
        assert_eq!(walk.turns(&[]).unwrap(), None, "nobody asks");
        walk.others = others;
        [walk.turns(&[]).unwrap(), walk.may_be_other().unwrap()]
    }

    #[test]
    fn the_record_is_asked_for_the_other_way_and_the_wrong_one_turns() {
        // Every sixteenth sample. Its input goes straight: held it would come half a sample, 40 ms, late.
        let all = made::data();
        let some = |values: &[f64]| values.iter().copied().step_by(16).collect::<Vec<f64>>();
        let seen = some(&all.displacement.as_ref().expect("it is seen").values);
        let with = |hold: Hold| {
            let seen = Seen::new("position", seen.clone(), 0.0);
            Data::driven(some(&all.time), some(&all.input), hold, seen)
        };
        let [line, step] = [with(Hold::Linear), with(Hold::ZeroOrder)];
        let bias = made::with(&made::rig(2.0), identify::effects::Kind::CurrentBias, &[made::BIAS]);
        let ways = [step, line];
        assert_eq!(asked(&bias, &ways[0], &ways[1..]), [Some(Hold::Linear); 2]);
        assert_eq!(asked(&bias, &ways[1], &ways[..1]), [None; 2]);
    }

    /// Every sixteenth sample of the record, its input late by so many samples of it.
    fn late_by(samples: usize, hold: Hold) -> Data {
        let all = made::data();
        let some = |values: &[f64], first: usize| -> Vec<f64> {
            values[first..].iter().copied().step_by(16).take(240).collect()
        };
        let seen = &all.displacement.as_ref().expect("it is seen").values;
        let seen = Seen::new("position", some(seen, 0), 0.0);
        Data::driven(some(&all.time, 0), some(&all.input, samples), hold, seen)
    }

    #[test]
    fn an_input_that_comes_late_is_not_held_for_that() {
        // Every sixteenth sample of an input that goes straight and comes 20 ms late: held it would be 40 ms.
        let [held, straight] = [Hold::ZeroOrder, Hold::Linear].map(|hold| late_by(4, hold));
        let bias = made::with(&made::rig(2.0), identify::effects::Kind::CurrentBias, &[made::BIAS]);
        let ways = [straight.clone()];
        let mut walk = made::walk(&bias, &held, &[]);
        walk.others = &ways;
        assert_eq!(walk.turns(&[]).unwrap(), Some(Hold::Linear));
        let late = walk.late(&bias).expect("it may be late");
        assert!((late.value("input_delay.delay").unwrap() - 0.04).abs() < 1e-12);
        assert!(
            walk.late(&late).is_none() && made::walk(&bias, &straight, &[]).late(&bias).is_none()
        );
    }

    #[test]
    fn what_is_not_the_nearest_this_way_may_be_so_the_other() {
        // Every sixteenth sample of an input that goes straight and comes 40 ms late, as one that is held does.
        let [straight, held] = [Hold::Linear, Hold::ZeroOrder].map(|hold| late_by(8, hold));
        let bias = made::with(&made::rig(2.0), Kind::CurrentBias, &[made::BIAS]);
        // 35 ms too late where the other is 40 ms too soon, and 75 ms where that is right.
        let mut late = made::with(&bias, Kind::InputDelay, &[0.075]);
        late.free.retain(|free| free != "input_delay.delay");
        let others = [held];
        let mut walk = made::walk(&late, &straight, &[]);
        walk.others = &others;
        assert_eq!(walk.turns(&[]).unwrap(), None);
        let fitted = walk.board.judged(&bias, None).unwrap();
        let candidate = Candidate { kind: Kind::CurrentBias, fitted };
        let [nearest, next] =
            [&walk.best, &candidate.fitted].map(|own| walk.judged(&own.blocks).level());
        assert!(nearest < next && next < super::RIVAL * nearest, "{nearest} and {next}");
        assert_eq!(walk.turns(&[candidate]).unwrap(), Some(Hold::ZeroOrder));
    }

    #[test]
    fn what_was_turned_from_is_gone_to_its_end_where_the_other_way_leaves_something() {
        let mut asked = Vec::new();
        let mut of = |verdict: Verdict| {
            asked.clear();
            let walked = |hold: Hold, others: &[Hold]| {
                asked.push((hold, others.to_vec()));
                let (found, turns) = match (hold, others.is_empty()) {
                    (Hold::ZeroOrder, false) => (answer(0, 211.0), true),
                    (Hold::ZeroOrder, true) => (answer(1, 1.0), false),
                    _ => (Discovery { verdict, ..answer(1, 3.3) }, false),
                };
                Ok(End { found, other: turns.then_some(Hold::Linear), turned: turns, simulated: 1 })
            };
            let ways = (Hold::ZeroOrder, vec![Hold::Linear, Hold::Smooth]);
            let (hold, found) = simplest(ways, &[], walked).unwrap();
            (hold, found.chi_squared[2], asked.len())
        };
        assert_eq!(of(Verdict::Partial), (Hold::ZeroOrder, 1.0, 3));
        assert_eq!(of(Verdict::Effect), (Hold::Linear, 3.3, 2));
        let others = vec![Hold::Linear, Hold::Smooth];
        assert_eq!(asked, [(Hold::ZeroOrder, others), (Hold::Linear, vec![Hold::Smooth])]);
    }

    #[test]
    fn where_one_way_is_surely_nearer_another_that_leaves_less_is_turned_to() {
        let ways = |t: [f64; 2]| {
            let way = |hold: Hold, t: f64, share: f64| super::Otherwise { hold, t, share };
            vec![way(Hold::ZeroOrder, t[0], 0.5), way(Hold::Linear, t[1], 0.7)]
        };
        assert_eq!(super::notably_nearer(ways([2.6, 3.1])), Some(Hold::ZeroOrder));
        assert_eq!(super::notably_nearer(ways([1.0, 3.1])), Some(Hold::Linear));
        assert_eq!(super::notably_nearer(ways([2.6, 2.9])), None);
    }

    #[test]
    fn of_two_ways_between_samples_the_one_that_asks_for_fewer_effects_is_right() {
        let simpler = |one: &Discovery, other: &Discovery| simpler(one, other, &[]);
        assert!(simpler(&answer(1, 1.0), &answer(2, 0.95)));
        assert!(!simpler(&answer(1, 1.2), &answer(2, 0.95)), "but not where more is left");
        assert!(simpler(&answer(1, 0.9), &answer(1, 0.95)));
        assert!(
            !simpler(&answer(2, 0.92), &answer(1, 1.0))
                && simpler(&answer(2, 0.8), &answer(1, 1.0))
        );
    }

    #[test]
    fn a_value_that_was_given_and_went_far_is_as_much_as_an_effect() {
        let off = |mass: f64| {
            let value =
                Value { name: "mass".to_owned(), value: mass, standard_error: 0.0, unit: "kg" };
            let parameters = vec![Moved { given: 2.0, found: value, moved: false }];
            Discovery { parameters, ..answer(1, 1.0) }
        };
        let better = |free: &[String]| simpler(&answer(1, 1.05), &off(2.3), free);
        assert!(better(&[]) && !better(&["mass".to_owned()]));
        assert!(!simpler(&answer(1, 1.05), &off(2.05), &[]), "as far as nominal values are off");
    }
}
