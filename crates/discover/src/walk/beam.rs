//! Other first effects than the one that was nearest: two effects together may look like a third, which then is found
//! first and has no right beside either of them.

use super::{
    ALIKE, GROSS, Walk,
    answer::MORE,
    named::{LEAST, MOST, Rated, SURE, shows},
    plain::part,
    settled,
};
use crate::{
    board::Fitted,
    decide::{Judged, shrink},
    model::Candidate,
    verdict::{Found, Options, name},
};
use identify::{effects::Context, fit::FitError};

/// So many first effects are begun with, that of the answer among them.
const WIDE: usize = 3;

/// So much of the excess one of two that explain all takes away alone: of two alike that undo each other by a half, c = -½,
/// each takes (1 + c)/2.
const HALF_UNDONE: f64 = 0.25;

impl Walk<'_> {
    /// Keeps the first effects beside which another may be found, the nearest first.
    pub(super) fn keep_firsts(&mut self, rated: &[Rated]) {
        let plausible = rated.iter().filter(|r| r.plausible).take(WIDE);
        self.firsts = plausible.map(|r| r.candidate.clone()).collect();
    }

    /// Where several effects were found, or what was found does not explain all, two others of which another goes first,
    /// if these explain all and are better; whether they are. It is asked once.
    pub(super) fn widened(
        &mut self,
        effects: &mut Vec<Found>,
        context: &Context,
        options: &Options,
    ) -> Result<bool, FitError> {
        let firsts = std::mem::take(&mut self.firsts);
        let explained = self.leaves(&self.best) < MORE;
        if self.bare() || options.most < 2 || explained && effects.len() < 2 {
            return Ok(false);
        }
        // A play is looked for beside what is nearest alone: that takes as long as all else.
        self.joins = false;
        let taken = effects.first().map(|first| first.name);
        let (ranked, mut better) = (self.ranking.len(), false);
        for first in firsts.iter().filter(|c| Some(name(c.kind)) != taken) {
            if self.tired() {
                break;
            }
            let alone = self.judged(&first.fitted.blocks).level();
            // Beside what explains all only what is a good part of it alone.
            let least = if explained { MOST } else { HALF_UNDONE };
            if shrink(self.refit, alone) <= least {
                continue;
            }
            let before = (self.board.clone(), self.best.clone(), self.origin.clone());
            let pair = self.begun_with(first, context, options)?;
            self.ranking.truncate(ranked);
            let [then, now] = [&before.1, &self.best].map(|f| self.judged(&f.blocks));
            let explains = self.leaves(&self.best) < MORE;
            let counts =
                |pair: &Vec<Found>| explains && takes(&then, &now, pair.len() < effects.len());
            if let Some(pair) = pair.filter(counts) {
                *effects = pair;
                better = true;
                break;
            }
            (self.board, self.best, self.origin) = before;
        }
        self.joins = true;
        Ok(better)
    }

    /// This effect and another one that is surely there beside it, if there is one; the last model then has both.
    fn begun_with(
        &mut self,
        first: &Candidate,
        context: &Context,
        options: &Options,
    ) -> Result<Option<Vec<Found>>, FitError> {
        self.ended_at(first.fitted.clone(), options.seed)?;
        self.origin = self.beside_given()?;
        let Some(second) = self.step(context, options, (1, None))? else { return Ok(None) };
        self.ended_at(self.best.clone(), options.seed)?;
        let alone = self.without(&self.best, name(first.kind))?;
        let [alone, both] = [&alone, &self.best].map(|f| self.judged(&f.blocks));
        let own = part(first.kind, [&alone, &both], alone.against(&both));
        Ok(shows(&alone, &both, 1, 0.0).then(|| vec![own, second]))
    }

    /// The last model is this one where it ends.
    fn ended_at(&mut self, fitted: Fitted, seed: u64) -> Result<(), FitError> {
        self.best = settled(&mut self.board, fitted, seed)?;
        self.begun_anew()?;
        self.near_the_floor(GROSS)
    }
}

