//! Whether an effect that was found first is still the one beside those found after it.

use super::{
    ALIKE, FIRST, Walk,
    named::{LEAST, SURE, UNSURE, numbers},
    polish::TOLD,
};
use crate::{
    board::Fitted,
    decide::Judged,
    model,
    screen::Scored,
    verdict::{Found, Options},
};
use identify::{
    effects::{Context, Key, Kind, LAWS},
    fit::FitError,
};

/// Without what does not begin smoothly another effect may come near where no more than so many floors are left.
const BESIDE: f64 = 3.0;

impl Walk<'_> {
    /// Looks once more for every effect but the last, beside all others: what was found first made up for what was
    /// found later as well, and a richer effect does that better than a simple one. For the last one, too, where it is no
    /// longer plausible: when another was taken away it may have become that one's opposite. What does not begin smoothly
    /// stays where much is left without it: nothing else comes near where it is.
    pub(super) fn exchange_each(
        &mut self,
        effects: &mut [Found],
        context: &Context,
        options: &Options,
    ) -> Result<(), FitError> {
        for place in 0..effects.len() {
            let plausible = self.plausible(effects[place].name, context);
            if self.tired() || place + 1 == effects.len() && plausible {
                break;
            }
            let name = effects[place].name;
            let (before, ranked) = (self.best.clone(), self.ranking.len());
            let without = self.without(&before, name)?;
            let joint = kind_of(name).is_some_and(|kind| !kind.tried().is_empty());
            if plausible && joint && self.left_rigid(&before, &without, name)? > BESIDE {
                continue;
            }
            self.reached = self.judged(&before.blocks).level().max(1.0);
            self.best = without;
            self.origin = self.best.clone();
            let again = self.step(context, options, (effects.len(), None))?;
            self.reached = 1.0;
            self.ranking.truncate(ranked);
            let [then, now] = [&before, &self.best].map(|f| self.judged(&f.blocks));
            match again {
                Some(found)
                    if found.name != name
                        && gives_way(plausible, [&then, &now], [name, found.name])
                        && self.sound(effects, place, context) =>
                {
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

    /// What a model leaves `without` the joint of this name that it had `before` [1], with the dry friction of the load, if it
    /// had any, as the mass's own where that has none: a load that rubs takes its place, however little it gives way.
    fn left_rigid(&self, before: &Fitted, without: &Fitted, name: &str) -> Result<f64, FitError> {
        let dry = Kind::Coulomb;
        let own = without.rig.effects.iter().any(|effect| effect.name == dry.about().name);
        let rubs = before.rig.value(&format!("{name}.rubs")).filter(|rubs| *rubs > 0.0);
        let Some(rubs) = rubs.filter(|_| dry.applies(&without.rig) && !own) else {
            return Ok(self.judged(&without.blocks).level());
        };
        let rig = model::with(without, &Scored::unscored(dry, vec![rubs]));
        let rigid = self.board.fit_near(&rig, &without.pieces, &FIRST)?;
        Ok(self.judged(&rigid.blocks).level())
    }

    /// Whether all effects but the one in this `place` are still plausible in the last model: none of them has become what
    /// was taken away.
    fn sound(&self, effects: &[Found], place: usize, context: &Context) -> bool {
        let mut others = effects.iter().enumerate().filter(|(own, _)| *own != place);
        others.all(|(_, effect)| self.plausible(effect.name, context))
    }

    /// Whether how far a joint of this name gives way is surely more than nothing beside all else; of what is no joint, yes.
    pub(super) fn joint_told(&self, name: &str) -> Result<bool, FitError> {
        let joint = kind_of(name).filter(|kind| !kind.tried().is_empty());
        let Some(first) = joint.and_then(|kind| kind.about().keys.first()) else { return Ok(true) };
        let (values, _) = self.values(&self.given, &|_| false)?;
        let own = values.iter().find(|value| value.name == format!("{name}.{}", first.name));
        Ok(own.is_none_or(|own| own.value > TOLD * own.standard_error))
    }

    /// Whether the effect of this name is plausible in the last model.
    pub(super) fn plausible(&self, name: &str, context: &Context) -> bool {
        let others = [&self.best.rig, &self.origin.rig, &self.given];
        let plausible = |kind| model::plausible(&self.best.rig, kind, context, &others);
        kind_of(name).is_none_or(plausible)
    }
}

/// The effect of this name.
pub(super) fn kind_of(name: &str) -> Option<Kind> {
    LAWS.iter().copied().find(|kind| kind.about().name == name)
}

/// The key of an effect that a free parameter is, if it is one of its: `inertia` is a plant's own.
pub(super) fn key_of(kind: Kind, parameter: &str) -> Option<&'static Key> {
    let key = parameter.strip_prefix(kind.about().name)?.strip_prefix('.')?;
    kind.about().keys.iter().find(|own| own.name == key)
}

/// Whether a model that was `plausible`, or was not, gives way to another: what is not plausible does in any case.
fn gives_way(plausible: bool, [then, now]: [&Judged; 2], [had, another]: [&str; 2]) -> bool {
    !plausible || takes(now, then, [another, had])
}

/// Whether a model with `another` effect takes the place of the one it had then: if it is not surely worse, or by no more
/// than what is worth no name; one that needs more numbers must surely be better.
fn takes(now: &Judged, then: &Judged, [another, had]: [&str; 2]) -> bool {
    let many = |name: &str| kind_of(name).map_or(0, numbers);
    if many(another) > many(had) {
        return then.against(now) >= SURE;
    }
    let unsure = now.against(then) < UNSURE && now.level() < ALIKE * then.level();
    unsure || now.gained(then) < LEAST
}

#[cfg(test)]
mod tests {
    use super::{Judged, gives_way, key_of, takes};
    use crate::walk::made::{BIAS, context, data, found, rig, taken, walk, with};
    use identify::effects::Kind;

    #[test]
    fn a_joint_of_which_nothing_is_told_is_told_from_one_that_gives_way() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let told = |walk: &mut crate::walk::Walk<'_>, compliance: f64| {
            let gives = with(&rig(2.0), Kind::Compliance, &[compliance, 0.3, 0.3, 1e-3]);
            walk.best = walk.board.judged(&gives, None).unwrap();
            walk.joint_told("compliance").unwrap()
        };
        assert!(told(&mut walk, 1e-2) && !told(&mut walk, 1e-7));
        assert!(walk.joint_told("current_bias").unwrap(), "it is no joint");
    }

    #[test]
    fn the_last_effect_is_looked_for_once_more_where_it_has_become_its_opposite() {
        let data = data();
        let last = |amount: f64| {
            let mut walk = walk(&rig(2.0), &data, &[]);
            let drag = with(&rig(2.0), Kind::QuadraticDrag, &[amount]);
            walk.best = walk.board.judged(&drag, None).unwrap();
            let context = context(&walk);
            let mut effects = vec![found("quadratic_drag")];
            walk.exchange_each(&mut effects, &context, &crate::Options::default()).unwrap();
            effects[0].name
        };
        // What is missing is a bias; a drag that drives is no drag.
        assert_eq!(last(-0.1), "current_bias");
        assert_eq!(last(0.1), "quadratic_drag", "what is plausible stays");
    }

    #[test]
    fn a_plants_parameter_is_no_effects_though_it_has_its_name() {
        for kind in super::LAWS.iter().copied() {
            let (name, keys) = (kind.about().name, kind.about().keys);
            assert!(key_of(kind, name).is_none(), "{name}");
            let own = |key: &super::Key| key_of(kind, &format!("{name}.{}", key.name));
            assert!(keys.iter().all(|key| own(key).is_some_and(|found| found.name == key.name)));
        }
    }

    #[test]
    fn what_does_not_begin_smoothly_stays_where_much_is_left_without_it() {
        // What is missing is a bias, which takes the place of a drag; of a soft gear only where it is small.
        let first = |kind: Kind, values: &[f64], bias: f64| {
            let data = taken(|_, _| bias);
            let mut walk = walk(&rig(2.0), &data, &[]);
            let rig = with(&with(&rig(2.0), kind, values), Kind::CubicSpring, &[1e-3]);
            walk.best = walk.board.judged(&rig, None).unwrap();
            let context = context(&walk);
            let mut effects = vec![found(kind.about().name), found("cubic_spring")];
            walk.exchange_each(&mut effects, &context, &crate::Options::default()).unwrap();
            effects[0].name
        };
        let soft = [1e-4, 0.2, 0.5, 0.01];
        assert_eq!(first(Kind::QuadraticDrag, &[0.1], BIAS), "current_bias");
        assert_eq!(first(Kind::Compliance, &soft, BIAS), "compliance");
        assert_eq!(first(Kind::Compliance, &soft, 0.012 * BIAS), "current_bias");
    }

    #[test]
    fn a_load_that_rubs_and_hardly_gives_way_is_dry_friction_of_the_mass() {
        let data = taken(|_, v| 0.3 * v.signum());
        let mut walk = walk(&rig(2.0), &data, &[]);
        let joint = with(&rig(2.0), Kind::Compliance, &[1e-5, 1.0, 0.5, 0.3]);
        walk.best = walk.board.judged(&with(&joint, Kind::CubicSpring, &[1e-3]), None).unwrap();
        let without = walk.without(&walk.best, "compliance").unwrap();
        assert!(walk.judged(&without.blocks).level() > super::BESIDE, "much is left");
        let context = context(&walk);
        let mut effects = vec![found("compliance"), found("cubic_spring")];
        walk.exchange_each(&mut effects, &context, &crate::Options::default()).unwrap();
        assert_eq!(effects[0].name, "coulomb");
    }

    #[test]
    fn a_richer_effect_takes_no_place_but_of_one_that_is_surely_worse() {
        let of = |means: [f64; 2]| Judged {
            blocks: (0..20).map(|k| means[k % 2]).collect(),
            counts: vec![300.0; 20],
        };
        let (then, alike, better) = (of([9.0, 9.0]), of([8.0, 10.0]), of([5.0, 6.0]));
        let (rich, simple) = ("cogging", "viscous");
        assert!(takes(&alike, &then, [simple, rich]) && !takes(&alike, &then, [rich, simple]));
        assert!(takes(&better, &then, [rich, simple]));
        assert!(!takes(&then, &better, [simple, rich]), "surely worse");
        // But what is not plausible stays nowhere, however near it is.
        assert!(gives_way(false, [&better, &then], [rich, simple]));
        assert!(!gives_way(true, [&better, &then], [rich, simple]));
        let worse = of([4.0, 40.0]);
        assert!(worse.against(&then) < super::UNSURE && !takes(&worse, &then, [simple, simple]));
    }
}
