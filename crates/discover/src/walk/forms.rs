//! The nearest effect in its other forms, where the one in which it was looked for does not do.

use super::{
    ABOVE, FIRST, Walk, answer::surely_worse, geared::geared, joints::AS_NEAR, loads::dragged,
};
use crate::{board::Fitted, model::Candidate};
use identify::{
    Rig,
    effects::{Context, Kind, LAWS},
    fit::{FitError, binding},
};
use rayon::prelude::*;

/// The overtone of what repeats along the way is begun at this share of it, at each of these phases [rad].
const SHARE: f64 = 0.2;
const PHASES: [f64; 4] = [0.8, 2.4, 3.9, 5.5];

/// What repeats along the way and may have an overtone.
const WAVES: [Kind; 2] = [Kind::Cogging, Kind::PositionFriction];

/// A wave that leaves no more than so many times what the nearest does is tried with its overtone.
const BEHIND: f64 = 10.0;

/// So are the nearest of so many kinds of effect in their other forms.
const KINDS: usize = 3;

/// So is a load whose friction builds up on a way.
const NOT_FAR: f64 = 1.5;

/// What has more of the same must lower what is left to so much of what it was.
const LOWER: f64 = 0.8;

impl Walk<'_> {
    /// The leading candidates in the best of their other forms, one with a load whose friction builds up on a way, and the
    /// nearest waves with their overtones, each if it comes much nearer so.
    pub(super) fn other_forms(&self, all: &[Candidate], context: &Context) -> Vec<Candidate> {
        let level = |c: &Candidate| self.judged(&c.fitted.blocks).level();
        let plausible = all.iter().filter(|c| self.fits(c, context));
        let Some(least) = plausible.map(level).min_by(f64::total_cmp) else { return Vec::new() };
        let nearest = |kind: Kind| {
            let own = all.iter().filter(|c| c.kind == kind);
            let wave = own.min_by(|a, b| level(a).total_cmp(&level(b)));
            wave.filter(|wave| level(wave) < BEHIND * least)
        };
        let waves = WAVES.into_iter().filter_map(nearest);
        let joints = all.iter().filter(|c| !c.kind.tried().is_empty());
        let joint = joints.min_by(|a, b| level(a).total_cmp(&level(b)));
        let joint = joint.filter(|joint| level(joint) < NOT_FAR * least);
        let leading = self.leading(all, context);
        let other = leading.iter().filter_map(|c| self.best_form(c, &forms(c.kind, &c.fitted.rig)));
        let geared =
            leading.iter().filter_map(|c| self.best_of(c, &geared(c.kind, &c.fitted.rig, context)));
        let overtones = waves.filter_map(|wave| self.overtone(wave));
        other
            .chain(geared)
            .chain(overtones)
            .chain(joint.and_then(|joint| self.loaded(joint, context)))
            .collect()
    }

    /// A wave with its overtone; where that is the larger, with its own in turn.
    fn overtone(&self, wave: &Candidate) -> Option<Candidate> {
        let name = wave.kind.about().name;
        let keys = ["share_2", "phase_2"].map(|key| format!("{name}.{key}"));
        let with = |rig: &Rig| {
            PHASES.map(|phase| spared(rig, &[(keys[0].as_str(), SHARE), (keys[1].as_str(), phase)]))
        };
        let mut found = self.best_of(wave, &with(&wave.fitted.rig))?;
        let on = |found: &Candidate| {
            twice(&found.fitted.rig, name).and_then(|rig| self.best_of(found, &with(&rig)))
        };
        while let Some(next) = on(&found) {
            found = next;
        }
        Some(found)
    }

    /// The nearest of each kind that is not far behind the nearest of all; none where that is down at the floor. What is
    /// in another form than its own may be nearer in a wrong kind.
    fn leading<'c>(&self, all: &'c [Candidate], context: &Context) -> Vec<&'c Candidate> {
        let plausible = all.iter().filter(|c| self.fits(c, context));
        let mut near: Vec<(f64, &Candidate)> =
            plausible.map(|c| (self.judged(&c.fitted.blocks).level(), c)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let least = near.first().map_or(0.0, |(level, _)| *level);
        let mut leading: Vec<&Candidate> = Vec::new();
        if least < ABOVE {
            return leading;
        }
        for (level, candidate) in near {
            let new = !leading.iter().any(|own| own.kind == candidate.kind);
            if level < BEHIND * least && new && leading.len() < KINDS {
                leading.push(candidate);
            }
        }
        leading
    }

    /// The last model with one of its effects in another form, or with a load that drags, if it then leaves no more than
    /// what has an effect more, `found`: what its own form misses is no second effect.
    pub(super) fn reformed(
        &self,
        found: &Fitted,
        context: &Context,
    ) -> Result<Option<Fitted>, FitError> {
        let here = &self.best;
        let found_here = |kind: &&Kind| {
            let name = kind.about().name;
            !self.given.effects.iter().any(|effect| effect.name == name)
        };
        let other = |kind: &Kind| {
            let drags = dragged(*kind, &here.rig, context);
            let geared = geared(*kind, &here.rig, context);
            forms(*kind, &here.rig).into_iter().chain(drags).chain(geared)
        };
        let others = LAWS.iter().filter(found_here).flat_map(other);
        let rigs: Vec<Rig> = others.collect();
        let one = |rig: &Rig| self.board.fit_near(rig, &here.pieces, &FIRST).ok();
        let fitted: Vec<Fitted> = rigs.par_iter().filter_map(one).collect();
        let level = |fitted: &Fitted| self.judged(&fitted.blocks).level();
        let Some(nearest) = fitted.into_iter().min_by(|a, b| level(a).total_cmp(&level(b))) else {
            return Ok(None);
        };
        let nearest = self.ended(nearest)?;
        let as_good = level(&nearest) < AS_NEAR * level(found);
        Ok(Some(nearest).filter(|_| as_good))
    }

    /// The nearest of a candidate's variants, refitted, if it lowers what the candidate leaves.
    pub(super) fn best_of(&self, candidate: &Candidate, variants: &[Rig]) -> Option<Candidate> {
        let level = |c: &Candidate| self.judged(&c.fitted.blocks).level();
        let best = self.nearest_of(candidate, variants)?;
        (level(&best) < LOWER * level(candidate)).then_some(best)
    }

    /// The same of variants that need no more numbers than it: those need only be surely nearer.
    fn best_form(&self, candidate: &Candidate, forms: &[Rig]) -> Option<Candidate> {
        let judged = |c: &Candidate| self.judged(&c.fitted.blocks);
        let best = self.nearest_of(candidate, forms)?;
        let (own, other) = (judged(candidate), judged(&best));
        let nearer = other.level() < LOWER * own.level() || surely_worse(&own, &other);
        nearer.then_some(best)
    }

    /// The nearest of a candidate's variants, refitted; none where it leaves too little to tell.
    fn nearest_of(&self, candidate: &Candidate, variants: &[Rig]) -> Option<Candidate> {
        let level = |c: &Candidate| self.judged(&c.fitted.blocks).level();
        if level(candidate) < ABOVE {
            return None;
        }
        let refitted = |rig: &Rig| {
            let fitted = self.board.fit_near(rig, &candidate.fitted.pieces, &FIRST).ok()?;
            Some(Candidate { kind: candidate.kind, fitted })
        };
        let found: Vec<Candidate> = variants.par_iter().filter_map(refitted).collect();
        found.into_iter().min_by(|a, b| level(a).total_cmp(&level(b)))
    }
}

