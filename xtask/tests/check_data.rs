//! The record's doctor as a command: what it prints and how it ends.

mod common;

use common::{Project, Ran};
use std::{fmt::Write, fs, process::Command};

const RIG: &str = r#"title = "bench"
[plant]
kind = "prescribed"
[friction]
name = "coulomb"
f_c = 1.0
[fit]
free = ["f_c"]
[channels]
time = "t [s]"
displacement = "u [m]"
force = "F [N]"
"#;

/// A triangle of displacement and its friction with a ripple, 4 s at 100 Hz.
fn record() -> String {
    let mut text = "t [s],u [m],F [N]\n".to_owned();
    for i in 0..400_u32 {
        let (up, at) = ((i / 100) % 2 == 0, f64::from(i % 100));
        let u = if up { at } else { 100.0 - at };
        let ripple = f64::from(i * 7919 % 101) * 1e-3;
        let force = if up { 1.0 } else { -1.0 } + ripple;
        let _ = writeln!(text, "{:.2},{:.4},{force:.3}", f64::from(i) * 0.01, u * 1e-3);
    }
    text
}

struct Bench {
    project: Project,
}

impl Bench {
    fn new(record: &str, rig: &str) -> Self {
        let project = Project::new(&[]);
        fs::write(project.path().join("record.csv"), record).expect("a record");
        fs::write(project.path().join("rig.toml"), rig).expect("a rig");
        Self { project }
    }

    fn path(&self, name: &str) -> String {
        self.project.path().join(name).display().to_string()
    }

    fn check(&self, flags: &[&str]) -> Ran {
        let (record, rig) = (self.path("record.csv"), self.path("rig.toml"));
        let arguments = [&["check-data", &record, "--rig", &rig], flags].concat();
        self.project.run(&arguments)
    }
}

#[test]
fn a_record_without_problems_ends_with_0_and_fits_a_screen() {
    let bench = Bench::new(&record(), RIG);
    let before = fs::read(bench.path("record.csv")).expect("the record");
    let ran = bench.check(&[]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(ran.out.contains("400 rows, 3.99 s at 100 Hz"), "{}", ran.out);
    assert!(ran.out.contains("turns 3 times, half swings 0.05 to 0.05 m"), "{}", ran.out);
    assert!(ran.out.lines().count() < 24, "{} lines", ran.out.lines().count());
    assert_eq!(
        fs::read(bench.path("record.csv")).expect("the record"),
        before,
        "the record changed"
    );
}

#[test]
fn a_problem_ends_with_1_and_names_the_line_of_the_file() {
    let damaged = record().replace("0.50,0.0500,", "0.50,,");
    let ran = Bench::new(&damaged, RIG).check(&[]);
    assert_eq!(ran.code, Some(1), "{ran:?}");
    let says = "! displacement (`u [m]`), line 52: 1 of 400 samples are blank or no number";
    assert!(ran.out.contains(says), "{}", ran.out);
    let json = Bench::new(&damaged, RIG).check(&["--json"]);
    let value: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!((json.code, &value["problems"]), (Some(1), &serde_json::json!(1)));
    let finding = &value["findings"][0];
    assert_eq!((&finding["kind"], &finding["severity"]), (&"missing".into(), &"problem".into()));
    assert_eq!((&finding["rows"], &finding["lines"]), (&vec![50, 50].into(), &vec![52, 52].into()));
}

#[test]
fn a_column_that_is_not_there_is_a_problem_that_lists_the_others() {
    let ran = Bench::new(&record(), &RIG.replace("F [N]", "G [N]")).check(&[]);
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(ran.out.contains("no column `G [N]`") && ran.out.contains("F [N]"), "{}", ran.out);
}

#[test]
fn what_cannot_be_read_ends_with_4_and_says_which_file() {
    let bench = Bench::new(&record(), &RIG.replace("f_c = 1.0", "f_c = -1.0"));
    let ran = bench.check(&[]);
    assert_eq!(ran.code, Some(4), "{ran:?}");
    assert!(ran.err.contains("rig.toml") && ran.err.contains("line 6: f_c = -1.0"), "{}", ran.err);
    fs::write(bench.path("rig.toml"), b"title = \"\xff\"").expect("a rig");
    assert_eq!(bench.check(&[]).code, Some(4), "a rig file that is no UTF-8");
    fs::write(bench.path("rig.toml"), RIG).expect("a rig");
    fs::write(bench.path("record.csv"), "").expect("a record");
    let ran = bench.check(&[]);
    assert_eq!(ran.code, Some(4), "{ran:?}");
    assert!(ran.err.contains("record.csv"), "{}", ran.err);
    let fifo = bench.path("pipe");
    assert!(Command::new("mkfifo").arg(&fifo).status().expect("mkfifo").success());
    let as_record = bench.project.run(&["check-data", &fifo]);
    let as_rig = bench.project.run(&["check-data", &bench.path("record.csv"), "--rig", &fifo]);
    for ran in [as_record, as_rig, bench.project.run(&["check-data", "/nowhere.csv"])] {
        assert_eq!(ran.code, Some(4), "{ran:?}");
    }
}

#[test]
fn text_of_the_file_does_not_control_the_terminal() {
    let header = "\u{1b}[31mF\u{202e}<b>";
    let bench = Bench::new(&record().replace("F [N]", header), RIG);
    let ran = bench.project.run(&["check-data", &bench.path("record.csv")]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(ran.out.contains("<b>"), "{}", ran.out);
    let controls = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
    assert!(!ran.out.contains(controls), "{:?}", ran.out);
    let ran = bench.check(&[]);
    assert!(!ran.out.contains(controls) && ran.code == Some(1), "{ran:?}");
}
