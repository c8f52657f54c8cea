//! Whether an effect that was found first is still the one beside those found after it.

use super::{
    Walk,
    named::{LEAST, UNSURE},
};
use crate::{
    decide::Judged,
    verdict::{Found, Options},
};
use identify::{effects::Context, fit::FitError};

impl Walk<'_> {
    /// Looks once more for every effect but the last, beside all others: what was found first made up for what was
    /// found later as well, and a richer effect does that better than a simple one.
    pub(super) fn exchange_each(
        &mut self,
        effects: &mut [Found],
        context: &Context,
        options: &Options,
    ) -> Result<(), FitError> {
        for place in 0..effects.len().saturating_sub(1) {
            let (before, ranked) = (self.best.clone(), self.ranking.len());
            let name = effects[place].name;
            self.best = self.without(&before, name)?;
            self.origin = self.best.clone();
            let again = self.step(context, options, (effects.len(), None))?;
            self.ranking.truncate(ranked);
            let [then, now] = [&before, &self.best].map(|f| self.judged(&f.blocks));
            match again {
                Some(found) if found.name != name && as_near(&now, &then) => {
                    effects[place] = found;
                }
                Some(found) if found.name == name => {
                    effects[place].set = found.set;
                    effects[place].separated_by = found.separated_by;
                    self.best = before;
                }
                _ => self.best = before,
            }
        }
        Ok(())
    }
}

/// Whether a model with another effect is not surely worse than the last one, or by no more than what is worth no name.
fn as_near(now: &Judged, then: &Judged) -> bool {
    now.against(then) < UNSURE || now.gained(then) < LEAST
}
