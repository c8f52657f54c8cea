//! `cargo xtask discover` on a record whose truth is known, and on a measured drive that is kept elsewhere.

mod common;

use common::{Project, Ran};
use serde_json::Value;
use std::{fs, path::PathBuf};

/// The rig of the named record `mass-spring` as an analyst would declare it who knows of no viscous friction; what is
/// nominal is a little wrong.
const RIG: &str = r#"title = "a mass on a spring"
[plant]
kind      = "mass-spring"
mass      = 1.0
stiffness = 1.5
[friction]
name  = "dahl"
f_c   = 0.74
sigma = 7.6
gamma = 1.0
[fit]
free = ["f_c", "sigma"]
[channels]
time     = "time_s"
force    = "force_n"
position = { column = "position_m", quantum = 1e-4 }
velocity = "velocity_m_s"
"#;

/// A folder with a record, another of the same rig, and the rig file.
struct Bench(Project);

impl Bench {
    fn new() -> Self {
        let project = Project::new(&[]);
        for (name, seed) in [("record", "1"), ("other", "2")] {
            let [record, truth] = [format!("{name}.csv"), format!("truth/{name}.toml")]
                .map(|path| project.path().join(path).display().to_string());
            let arguments = ["record", "mass-spring", "--seed", seed, "--out", &record];
            let ran = project.run(&[&arguments[..], &["--truth", &truth]].concat());
            assert_eq!(ran.code, Some(0), "{ran:?}");
        }
        fs::write(project.path().join("rig.toml"), RIG).expect("a rig file");
        Self(project)
    }

    fn at(&self, name: &str) -> String {
        self.0.path().join(name).display().to_string()
    }

    fn run(&self, [record, rig]: [&str; 2], flags: &[&str]) -> Ran {
        let (record, rig) = (self.at(record), self.at(rig));
        self.0.run(&[&["discover", &record, "--rig", &rig], flags].concat())
    }

    /// It ends with `code` and all of `words` in one error, and writes nothing.
    fn refused(&self, pair: [&str; 2], flags: &[&str], (code, words): (i32, &[&str])) {
        let before = self.0.files("");
        let ran = self.run(pair, flags);
        assert_eq!(ran.code, Some(code), "{pair:?} {flags:?}: {ran:?}");
        assert_eq!(ran.err.matches("error:").count(), 1, "{ran:?}");
        for word in words {
            assert!(ran.err.contains(word), "no `{word}` in: {}", ran.err);
        }
        assert_eq!(common::difference(&before, &self.0.files("")), None, "{flags:?} wrote");
    }
}

fn json(ran: &Ran) -> Value {
    assert_eq!(ran.code, Some(0), "{ran:?}");
    serde_json::from_str(&ran.out).expect("JSON")
}

fn has(value: &Value, keys: &[&str]) {
    let object = value.as_object().unwrap_or_else(|| panic!("{value} is no object"));
    for key in keys {
        assert!(object.contains_key(*key), "no `{key}` in {value}");
    }
}

fn each<'a>(value: &'a Value, key: &str) -> &'a Vec<Value> {
    value[key].as_array().unwrap_or_else(|| panic!("`{key}` of {value} is no list"))
}

#[test]
fn the_missing_friction_is_named_with_all_that_was_promised_and_its_model_lacks_nothing() {
    let bench = Bench::new();
    let (out, other) = (bench.at("out"), bench.at("other.csv"));
    let ran =
        bench.run(["record.csv", "rig.toml"], &["--out", &out, "--holdout", &other, "--json"]);
    let answer = json(&ran);
    has_all(&answer);
    assert_eq!(answer["verdict"], "effect", "{answer}");
    let effect = &each(&answer, "effects")[0];
    let set = each(effect, "set");
    assert!(
        set.contains(&Value::from("viscous")),
        "the record was made with viscous friction: {effect}"
    );
    let [after, floor] = ["after", "floor"].map(|key| each(&answer, "holdout")[0][key].as_f64());
    assert!(
        after < floor.map(|floor| 3.0 * floor),
        "held out {after:?} m, the floor is {floor:?} m"
    );
    left_behind(&bench, &answer);
    let again = json(&bench.run(["record.csv", "out/model.toml"], &["--json"]));
    assert_eq!(again["verdict"], "nothing_missing", "{again}");
}

fn has_all(answer: &Value) {
    let keys = ["verdict", "parameters", "effects", "gap", "where", "map", "detectability"];
    has(answer, &[&keys[..], &["format", "seconds", "holdout"]].concat());
    for p in each(answer, "parameters") {
        has(p, &["name", "given", "found", "standard_error", "unit", "moved"]);
        has(p, &["identified", "interval"]);
        assert_eq!(each(p, "interval").len(), 2, "{p}");
    }
    for e in each(answer, "effects") {
        has(e, &["name", "set", "values", "shrink", "separated_by"]);
        assert!(each(e, "set").contains(&e["name"]), "the set holds the name itself: {e}");
        for v in each(e, "values") {
            has(v, &["name", "value", "standard_error", "unit"]);
        }
    }
    for g in each(answer, "gap").iter().chain(each(answer, "holdout")) {
        has(g, &["channel", "unit", "before", "refit", "after", "floor"]);
    }
    assert!(answer["where"].is_object(), "{}", answer["where"]);
    assert!(answer["seconds"].as_f64().is_some_and(|s| s > 0.0), "{}", answer["seconds"]);
}

