//! Where what has no name acts.

use super::Walk;
use crate::{
    board::Fitted,
    decide::shrink,
    maps::{self, Map, Of},
    verdict::MapOf,
};
use identify::{effects::Context, fit::FitError};

/// A map of twelve forces lowers the sum of squares by so much, in units of the floor, if something acts: by chance by
/// twelve, on 74 records with nothing hidden by 38 at most.
const ACTS: f64 = 100.0;

/// And where an effect is named, if it is no small part of what that takes away: of 35 right names one left so much, a
/// twenty-fifth of what it took; two wrong ones left a third, and twice as much.
const PART: f64 = 0.2;

impl Walk<'_> {
    /// The maps of what is left, the one that lowers the sum of squares most first.
    fn maps(&self, context: &Context, of: Of) -> Result<Vec<MapOf>, FitError> {
        let now = self.judged(&self.best.blocks).level();
        let shown = |map: Map| {
            let blocks: Vec<Vec<f64>> = map.left.iter().map(|sum| vec![*sum]).collect();
            let gone = shrink(now, self.judged(&blocks).level());
            let Map { of, axis, at, force, gain, .. } = map;
            MapOf { of, axis, at, force, shrink: gone, gain }
        };
        // The residuals are those of the fine steps; the derivatives run along coarser ones (`Problem::slopes`).
        let all = maps::maps(&self.board, &self.best, (context, of))?;
        Ok(all.into_iter().map(shown).collect())
    }

    /// The map that takes away most of what is left.
    pub(super) fn map(&self, context: &Context) -> Result<Option<MapOf>, FitError> {
        let all = self.maps(context, Of::Force)?;
        Ok(all.into_iter().max_by(|a, b| a.shrink.total_cmp(&b.shrink)))
    }

    /// The map of what acts though it leaves hardly more than noise does: one that lowers the sum of squares, beside all
    /// parameters, by far more than as many numbers do by chance.
    pub(super) fn faint(&self, context: &Context) -> Result<Option<MapOf>, FitError> {
        let all = self.maps(context, Of::Force)?;
        Ok(all.into_iter().next().filter(|map| map.gain > ACTS))
    }

    /// The map of what the named effects only resemble: one that takes away no small part of what they do, where that
    /// is little.
    pub(super) fn resembled(
        &self,
        refit: &Fitted,
        context: &Context,
    ) -> Result<Option<MapOf>, FitError> {
        let trained = |k: &usize| self.board.trains[*k];
        let squares = |f: &Fitted| -> f64 {
            (0..f.blocks.len()).filter(trained).flat_map(|k| &f.blocks[k]).sum()
        };
        let taken = squares(refit) - squares(&self.best);
        let least = ACTS.max(PART * taken);
        // A map does not take away more than there is.
        if least > squares(&self.best) {
            return Ok(None);
        }
        let mut all = self.maps(context, Of::Force)?;
        all.extend(self.maps(context, Of::Friction)?);
        let most = all.into_iter().max_by(|a, b| a.gain.total_cmp(&b.gain));
        Ok(most.filter(|map| map.gain > least))
    }
}

#[cfg(test)]
mod tests {
    use super::Walk;
    use crate::walk::made;
    use identify::{Rig, effects::Kind};

    #[test]
    fn a_small_force_without_a_name_is_seen_beside_all_parameters() {
        let data = made::data();
        let mut walk = made::walk(&made::rig(2.0), &data, &[]);
        let context = made::context(&walk);
        let mut leaves = |bias: f64| {
            let right = made::with(&made::rig(2.0), Kind::CurrentBias, &[bias]);
            walk.best = walk.board.judged(&Rig { free: Vec::new(), ..right }, None).unwrap();
            let level = walk.judged(&walk.best.blocks).level();
            (level, walk.faint(&context).unwrap().map(|map| map.gain))
        };
        let (level, gain) = leaves(made::BIAS);
        assert!(level < 1.2 && gain.is_none(), "{gain:?} where nothing is missing");
        let (level, gain) = leaves(made::BIAS + 0.05);
        assert!(
            level < 1.3 && gain.is_some_and(|gain| gain > 2.0 * super::ACTS),
            "{level}, {gain:?}"
        );
    }

    #[test]
    fn what_leaves_a_map_no_small_part_of_what_it_takes_is_no_name() {
        let data = made::data();
        let mut walk = made::walk(&made::rig(2.0), &data, &[]);
        let context = made::context(&walk);
        let off = |walk: &Walk<'_>, bias: f64| {
            let rig = made::with(&made::rig(2.0), Kind::CurrentBias, &[made::BIAS + bias]);
            walk.board.judged(&Rig { free: Vec::new(), ..rig }, None).unwrap()
        };
        // A named effect takes a force of 0.08 N down to so much, or one of 1 N.
        for (before, after, only_resembles) in
            [(0.08, 0.05, true), (0.08, 0.0, false), (1.0, 0.05, false)]
        {
            let refit = off(&walk, before);
            walk.best = off(&walk, after);
            let map = walk.resembled(&refit, &context).unwrap();
            assert_eq!(map.is_some(), only_resembles, "{after} N of {before} N");
        }
    }
}
