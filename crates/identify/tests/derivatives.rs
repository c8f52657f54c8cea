//! The derivatives that a replay gives, against differences of the march itself.

use identify::{
    Hold, Rig,
    fit::binding,
    march::{Drive, Dual, Model, Motion, Start, Tolerance, march, replay},
};

const PLANTS: [(&str, &str, &[&str]); 4] = [
    (
        "drum",
        "inertia = 0.02\nradius = 0.5\nk_1 = 1.0\nk_2 = 1.2\nf_10 = 0.3\nf_20 = 0.2\n\
         motor_constant = 1.1\ngear_ratio = 5.0\noffset = 0.1",
        &["inertia", "radius", "k_1", "k_2", "f_10", "f_20", "motor_constant", "offset"],
    ),
    ("mass-spring", "mass = 0.8\nstiffness = 3.0\noffset = 0.1", &["mass", "stiffness", "offset"]),
    ("axis", "inertia = 1.3\ngain = 1.2\noffset = 0.1", &["inertia", "gain", "offset"]),
    (
        "pendulum",
        "inertia = 0.3\nmass = 0.5\nlength = 0.3\ntorque_constant = 0.8\nresistance = 0.7\n\
         offset = 0.05",
        &["inertia", "mass", "length", "torque_constant", "resistance", "offset"],
    ),
];

const FRICTIONS: [(&str, &str, &[&str]); 7] = [
    ("none", "sigma_2 = 0.4", &["sigma_2"]),
    ("coulomb", "f_c = 0.6\nsigma_2 = 0.1", &["f_c", "sigma_2"]),
    ("dahl", "f_c = 0.6\nsigma = 12.0\ngamma = 1.0\nsigma_2 = 0.1", &["f_c", "sigma", "sigma_2"]),
    ("dahl", "f_c = 0.6\nsigma = 12.0\ngamma = 0.5\nsigma_2 = 0.1", &["f_c", "sigma", "gamma"]),
    ("dahl", "f_c = 0.6\nsigma = 12.0\ngamma = 1.6\nsigma_2 = 0.1", &["f_c", "sigma", "gamma"]),
    (
        "lugre",
        "f_c = 0.6\nf_s = 0.9\nv_s = 0.3\nsigma_0 = 20.0\nsigma_1 = 2.0\nsigma_2 = 0.2",
        &["f_c", "f_s", "v_s", "sigma_0", "sigma_1", "sigma_2"],
    ),
    (
        "maxwell-slip",
        "k = [12.0, 4.0]\ndelta = [0.03, 0.07]\nsigma_2 = 0.1",
        &["k[1]", "k[2]", "delta[1]", "delta[2]", "sigma_2"],
    ),
];

fn rig(plant: (&str, &str), friction: (&str, &str)) -> Rig {
    let (kind, values) = plant;
    let (name, parameters) = friction;
    let channels = match kind {
        "drum" => "current = \"u\"\nangle = \"q\"",
        "mass-spring" => "force = \"u\"\nposition = \"q\"",
        "axis" => "voltage = \"u\"\nposition = \"q\"",
        _ => "voltage = \"u\"\nangle = \"q\"",
    };
    let text = format!(
        "title = \"t\"\n[plant]\nkind = \"{kind}\"\n{values}\n[friction]\nname = \"{name}\"\n{parameters}\n\
         [channels]\ntime = \"t\"\n{channels}\n"
    );
    Rig::parse(&text).expect("a value")
}

/// A drive that lets every friction stick, creep and slide.
fn drive(time: &[f64]) -> Vec<f64> {
    time.iter().map(|t| 1.6 * (2.1 * t).sin() + 0.5 * (5.3 * t).sin()).collect()
}

fn moved(rig: &Rig, name: &str, to: f64, time: &[f64], rtol: f64) -> Motion {
    let mut rig = rig.clone();
    rig.set(name, to).expect("a value");
    let model = binding::model::<f64>(&rig, &|_| None);
    let u = drive(time);
    let start = Start { q: 0.05, v: 0.2, z: vec![0.01; model.contact.states()], shown: None };
    let tolerance = Tolerance { q: rtol, v: rtol, z: rtol, steps: 50_000_000 };
    let drive = Drive::Recorded { values: &u, first: 0, hold: Hold::Linear };
    march(&model, &drive, time, &start, &tolerance).expect("a value")
}

/// The derivatives of q at every sample by one parameter.
fn replayed(rig: &Rig, name: &str, time: &[f64], motion: &Motion) -> Vec<f64> {
    let value = rig.value(name).expect("a value");
    let model: Model<Dual<2>> =
        binding::model(rig, &|key| (key == name).then(|| Dual::variable(value, 0)));
    let u = drive(time);
    let start = Start {
        q: 0.05.into(),
        v: 0.2.into(),
        z: vec![0.01.into(); model.contact.states()],
        shown: None,
    };
    let drive = Drive::Recorded { values: &u, first: 0, hold: Hold::Linear };
    let mut by = Vec::new();
    replay(&model, (&drive, time), &motion.tape, &start, &mut |_, q, _, _| {
        by.push(q.eps[0]);
    });
    by
}

/// What the derivatives may be off by, of the largest: differences over 1e-4 of the parameter err by its square
/// where the motion is smooth, and by 1e-4 to 1e-3 of it where a turn or an element's yield lies between the two
/// motions that are compared, for there the motion has a kink over the parameter.
fn allowed(friction: &str) -> f64 {
    if friction == "none" { 1e-6 } else { 2e-3 }
}

#[test]
fn a_replay_gives_the_derivatives_of_the_motion_by_every_parameter() {
    let time: Vec<f64> = (0..301).map(|i| 0.01 * f64::from(i)).collect();
    let rtol = 1e-8;
    for (kind, values, plant_keys) in PLANTS {
        for (name, parameters, keys) in FRICTIONS {
            let rig = rig((kind, values), (name, parameters));
            for key in plant_keys.iter().chain(keys) {
                let value = rig.value(key).expect("a value");
                let here = moved(&rig, key, value, &time, rtol);
                let by = replayed(&rig, key, &time, &here);
                let step = 1e-4 * value;
                let low = moved(&rig, key, value - step, &time, 0.1 * rtol);
                let high = moved(&rig, key, value + step, &time, 0.1 * rtol);
                let size = by.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                assert!(size > 0.0, "{kind}, {name}: q does not depend on {key}");
                let apart = |i: usize| (high.q[i] - low.q[i]) / (2.0 * step) - by[i];
                let worst = (0..time.len()).map(|i| apart(i).abs()).fold(0.0, f64::max) / size;
                assert!(
                    worst < allowed(name),
                    "{kind}, {name}: dq/d{key} is off by {worst:.1e} of its largest value"
                );
            }
        }
    }
}
