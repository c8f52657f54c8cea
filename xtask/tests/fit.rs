//! `cargo xtask fit` on records whose truth is known, and on a measured drive that is kept elsewhere.

mod common;

use common::{Project, Ran};
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

fn data(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(name).display().to_string()
}

/// Runs `fit` on a record, and gives what it left in `out/` as `fit.json`.
fn fit(project: &Project, (record, rig): (&str, &str), flags: &[&str]) -> Value {
    let out = project.path().join("out").display().to_string();
    let ran = project.run(&[&["fit", record, "--rig", rig, "--out", &out], flags].concat());
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let text = fs::read_to_string(project.path().join("out/fit.json")).expect("fit.json");
    serde_json::from_str(&text).expect("JSON")
}

fn parameter<'a>(fitted: &'a Value, name: &str) -> &'a Value {
    let all = fitted["parameters"].as_array().expect("parameters");
    all.iter().find(|p| p["name"] == name).unwrap_or_else(|| panic!("no {name} in {all:?}"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// The value of a parameter that the record of this truth file was made with; `k[2]` is the second of a list.
fn made_with(truth: &toml::Table, name: &str) -> f64 {
    let (key, place) = match name.split_once('[') {
        Some((key, place)) => (key, place.trim_end_matches(']').parse::<usize>().expect("a place")),
        None => (name, 1),
    };
    let scenario = &truth["scenario"];
    let value = scenario["friction"].get(key).or_else(|| scenario["plant"].get(key));
    let value = value.unwrap_or_else(|| panic!("no {name} in the truth"));
    let value = value.as_array().map_or(value, |list| &list[place - 1]);
    value.as_float().expect("a number")
}

fn truth(path: &Path) -> toml::Table {
    toml::from_str(&fs::read_to_string(path).expect("the truth")).expect("TOML")
}

/// Found within three standard errors or 5 % of what the record was made with.
fn lands(fitted: &Value, truth: &toml::Table, names: &[&str]) {
    for name in names {
        let (p, made) = (parameter(fitted, name), made_with(truth, name));
        let (found, error) = (number(&p["found"]), number(&p["standard_error"]));
        let off = (found - made).abs();
        assert!(
            off < (3.0 * error).max(0.05 * made.abs()),
            "{name} = {found} ± {error} {}, made with {made}",
            p["unit"]
        );
    }
}

#[test]
fn the_gearbox_record_gives_back_what_it_was_made_with_and_says_all_that_was_promised() {
    let project = Project::new(&[]);
    let rig = data("gearbox-rig.toml");
    let fitted = fit(&project, (&data("gearbox-synthetic.parquet"), &rig), &["--quick"]);
    let truth = truth(Path::new(&data("truth/gearbox-synthetic.toml")));
    assert_eq!(fitted["converged"], true, "{}", fitted["status"]);
    let names =
        ["f_c", "f_s", "v_s", "sigma_0", "sigma_1", "sigma_2", "k_1", "k_2", "f_10", "f_20"];
    lands(&fitted, &truth, &names);
    // The monitor's bias stands in the offset, times the motor constant.
    let offset = parameter(&fitted, "offset");
    assert!((number(&offset["found"]) + 16.5 * 0.032).abs() < 1e-3, "{offset} N·m");
    for p in fitted["parameters"].as_array().expect("parameters") {
        let keys = ["name", "given", "found", "standard_error", "unit", "moved", "identified"];
        assert!(keys.iter().all(|key| !p[key].is_null()), "{p}");
        assert_eq!(p["interval"].as_array().map(Vec::len), Some(2), "{p}");
    }
    for gap in fitted["gap"].as_array().expect("gap") {
        let keys = ["channel", "unit", "before", "refit", "after", "floor"];
        assert!(keys.iter().all(|key| !gap[key].is_null()), "{gap}");
        let [after, floor] = ["after", "floor"].map(|key| number(&gap[key]));
        assert!(after < 1.5 * floor, "{gap}");
    }
    assert_eq!(fitted["correlation"].as_array().map(Vec::len), Some(11), "rows of the correlation");
    assert!(fitted["models"].is_array() && number(&fitted["seconds"]) > 0.0);
    leaves_a_model(&project);
}

/// The fitted model is a rig file for every command, and its header compiles.
fn leaves_a_model(project: &Project) {
    let at = |name: &str| project.path().join("out").join(name).display().to_string();
    let (record, model) = (data("gearbox-synthetic.parquet"), at("model.toml"));
    let again: [&[&str]; 3] =
        [&["fit", "--quick", "--starts", "0"], &["simulate"], &["check-data"]];
    for command in again {
        let mut arguments = vec![command[0], &record, "--rig", &model];
        arguments.extend(&command[1..]);
        let ran: Ran = project.run(&arguments);
        assert!(matches!(ran.code, Some(0 | 1)) && ran.err.is_empty(), "{command:?}: {ran:?}");
    }
    let flags =
        ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-fsyntax-only", "-x", "c"];
    let compiled = Command::new("cc").args(flags).arg(at("model.h")).output().expect("cc");
    let said = String::from_utf8_lossy(&compiled.stderr);
    assert!(compiled.status.success(), "{said}");
    let page = fs::read_to_string(at("fit.html")).expect("fit.html");
    for words in ["f_c [N·m]", "sigma_0 [N·m/rad]", "The loop over the data", "<svg", "Not asked"]
    {
        assert!(page.contains(words), "no {words:?} in the page");
    }
    assert!(!page.contains("<script") && !page.contains("http"), "the page asks for something");
    let traces = record::read_sheet(Path::new(&at("simulated.csv"))).expect("simulated.csv");
    for column in ["time_s", "angle_measured", "angle_before", "angle_after", "velocity_after"] {
        assert_eq!(traces.column(column).expect(column).len(), traces.rows(), "rows of {column}");
    }
}

/// A rig file for a scenario, its nominal values 20 % wrong, alternately too large and too small.
struct Simple {
    name: &'static str,
    plant: &'static [&'static str],
    free: &'static [&'static str],
    friction: &'static str,
    channels: &'static str,
}

