//! What the input does between its samples, where the record is not sure of it: of two answers the simpler.

use super::{
    ABOVE, ALIKE, End, FIRST, Walk,
    answer::MORE,
    named::{SURE, UNSURE},
    polish::lacking,
    walked,
};
use crate::{
    board::{Board, Fitted},
    model::Candidate,
    verdict::{Discovery, Options},
};
use identify::{
    Hold, Rig,
    fit::{Data, FitError, hold, starts},
};
use std::cmp::Ordering;

/// Looks for what the model `rig` of the record `data` lacks. Where the rig file does not say what the input does between
/// its samples the record does: beside the nominal model, beside the nearest of every round, and once more beside the
/// last one.
pub fn discover(rig: &Rig, data: &Data, options: &Options) -> Result<Discovery, FitError> {
    let Some(told) = hold::told(rig, data)? else {
        return walked(rig, data, None, options).map(|end| end.found);
    };
    let with = |hold: Hold, asks: bool| -> Result<End, FitError> {
        let [own, other] = [hold, opposite(hold)].map(|hold| Data { hold, ..data.clone() });
        let rig = rig.clone().saying(Some(hold));
        let end = walked(&rig, &own, Some(&other).filter(|_| asks), options)?;
        Ok(End { found: Discovery { hold: Some(hold), ..end.found }, ..end })
    };
    let first = with(told.hold, true)?;
    if !first.other {
        return Ok(first.found);
    }
    let second = with(opposite(told.hold), false)?.found;
    Ok(if simpler(&second, &first.found) { second } else { first.found })
}

/// The other of the two ways between samples.
fn opposite(hold: Hold) -> Hold {
    if hold == Hold::ZeroOrder { Hold::Smooth } else { Hold::ZeroOrder }
}

impl Walk<'_> {
    /// A model refitted to the record with its input the other way, and by how many standard errors that is nearer; none
    /// where it is not asked.
    fn the_other_way(&self, rig: &Rig, near: &Fitted) -> Result<Option<(f64, f64)>, FitError> {
        let Some(other) = self.other else { return Ok(None) };
        let board = Board { data: other, ..self.board.clone() };
        let x = starts::nominal(&board.problem(rig, |_| true)?);
        let there = board.fit(rig, Some((&x, &near.pieces)), &FIRST)?;
        let [here, there] = [near, &there].map(|fitted| self.judged(&fitted.blocks));
        Ok(Some((here.against(&there), there.level() / here.level())))
    }

    /// Whether the nearest of the candidates, or without one the last model, is surely much nearer to the record with its
    /// input the other way: then this is the wrong one, and what is missing with it is another thing. What is at the floor
    /// is there already.
    pub(super) fn turns(&self, all: &[Candidate]) -> Result<bool, FitError> {
        if self.other.is_none() {
            return Ok(false);
        }
        let all = all.iter().map(|candidate| &candidate.fitted).chain([&self.best]);
        let level = |fitted: &Fitted| self.judged(&fitted.blocks).level();
        let near = all.min_by(|a, b| level(a).total_cmp(&level(b))).unwrap_or(&self.best);
        // Refitted as far as the other will be: a candidate may still be on its way.
        let near = self.board.fit(&near.rig, Some((&near.x, &near.pieces)), &FIRST)?;
        if level(&near) < ABOVE {
            return Ok(false);
        }
        let other = self.the_other_way(&near.rig, &near)?;
        Ok(other.is_some_and(|(t, share)| t > SURE && ALIKE * share < 1.0))
    }

    /// Whether the record may be simpler with its input the other way: the last model is nearer so, or is as near
    /// without one of its effects, or leaves something and is not surely further off.
    pub(super) fn may_be_other(&self) -> Result<bool, FitError> {
        let best = &self.best;
        let Some((t, _)) = self.the_other_way(&best.rig, best)? else { return Ok(false) };
        let leaves = self.leaves(best) > MORE || self.struck();
        if t > UNSURE || leaves && t > -SURE {
            return Ok(true);
        }
        for effect in &best.rig.effects {
            let without = lacking(&best.rig, &effect.name);
            let given = self.given.effects.iter().any(|own| own.name == effect.name);
            let other = self.the_other_way(&without, best)?;
            if !given && other.is_some_and(|(_, share)| share < ALIKE) {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// Whether an answer leaves less than another, or as much with fewer effects.
pub(super) fn simpler(one: &Discovery, other: &Discovery) -> bool {
    let [own, its] = [one, other].map(|found| found.chi_squared[2]);
    let [few, many] = [one, other].map(|found| found.rig.effects.len());
    match few.cmp(&many) {
        Ordering::Less => own < ALIKE * its,
        Ordering::Equal => own < its,
        Ordering::Greater => ALIKE * own < its,
    }
}

#[cfg(test)]
mod tests {
    use super::{Data, Discovery, Hold, simpler};
    use crate::{verdict::Verdict, walk::made};
    use identify::fit::Seen;

    /// An answer with so many effects that leaves so much.
    fn answer(effects: usize, left: f64) -> Discovery {
        let mut rig = made::rig(2.0);
        let bias = made::with(&rig, identify::effects::Kind::CurrentBias, &[made::BIAS]);
        rig.effects = vec![bias.effects[0].clone(); effects];
        Discovery {
            verdict: Verdict::Effect,
            parameters: Vec::new(),
            effects: Vec::new(),
            gap: Vec::new(),
            shares: Vec::new(),
            map: None,
            tone: None,
            ranking: Vec::new(),
            detectability: Vec::new(),
            chi_squared: [9.0, 9.0, left],
            hold: None,
            rig,
        }
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
        let asked = |own: &Data, other: &Data| {
            let mut walk = made::walk(&bias, own, &[]);
            assert!(!walk.turns(&[]).unwrap(), "nobody asks");
            walk.other = Some(other);
            (walk.turns(&[]).unwrap(), walk.may_be_other().unwrap())
        };
        assert_eq!(asked(&step, &line), (true, true));
        assert_eq!(asked(&line, &step), (false, false));
    }

    #[test]
    fn of_two_ways_between_samples_the_one_that_asks_for_fewer_effects_is_right() {
        assert!(simpler(&answer(1, 1.0), &answer(2, 0.95)));
        assert!(!simpler(&answer(1, 1.2), &answer(2, 0.95)), "but not where more is left");
        assert!(simpler(&answer(1, 0.9), &answer(1, 0.95)));
        assert!(
            !simpler(&answer(2, 0.92), &answer(1, 1.0))
                && simpler(&answer(2, 0.8), &answer(1, 1.0))
        );
    }
}
