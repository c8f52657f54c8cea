//! The load behind a joint, where it is of another kind than the one with which the joint was looked for.

use super::{Walk, forms::spared};
use crate::model::Candidate;
use identify::{
    Rig,
    effects::{Context, Kind},
    fit::binding,
};

/// The way in which the friction of a load builds up is begun at these shares of the record's.
const WAYS: [f64; 3] = [3e-4, 1e-3, 1e-2];

/// Viscous friction of a load is begun at so much of all friction where it is fastest.
const DRAGS: f64 = 0.01;

/// A load that drags is begun behind plays of this range, of the way the plant goes.
const SLOW: [f64; 2] = [2e-4, 5e-3];

/// That of a load that is hidden behind a play, where its dry friction is less than so much of all.
const SLOWED: f64 = 0.1;
const LITTLE: f64 = 0.05;

/// Teeth are begun with these damping ratios, where they are not what they are as a rule; those of a load that drags as well
/// with this one.
const ZETAS: [f64; 2] = [0.15, 0.5];
const ZETA: f64 = 0.3;

impl Walk<'_> {
    /// A joint with a load of another kind, and with that of another kind again for as long as it comes much nearer so: one
    /// whose friction builds up on a way, that drags, or that bounces.
    pub(super) fn loaded(&self, joint: &Candidate, context: &Context) -> Option<Candidate> {
        let on = |found: &Candidate| self.best_of(found, &loads(found, context));
        let mut found = on(joint)?;
        while let Some(next) = on(&found) {
            found = next;
        }
        Some(found)
    }

    /// The model with a load that drags, hidden behind plays that are not so small that a little of anything else does as
    /// well: what such a load does is not seen before the motor's own friction gives way to it.
    pub(super) fn slow(&self, kind: Kind, context: &Context) -> Vec<(Kind, Rig)> {
        let all = self.tried(&self.best, context).into_iter().filter(|(own, _)| *own == kind);
        let wide = |(kind, rig): &(Kind, Rig)| {
            let about = kind.about();
            let amount = rig.value(&format!("{}.{}", about.name, about.keys[0].name));
            let share = amount.unwrap_or(0.0) / context.size(about.keys[0].measure);
            (SLOW[0]..SLOW[1]).contains(&share)
        };
        let dragging = |(kind, rig): (Kind, Rig)| Some((kind, slowed(kind, &rig, context)?));
        all.filter(wide).filter_map(dragging).collect()
    }
}

/// A joint with each kind of load that it has not yet.
fn loads(joint: &Candidate, context: &Context) -> Vec<Rig> {
    let (kind, rig) = (joint.kind, &joint.fitted.rig);
    let begun = [
        ("gives", WAYS.map(|way| way * context.span).to_vec()),
        ("drags", vec![drag(context)]),
        ("zeta", ZETAS.to_vec()),
    ];
    let with = |(key, values): (&str, Vec<f64>)| {
        let name = unasked(kind, rig, key);
        values.into_iter().filter_map(move |value| Some(spared(rig, &[(name.as_ref()?, value)])))
    };
    let more = [slower(kind, rig, context), bouncing(kind, rig, context)];
    begun.into_iter().flat_map(with).chain(more.into_iter().flatten()).collect()
}

/// Whether the teeth of `rig` are soft, so that they bounce.
pub(super) fn is_soft(kind: Kind, rig: &Rig) -> bool {
    rig.free.contains(&format!("{}.zeta", kind.about().name))
}

/// `rig` with a load of this kind that drags much and bounces off its teeth.
fn bouncing(kind: Kind, rig: &Rig, context: &Context) -> Option<Rig> {
    let zeta = unasked(kind, rig, "zeta")?;
    Some(spared(&slower(kind, rig, context)?, &[(&zeta, ZETA)]))
}

/// `rig` with viscous friction of the load, if an effect of this kind that it has holds one that does not drag yet.
pub(super) fn dragged(kind: Kind, rig: &Rig, context: &Context) -> Option<Rig> {
    let name = unasked(kind, rig, "drags")?;
    Some(spared(rig, &[(&name, drag(context))]))
}