/// Whether one model takes the place of that from then: it is surely nearer, or as near with `fewer` effects.
fn takes(then: &Judged, now: &Judged, fewer: bool) -> bool {
    let nearer = then.against(now) > SURE && then.gained(now) > LEAST;
    nearer || fewer && now.level() < ALIKE * then.level()
}

#[cfg(test)]
mod tests {
    use super::{Judged, takes};
    use crate::{
        model::Candidate,
        walk::made::{BIAS, context, data, rig, walk, with},
    };
    use identify::{effects::Kind, fit::Data};

    /// How much drag the data has besides [N·s²/m²].
    const DRAG: f64 = 0.05;

    /// The data with a drag and more of a force [N].
    fn dragged(more: impl Fn(f64) -> f64) -> Data {
        let mut data = data();
        for (u, t) in data.input.iter_mut().zip(&data.time) {
            let v = 2.0 * (2.0 * t).cos();
            *u += DRAG * v * v.abs() + more(*t);
        }
        data
    }

    /// Whether two effects took the place, their names, the bias found, and what is left, begun with each of these.
    fn found(data: &Data, firsts: &[(Kind, f64)]) -> (bool, Vec<&'static str>, Option<f64>, f64) {
        let mut walk = walk(&rig(2.0), data, &[]);
        let first = |(kind, amount): &(Kind, f64)| {
            let fitted = walk.board.judged(&with(&rig(2.0), *kind, &[*amount]), None);
            Candidate { kind: *kind, fitted: fitted.unwrap() }
        };
        walk.firsts = firsts.iter().map(first).collect();
        let (context, mut effects) = (context(&walk), Vec::new());
        walk.refit = walk.judged(&walk.best.blocks).level();
        let better = walk.widened(&mut effects, &context, &crate::Options::default()).unwrap();
        let names = effects.iter().map(|found| found.name).collect();
        let left = walk.judged(&walk.best.blocks).level();
        (better, names, walk.best.rig.value("current_bias.bias"), left)
    }

    #[test]
    fn two_effects_of_which_another_goes_first_are_found() {
        let data = dragged(|_| 0.0);
        let (better, names, bias, left) = found(&data, &[(Kind::CurrentBias, 0.1)]);
        assert!(better && names == ["current_bias", "quadratic_drag"] && left < 1.1, "{names:?}");
        assert!((bias.unwrap() - BIAS).abs() < 0.01, "{bias:?}");
        // A first that takes away next to nothing alone is none of two.
        let (better, names, ..) = found(&data, &[(Kind::CurrentBias, 0.005)]);
        assert!(!better && names.is_empty(), "{names:?}");
        let (better, names, bias, left) = found(&data, &[]);
        assert!(!better && names.is_empty() && bias.is_none() && left > 2.0, "{left}");
    }

    #[test]
    fn two_effects_that_do_not_explain_all_are_not_taken() {
        // What no effect of the library has stays.
        let data = dragged(|t| 0.2 * (11.0 * t).sin());
        let (better, names, ..) = found(&data, &[(Kind::CurrentBias, 0.1)]);
        assert!(!better && names.is_empty(), "{names:?}");
    }

    #[test]
    fn what_is_surely_nearer_or_simpler_takes_the_place() {
        let of = |mean: f64| Judged {
            blocks: (0..20).map(|k| mean + 0.01 * f64::from(k % 2)).collect(),
            counts: vec![300.0; 20],
        };
        assert!(takes(&of(2.0), &of(1.9), false) && !takes(&of(1.9), &of(2.0), false));
        // One block of twenty that is far better, where all others are a little worse, says nothing.
        let but_one = |first: f64, others: f64| Judged {
            blocks: (0..20).map(|k| if k == 1 { first } else { others }).collect(),
            counts: vec![300.0; 20],
        };
        assert!(!takes(&but_one(9.0, 1.0), &but_one(1.0, 1.01), false));
        // A thousandth less on 6000 residuals is worth no name.
        assert!(!takes(&of(1.0), &of(0.999), false));
        assert!(takes(&of(1.9), &of(2.0), true) && !takes(&of(1.0), &of(2.0), true));
    }
}
