//! Where what has no name acts.

use super::Walk;
use crate::{
    board::Fitted,
    decide::shrink,
    maps::{self, Map, Of},
    verdict::{MapOf, Moved},
};
use identify::{
    Rig,
    effects::Context,
    fit::{FitError, search::Patience},
};

/// A map of twelve forces lowers the sum of squares by so much, in units of the floor, if something acts: by chance by
/// twelve, on 74 records with nothing hidden by 38 at most.
const ACTS: f64 = 100.0;

/// At the end of a valley, which a map is not to be taken for.
const DOWN: Patience = Patience { misfit: 1.0, share: 1e-6, simulations: 60 };

/// And where an effect is named, if it is no small part of what that takes away: of 35 right names one left so much, a
/// twenty-fifth of what it took; two wrong ones left a third, and twice as much.
const PART: f64 = 0.2;

/// And where several are named that do not explain all, if a force over the displacement leaves hardly more: they are its
/// series. Where they nearly do, if it leaves less.
const SERIES: f64 = 1.2;
const NEARER: f64 = 0.95;

impl Walk<'_> {
    /// The maps of what a model leaves, the one that lowers the sum of squares most first; and by how much each lowers that
    /// of the blocks it is not fitted to, but for the two that gain most.
    fn maps_judged(
        &self,
        fitted: &Fitted,
        (context, of): (&Context, Of),
    ) -> Result<Vec<(MapOf, f64)>, FitError> {
        let judged = self.judged(&fitted.blocks);
        let shown = |map: Map| {
            let blocks: Vec<Vec<f64>> = map.left.iter().map(|sum| vec![*sum]).collect();
            let with = self.judged(&blocks);
            let Map { of, axis, at, force, gain, .. } = map;
            let gone = shrink(judged.level(), with.level());
            (MapOf { of, axis, at, force, shrink: gone, gain }, judged.gained_besides(&with))
        };
        // The residuals are those of the fine steps; the derivatives run along coarser ones (`Problem::slopes`).
        let all = maps::maps(&self.board, fitted, (context, of))?;
        Ok(all.into_iter().map(shown).collect())
    }

    /// The maps alone.
    fn maps(&self, fitted: &Fitted, context: &Context, of: Of) -> Result<Vec<MapOf>, FitError> {
        let all = self.maps_judged(fitted, (context, of))?;
        Ok(all.into_iter().map(|(map, _)| map).collect())
    }

    /// The map that takes away most of what is left.
    pub(super) fn map(&self, context: &Context) -> Result<Option<MapOf>, FitError> {
        let all = self.maps(&self.best, context, Of::Force)?;
        Ok(all.into_iter().max_by(|a, b| a.shrink.total_cmp(&b.shrink)))
    }

    /// The map of what acts though it leaves hardly more than noise does: one that lowers the sum of squares, beside all
    /// parameters, by far more than as many numbers do by chance, and on blocks that it was not fitted to as well: it goes
    /// after the windows that went astray. The last model has then gone to the end of its valley, and its
    /// `parameters` with it.
    pub(super) fn faint(
        &mut self,
        (rig, parameters): (&Rig, &mut [Moved]),
        context: &Context,
    ) -> Result<Option<MapOf>, FitError> {
        let acts = |walk: &Self| -> Result<Option<MapOf>, FitError> {
            let least = ACTS * walk.grained(&walk.best);
            let all = walk.maps_judged(&walk.best, (context, Of::Force))?;
            let acts = |(map, elsewhere): &(MapOf, f64)| map.gain > least && *elsewhere > 0.0;
            Ok(all.into_iter().find(acts).map(|(map, _)| map))
        };
        if acts(self)?.is_none() {
            return Ok(None);
        }
        let down = self.board.fit_near(&self.best.rig, &self.best.pieces, &DOWN)?;
        if self.board.trained(&down) < self.board.trained(&self.best) {
            self.best = down;
            let (values, _) = self.values(rig, &|_| false)?;
            for (parameter, value) in parameters.iter_mut().zip(values) {
                parameter.found = value;
            }
        }
        acts(self)
    }

    /// The map of what the named effects only resemble: one that takes away no small part of what they do, where that
    /// is little, and something on blocks that it was not fitted to.
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
        let least = (ACTS * self.grained(&self.best)).max(PART * taken);
        // A map does not take away more than there is.
        if least > squares(&self.best) {
            return Ok(None);
        }
        let mut all = self.maps_judged(&self.best, (context, Of::Force))?;
        // Where the motion is imposed the noise of the displacement turns it to and fro at its ends, where friction is
        // less for that: a right model of such a record left a map of 766.
        if !self.board.imposed() {
            all.extend(self.maps_judged(&self.best, (context, Of::Friction))?);
        }
        let acts = all.into_iter().filter(|(_, elsewhere)| *elsewhere > 0.0).map(|(map, _)| map);
        let most = acts.max_by(|a, b| a.gain.total_cmp(&b.gain));
        Ok(most.filter(|map| map.gain > least))
    }

    /// The map of one force over the displacement that does as well as several named effects, so `many`, which leave
    /// something, or better where they explain nearly `all`: friction that is stronger on the way out than on the way home
    /// is a step of a force at the middle, and a wave with overtones and a slip make up for that in part. Over the velocity,
    /// and the drive that goes with it, the library has many names, so that several of them are no series.
    pub(super) fn series(
        &self,
        refit: &Fitted,
        (many, all): (usize, bool),
        context: &Context,
    ) -> Result<Option<MapOf>, FitError> {
        if many < 2 {
            return Ok(None);
        }
        let [nominal, last] = [refit, &self.best].map(|f| self.judged(&f.blocks).level());
        let enough = shrink(nominal, if all { NEARER } else { SERIES } * last);
        let maps = self.maps(refit, context, Of::Force)?;
        Ok(maps.into_iter().find(|map| map.axis == "displacement" && map.shrink > enough))
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
            (level, walk.faint((&made::rig(2.0), &mut []), &context).unwrap().map(|map| map.gain))
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
    fn what_acts_on_the_blocks_alone_that_a_map_is_fitted_to_is_no_force() {
        let mut data = made::data();
        let trains: Vec<bool> = {
            let walk = made::walk(&made::rig(2.0), &data, &[]);
            let board = &walk.board;
            let mut trains = vec![false; data.input.len()];
            for (w, window) in board.windows.iter().enumerate() {
                trains[window.first..window.end].fill(board.trains[board.block(w)]);
            }
            trains
        };
        for (u, trains) in data.input.iter_mut().zip(&trains) {
            *u += made::BIAS + if *trains { 0.05 } else { 0.0 };
        }
        let mut walk = made::walk(&made::rig(2.0), &data, &[]);
        let context = made::context(&walk);
        let maps = walk.maps(&walk.best, &context, super::Of::Force).unwrap();
        assert!(maps[0].gain > super::ACTS, "{}", maps[0].gain);
        let found = walk.faint((&made::rig(2.0), &mut []), &context).unwrap();
        assert!(found.is_none(), "{found:?}");
        // Nor does it say that an effect which takes hardly more only resembles what is missing.
        let with = made::with(&made::rig(2.0), Kind::CurrentBias, &[0.06]);
        let far = walk.board.judged(&Rig { free: Vec::new(), ..with }, None).unwrap();
        let found = walk.resembled(&far, &context).unwrap();
        assert!(found.is_none(), "{found:?}");
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

    #[test]
    fn several_names_are_the_series_of_a_force_over_the_displacement() {
        // A force that goes from -0.5 N to 0.5 N in the middle, and one with the cube of the velocity.
        let (mut steps, mut drags) = (made::data(), made::data());
        for (i, t) in steps.time.iter().enumerate() {
            let (x, v) = ((2.0 * t).sin(), 2.0 * (2.0 * t).cos());
            steps.input[i] += made::BIAS + 0.5 * (x / 0.2).tanh();
            drags.input[i] += made::BIAS + 0.1 * v * v * v;
        }
        let axis = |data: &identify::fit::Data, named: [f64; 2], how: (usize, bool)| {
            let mut walk = made::walk(&made::rig(2.0), data, &[]);
            let context = made::context(&walk);
            let refit = walk.best.clone();
            let with = made::with(&made::rig(2.0), Kind::CubicSpring, &named[..1]);
            let with = made::with(&with, Kind::QuadraticDrag, &named[1..]);
            walk.best = walk.board.judged(&Rig { free: Vec::new(), ..with }, None).unwrap();
            let levels = [&refit, &walk.best].map(|f| walk.judged(&f.blocks).level());
            (walk.series(&refit, how, &context).unwrap().map(|map| map.axis), levels)
        };
        // A spring and a drag make up for a part of the step.
        let (found, [alone, named]) = axis(&steps, [0.1; 2], (2, false));
        assert!(found == Some("displacement") && named < alone, "{found:?}: {alone} to {named}");
        assert_eq!(axis(&steps, [0.1; 2], (1, false)).0, None, "a name is a name");
        // It is nearer than these, and hardly as near as a spring that is right.
        assert_eq!(axis(&steps, [0.1; 2], (2, true)).0, Some("displacement"));
        let mut springs = made::data();
        for (u, t) in springs.input.iter_mut().zip(&springs.time) {
            *u += made::BIAS + 0.4 * (2.0 * t).sin().powi(3);
        }
        let (found, [alone, named]) = axis(&springs, [0.4, 1e-4], (2, true));
        assert!(found.is_none() && named < 1.05, "{found:?}: {alone} to {named}");
        assert_eq!(axis(&springs, [0.4, 1e-4], (2, false)).0, Some("displacement"));
        let (found, levels) = axis(&drags, [0.1; 2], (2, false));
        assert!(
            found.is_none() && levels[1] < levels[0],
            "over the velocity there are many: {found:?} {levels:?}"
        );
    }
}
