//! Friction that grows with what a gear carries, of which the motor may count more than the load.

use super::forms::spared;
use identify::{
    Rig,
    effects::{Context, Kind},
    fit::binding,
};

/// What a gear's motor counts beside what pulls at its load is begun at these shares [1].
const MOTORS: [f64; 2] = [0.3, 3.0];

/// `rig` with friction that grows with what its gear carries, in each of these forms and with the motor's part of it free;
/// none without such friction, or where nothing but the motor loads it.
pub(super) fn geared(kind: Kind, rig: &Rig, context: &Context) -> Vec<Rig> {
    let name = kind.about().name;
    let [form, motor] = ["form", "motor"].map(|key| format!("{name}.{key}"));
    if !context.loaded || rig.value(&motor).is_none() || rig.free.contains(&motor) {
        return Vec::new();
    }
    let ways = if context.memory > 0.0 { &[7.0, 8.0, 9.0][..] } else { &[7.0] };
    let begun = |way: &f64| {
        let mut with = rig.clone();
        binding::set(&mut with, &form, *way);
        MOTORS.map(|own| spared(&with, &[(motor.as_str(), own)]))
    };
    ways.iter().flat_map(begun).collect()
}

#[cfg(test)]
mod tests {
    use super::geared;
    use crate::{
        model::Candidate,
        walk::{
            FIRST,
            made::{DRY, context, taken, walk, with},
        },
    };
    use identify::{
        Rig,
        effects::{Context, Kind},
    };

    #[test]
    fn of_what_a_gear_carries_the_motor_may_count_more_than_the_load() {
        // 0.5 N and 0.3 |3 u + 3 N/m q|/4 of friction, which is part of the drive u itself.
        let rubs = |q: f64, v: f64| {
            let (nominal, way) = (-5.0 * q + 0.5 * v, v.signum());
            let of = |sign: f64| {
                let by = 0.3 * sign / 4.0;
                let force = way * (0.5 + by * 3.0 * (nominal + q)) / (1.0 - way * by * 3.0);
                (force, sign * 3.0 * (nominal + force + q))
            };
            let (force, load) = of(1.0);
            if load >= 0.0 { force } else { of(-1.0).0 }
        };
        let data = taken(rubs);
        let rig = Rig::parse(DRY).unwrap();
        let walk = walk(&rig, &data, &[]);
        let context = context(&walk);
        let alike = with(&rig, Kind::LoadFriction, &[0.3, 7.0]);
        let fitted = walk.board.fit(&alike, None, &FIRST).unwrap();
        let alone = walk.judged(&fitted.blocks).level();
        let candidate = Candidate { kind: Kind::LoadFriction, fitted };
        let variants = geared(candidate.kind, &candidate.fitted.rig, &context);
        let found = walk.best_of(&candidate, &variants).expect("it is nearer");
        let end = walk.ended(found.fitted).unwrap();
        let left = walk.judged(&end.blocks).level();
        assert!(left < 0.3 * alone, "{alone} alike, {left} with the motor's part");
        let of = |key: &str| end.rig.value(&format!("load_friction.{key}")).unwrap();
        assert!(
            (of("ratio") - 0.3).abs() < 0.01 && (of("motor") - 3.0).abs() < 0.3,
            "{}, {}",
            of("ratio"),
            of("motor")
        );
        let loose = Context { loaded: false, ..context };
        assert!(geared(Kind::LoadFriction, &alike, &loose).is_empty(), "nothing pulls");
    }
}
