//! What is done to a model that is near already.

use super::{DOWN, REFIT, SURE, Walk};
use crate::{
    board::{FINE, Fitted},
    verdict::Found,
};
use identify::fit::{FitError, search::Patience, starts};

/// Enough for a model that is near already.
const POLISH: Patience = Patience { misfit: 0.5, share: 2e-5, simulations: 12 };

/// So often at most, as long as the misfit falls by so much; a standard error makes 1.
const POLISHED: usize = 6;
const GAINED: f64 = 0.2;

/// A model without an effect is as good if it leaves no more than so many times as much, and may become so if it
/// leaves no more than this.
const AS_GOOD: f64 = 1.1;
const CLOSE_TO: f64 = 1.4;

impl Walk<'_> {
    /// The last model and the refitted nominal one with steps that no longer show.
    pub(super) fn polish(&mut self, refit: &Fitted, seed: u64) -> Result<Fitted, FitError> {
        self.best = self.board.refined(&self.best, FINE)?;
        self.board.refloor(&self.best, seed)?;
        self.best = self.board.again(&self.best)?;
        let refit = &self.board.again(refit)?;
        self.polished()?;
        // Without effects the two are one model: the better minimum is its.
        if self.best.rig.effects.len() == refit.rig.effects.len() {
            if self.board.trained(refit) < self.board.trained(&self.best) {
                self.best = refit.clone();
            }
            return Ok(self.best.clone());
        }
        Ok(refit.clone())
    }

    /// A model near the floor is polished before more is looked for: what a search that stopped early leaves is no
    /// effect's.
    pub(super) fn near_the_floor(&mut self) -> Result<(), FitError> {
        let level = self.judged(&self.best.blocks).level();
        if (DOWN..CLOSE_TO).contains(&level) { self.polished() } else { Ok(()) }
    }

    /// The last model refitted until it falls by less than shows.
    fn polished(&mut self) -> Result<(), FitError> {
        for _ in 0..POLISHED {
            let from = (self.best.x.as_slice(), self.best.pieces.as_slice());
            let next = self.board.fit(&self.best.rig, Some(from), &POLISH)?;
            let gained = self.board.trained(&self.best) - self.board.trained(&next);
            if gained > 0.0 {
                self.best = next;
            }
            // The logarithms of the blocks fall by their shares.
            if gained * self.counts.iter().sum::<f64>() < GAINED * self.counts.len() as f64 {
                break;
            }
        }
        Ok(())
    }

    /// Takes away again every effect without which a refit is as good: it had only shown the way.
    pub(super) fn drop_each(&mut self, effects: &mut Vec<Found>) -> Result<(), FitError> {
        for place in (0..effects.len()).rev() {
            let name = effects[place].name;
            let mut rig = self.best.rig.clone();
            rig.effects.retain(|effect| effect.name != name);
            rig.free.retain(|free| !free.starts_with(&format!("{name}.")));
            let x = starts::nominal(&self.board.problem(&rig, |_| true)?);
            let mut without = self.board.fit(&rig, Some((&x, &self.best.pieces)), &REFIT)?;
            let now = self.judged(&self.best.blocks);
            let needless = |without: &Fitted| {
                let there = self.judged(&without.blocks);
                let near = there.against(&now) < SURE && there.level() < AS_GOOD * now.level();
                near && self.board.strayed(without).is_empty()
            };
            // What comes near at once may come all the way.
            if !needless(&without) && self.judged(&without.blocks).level() < CLOSE_TO * now.level()
            {
                let from = (without.x.as_slice(), without.pieces.as_slice());
                without = self.board.fit(&without.rig, Some(from), &REFIT)?;
            }
            if needless(&without) {
                self.best = without;
                effects.remove(place);
            }
        }
        Ok(())
    }
}