/// `rig` with a play behind which the load is hidden and drags: nothing but its friction brings a load that is not seen to
/// rest on its way through the play.
fn slowed(kind: Kind, rig: &Rig, context: &Context) -> Option<Rig> {
    let name = kind.about().name;
    let value = |key: &str| rig.value(&format!("{name}.{key}")).unwrap_or(0.0);
    let hidden = kind == Kind::Backlash && value("encoder") > 1.5;
    let rubs = value("rubs") > LITTLE * context.force;
    if hidden && !rubs { slower(kind, rig, context) } else { None }
}

/// `rig` with a load of this kind that drags much.
fn slower(kind: Kind, rig: &Rig, context: &Context) -> Option<Rig> {
    let drags = unasked(kind, rig, "drags")?;
    let drag = SLOWED * context.force / context.speed;
    Some(lightened(kind, spared(rig, &[(&drags, drag)])))
}

/// `rig`, if its load drags, with so much less of the motor's own viscous friction: both together drag as it was found.
pub(super) fn lightened(kind: Kind, mut rig: Rig) -> Rig {
    let drags = format!("{}.drags", kind.about().name);
    let drag = rig.value(&drags).filter(|_| rig.free.contains(&drags));
    let left = drag.and_then(|drag| Some(rig.value("sigma_2")? - drag)).filter(|left| *left > 0.0);
    if let Some(left) = left {
        binding::set(&mut rig, "sigma_2", left);
    }
    rig
}

/// The name of a value of an effect's load that `rig` has and that is not free yet.
fn unasked(kind: Kind, rig: &Rig, key: &str) -> Option<String> {
    let about = kind.about();
    let has = rig.effects.iter().any(|effect| effect.name == about.name);
    let name = format!("{}.{key}", about.name);
    let known = has && about.keys.iter().any(|own| own.name == key);
    (known && !rig.free.contains(&name)).then_some(name)
}

/// Viscous friction with which a load's is begun [N·s/m].
fn drag(context: &Context) -> f64 {
    DRAGS * context.force / context.speed
}

/// A model whose load rubs, with so much less of the motor's own friction: both together rub as it was found, and a search
/// that begins with more than that hands none of it over.
pub(super) fn shared(mut rig: Rig, kind: Kind) -> Rig {
    let load = rig.value(&format!("{}.rubs", kind.about().name)).unwrap_or(0.0);
    let left = 1.0 - load / binding::model::<f64>(&rig, &|_| None).contact.level();
    // A motor that rubs less than its load has none to hand over.
    if !(left > 0.0 && left < 1.0) {
        return rig;
    }
    let together = rig.clone();
    for name in &together.free {
        let Some(value) = together.value(name) else { continue };
        match name.as_str() {
            "f_c" | "f_s" => binding::set(&mut rig, name, value - load),
            spring if spring.starts_with("k[") => binding::set(&mut rig, name, left * value),
            _ => {}
        }
    }
    rig
}

#[cfg(test)]
mod tests {
    use super::{SLOW, ZETA, dragged, is_soft, loads, shared};
    use crate::{
        model::Candidate,
        walk::made::{context, rig, walk, with},
    };
    use identify::{
        Hold, Rig,
        effects::{Context, Kind},
        fit::{Data, Seen, binding},
    };
    use nalgebra::Complex;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// As a play has it (`backlash`).
    const SOFT: f64 = 1.0;
    const HEAVY: f64 = 0.6;
    const COMPLIANCE: [f64; 5] = [2.5e-4, 0.25, 0.02, 1e-6, 1.0];
    const DRAG: f64 = 0.5;

