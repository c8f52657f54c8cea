//! A model beside whose effects nothing moved, where in the one that was found something did.

use super::{Walk, answer::surely_worse, exchange::kind_of, forms::forms};
use crate::{
    board::Fitted,
    verdict::{Found, Moved},
};
use identify::Rig;
use rayon::prelude::*;
use std::mem;

impl Walk<'_> {
    /// Where parameters moved beside effects: the last model once more, with its effects in each of their forms, from the
    /// given values and with all of these a little off at most. It takes the place of the last one if it is surely no
    /// worse; whether it does. What another form of an effect changes looks like another stiffness, and a search that
    /// went along a valley ends in a minimum of its own.
    pub(super) fn unmoved(&mut self, rig: &Rig, effects: &[Found], parameters: &[Moved]) -> bool {
        if effects.is_empty() || parameters.iter().all(|p| !p.moved) {
            return false;
        }
        let mut loose = self.tied(rig);
        loose.extend(self.board.loose.iter().filter(|(name, _)| !self.own(name)).cloned());
        let before = mem::replace(&mut self.board.loose, loose.clone());
        self.short.loose = loose;
        let here = &self.best.rig;
        let kinds = effects.iter().filter_map(|effect| kind_of(effect.name));
        let others = kinds.flat_map(|kind| forms(kind, here));
        let rigs: Vec<Rig> = [here.clone()].into_iter().chain(others).collect();
        let all: Vec<Fitted> = rigs.par_iter().filter_map(|rig| self.anew(rig).ok()).collect();
        let level = |fitted: &Fitted| self.judged(&fitted.blocks).level();
        let stays = |fitted: &Fitted| self.board.strayed(fitted).is_empty();
        let near = all.into_iter().filter(stays);
        let near = near.min_by(|a, b| level(a).total_cmp(&level(b)));
        let now = self.judged(&self.best.blocks);
        let near = near.filter(|near| !surely_worse(&self.judged(&near.blocks), &now));
        let Some(near) = near else {
            self.short.loose.clone_from(&before);
            self.board.loose = before;
            return false;
        };
        self.best = near;
        true
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        verdict::{Moved, Value},
        walk::made::{BIAS, data, found, rig, walk, with},
    };
    use identify::effects::Kind;

    /// Whether a bias beside a mass of 2.4 kg gives way where so much was given [kg], and the mass then.
    fn gives_way(given: f64) -> (bool, f64, usize) {
        let data = data();
        let mut told = rig(given);
        told.free = vec!["mass".to_owned()];
        let mut walk = walk(&told, &data, &[]);
        let mut there = with(&told, Kind::CurrentBias, &[BIAS]);
        // Near the truth where that is not given, and far off where it is.
        let mass = if given == 2.0 { 2.4 } else { 2.0 };
        identify::fit::binding::set(&mut there, "mass", mass);
        walk.best = walk.board.judged(&there, None).unwrap();
        let name = "mass".to_owned();
        let value = Value { name, value: mass, standard_error: 1e-3, unit: "kg" };
        let moved = [Moved { given, found: value, moved: true }];
        let took = walk.unmoved(&told, &[found("current_bias")], &moved);
        assert!(!walk.unmoved(&told, &[], &moved), "without an effect");
        (took, walk.best.rig.value("mass").unwrap(), walk.board.loose.len())
    }

    #[test]
    fn what_moved_beside_an_effect_did_not_have_to_where_the_given_value_is_as_good() {
        let (took, mass, loose) = gives_way(2.0);
        assert!(took && (mass - 2.0).abs() < 0.02 && loose > 0, "{mass} kg");
        let (took, mass, loose) = gives_way(1.5);
        assert!(!took && (mass - 2.0).abs() < 1e-12 && loose == 0, "{mass} kg");
    }
}