/// `rig` with an effect of this kind in each of the other forms that it may take; none without the effect.
pub(super) fn forms(kind: Kind, rig: &Rig) -> Vec<Rig> {
    let form = format!("{}.form", kind.about().name);
    let Some(own) = rig.value(&form) else { return Vec::new() };
    let set = |other: &f64| {
        let mut with = rig.clone();
        binding::set(&mut with, &form, *other);
        with
    };
    kind.forms().iter().filter(|other| own != **other).map(set).collect()
}

/// `rig` with the overtone of an effect's wave in the place of the wave, where it is the larger.
fn twice(rig: &Rig, name: &str) -> Option<Rig> {
    let key = |key: &str| format!("{name}.{key}");
    let [sine, cosine, wavenumber, share, phase] =
        ["sine", "cosine", "wavenumber", "share_2", "phase_2"].map(|own| rig.value(&key(own)));
    let (sine, cosine, share) = (sine?, cosine?, share.filter(|share| *share > 1.0)?);
    let (s, c) = phase?.sin_cos();
    let mut rig = rig.clone();
    let values = [
        ("sine", share * (sine * c - cosine * s)),
        ("cosine", share * (sine * s + cosine * c)),
        ("wavenumber", 2.0 * wavenumber?),
    ];
    for (own, value) in values {
        binding::set(&mut rig, &key(own), value);
    }
    Some(rig)
}

/// `rig` with these values of what is not asked for as a rule, free.
pub(super) fn spared(rig: &Rig, values: &[(impl AsRef<str>, f64)]) -> Rig {
    let mut with = rig.clone();
    for (name, value) in values {
        let name = name.as_ref();
        binding::set(&mut with, name, *value);
        if !with.free.iter().any(|free| free == name) {
            with.free.push(name.to_owned());
        }
    }
    with
}

#[cfg(test)]
mod tests {
    use crate::{
        model::Candidate,
        walk::made::{DRY, context, rig, taken, walk, with},
    };
    use identify::effects::{Context, Kind};