    /// A load of 0.4 kg that drags, on 3 N/m, driven by a motor of 1.6 kg with 0.5 N·s/m through a gear of 4 kN/m, damped
    /// by a fiftieth of what is critical: its motion is of two tones; noise of 0.1 mm.
    fn data() -> Data {
        let (motor, load, stiffness) = (1.6, 0.4, 4e3_f64);
        let damping = 2.0 * 0.02 * (stiffness * load).sqrt();
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let tones = [(1.0, 2.0), (0.4, 7.0)];
        let drive = |(size, w): (f64, f64), t: f64| {
            let j = Complex::i() * w;
            let force = (j * j * load + j * DRAG + 3.0) * size;
            let ahead = force / (j * damping + stiffness);
            let input = (j * j * motor + j * 0.5) * (ahead + size) + force;
            (input * Complex::cis(w * t)).im
        };
        let input = time.iter().map(|t| tones.iter().map(|tone| drive(*tone, *t)).sum()).collect();
        let place = |t: f64| tones.iter().map(|(size, w)| size * (w * t).sin()).sum::<f64>();
        let seen = time.iter().map(|t| place(*t) + 1e-4 * noise()).collect();
        Data::driven(time, input, Hold::Smooth, Seen::new("position", seen, 0.0))
    }

    #[test]
    fn a_load_that_drags_is_found_and_is_no_second_effect() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let context = context(&walk);
        let alone = with(&rig(2.0), Kind::Compliance, &COMPLIANCE);
        let fitted = walk.board.fit(&alone, None, &crate::walk::REFIT).unwrap();
        let left = walk.judged(&fitted.blocks).level();
        let joint = Candidate { kind: Kind::Compliance, fitted };
        let found = walk.loaded(&joint, &context).expect("a load");
        let end = walk.judged(&found.fitted.blocks).level();
        let drags = found.fitted.rig.value("compliance.drags").unwrap();
        assert!(left > 2.0 && end < 1.1, "{left} without, {end} with a load that drags");
        assert!((drags - DRAG).abs() < 0.02 * DRAG, "{drags} N·s/m");
        walk.best = joint.fitted.clone();
        let anew = walk.reformed(&joint.fitted, &context).unwrap().expect("the other load");
        assert!(anew.rig.free.iter().any(|free| free == "compliance.drags"));
        // What has it is not asked once more.
        assert!(dragged(Kind::Compliance, &anew.rig, &context).is_none());
        assert!(dragged(Kind::Backlash, &anew.rig, &context).is_none());
    }

    #[test]
    fn each_kind_of_load_is_asked_for_once() {
        let data = crate::walk::made::data();
        let walk = walk(&rig(2.0), &data, &[]);
        let context = context(&walk);
        let many = |kind: Kind, values: &[f64], free: &[&str]| {
            let mut rig = with(&rig(2.0), kind, values);
            rig.free.extend(free.iter().map(|key| format!("{}.{key}", kind.about().name)));
            let fitted = walk.board.judged(&rig, None).unwrap();
            loads(&Candidate { kind, fitted }, &context).len()
        };
        let play = [1e-3, 0.2, 1e-6, 1e-3, 1.0];
        // Three ways, two drags, two damping ratios of the teeth, and both; a gear that gives way has no teeth.
        assert_eq!(many(Kind::Backlash, &play, &[]), 8);
        assert_eq!(many(Kind::Backlash, &play, &["zeta"]), 5);
        assert_eq!(many(Kind::Backlash, &play, &["zeta", "gives", "drags"]), 0);
        assert_eq!(many(Kind::Compliance, &COMPLIANCE, &[]), 5);
    }

    #[test]
    fn a_play_is_begun_with_soft_teeth_and_a_heavy_load_as_well() {
        let data = crate::walk::made::data();
        let walk = walk(&rig(2.0), &data, &[]);
        let context = context(&walk);
        let all = walk.tried(&walk.best, &context);
        let soft: Vec<&Rig> =
            all.iter().filter(|(kind, rig)| is_soft(*kind, rig)).map(|(_, rig)| rig).collect();
        let amounts = Kind::Backlash.tried().len();
        assert_eq!(soft.len(), amounts, "each amount once, for one place of the encoder");
        for rig in soft {
            let value = |key: &str| rig.value(&format!("backlash.{key}")).unwrap();
            assert_eq!((value("ratio"), value("zeta")), (HEAVY, ZETA));
            assert!((value("teeth") - SOFT * context.sample_time).abs() < 1e-12);
            // Both together drag as it was found.
            assert!((value("drags") + rig.value("sigma_2").unwrap() - 0.5).abs() < 1e-12);
        }
        // And once more where the load may be hidden.
        let soft = |kind: Kind, context: &Context| {
            let probes = (kind.about().probes)(context).into_iter();
            probes.filter(|own| own[2] == SOFT * context.sample_time).collect::<Vec<_>>()
        };
        assert_eq!(soft(Kind::Compliance, &context), Vec::<Vec<f64>>::new());
        let hidden = Context { hidden: true, force: 10.0, ..context };
        let both = soft(Kind::Backlash, &hidden);
        assert_eq!(
            both.iter().map(|own| (own[1], own[3])).collect::<Vec<_>>(),
            [(0.1, 1.0), (0.1, 2.0)]
        );
    }

    #[test]
    fn behind_a_play_a_hidden_load_is_begun_dragging() {
        let data = crate::walk::made::data();
        let walk = walk(&rig(2.0), &data, &[]);
        let seen = context(&walk);
        assert!(walk.slow(Kind::Backlash, &seen).is_empty(), "a load that is seen");
        // A drag that is a share of the motor's own.
        let hidden = Context { hidden: true, force: 2.0 * seen.speed, ..seen };
        let all = walk.slow(Kind::Backlash, &hidden);
        assert!(!all.is_empty() && walk.slow(Kind::Compliance, &hidden).is_empty());
        for (_, rig) in &all {
            let value = |name: &str| rig.value(name).unwrap();
            assert!((value("backlash.drags") + value("sigma_2") - 0.5).abs() < 1e-12);
            assert!(rig.free.iter().any(|free| free == "backlash.drags"));
            let share = value("backlash.gap") / hidden.span;
            assert!(value("backlash.encoder") > 1.5 && (SLOW[0]..SLOW[1]).contains(&share));
        }
    }

    #[test]
    fn what_the_load_rubs_the_motor_does_not() {
        let of = |friction: &str, free: &str, rubs: f64| {
            let text = format!(
                "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n[friction]\n\
                 {friction}\nsigma_2 = 0.5\n[fit]\nfree = [{free}]\n[channels]\ntime = \"t\"\nforce = \"f\"\n\
                 position = \"x\"\n"
            );
            let play = [1e-3, 0.2, rubs, 1e-3];
            let rig = with(&Rig::parse(&text).unwrap(), Kind::Backlash, &play);
            shared(rig, Kind::Backlash)
        };
        let near = |rig: &Rig, name: &str, value: f64| {
            let found = rig.value(name).unwrap();
            assert!((found - value).abs() < 1e-12, "{name} of {found}, expected {value}");
        };
        let lugre =
            "name = \"lugre\"\nf_c = 1.5\nf_s = 2.0\nv_s = 0.01\nsigma_0 = 1e3\nsigma_1 = 1.0";
        let rig = of(lugre, "\"f_c\", \"f_s\"", 0.3);
        near(&rig, "f_c", 1.2);
        near(&rig, "f_s", 1.7);
        // Equal, they stay so.
        let rig = of(&lugre.replace("2.0", "1.5"), "\"f_c\", \"f_s\"", 0.3);
        near(&rig, "f_c", 1.2);
        near(&rig, "f_s", 1.2);
        let springs = "name = \"maxwell-slip\"\nk = [1e3, 5e2]\ndelta = [1e-3, 2e-3]";
        let rig = of(springs, "\"k[1]\", \"k[2]\"", 0.5);
        near(&rig, "k[1]", 750.0);
        let level = binding::model::<f64>(&rig, &|_| None).contact.level();
        assert!((level + 0.5 - 2.0).abs() < 1e-12, "{level} N");
        // A little is handed over, too.
        let coulomb = "name = \"coulomb\"\nf_c = 1.5";
        near(&of(coulomb, "\"f_c\"", 0.03), "f_c", 1.47);
        // What is not free, and what is all of it, stays.
        near(&of(coulomb, "\"sigma_2\"", 0.3), "f_c", 1.5);
        near(&of(coulomb, "\"f_c\"", 1.6), "f_c", 1.5);
        near(&of("name = \"none\"", "\"sigma_2\"", 0.3), "sigma_2", 0.5);
    }
}
