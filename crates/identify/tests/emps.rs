//! The measured drive of the EMPS benchmark by its authors' regression, against the numbers they
//! published with it (Janot, Gautier and Brunot, 2019). The records are kept elsewhere: these tests run
//! when the folder named by `DUHEM_DATA` holds them, a path from the project's root, and say so otherwise.

use identify::regression::{Linear, Options, Regression, Samples, regress, relative_error};
use std::path::{Path, PathBuf};

/// M [kg], F_v [N·s/m], F_c [N] and the offset [N], as published.
const PUBLISHED: [f64; 4] = [95.1089, 203.5034, 20.3935, -3.1648];

/// M, F_v and F_c upwards, F_v and F_c downwards, as published.
const BY_DIRECTION: [f64; 5] = [95.1540, 166.7061, 20.1440, 240.4236, 20.6277];

struct Run {
    time: Vec<f64>,
    position: Vec<f64>,
    force: Vec<f64>,
}

impl Run {
    fn samples(&self) -> Samples<'_> {
        Samples { time: &self.time, position: &self.position, force: &self.force }
    }
}

fn read(path: &Path) -> Run {
    let mut run = Run { time: Vec::new(), position: Vec::new(), force: Vec::new() };
    let mut reader = csv::Reader::from_path(path).expect("the record can be read");
    let headers = reader.headers().expect("a header").clone();
    let place = |name: &str| headers.iter().position(|h| h == name).expect(name);
    let (time, position, voltage) = (place("time_s"), place("position_m"), place("control_V"));
    let gain = 35.150_651_882_485_47;
    for row in reader.records() {
        let row = row.expect("a row");
        let number = |i: usize| row[i].parse::<f64>().expect("a number");
        run.time.push(number(time));
        run.position.push(number(position));
        run.force.push(gain * number(voltage));
    }
    run
}

/// The run fitted and the run held out, if they are there.
fn runs() -> Option<(Run, Run)> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = std::env::var_os("DUHEM_DATA").map(|data| root.join(data).join("emps"));
    let Some(folder) = folder.filter(|folder| folder.join("emps_train.csv").exists()) else {
        say("not run: DUHEM_DATA names no folder with emps/emps_train.csv; see data/emps.toml");
        return None;
    };
    Some((read(&folder.join("emps_train.csv")), read(&folder.join("emps_test_pulses.csv"))))
}

#[expect(clippy::print_stderr, reason = "a test that has nothing to run on says so")]
fn say(what: &str) {
    eprintln!("{what}");
}

fn axis() -> Options {
    Options::new(Linear::of("axis").expect("a plant of the list"))
}

fn values(fit: &Regression) -> Vec<f64> {
    fit.coefficients.iter().map(|c| c.value).collect()
}

/// The authors' script leaves away the first 49 samples and none at the end.
fn as_published() -> Options {
    Options { trim: (49, 0), ..axis() }
}

#[test]
fn the_published_parameters_come_out_to_the_last_published_digit() {
    let Some((train, test)) = runs() else { return };
    let fit = regress(&train.samples(), &as_published()).expect("a fit");
    for (c, published) in fit.coefficients.iter().zip(PUBLISHED) {
        let off = (c.value - published).abs();
        assert!(
            off < 0.6e-4,
            "{} = {} {}, published {published}",
            c.term.name,
            c.value,
            c.term.unit
        );
    }
    let held_out =
        relative_error(&test.samples(), &as_published(), &values(&fit)).expect("an error");
    assert_eq!(format!("{:.2} {held_out:.2}", fit.relative_error), "4.08 5.98", "% of the force");
}

#[test]
fn the_published_parameters_have_their_published_errors() {
    let Some((train, test)) = runs() else { return };
    let error =
        |run: &Run| relative_error(&run.samples(), &as_published(), &PUBLISHED).expect("an error");
    assert_eq!(format!("{:.2} {:.2}", error(&train), error(&test)), "4.08 5.98", "% of the force");
}

#[test]
fn friction_by_direction_comes_out_to_the_last_published_digit() {
    let Some((train, _)) = runs() else { return };
    let options = Options { by_direction: true, ..as_published() };
    let fit = regress(&train.samples(), &options).expect("a fit");
    for (c, published) in fit.coefficients.iter().zip(BY_DIRECTION) {
        let off = (c.value - published).abs();
        assert!(
            off < 0.6e-4,
            "{} = {} {}, published {published}",
            c.term.name,
            c.value,
            c.term.unit
        );
    }
    assert_eq!(format!("{:.2}", fit.relative_error), "3.11", "% of the force");
}

#[test]
fn with_both_ends_left_away_the_fit_is_within_a_percent_and_no_worse_than_the_published_one() {
    let Some((train, test)) = runs() else { return };
    let fit = regress(&train.samples(), &axis()).expect("a fit");
    for (c, published) in fit.coefficients.iter().zip(PUBLISHED) {
        let off = (c.value / published - 1.0).abs();
        assert!(
            off < 0.01,
            "{} = {} {}, {:.3} % off",
            c.term.name,
            c.value,
            c.term.unit,
            100.0 * off
        );
    }
    let held_out = relative_error(&test.samples(), &axis(), &values(&fit)).expect("an error");
    assert!(fit.relative_error <= 4.08, "{} % of the force fitted", fit.relative_error);
    assert!(held_out <= 5.98, "{held_out} % of the force held out");
    for (run, ours) in [(&train, fit.relative_error), (&test, held_out)] {
        let theirs = relative_error(&run.samples(), &axis(), &PUBLISHED).expect("an error");
        assert!(ours <= theirs, "{ours} % of the force, the published parameters {theirs} %");
    }
}

#[test]
fn the_residuals_of_a_real_drive_hang_together_and_the_errors_allow_for_it() {
    let Some((train, _)) = runs() else { return };
    let fit = regress(&train.samples(), &axis()).expect("a fit");
    assert!(fit.lag > 0, "lag {}", fit.lag);
    for c in &fit.coefficients {
        let ratio = c.standard_error / c.classical_error;
        assert!(ratio > 1.0, "{}: {} against {}", c.term.name, c.standard_error, c.classical_error);
    }
}