    /// A force that repeats along the way with 9 rad/m, and its overtone.
    fn overtone(q: f64, _: f64) -> f64 {
        let wave = |x: f64| 6.0 * x.sin() + 3.0 * x.cos();
        wave(9.0 * q) + 0.3 * wave(18.0 * q + 2.0)
    }

    #[test]
    fn an_overtone_is_found_beside_its_wave() {
        let data = taken(overtone);
        let walk = walk(&rig(2.0), &data, &[]);
        let context = Context { span: 200.0, ..context(&walk) };
        let wave = with(&rig(2.0), Kind::Cogging, &[6.0, 3.0, 9.0]);
        let fitted = walk.board.judged(&wave, None).unwrap();
        let alone = walk.judged(&fitted.blocks).level();
        let found = walk.other_forms(&[Candidate { kind: Kind::Cogging, fitted }], &context);
        let [found] = found.as_slice() else { panic!("{} forms", found.len()) };
        let left = walk.judged(&found.fitted.blocks).level();
        assert!(alone > 5.0 && left < 1.2, "{alone} alone, {left} with its overtone");
        let value = |key: &str| found.fitted.rig.value(&format!("cogging.{key}")).unwrap();
        assert!((value("share_2") - 0.3).abs() < 0.02, "{}", value("share_2"));
        let off = (value("phase_2") - 2.0).rem_euclid(std::f64::consts::TAU);
        assert!(off.min(std::f64::consts::TAU - off) < 0.05, "{}", value("phase_2"));
    }

    #[test]
    fn what_rubs_from_place_to_place_has_an_overtone_too() {
        let wave = |x: f64| 0.5 * x.sin() + 0.2 * x.cos();
        let share = move |q: f64| wave(9.0 * q) + 0.4 * wave(18.0 * q + 2.0);
        let data = taken(|q, v| 5.0 * (1.0 + share(q)) * v.signum());
        let rig = identify::Rig::parse(&DRY.replace("f_c = 0.5", "f_c = 5.0")).unwrap();
        let walk = walk(&rig, &data, &[]);
        let rubs = with(&rig, Kind::PositionFriction, &[0.5, 0.2, 9.0, 1.0]);
        let fitted = walk.board.judged(&rubs, None).unwrap();
        let alone = walk.judged(&fitted.blocks).level();
        let found = walk.overtone(&Candidate { kind: Kind::PositionFriction, fitted }).unwrap();
        let end = walk.ended(found.fitted).unwrap();
        let left = walk.judged(&end.blocks).level();
        let share = end.rig.value("position_friction.share_2").unwrap();
        // Where it turns between two samples the friction jumps, as the line of the input there does not.
        assert!(left < 0.1 * alone, "{alone} alone, {left} with its overtone");
        assert!((share - 0.4).abs() < 0.02, "{share}");
    }

    #[test]
    fn an_overtone_larger_than_its_wave_is_the_wave() {
        // Begun at half of its wavenumber the wave is an overtone, and has one of its own.
        let data = taken(overtone);
        let walk = walk(&rig(2.0), &data, &[]);
        let mut half = with(&rig(2.0), Kind::Cogging, &[0.5, 0.25, 4.5]);
        half.free.push("cogging.wavenumber".to_owned());
        let fitted = walk.board.judged(&half, None).unwrap();
        let found = walk.overtone(&Candidate { kind: Kind::Cogging, fitted }).unwrap();
        let left = walk.judged(&found.fitted.blocks).level();
        let wavenumber = found.fitted.rig.value("cogging.wavenumber").unwrap();
        assert!(left < 1.2 && (wavenumber - 9.0).abs() < 0.02, "{left}, {wavenumber} rad/m");
        // The same force, but for the wave that is as good as none.
        let mut rig = with(&rig(2.0), Kind::Cogging, &[0.02, -0.01, 4.5]);
        super::binding::set(&mut rig, "cogging.share_2", 30.0);
        super::binding::set(&mut rig, "cogging.phase_2", 0.7);
        let rig = super::twice(&rig, "cogging").unwrap();
        let of = |key: &str| rig.value(&format!("cogging.{key}")).unwrap();
        for q in [0.1, 0.4] {
            let (s, c) = (9.0_f64 * q + 0.7).sin_cos();
            let turned = of("wavenumber") * q;
            let force = of("sine") * turned.sin() + of("cosine") * turned.cos();
            assert!((force - 30.0 * (0.02 * s - 0.01 * c)).abs() < 1e-12, "{force} N at {q} m");
        }
    }