const SIMPLE: [Simple; 4] = [
    Simple {
        name: "axis",
        plant: &["inertia", "gain"],
        free: &["inertia", "f_c", "sigma_2"],
        friction: "coulomb",
        channels: "voltage = { column = \"voltage_v\", hold = \"zero-order\" }\nposition = \"position_m\"",
    },
    Simple {
        name: "mass-spring",
        plant: &["mass", "stiffness"],
        free: &["mass", "stiffness", "f_c", "sigma", "sigma_2"],
        friction: "dahl",
        channels: "force = \"force_n\"\nposition = { column = \"position_m\", quantum = 1e-4 }\n\
                   velocity = \"velocity_m_s\"",
    },
    Simple {
        name: "pendulum",
        plant: &["inertia", "mass", "length", "torque_constant", "resistance"],
        free: &["inertia", "f_c", "sigma_2"],
        friction: "coulomb",
        channels: "voltage = \"voltage_v\"\nangle = { column = \"angle_deg\", unit = \"deg\" }\n\
                   velocity = { column = \"speed_rpm\", unit = \"rpm\" }",
    },
    Simple {
        name: "prescribed",
        plant: &[],
        free: &["k", "delta", "sigma_2"],
        friction: "maxwell-slip",
        channels: "displacement = { column = \"displacement_mm\", unit = \"mm\" }\nforce = \"force_n\"",
    },
];

impl Simple {
    fn rig(&self, truth: &toml::Table) -> String {
        let friction: &[&str] = match self.friction {
            "dahl" => &["f_c", "sigma", "gamma", "sigma_2"],
            "coulomb" => &["f_c", "sigma_2"],
            _ => &["k", "delta", "sigma_2"],
        };
        let mut n = 0;
        let mut wrong = |table: &str, key: &str| {
            let value = &truth["scenario"][table][key];
            if !self.free.contains(&key) {
                return format!("{key} = {value}\n");
            }
            n += 1;
            let factor = if n % 2 == 0 { 0.8 } else { 1.2 };
            let scaled = |v: &toml::Value| (factor * v.as_float().expect("a number")).to_string();
            match value.as_array() {
                Some(list) => {
                    let list: Vec<String> = list.iter().map(scaled).collect();
                    format!("{key} = [{}]\n", list.join(", "))
                }
                None => format!("{key} = {}\n", scaled(value)),
            }
        };
        let plant: String = self.plant.iter().map(|key| wrong("plant", key)).collect();
        let friction: String = friction.iter().map(|key| wrong("friction", key)).collect();
        let offset = &truth["scenario"]["plant"]["offset"];
        format!(
            "title = \"{}\"\n[plant]\nkind = \"{}\"\noffset = {offset}\n{plant}[friction]\nname = \"{}\"\n\
             {friction}[fit]\nfree = {:?}\n[channels]\ntime = \"time_s\"\n{}\n",
            self.name, self.name, self.friction, self.free, self.channels
        )
    }

    /// The record made, its rig written, and both fitted.
    fn fitted(&self) -> (Value, toml::Table) {
        let project = Project::new(&[]);
        let at = |name: &str| project.path().join(name).display().to_string();
        let record = at("record.csv");
        let ran = project.run(&["record", self.name, "--out", &record]);
        assert_eq!(ran.code, Some(0), "{ran:?}");
        let truth = truth(&project.path().join("truth/record.toml"));
        fs::write(at("rig.toml"), self.rig(&truth)).expect("a rig file");
        (fit(&project, (&record, &at("rig.toml")), &["--quick", "--starts", "1"]), truth)
    }
}

fn of_kind(name: &str) -> (Value, toml::Table) {
    SIMPLE.iter().find(|simple| simple.name == name).expect("a kind of the list").fitted()
}

