//! The plants: each equation by hand, the rig as a mass on a spring, and what cannot be built.

use duhem::{PLANTS, Parameters, Plant, Rig, plant::output_at_rest};

fn near(found: f64, by_hand: f64) {
    let error = (found - by_hand).abs();
    assert!(
        error <= 8.0 * f64::EPSILON * by_hand.abs(),
        "{found}, by hand {by_hand}: off by {error:e}"
    );
}

#[test]
fn a_mass_on_a_spring_by_hand() {
    let plant = Plant { mass: 2.0, stiffness: 3.0, gain: 4.0, offset: 0.5 };
    assert_eq!(plant.drive(0.25), 1.5);
    assert_eq!(plant.acceleration(0.1, 1.5, 0.2), (1.5 - 0.2 - 0.3) / 2.0);
    assert_eq!(plant.transfer(0.5), 1.0 / 3.5);
    near(plant.rest(1.5, -0.75), 0.75);
    near(output_at_rest(0.5, 3.0, 1.0), 1.0);
}

#[test]
fn at_rest_nothing_accelerates_whatever_the_friction_is() {
    let plant = Plant::mass_spring(1.0, 1.5);
    for friction in [-0.75, -0.1, 0.0, 0.3, 0.75] {
        let q = plant.rest(2.0, friction);
        let acceleration = plant.acceleration(q, 2.0, friction);
        assert!(acceleration.abs() < 1e-15, "{acceleration:e} m/s² at F = {friction} N");
        near(plant.holding(q, 2.0) + 1.0, friction + 1.0);
    }
}

#[test]
fn the_rigs_torques_by_hand() {
    let rig = Rig { k_2: 3.0, f_10: 0.04, ..Rig::PAPER };
    let (f_1, f_2) = rig.spring_forces(0.5);
    near(f_1, 0.04 + 2.0 * 0.0127);
    near(f_2, 0.01 - 3.0 * 0.0127);
    near(rig.motor_torque(0.05), 0.825);
    near(rig.net_torque(0.5, 0.825, 0.6), 0.225 + (0.01 - 0.0381 - 0.04 - 0.0254) * 0.0254);
}

#[test]
fn the_rig_is_a_mass_on_a_spring() {
    let rigs = [Rig::PAPER, Rig { k_1: 1.5, f_10: 0.03, f_20: 0.012, ..Rig::PAPER }];
    for rig in rigs {
        let plant = rig.plant();
        for (theta, current, friction) in
            [(0.0, 0.05, 0.6_f64), (0.3, -0.02, -0.4), (-1.2, 0.0, 0.0)]
        {
            let (motor, drive) = (rig.motor_torque(current), plant.drive(current));
            let size = motor.abs() + friction.abs() + 0.01;
            let sums = [
                rig.net_torque(theta, motor, friction),
                plant.mass * plant.acceleration(theta, drive, friction),
                rig.inertia * rig.acceleration(theta, motor, friction),
            ];
            let expected = rig.net_torque_of_springs(theta, motor, friction);
            for sum in sums {
                assert!((sum - expected).abs() < 1e-15 * size, "{sum} N·m, not {expected} N·m");
            }
        }
    }
}

#[test]
fn a_spring_goes_slack_where_its_force_is_zero_and_no_sooner() {
    let rigs = [Rig::PAPER, Rig { f_10: 0.004, ..Rig::PAPER }, Rig { k_2: 7.0, ..Rig::PAPER }];
    for rig in rigs {
        let slack = rig.slack_angle();
        let least = |theta: f64| {
            let ((a, b), (c, d)) = (rig.spring_forces(theta), rig.spring_forces(-theta));
            a.min(b).min(c).min(d)
        };
        assert!(least(slack).abs() < 1e-16, "{} N at {slack} rad", least(slack));
        assert!(least(0.99 * slack) > 0.0 && least(1.01 * slack) < 0.0);
    }
    near(Rig::PAPER.slack_angle(), 0.01 / (2.0 * 0.0254));
}

#[test]
fn every_plant_names_a_wrong_parameter() {
    for entry in PLANTS {
        assert_eq!(entry.keys.len(), entry.units.len(), "{}", entry.name);
        let good: Parameters = entry.keys.iter().map(|key| (*key, 2.0)).collect();
        assert!((entry.build)(&good).is_ok(), "{}", entry.name);
        for key in entry.keys {
            let mut missing = good.clone();
            missing.0.remove(*key);
            assert_eq!((entry.build)(&missing).unwrap_err().key(), *key);
            let mut negative = good.clone();
            negative.0.insert((*key).to_owned(), (-1.0).into());
            assert_eq!((entry.build)(&negative).unwrap_err().key(), *key);
        }
        let mut more = good.clone();
        more.0.insert("length".to_owned(), 1.0.into());
        assert_eq!((entry.build)(&more).unwrap_err().key(), "length");
    }
}

#[test]
fn the_papers_rig_is_built_from_its_keys() {
    let values = [3e-4, 0.0254, 2.0, 2.0, 0.01, 0.01, 16.5, 68.8];
    let drum = PLANTS.iter().find(|entry| entry.name == "drum").unwrap();
    let parameters: Parameters = drum.keys.iter().copied().zip(values).collect();
    assert_eq!((drum.build)(&parameters).unwrap(), Rig::PAPER.plant());
}
