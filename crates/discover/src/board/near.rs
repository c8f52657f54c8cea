//! A model beside another: begun where that one was.

use super::{Board, Fitted};
use identify::{
    Rig,
    fit::{FitError, problem::Piece, search::Patience, starts},
};

impl Board<'_> {
    /// Fits `rig` from its own values, its windows begun where they did in `pieces` of a model nearby.
    pub(crate) fn fit_near(
        &self,
        rig: &Rig,
        pieces: &[Piece],
        patience: &Patience,
    ) -> Result<Fitted, FitError> {
        let x = starts::nominal(&self.problem(rig, |_| true)?);
        self.fit(rig, Some((&x, pieces)), patience)
    }

    /// A fitted model with each window begun where it was or where one of the `others` does, whichever is nearer.
    pub(crate) fn nearer(&self, fitted: &Fitted, others: &[Piece]) -> Result<Fitted, FitError> {
        let there = self.judged(&fitted.rig, Some(others))?;
        let pairs = fitted.pieces.iter().zip(&there.pieces);
        let near = pairs.map(|(a, b)| if b.misfit() < a.misfit() { b } else { a });
        self.judged(&fitted.rig, Some(&near.cloned().collect::<Vec<Piece>>()))
    }

    /// A fitted model with each window begun where it was or where what was seen leads to, whichever is nearer: a start has
    /// minima of its own, and those of two models must be the same before what they leave can be compared.
    pub(crate) fn seated(&self, fitted: &Fitted) -> Result<Fitted, FitError> {
        if self.imposed() {
            return Ok(fitted.clone());
        }
        let seen = self.judged(&fitted.rig, None)?;
        self.nearer(fitted, &seen.pieces)
    }
}
