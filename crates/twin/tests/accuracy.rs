//! The error of the records themselves.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

#[allow(dead_code, reason = "each test file uses some of it")]
mod common;

use common::{clean, made, sensors};
use twin::{Hidden, SCENARIOS, Scenario, make_hidden, scenario};

struct Nothing;

impl Hidden for Nothing {}

/// Friction models with values that suit a force of about 1 N.
const FRICTION: [&str; 6] = [
    "name = 'none'\nsigma_2 = 0.5",
    "name = 'coulomb'\nf_c = 0.4\nsigma_2 = 0.5",
    "name = 'dahl'\nf_c = 0.4\nsigma = 60.0\ngamma = 0.5\nsigma_2 = 0.5",
    "name = 'dahl'\nf_c = 0.4\nsigma = 60.0\ngamma = 1.0",
    "name = 'lugre'\nf_c = 0.4\nf_s = 0.6\nv_s = 0.002\nsigma_0 = 1e3\nsigma_1 = 20.0\nsigma_2 = 0.5",
    "name = 'maxwell-slip'\nk = [20.0, 40.0, 60.0]\ndelta = [1e-3, 3e-3, 4e-3]\nsigma_2 = 0.5",
];

/// Plants with the quantity that moves, and its unit.
const PLANTS: [(&str, &str, f64); 5] = [
    (
        "kind = 'drum'\ninertia = 3e-4\nradius = 0.0254\nk_1 = 2.0\nk_2 = 2.0\nf_10 = 0.01\nf_20 = 0.01\n\
         motor_constant = 1.0\ngear_ratio = 68.8",
        "angle",
        1.0,
    ),
    ("kind = 'mass-spring'\nmass = 0.5\nstiffness = 3.0", "position", 1.0),
    ("kind = 'axis'\ninertia = 0.5", "position", 1.0),
    (
        "kind = 'pendulum'\ninertia = 0.02\nmass = 0.3\nlength = 0.15\ntorque_constant = 0.3\nresistance = 0.3",
        "angle",
        1.0,
    ),
    ("kind = 'prescribed'", "force", 0.02),
];

/// How far a record moves when its local errors are a hundredth: the worst column, as a share of what it resolves
/// where sensors are not perfect, of its largest value where they are.
fn moves(scenario: &Scenario) -> f64 {
    let usual = make_hidden(scenario, 1, &Nothing, 1.0).unwrap();
    let finer = make_hidden(scenario, 1, &Nothing, 0.01).unwrap();
    let mut worst = 0.0_f64;
    for ((sensor, (_, a)), (_, b)) in
        scenario.sensors.iter().zip(&usual.clean[1..]).zip(&finer.clean[1..])
    {
        let largest = a.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let resolved = sensor.noise.max(sensor.quantum);
        let resolved = if resolved > 0.0 { resolved } else { largest };
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        worst = worst.max(off / resolved);
    }
    worst
}

#[test]
fn a_named_record_changes_by_less_than_a_hundredth_of_its_noise_when_its_steps_are_refined() {
    for (name, _) in SCENARIOS {
        let moves = moves(&scenario(name).unwrap());
        assert!(moves < 0.01, "{name}: {moves:.1e} of its noise");
    }
}

#[test]
fn every_friction_on_every_plant_is_followed_to_a_ten_millionth_under_sines_and_held_steps() {
    for (plant, quantity, size) in PLANTS {
        for friction in FRICTION {
            for hold in ["", "hold = 0.02"] {
                if plant.contains("prescribed") && !hold.is_empty() {
                    continue;
                }
                let text = format!(
                    "title = 't'\nduration = 10.0\nrate = 100.0\n[plant]\n{plant}\n[friction]\n{friction}\n[input]\n\
                     {hold}\n[[input.part]]\nshape = 'sine'\namplitude = {size:?}\nomega = 3.0\n[[input.part]]\n\
                     shape = 'triangle'\namplitude = {:?}\nperiod = 0.77\n{}",
                    0.2 * size,
                    sensors(&[quantity])
                );
                let moves = moves(&Scenario::parse(&text).unwrap());
                assert!(moves < 1e-7, "{plant}\n{friction}\n{hold}\nmoves by {moves:.1e}");
            }
        }
    }
}

#[test]
fn a_hidden_force_against_the_displacement_is_a_stiffer_spring() {
    struct Spring;
    impl Hidden for Spring {
        fn drive(&self, _t: f64, q: f64, _v: f64) -> f64 {
            -0.7 * q
        }
    }
    for friction in FRICTION {
        let text = |stiffness: f64| {
            format!(
                "title = 't'\nduration = 10.0\nrate = 100.0\n[plant]\nkind = 'mass-spring'\nmass = 0.5\n\
                 stiffness = {stiffness:?}\n[friction]\n{friction}\n[[input.part]]\nshape = 'sine'\namplitude = 1.0\n\
                 omega = 3.0\n{}",
                sensors(&["position"])
            )
        };
        let hidden = make_hidden(&Scenario::parse(&text(2.3)).unwrap(), 1, &Spring, 1.0).unwrap();
        let stiffer = made(&text(3.0));
        let pairs = clean(&hidden, "position").iter().zip(clean(&stiffer, "position"));
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-7, "{friction}: off by {worst:.1e} m");
    }
}
