//! Six parameters of LuGre from a record of the paper's rig.
use identify::{
    Channel, Friction, Hold, Rig, Shaft,
    fit::{Data, Seen},
    march::{Drive, Start, Tolerance, march},
};
use rand::{RngExt, SeedableRng};
use std::collections::BTreeMap;

fn rig() -> Rig {
    let plant = [
        ("inertia", 3e-4),
        ("radius", 0.0254),
        ("k_1", 2.0),
        ("k_2", 2.0),
        ("f_10", 0.01),
        ("f_20", 0.01),
        ("motor_constant", 16.5),
        ("gear_ratio", 68.8),
    ];
    let lugre = [
        ("f_c", 0.6),
        ("f_s", 1.0),
        ("v_s", 1e-3),
        ("sigma_0", 1e3),
        ("sigma_1", 1000f64.sqrt()),
        ("sigma_2", 1.3),
    ];
    Rig {
        title: String::new(),
        kind: "drum",
        plant: plant.iter().map(|(k, v)| ((*k).to_owned(), *v)).collect(),
        friction: Friction {
            name: "lugre".into(),
            parameters: lugre.iter().map(|(k, v)| (*k, *v)).collect(),
            sigma_2: 0.0,
        },
        free: vec![],
        channels: BTreeMap::from([(
            "current".to_owned(),
            Channel {
                column: "i".into(),
                unit: None,
                quantum: None,
                at: Shaft::Drum,
                hold: Hold::Linear,
            },
        )]),
        controller: None,
        effects: vec![],
    }
}

#[test]
fn p6() {
    let rig = rig();
    let time: Vec<f64> = (0..5001).map(|i| f64::from(i) * 0.01).collect();
    let input: Vec<f64> =
        time.iter().map(|t| 0.05 * (0.2 * std::f64::consts::PI * t).sin()).collect();
    let model = identify::fit::binding::model::<f64>(&rig, &|_| None);
    let truth = march(
        &model,
        &Drive::Recorded { values: &input, hold: Hold::Linear },
        &time,
        &Start { q: 0.0, v: 0.0, z: vec![0.0] },
        &Tolerance { q: 1e-8, v: 1e-8, z: 1e-7, steps: 10_000_000 },
    )
    .unwrap();
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
    let mut noise = |values: &[f64]| {
        let s = 0.01 * values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        values
            .iter()
            .map(|v| {
                let (a, b): (f64, f64) = (rng.random(), rng.random());
                v + s * (-2.0 * (1.0 - a).ln()).sqrt() * (std::f64::consts::TAU * b).cos()
            })
            .collect::<Vec<f64>>()
    };
    let q = Seen::new("angle", noise(&truth.q), 0.0);
    let v = Seen::new("velocity", noise(&truth.v), 0.0);
    println!("noise {} {}", q.noise, v.noise);
    let data = Data {
        time,
        input,
        hold: Hold::Linear,
        velocity: Some(v.clone()),
        displacement: Some(q.clone()),
        force: None,
        loads: None,
        reference: vec![],
        added: vec![],
    };
    let mut rig = rig;
    rig.free = ["f_c", "f_s", "v_s", "sigma_0", "sigma_1", "sigma_2"].map(str::to_owned).to_vec();
    for factor in [1.0, 1.3] {
        let mut nominal = rig.clone();
        for name in &rig.free {
            let given = identify::fit::binding::value(&rig, name).unwrap();
            identify::fit::binding::set(&mut nominal, name, given * factor);
        }
        let t = std::time::Instant::now();
        let fit = identify::fit::fit(
            &nominal,
            &data,
            &identify::fit::Options { models: factor == 1.0, ..Default::default() },
        )
        .unwrap();
        println!(
            "{:?} {:?} {} {:?} {:?} s2 {} nb {} step {}",
            t.elapsed(),
            fit.way,
            fit.windows,
            fit.end,
            fit.simulations,
            fit.variance,
            fit.neighbours,
            fit.step_error
        );
        for p in &fit.parameters {
            println!(
                "{:8} {:.5} -> {:.5} +- {:.5} {:?} boot {:?}",
                p.name, p.given, p.found, p.standard_error, p.interval, p.bootstrap
            );
        }
        for g in &fit.gap {
            println!("{g:?}");
        }
        for m in &fit.models {
            println!("{} {} {} {}", m.name, m.free, m.trained_error, m.held_out_error);
        }
    }
}
