//! What sensors do, and that a seed makes one record.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

#[allow(dead_code, reason = "each test file uses some of it")]
mod common;

use common::clean;
use twin::{Made, SCENARIOS, Scenario, make, scenario};

fn column<'a>(made: &'a Made, name: &str) -> &'a [f64] {
    &made.columns.iter().find(|(known, _)| known == name).unwrap().1
}

fn gearbox() -> Scenario {
    scenario("gearbox").unwrap()
}

#[test]
fn the_same_seed_makes_the_same_record_bit_for_bit_and_another_seed_another() {
    for (name, _) in SCENARIOS {
        let scenario = scenario(name).unwrap();
        let (a, b, c) = (make(&scenario, 7), make(&scenario, 7), make(&scenario, 8));
        assert_eq!(a, b, "{name}");
        assert_ne!(a.unwrap().columns, c.unwrap().columns, "{name}");
    }
}

#[test]
fn an_encoder_shows_whole_steps_only_and_is_off_by_half_a_step_at_most() {
    let mut scenario = gearbox();
    scenario.sensors[1].noise = 0.0;
    let made = make(&scenario, 3).unwrap();
    for (shown, true_angle) in column(&made, "angle_rad").iter().zip(clean(&made, "angle_rad")) {
        let steps = shown / 1e-4;
        assert!((steps - steps.round()).abs() < 1e-9, "{steps} steps");
        assert!((shown - true_angle).abs() < 0.500_001e-4, "{shown} rad for {true_angle} rad");
    }
}

#[test]
fn the_noise_of_a_sensor_has_its_standard_deviation_and_no_memory() {
    let mut scenario = gearbox();
    scenario.sensors[3].quantum = 0.0;
    let made = make(&scenario, 11).unwrap();
    let pairs = column(&made, "force1_n").iter().zip(clean(&made, "force1_n"));
    let noise: Vec<f64> = pairs.map(|(shown, truth)| (shown - truth) / 2e-4).collect();
    let n = noise.len() as f64;
    let mean = noise.iter().sum::<f64>() / n;
    let variance = noise.iter().map(|e| e * e).sum::<f64>() / n;
    let next = noise.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / n;
    // Four standard errors of each.
    assert!(mean.abs() < 4.0 / n.sqrt(), "mean {mean} of its standard deviation");
    assert!(
        (variance - 1.0).abs() < 4.0 * (2.0 / n).sqrt(),
        "variance {variance} of the declared one"
    );
    assert!(next.abs() < 4.0 / n.sqrt(), "correlation {next} with the next sample");
}

#[test]
fn gain_and_bias_are_those_declared_in_the_sensors_own_unit() {
    let mut scenario = gearbox();
    let sensor = &mut scenario.sensors[2];
    (sensor.gain, sensor.bias, sensor.noise, sensor.quantum) = (1.03, 2.5, 0.0, 0.0);
    let made = make(&scenario, 1).unwrap();
    let name = "motor_velocity_rpm";
    for (shown, truth) in column(&made, name).iter().zip(clean(&made, name)) {
        assert!((shown - (1.03 * truth + 2.5)).abs() < 1e-12, "{shown} rpm for {truth} rpm");
    }
}

#[test]
fn taking_a_sensor_away_changes_no_other() {
    let mut scenario = gearbox();
    let all = make(&scenario, 5).unwrap();
    scenario.sensors.remove(1);
    let fewer = make(&scenario, 5).unwrap();
    for (name, values) in &fewer.columns {
        assert_eq!(column(&all, name), values.as_slice(), "{name}");
    }
}

#[test]
fn the_record_has_a_sample_at_its_end_and_stamps_that_are_multiples_of_the_sample_time() {
    let made = make(&gearbox(), 1).unwrap();
    let t = column(&made, "time_s");
    assert_eq!((t.len(), t[0], t[5000], t[123]), (5001, 0.0, 50.0, 1.23));
}
