//! The regression on records of known truth.

use identify::regression::{
    LINEAR, Linear, Options, RegressionError, Samples, regress, relative_error,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// 20 s at 1 kHz of two sines: it reverses at many speeds.
struct Record {
    time: Vec<f64>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

fn record() -> Record {
    let time: Vec<f64> = (0..20_000).map(|i| 1e-3 * f64::from(i)).collect();
    let waves = [(0.8, 0.7 * TAU), (0.5, 0.31 * TAU)];
    let sum = |of: &dyn Fn(f64, f64, f64) -> f64| -> Vec<f64> {
        time.iter().map(|t| waves.iter().map(|(a, w)| of(*a, *w, *t)).sum()).collect()
    };
    let position = sum(&|a, w, t| a * (w * t).sin());
    let velocity = sum(&|a, w, t| a * w * (w * t).cos());
    let acceleration = sum(&|a, w, t| -a * w * w * (w * t).sin());
    Record { time, position, velocity, acceleration }
}

/// The force of the terms times these values.
fn force(record: &Record, options: &Options, values: &[f64]) -> Vec<f64> {
    let terms = options.plant.terms(options.by_direction);
    let at = |i: usize| {
        let (q, v, a) = (record.position[i], record.velocity[i], record.acceleration[i]);
        let sum: f64 =
            terms.iter().zip(values).map(|(t, value)| value * t.column.at(q, v, a)).sum();
        sum + options.known_damping * v
    };
    (0..record.time.len()).map(at).collect()
}

fn axis() -> Options {
    Options::new(Linear::of("axis").expect("a plant of the list"))
}

fn samples<'a>(record: &'a Record, force: &'a [f64]) -> Samples<'a> {
    Samples { time: &record.time, position: &record.position, force }
}

#[test]
fn every_plant_of_the_list_is_found_again_from_a_clean_record() {
    let record = record();
    for plant in LINEAR {
        for by_direction in [false, true] {
            let options = Options { by_direction, known_damping: 0.4, ..Options::new(plant) };
            let count = plant.terms(by_direction).len();
            let truth: Vec<f64> = (0..count).map(|j| 2.0 - 0.7 * j as f64).collect();
            let force = force(&record, &options, &truth);
            let fit = regress(&samples(&record, &force), &options).expect(plant.kind);
            for (c, truth) in fit.coefficients.iter().zip(&truth) {
                // The position's filter takes 3e-18 of 0.7 Hz, two central differences 3e-6.
                let off = (c.value - truth).abs();
                assert!(off < 1e-4, "{} {}: {} for {truth}", plant.kind, c.term.name, c.value);
            }
        }
    }
}

#[test]
fn the_offset_does_not_shrink_with_the_decimation() {
    let record = record();
    let force = force(&record, &axis(), &[3.0, 1.0, 0.5, -2.0]);
    for decimation in [1, 2, 10, 40] {
        let options = Options { decimation, ..axis() };
        let fit = regress(&samples(&record, &force), &options).expect("a fit");
        let offset = fit.coefficients[3].value;
        assert!((offset + 2.0).abs() < 1e-4, "{offset} N with every {decimation}th");
    }
}

/// A uniform deviate of variance 1.
fn deviate(rng: &mut ChaCha8Rng) -> f64 {
    12.0_f64.sqrt() * (rng.random::<f64>() - 0.5)
}

#[test]
fn intervals_that_allow_for_slow_noise_cover_the_truth_and_the_classical_ones_do_not() {
    let (record, truth) = (record(), [3.0, 1.0, 0.5, -2.0]);
    let clean = force(&record, &axis(), &truth);
    // Rows are 10 ms apart: the noise of one has e^(−1/3) = 0.72 of it left in the next.
    let (runs, keep) = (300_u32, (-1.0_f64 / 30.0).exp());
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let (mut covered, mut classical) = (0_u32, 0_u32);
    for _ in 0..runs {
        let mut noise = 0.0;
        let mut noisy = |f: &f64| {
            noise = keep * noise + (1.0 - keep * keep).sqrt() * deviate(&mut rng);
            f + noise
        };
        let force: Vec<f64> = clean.iter().map(&mut noisy).collect();
        let fit = regress(&samples(&record, &force), &axis()).expect("a fit");
        for (c, truth) in fit.coefficients.iter().zip(truth) {
            let off = (c.value - truth).abs();
            covered += u32::from(off < 1.96 * c.standard_error);
            classical += u32::from(off < 1.96 * c.classical_error);
        }
    }
    let share = |count: u32| f64::from(count) / f64::from(4 * runs);
    let (covered, classical) = (share(covered), share(classical));
    assert!((0.92..0.97).contains(&covered), "{covered} of 1200 intervals of 95 % hold the truth");
    assert!(classical < 0.75, "{classical} of the classical ones");
}

#[test]
fn without_slow_noise_both_errors_agree() {
    let (record, mut rng) = (record(), ChaCha8Rng::seed_from_u64(6));
    let clean = force(&record, &axis(), &[3.0, 1.0, 0.5, -2.0]);
    let force: Vec<f64> = clean.iter().map(|f| f + deviate(&mut rng)).collect();
    // Every sample is a row: decimation itself makes neighbours hang together.
    let fit =
        regress(&samples(&record, &force), &Options { decimation: 1, ..axis() }).expect("a fit");
    for c in &fit.coefficients {
        let ratio = c.standard_error / c.classical_error;
        assert!((0.9..1.1).contains(&ratio), "{}: {ratio}", c.term.name);
    }
}

#[test]
fn the_error_of_the_fitted_values_is_that_of_the_fit_and_the_smallest_there_is() {
    let (record, mut rng) = (record(), ChaCha8Rng::seed_from_u64(7));
    let clean = force(&record, &axis(), &[3.0, 1.0, 0.5, -2.0]);
    let force: Vec<f64> = clean.iter().map(|f| f + deviate(&mut rng)).collect();
    let samples = samples(&record, &force);
    let fit = regress(&samples, &axis()).expect("a fit");
    let mut values: Vec<f64> = fit.coefficients.iter().map(|c| c.value).collect();
    let of = |values: &[f64]| relative_error(&samples, &axis(), values).expect("an error");
    assert!((of(&values) - fit.relative_error).abs() < 1e-9, "{} %", of(&values));
    for j in 0..4 {
        for by in [1e-3, -1e-3] {
            values[j] += by;
            assert!(of(&values) > fit.relative_error, "{} % is less", of(&values));
            values[j] -= by;
        }
    }
}

#[test]
fn a_record_that_never_turns_cannot_tell_coulomb_friction_from_an_offset() {
    let record = record();
    let position: Vec<f64> = record.time.iter().map(|t| 0.1 * t + 0.01 * t * t).collect();
    let force = vec![1.0; position.len()];
    let samples = Samples { time: &record.time, position: &position, force: &force };
    let found = regress(&samples, &axis());
    assert_eq!(found, Err(RegressionError::Untold { name: "offset" }));
}

#[test]
fn what_is_no_even_record_of_numbers_is_refused_where_it_is_wrong() {
    let record = record();
    let good = force(&record, &axis(), &[3.0, 1.0, 0.5, -2.0]);
    let refused = |change: &dyn Fn(&mut Vec<f64>, &mut Vec<f64>)| {
        let (mut time, mut force) = (record.time.clone(), good.clone());
        change(&mut time, &mut force);
        let samples = Samples { time: &time, position: &record.position, force: &force };
        regress(&samples, &axis()).expect_err("it is refused").to_string()
    };
    let nan = refused(&|_, force| force[41] = f64::NAN);
    assert!(nan.starts_with("force is NaN at sample 42:"), "{nan}");
    let gap = refused(&|time, _| time[500..].iter_mut().for_each(|t| *t += 0.002));
    assert!(gap.starts_with("0.003"), "{gap}");
    assert!(gap.contains("from sample 500 to the next"), "{gap}");
    let backwards = refused(&|time, _| time.reverse());
    assert!(backwards.contains("from sample 1 to the next"), "{backwards}");
    let uneven = refused(&|time, _| time.truncate(7));
    assert!(uneven.starts_with("position has 20000 samples: expected 7"), "{uneven}");
    let samples = Samples { time: &[0.0], position: &[0.0], force: &[0.0] };
    let short = regress(&samples, &axis()).expect_err("too short").to_string();
    assert!(short.starts_with("1 samples: expected 498 at least"), "{short}");
    let options = Options { cutoff: Some(500.0), ..axis() };
    let samples = Samples { time: &record.time, position: &record.position, force: &good };
    let high = regress(&samples, &options).expect_err("no such filter").to_string();
    assert!(high.starts_with("cut-off 500 Hz: expected"), "{high}");
}