/// The model is a rig file for every command, the answer is that on the screen, and the page asks for nothing.
fn left_behind(bench: &Bench, answer: &Value) {
    let text = fs::read_to_string(bench.at("out/answer.json")).expect("answer.json");
    assert_eq!(serde_json::from_str::<Value>(&text).expect("JSON"), *answer);
    let (record, model) = (bench.at("record.csv"), bench.at("out/model.toml"));
    let others: [&[&str]; 3] =
        [&["fit", "--quick", "--starts", "0"], &["simulate"], &["check-data"]];
    for command in others {
        let ran = bench.0.run(&[command, &[record.as_str(), "--rig", model.as_str()]].concat());
        assert!(matches!(ran.code, Some(0 | 1)) && ran.err.is_empty(), "{command:?}: {ran:?}");
    }
    let page = fs::read_to_string(bench.at("out/page.html")).expect("page.html");
    let parts = ["What was found", "The gap", "Residual force", "Where", "Candidates"];
    let more = ["Hysteresis before and after", "Confirmation", "What would have been visible"];
    for part in parts.iter().chain(&more) {
        assert!(page.contains(&format!("<h2>{part}</h2>")), "no {part:?} in the page");
    }
    assert!(!page.contains("<script") && !page.contains("http"), "the page asks for something");
    assert!(!page.contains("not drawn") && !page.contains(">NaN<"), "something is not drawn");
}

#[test]
fn the_answer_fits_a_screen_and_two_runs_give_the_same() {
    let bench = Bench::new();
    let run = || bench.run(["record.csv", "rig.toml"], &[]);
    let (first, second) = (run(), run());
    assert_eq!(first.code, Some(0), "{first:?}");
    assert!(first.out.lines().count() <= 45, "{} lines: {}", first.out.lines().count(), first.out);
    assert!(first.out.lines().all(|line| !line.contains("NaN ")), "{}", first.out);
    for step in ["check", "before", "refit", "floor", "where", "verdict", "gap", "visible"] {
        assert!(first.out.lines().any(|line| line.starts_with(step)), "no {step}: {}", first.out);
    }
    assert_eq!(first.out, second.out);
}

#[test]
fn a_record_that_is_not_there_is_refused() {
    let bench = Bench::new();
    bench.refused(["none.csv", "rig.toml"], &[], (4, &["none.csv"]));
    bench.refused(["record.csv", "none.toml"], &[], (4, &["none.toml"]));
    let none = bench.at("none.csv");
    bench.refused(["record.csv", "rig.toml"], &["--holdout", &none], (4, &["none.csv"]));
}

#[test]
fn a_rig_without_channels_is_refused() {
    let bench = Bench::new();
    let (plain, _) = RIG.split_once("[channels]").expect("channels");
    fs::write(bench.at("rig.toml"), plain).expect("a rig file");
    bench.refused(["record.csv", "rig.toml"], &[], (4, &["rig.toml", "channels"]));
}

#[test]
fn a_held_out_record_that_lacks_a_channel_is_refused_before_the_work() {
    let bench = Bench::new();
    let text = fs::read_to_string(bench.at("other.csv")).expect("a record");
    fs::write(bench.at("lacks.csv"), text.replacen("velocity_m_s", "speed", 1)).expect("a record");
    let (lacks, out) = (bench.at("lacks.csv"), bench.at("out"));
    let flags = ["--holdout", &lacks, "--out", &out];
    bench.refused(["record.csv", "rig.toml"], &flags, (4, &["lacks.csv", "velocity"]));
}

#[test]
fn a_folder_that_cannot_be_made_is_the_environments_fault() {
    let bench = Bench::new();
    let out = bench.at("rig.toml/out");
    bench.refused(["record.csv", "rig.toml"], &["--out", &out], (6, &["rig.toml/out"]));
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

#[test]
fn the_command_of_the_measured_drive_is_as_far_off_as_is_known_and_nearer_with_what_the_published_model_lacks()
 {
    let Some(folder) = emps() else { return };
    let project = Project::new(&[]);
    let rig =
        fs::read_to_string(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../data/emps-rig.toml"));
    // The parameters that the drive's authors published.
    let rig = rig.expect("the drive's rig file").replace("inertia = 95.0", "inertia = 95.1089");
    let rig = rig.replace("= 20.0", "= 20.3935").replace("= 200.0", "= 203.5034");
    let rig = rig.replace("offset  = 0.0", "offset  = -3.1648");
    let at = |name: &str| project.path().join(name).display().to_string();
    fs::write(at("rig.toml"), rig).expect("a rig file");
    let [train, test] = ["emps_train.csv", "emps_test_pulses.csv"]
        .map(|name| folder.join(name).display().to_string());
    let (rig, flags) = (at("rig.toml"), ["--holdout", &test, "--json"]);
    let answer = json(&project.run(&[&["discover", &train, "--rig", &rig], &flags[..]].concat()));
    // By a simulation of our own in another language, with implicit Euler steps of 0.1 ms.
    for (key, known) in [("command", 4.572), ("holdout_command", 5.444)] {
        let found = answer[key]["before"].as_f64().expect("a number");
        assert!((found - known).abs() < 0.01, "{key} {found} %, known {known} %");
    }
    // And it is nearer with what they lack, on the run of which nothing was fitted too: what the best model known leaves,
    // and a little.
    for (key, good) in [("command", 3.0), ("holdout_command", 4.2)] {
        let found = answer[key]["after"].as_f64().expect("a number");
        assert!(found < good, "{key} {found} % after, not under {good} %");
    }
}
