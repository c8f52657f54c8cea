//! Models whose windows are begun alike, before they are compared near the floor.
//!
//! Where a window begins has minima of its own: under bristles nobody knows what they held there. A model that was fitted
//! from another one's windows is in other minima than that, and what these differ by, tens of squared standard errors, is as
//! much as a weak effect gains.

use super::{Walk, named::NOTHING};
use crate::{board::Fitted, model::Candidate};
use identify::fit::FitError;
use rayon::prelude::*;

impl Walk<'_> {
    /// The candidates, and with them the last model, near the floor, each with its windows begun where they leave least.
    pub(super) fn begun_alike(&mut self, all: Vec<Candidate>) -> Result<Vec<Candidate>, FitError> {
        if self.judged(&self.best.blocks).level() > NOTHING || all.is_empty() {
            return Ok(all);
        }
        self.best = self.board.seated(&self.best)?;
        let one = |c: Candidate| Ok(Candidate { fitted: self.board.seated(&c.fitted)?, ..c });
        all.into_par_iter().map(one).collect()
    }

    /// The same of the last model and one `other` that is compared with it.
    pub(super) fn alike(&mut self, other: Fitted) -> Result<Fitted, FitError> {
        if self.judged(&other.blocks).level() > NOTHING {
            return Ok(other);
        }
        self.best = self.board.seated(&self.best)?;
        self.board.seated(&other)
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        board::Fitted,
        decide::Judged,
        model::Candidate,
        walk::{
            Walk,
            made::{BIAS, data, found, rig, walk, with},
            named::Rated,
        },
    };
    use identify::{effects::Kind, fit::Data};

    /// The record of a mass that lacks a bias of 21 mN.
    fn weak() -> Data {
        let mut data = data();
        data.input.iter_mut().for_each(|u| *u += 0.93 * BIAS);
        data
    }

    /// A model with every judging window begun so far beside where it did [m].
    fn spoiled(walk: &Walk<'_>, fitted: &Fitted, by: f64) -> Fitted {
        let held = fitted.held();
        let problem = walk.board.problem(&held, |_| true).unwrap();
        let mut pieces = fitted.pieces.clone();
        for (w, piece) in pieces.iter_mut().enumerate().filter(|(w, _)| !walk.board.trains[*w]) {
            let [q, v, ..] = piece.start;
            *piece = problem.piece(&[], &walk.board.windows[w], [q + by, v, 0.0, 0.0, 0.0]);
        }
        let blocks = walk.board.sums(&problem, &[], &pieces);
        Fitted { pieces, blocks, ..fitted.clone() }
    }

    #[test]
    fn what_is_compared_near_the_floor_begins_where_it_leaves_least() {
        let data = weak();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let level = |walk: &Walk<'_>, fitted: &Fitted| walk.judged(&fitted.blocks).level();
        let there =
            walk.board.judged(&with(&rig(2.0), Kind::CurrentBias, &[0.07 * BIAS]), None).unwrap();
        let right = level(&walk, &there);
        let begun = spoiled(&walk, &there, 0.01);
        assert!(level(&walk, &begun) > 2.0 * right, "{} {right}", level(&walk, &begun));
        // As every candidate is that a step follows, and the last model with it.
        let now = level(&walk, &walk.best);
        walk.best = spoiled(&walk, &walk.best, 4e-4);
        let badly = level(&walk, &walk.best);
        assert!(right < now && 1.01 * now < badly && badly < super::NOTHING, "{now} {badly}");
        let candidate = Candidate { kind: Kind::CurrentBias, fitted: begun.clone() };
        let all = walk.finely(vec![candidate]).unwrap();
        let (left, after) = (level(&walk, &all[0].fitted), level(&walk, &walk.best));
        assert!((left / right - 1.0).abs() < 0.02, "{left} {right}");
        assert!((after / now - 1.0).abs() < 1e-6, "{after} {now}");
        // So does the last model itself.
        walk.best = begun;
        let without = walk.board.judged(&rig(2.0), None).unwrap();
        walk.alike(without).unwrap();
        assert!((level(&walk, &walk.best) / right - 1.0).abs() < 1e-6);
    }

    #[test]
    fn of_two_that_gain_as_much_on_all_blocks_the_simpler_is_named() {
        // The blocks that were not fitted are more for the other, by chance.
        let judged = |mean: f64, apart: f64| {
            let block = |k: usize| mean + if k.is_multiple_of(2) { apart } else { -apart };
            Judged { blocks: (0..20).map(block).collect(), counts: vec![300.0; 20] }
        };
        let now = judged(1.02, 0.03);
        let rated = |kind: Kind, judged: Judged, together: f64| {
            let fitted =
                Fitted { rig: rig(2.0), x: Vec::new(), pieces: Vec::new(), blocks: Vec::new() };
            let candidate = Candidate { kind, fitted };
            Rated { candidate, judged, evidence: 6.0, together, plausible: true }
        };
        let named = |together: f64| {
            let all = [
                rated(Kind::LoadCellDrift, judged(1.0, 0.0), 200.0),
                rated(Kind::PreloadAsymmetry, judged(1.006, 0.03), together),
            ];
            super::super::named::found(&now, &all, 0).unwrap().1.set
        };
        assert_eq!(named(190.0), ["preload_asymmetry", "load_cell_drift"]);
        assert_eq!(named(100.0), ["load_cell_drift"]);
    }

    #[test]
    fn an_effect_is_not_dropped_for_where_its_windows_began() {
        let data = weak();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let context = crate::walk::made::context(&walk);
        let there =
            walk.board.judged(&with(&rig(2.0), Kind::CurrentBias, &[0.07 * BIAS]), None).unwrap();
        walk.best = spoiled(&walk, &there, 0.01);
        let mut effects = vec![found("current_bias")];
        walk.drop_each(&mut effects, &context).unwrap();
        assert_eq!(effects.len(), 1);
    }
}