    #[test]
    fn the_form_that_comes_nearer_is_taken() {
        let data = taken(|_, v| 0.5 * v.signum() + 30.0 * 0.05 * (v / 0.05).asinh());
        let rig = identify::Rig::parse(DRY).unwrap();
        let walk = walk(&rig, &data, &[]);
        let context = context(&walk);
        let carreau = with(&rig, Kind::SublinearDrag, &[30.0, 0.05, 0.9, 1.0]);
        let mut free = carreau.clone();
        free.free.extend(["v_0", "bend"].map(|key| format!("sublinear_drag.{key}")));
        let fitted = walk.board.fit(&free, None, &super::FIRST).unwrap();
        let alone = walk.judged(&fitted.blocks).level();
        let candidate = Candidate { kind: Kind::SublinearDrag, fitted };
        let found = walk.other_forms(&[candidate], &context);
        let [found] = found.as_slice() else { panic!("{} forms beside {alone}", found.len()) };
        let left = walk.judged(&found.fitted.blocks).level();
        assert!(alone > 1.5 && left < 1.2, "{alone} as Carreau's, {left} as Eyring's");
        assert_eq!(found.fitted.rig.value("sublinear_drag.form"), Some(2.0));
        assert!(walk.other_forms(std::slice::from_ref(found), &context).is_empty(), "it is down");
    }

    #[test]
    fn a_form_that_is_surely_nearer_is_taken_though_it_lowers_little() {
        let data = taken(|_, v| 0.5 * v.signum() + 13.0 * 0.05 * (v / 0.05).asinh());
        let walk = walk(&identify::Rig::parse(DRY).unwrap(), &data, &[]);
        let mut carreau = with(&walk.best.rig, Kind::SublinearDrag, &[13.0, 0.05, 0.9, 1.0]);
        carreau.free.extend(["v_0", "bend"].map(|key| format!("sublinear_drag.{key}")));
        let fitted = walk.board.fit(&carreau, None, &super::FIRST).unwrap();
        let candidate =
            Candidate { kind: Kind::SublinearDrag, fitted: walk.ended(fitted).unwrap() };
        let forms = super::forms(candidate.kind, &candidate.fitted.rig);
        let level = |c: &Candidate| walk.judged(&c.fitted.blocks).level();
        let found = walk.best_form(&candidate, &forms).expect("a form");
        assert_eq!(found.fitted.rig.value("sublinear_drag.form"), Some(2.0));
        let share = level(&found) / level(&candidate);
        assert!((super::LOWER..0.98).contains(&share), "{share} of {}", level(&candidate));
        assert!(walk.best_of(&candidate, &forms).is_none(), "what needs more must lower more");
    }

    #[test]
    fn what_its_own_form_misses_is_no_second_effect() {
        let data = taken(|_, v| 0.5 * v.signum() + 30.0 * 0.05 * (v / 0.05).asinh());
        let rig = identify::Rig::parse(DRY).unwrap();
        let mut walk = walk(&rig, &data, &[]);
        let context = context(&walk);
        let mut carreau = with(&rig, Kind::SublinearDrag, &[30.0, 0.05, 0.9, 1.0]);
        carreau.free.extend(["v_0", "bend"].map(|key| format!("sublinear_drag.{key}")));
        walk.best = walk.board.fit(&carreau, None, &super::FIRST).unwrap();
        let second = walk.best.clone();
        let eyring = walk.reformed(&second, &context).unwrap().expect("the other form");
        assert_eq!(eyring.rig.value("sublinear_drag.form"), Some(2.0));
        assert!(walk.judged(&eyring.blocks).level() < 1.2);
        // A second effect that leaves less than the other form does stays.
        walk.best = eyring.clone();
        assert!(walk.reformed(&eyring, &context).unwrap().is_none());
    }

    #[test]
    fn the_nearest_of_each_kind_leads_and_what_is_far_behind_does_not() {
        let data = crate::walk::made::data();
        let walk = walk(&rig(2.0), &data, &[]);
        let context = context(&walk);
        let candidate = |kind, values: &[f64]| {
            let fitted = walk.board.judged(&with(&rig(2.0), kind, values), None).unwrap();
            Candidate { kind, fitted }
        };
        let all = [
            candidate(Kind::CurrentBias, &[0.1]),
            candidate(Kind::QuadraticDrag, &[1e-3]),
            candidate(Kind::CurrentBias, &[0.2]),
            candidate(Kind::CubicSpring, &[30.0]),
        ];
        let level = |c: &Candidate| walk.judged(&c.fitted.blocks).level();
        assert!(level(&all[3]) > super::BEHIND * level(&all[2]), "{}", level(&all[3]));
        let leading = walk.leading(&all, &context);
        let is = |c: &&Candidate, own: usize| std::ptr::eq(*c, &raw const all[own]);
        assert!(leading.len() == 2 && is(&leading[0], 2) && is(&leading[1], 1));
        // At the floor no other form is asked for.
        let all = [candidate(Kind::CurrentBias, &[crate::walk::made::BIAS])];
        assert!(level(&all[0]) < super::ABOVE && walk.leading(&all, &context).is_empty());
    }
}
