//! A model once more from where it was not.

use super::{ABOVE, REFIT, Walk, begin::astray};
use crate::board::Fitted;
use identify::{
    Rig,
    fit::{FitError, binding},
};

/// What leaves no more than so many floors may be the right effect that was not followed to its end.
const STUCK: f64 = 3.0;

impl Walk<'_> {
    /// The last model refitted with every window begun anew, if that is nearer: where a window begins is looked for
    /// beside the parameters, and one that was begun far from the truth keeps them in a minimum of its own.
    pub(super) fn begun_anew(&mut self) -> Result<(), FitError> {
        if self.board.imposed() || self.judged(&self.best.blocks).level() < ABOVE {
            return Ok(());
        }
        let anew = self.board.fit(&self.best.rig, None, &REFIT)?;
        let anew = self.board.nearer(&anew, &self.best.pieces)?;
        let better = self.board.trained(&anew) < self.board.trained(&self.best);
        if better && !astray(&self.board, &anew, &self.origin) {
            self.best = anew;
        }
        // Along a valley what is left falls by less each time; from the given values it is another way.
        let level = self.judged(&self.best.blocks).level();
        if (ABOVE..STUCK).contains(&level) {
            let anew = self.anew(&self.best.rig)?;
            if self.board.trained(&anew) < self.board.trained(&self.best) {
                self.best = anew;
            }
        }
        Ok(())
    }

    /// A model refitted from the given values of what is no effect's, by way of short windows, to its end.
    pub(super) fn anew(&self, rig: &Rig) -> Result<Fitted, FitError> {
        let rig = self.at_given(rig);
        let short = Some(&self.short).filter(|short| !short.imposed());
        self.ended(self.board.refit(&rig, short, &REFIT)?)
    }

    /// `rig` with the given values of what is no effect's.
    pub(super) fn at_given(&self, rig: &Rig) -> Rig {
        let mut rig = rig.clone();
        for name in rig.free.clone().iter().filter(|name| !name.contains('.')) {
            if let Some(given) = self.given.value(name) {
                binding::set(&mut rig, name, given);
            }
        }
        rig
    }
}
