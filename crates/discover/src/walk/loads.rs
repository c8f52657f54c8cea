//! The load behind a joint, where it is of another kind than the one with which the joint was looked for.

use super::{Walk, forms::spared};
use crate::model::Candidate;
use identify::{
    Rig,
    effects::{Context, Kind},
};

/// The way in which the friction of a load builds up is begun at these shares of the record's.
const WAYS: [f64; 3] = [3e-4, 1e-3, 1e-2];

/// Viscous friction of a load is begun at so much of all friction where it is fastest.
const DRAGS: f64 = 0.01;

/// Teeth are begun with these damping ratios, where they are not what they are as a rule.
const ZETAS: [f64; 2] = [0.15, 0.5];

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
    begun.into_iter().flat_map(with).collect()
}

/// `rig` with viscous friction of the load, if an effect of this kind that it has holds one that does not drag yet.
pub(super) fn dragged(kind: Kind, rig: &Rig, context: &Context) -> Option<Rig> {
    let name = unasked(kind, rig, "drags")?;
    Some(spared(rig, &[(&name, drag(context))]))
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

#[cfg(test)]
mod tests {
    use super::{dragged, loads};
    use crate::{
        model::Candidate,
        walk::made::{context, rig, walk, with},
    };
    use identify::{
        Hold,
        effects::Kind,
        fit::{Data, Seen},
    };
    use nalgebra::Complex;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

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
        // Three ways, a drag, two damping ratios of the teeth; a gear that gives way has none.
        assert_eq!(many(Kind::Backlash, &play, &[]), 6);
        assert_eq!(many(Kind::Backlash, &play, &["zeta"]), 4);
        assert_eq!(many(Kind::Backlash, &play, &["zeta", "gives", "drags"]), 0);
        assert_eq!(many(Kind::Compliance, &COMPLIANCE, &[]), 4);
    }
}