#[test]
fn an_axis_gives_back_its_inertia_and_friction() {
    let (fitted, truth) = of_kind("axis");
    lands(&fitted, &truth, &["inertia", "f_c", "sigma_2"]);
}

#[test]
fn a_mass_on_a_spring_gives_back_its_mass_its_spring_and_its_friction() {
    let (fitted, truth) = of_kind("mass-spring");
    lands(&fitted, &truth, &["mass", "stiffness", "f_c", "sigma", "sigma_2"]);
}

#[test]
fn a_pendulum_gives_back_its_inertia_and_friction() {
    let (fitted, truth) = of_kind("pendulum");
    lands(&fitted, &truth, &["inertia", "f_c", "sigma_2"]);
}

#[test]
fn a_contact_under_imposed_motion_gives_back_its_elements() {
    let (fitted, truth) = of_kind("prescribed");
    // An element has no name but its deadband: in which order they come back says nothing.
    let found = |key: &str, i: usize| {
        let p = parameter(&fitted, &format!("{key}[{i}]"));
        (number(&p["found"]), number(&p["standard_error"]))
    };
    let made = |key: &str, i: usize| made_with(&truth, &format!("{key}[{i}]"));
    let mut elements: Vec<_> = (1..=4).map(|i| (found("delta", i), found("k", i))).collect();
    elements.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
    for (i, (delta, k)) in (1..).zip(elements) {
        for (key, (value, error)) in [("delta", delta), ("k", k)] {
            let (off, truth) = ((value - made(key, i)).abs(), made(key, i));
            assert!(
                off < (3.0 * error).max(0.05 * truth),
                "{key}[{i}] = {value} ± {error}, made with {truth}"
            );
        }
    }
}

#[test]
fn one_thread_and_two_find_the_same_numbers() {
    let project = Project::new(&[]);
    let pair = (data("gearbox-synthetic.parquet"), data("gearbox-rig.toml"));
    let [mut one, mut two] = ["1", "2"].map(|n| {
        fit(&project, (&pair.0, &pair.1), &["--quick", "--window", "2.5", "--threads", n])
    });
    for value in [&mut one, &mut two] {
        value["seconds"] = Value::Null;
    }
    assert_eq!(one, two);
}

/// The measured drive's folder, if it is there.
fn emps() -> Option<PathBuf> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..");
    let folder = std::env::var_os("DUHEM_DATA").map(|data| root.join(data).join("emps"));
    let folder = folder.filter(|folder| folder.join("emps_train.csv").exists());
    if folder.is_none() {
        say("not run: DUHEM_DATA names no folder with emps/emps_train.csv; see data/emps.toml");
    }
    folder
}

#[expect(clippy::print_stderr, reason = "a test that has nothing to run on says so")]
fn say(what: &str) {
    eprintln!("{what}");
}

/// The drive's parameters as its authors published them.
const PUBLISHED: [(&str, f64); 4] =
    [("inertia", 95.1089), ("sigma_2", 203.5034), ("f_c", 20.3935), ("offset", -3.1648)];

/// The largest deviation from what was published, and whose.
fn off(fitted: &Value) -> (f64, &'static str) {
    let each = PUBLISHED.map(|(name, published)| {
        ((number(&parameter(fitted, name)["found"]) / published - 1.0).abs(), name)
    });
    each.into_iter().reduce(|a, b| if b.0 > a.0 { b } else { a }).expect("four parameters")
}

#[test]
fn the_measured_drive_is_within_a_percent_by_regression_and_five_by_simulation() {
    let Some(folder) = emps() else { return };
    let at = |name: &str| folder.join(name).display().to_string();
    let (train, test) = (at("emps_train.csv"), at("emps_test_pulses.csv"));
    let project = Project::new(&[]);
    let rig = data("emps-rig.toml");
    let flags = ["--holdout", &test, "--method", "regression"];
    let fitted = fit(&project, (&train, &rig), &flags);
    let (most, name) = off(&fitted);
    assert!(most < 0.01, "{name} is {} % off by regression", 100.0 * most);
    // The published model's relative force errors, by the authors' measure.
    for (key, theirs) in [("relative_error", 4.08), ("holdout_relative_error", 5.98)] {
        let ours = number(&fitted[key]);
        assert!(ours <= theirs, "{key} {ours} %, the published model's {theirs} %");
    }
    let fitted = fit(&project, (&train, &rig), &["--holdout", &test, "--quick", "--starts", "0"]);
    let (most, name) = off(&fitted);
    assert!(most < 0.05, "{name} is {} % off by simulation", 100.0 * most);
    assert_eq!(fitted["converged"], true, "{}", fitted["status"]);
    assert!(
        fitted["holdout"].as_array().is_some_and(|gap| gap.len() == 2),
        "{}",
        fitted["holdout"]
    );
}
