//! Records and rig files that are wrong, through every command that reads one.

mod common;

use common::{Project, Ran};
use std::{collections::BTreeMap, fmt::Write, fs, path::PathBuf, process::Command};

const RIG: &str = r#"title = "bench"
[plant]
kind = "axis"
inertia = 1.0
[friction]
name = "coulomb"
f_c = 1.0
[fit]
free = ["f_c"]
[channels]
time = "t"
force = "F"
position = "x"
"#;

/// A mass pushed to and fro, `rows` long; its motion is no solution, which no reader can know.
fn record(rows: u32) -> String {
    let mut text = "t,F,x\n".to_owned();
    for i in 0..rows {
        let t = f64::from(i) * 0.01;
        let _ = writeln!(text, "{t:.2},{:.4},{:.6}", 3.0 * t.sin(), -2.0 * t.sin());
    }
    text
}

/// A folder with a record and a rig file, and what it held before a command ran.
struct Bench {
    project: Project,
    before: BTreeMap<PathBuf, Vec<u8>>,
}

/// The commands that read a record and a rig file.
const COMMANDS: [&[&str]; 5] = [
    &["fit", "--quick"],
    &["fit", "--method", "regression"],
    &["simulate"],
    &["discover"],
    &["check-data"],
];

impl Bench {
    fn new(name: &str, record: &[u8], rig: &[u8]) -> Self {
        let project = Project::new(&[]);
        let folder = project.path().join("in");
        fs::create_dir(&folder).expect("a folder");
        fs::write(folder.join(name), record).expect("a record");
        fs::write(folder.join("rig.toml"), rig).expect("a rig");
        let before = project.files("in");
        Self { project, before }
    }

    fn path(&self, name: &str) -> String {
        self.project.path().join("in").join(name).display().to_string()
    }

    fn run(&self, command: &[&str], record: &str, rig: &str) -> Ran {
        let (record, rig) = (self.path(record), self.path(rig));
        let out = self.project.path().join("out").display().to_string();
        let mut arguments = vec![command[0], &record, "--rig", &rig];
        arguments.extend(&command[1..]);
        if command[0] != "check-data" {
            arguments.extend(["--out", &out]);
        }
        self.project.run(&arguments)
    }

    /// Every command ends with `code` (the doctor with `doctor`), says `words`, and leaves all as it was.
    fn refused(&self, (record, rig): (&str, &str), doctor: i32, words: &[&str]) {
        for command in COMMANDS {
            let ran = self.run(command, record, rig);
            let told = if command[0] == "check-data" { doctor } else { 4 };
            let what = format!("{command:?} of {record} with {rig}: {ran:?}");
            assert_eq!(ran.code, Some(told), "{what}");
            let said = format!("{}{}", ran.out, ran.err);
            assert!(!said.contains("panicked"), "{what}");
            assert!(!said.contains(controls), "a character that controls the terminal: {what}");
            if told == 4 {
                assert!(words.iter().all(|word| ran.err.contains(word)), "{words:?}: {what}");
                assert!(ran.err.lines().count() <= 6, "{what}");
            }
        }
        assert_eq!(self.project.files("in"), self.before, "the input changed");
        assert!(self.project.files("out").is_empty(), "something stands in --out");
    }
}

fn controls(c: char) -> bool {
    c.is_control() && c != '\n' || c == '\u{202e}'
}

fn refused(record: impl AsRef<[u8]>, doctor: i32, words: &[&str]) {
    let bench = Bench::new("record.csv", record.as_ref(), RIG.as_bytes());
    bench.refused(("record.csv", "rig.toml"), doctor, words);
}

fn rig_refused(rig: impl AsRef<[u8]>, doctor: i32, words: &[&str]) {
    let bench = Bench::new("record.csv", record(400).as_bytes(), rig.as_ref());
    bench.refused(("record.csv", "rig.toml"), doctor, words);
}

#[test]
fn a_record_without_rows_is_refused() {
    refused("", 4, &["record.csv"]);
    refused("t,F,x\n", 4, &["record.csv"]);
}

#[test]
fn a_record_of_one_or_seven_rows_is_too_short_and_one_of_nine_ends_in_words() {
    refused(record(1), 1, &["record.csv", "1"]);
    refused(record(7), 1, &["record.csv", "7"]);
    for rows in [8, 9, 12] {
        let bench = Bench::new("record.csv", record(rows).as_bytes(), RIG.as_bytes());
        for command in COMMANDS {
            let ran = bench.run(command, "record.csv", "rig.toml");
            assert!(matches!(ran.code, Some(0 | 1 | 4)), "{rows} rows, {command:?}: {ran:?}");
        }
    }
}

#[test]
fn a_record_that_is_no_table_is_refused() {
    refused([0_u8, 159, 146, 150, 0, 7, 27, 255].repeat(500), 4, &["record.csv"]);
    refused("PAR1\0\0\0\0PAR1", 4, &["record.csv"]);
    refused(format!("t,F,x\n0,0,{}\n", "1".repeat(3 << 20)), 4, &["record.csv", "line 2"]);
    let many = (0..1_000_000).fold(String::new(), |mut text, i| {
        let _ = write!(text, "c{i},");
        text
    });
    refused(format!("{many}\n{many}\n"), 4, &["record.csv"]);
}

#[test]
fn time_that_goes_back_is_refused_with_its_line() {
    let text = record(400).replace("\n1.00,", "\n0.50,");
    refused(text, 1, &["record.csv", "line 102"]);
}

#[test]
fn numbers_that_are_none_are_refused_with_their_line_and_column() {
    let text = record(400).replace("\n1.00,", "\n1.00,oops");
    refused(text, 1, &["record.csv", "line 102", "F"]);
    let none = (0..400).fold("t,F,x\n".to_owned(), |mut text, i| {
        let _ = writeln!(text, "{i},NaN,NaN");
        text
    });
    refused(none, 1, &["record.csv", "line 2"]);
}

#[test]
fn numbers_too_large_to_simulate_end_in_words() {
    let huge = (0..400).fold("t,F,x\n".to_owned(), |mut text, i| {
        let sign = if i % 2 == 0 { '-' } else { ' ' };
        let _ = writeln!(text, "{i},{sign}1e308,{sign}1e308");
        text
    });
    refused(huge, 1, &["record.csv"]);
}

#[test]
fn a_record_in_which_nothing_moves_is_refused() {
    let still = (0..400).fold("t,F,x\n".to_owned(), |mut text, i| {
        let _ = writeln!(text, "{},0,1", f64::from(i) * 0.01);
        text
    });
    refused(still, 1, &["record.csv"]);
}

#[test]
fn an_imposed_motion_that_is_none_is_refused() {
    let rig = "title = \"a slide\"\n[plant]\nkind = \"prescribed\"\n[friction]\nname = \"coulomb\"\nf_c = 1.0\n\
        [fit]\nfree = [\"f_c\"]\n[channels]\ntime = \"t\"\ndisplacement = \"x\"\nforce = \"F\"\n";
    let still = (0..400).fold("t,F,x\n".to_owned(), |mut text, i| {
        let _ = writeln!(text, "{},{},1", f64::from(i) * 0.01, f64::from(i).sin());
        text
    });
    let bench = Bench::new("record.csv", still.as_bytes(), rig.as_bytes());
    bench.refused(("record.csv", "rig.toml"), 1, &["record.csv"]);
    let said = bench.run(&["discover"], "record.csv", "rig.toml").err;
    assert!(said.contains("channel displacement is the same from the first"), "{said}");
}

#[test]
fn what_is_no_file_is_refused_at_once() {
    let bench = Bench::new("record.csv", record(400).as_bytes(), RIG.as_bytes());
    let pipes = tempfile::tempdir().expect("a folder");
    let fifo = pipes.path().join("pipe").display().to_string();
    assert!(Command::new("mkfifo").arg(&fifo).status().expect("mkfifo").success());
    // An absolute path takes the place of the bench's folder.
    for (record, rig) in
        [(fifo.as_str(), "rig.toml"), ("record.csv", fifo.as_str()), (".", "rig.toml")]
    {
        bench.refused((record, rig), 4, &[]);
    }
    bench.refused(("record.csv", "."), 4, &["expected a rig file"]);
    bench.refused(("none.csv", "rig.toml"), 4, &["none.csv"]);
    bench.refused(("record.csv", "none.toml"), 4, &["none.toml"]);
}

#[test]
fn a_rig_file_that_is_none_is_refused() {
    rig_refused([0_u8, 159, 146, 150, 255], 4, &["rig.toml", "UTF-8"]);
    rig_refused("", 4, &["rig.toml"]);
    rig_refused(format!("{RIG}\n# {}", "x".repeat(3 << 20)), 4, &["rig.toml", "bytes"]);
    rig_refused("title = \u{1b}[31m\n", 4, &["rig.toml"]);
}

#[test]
fn what_a_rig_file_cannot_mean_is_refused_with_what_is_known() {
    rig_refused(RIG.replace("inertia", "inertai"), 4, &["inertai", "inertia"]);
    rig_refused(RIG.replace("\"axis\"", "\"ax\u{0007}is\""), 4, &["rig.toml"]);
    rig_refused(RIG.replace("\"axis\"", "\"lever\""), 4, &["lever", "axis", "drum"]);
    rig_refused(RIG.replace("\"coulomb\"", "\"coulom\""), 4, &["coulom", "coulomb", "lugre"]);
    rig_refused(RIG.replace("free = [\"f_c\"]", "free = [\"f_d\"]"), 4, &["f_d", "f_c"]);
    let unit = RIG.replace("\"x\"", "{ column = \"x\", unit = \"V\" }");
    rig_refused(unit, 4, &["rig.toml", "V"]);
}

#[test]
fn a_rig_that_does_not_fit_its_record_is_refused_with_the_columns_there_are() {
    rig_refused(RIG.replace("\"x\"", "\"y\""), 1, &["record.csv", "`y`", "`t`, `F`, `x`"]);
}

#[test]
fn a_model_that_cannot_be_simulated_ends_in_words() {
    let stiff = RIG.replace("inertia = 1.0", "inertia = 1e-59");
    let bench = Bench::new("record.csv", record(400).as_bytes(), stiff.as_bytes());
    for command in [&["fit", "--quick", "--window", "100"][..], &["simulate"], &["discover"]] {
        let ran = bench.run(command, "record.csv", "rig.toml");
        assert_eq!(ran.code, Some(4), "{command:?}: {ran:?}");
        let words = ["record.csv", "cannot be simulated"];
        assert!(words.iter().all(|word| ran.err.contains(word)), "{command:?}: {ran:?}");
    }
    assert!(bench.project.files("out").is_empty(), "something stands in --out");
}

#[test]
fn nothing_free_is_said_with_what_to_do() {
    let none = RIG.replace("name = \"coulomb\"\nf_c = 1.0", "name = \"none\"");
    let rig = none.replace("free = [\"f_c\"]", "free = []");
    let bench = Bench::new("record.csv", record(400).as_bytes(), rig.as_bytes());
    let ran = bench.run(&["fit"], "record.csv", "rig.toml");
    assert_eq!(ran.code, Some(4), "{ran:?}");
    assert!(ran.err.contains("free = ["), "{ran:?}");
}

#[test]
fn text_of_record_and_rig_is_shown_and_never_obeyed() {
    let header = "\u{1b}[31mx\u{202e}<script>alert(1)</script>";
    let text = record(400).replace("t,F,x", &format!("t,F,{header}"));
    // The column asked for is not there: the error lists those that are.
    let bench = Bench::new("record.csv", text.as_bytes(), RIG.as_bytes());
    bench.refused(("record.csv", "rig.toml"), 1, &["record.csv", "<script>"]);
    let text = record(1000).replace("t,F,x", &format!("t,F,{header}"));
    let title = "*/ int x; /* </title><script>alert(1)</script>\\u001b[31m\\u202e";
    let rig = RIG
        .replace("bench", title)
        .replace("\"x\"", "\"\\u001b[31mx\\u202e<script>alert(1)</script>\"");
    let bench = Bench::new("record.csv", text.as_bytes(), rig.as_bytes());
    for command in &COMMANDS[..4] {
        let ran = bench.run(command, "record.csv", "rig.toml");
        assert_eq!(ran.code, Some(0), "{command:?}: {ran:?}");
        assert!(!format!("{}{}", ran.out, ran.err).contains(controls), "{command:?}: {ran:?}");
    }
    for (path, bytes) in bench.project.files("out") {
        let text = String::from_utf8(bytes).expect("text");
        let is = |kind: &str| path.extension().is_some_and(|e| e == kind);
        // The rig file keeps its title as it is, in a string where nothing stands that TOML forbids.
        let data = is("toml");
        let turned = |line: &&str| line.contains(controls) && !(data && line.contains('\u{202e}'));
        let control = text.lines().find(turned);
        assert_eq!(control, None, "a character that controls in {}", path.display());
        if is("html") {
            assert!(!text.contains("<script"), "a script in {}", path.display());
            assert!(text.contains("&lt;script&gt;"), "no title in {}", path.display());
        }
    }
    assert_eq!(bench.project.files("in"), bench.before, "the input changed");
}

#[test]
fn a_wrong_flag_is_a_wrong_use() {
    let bench = Bench::new("record.csv", record(400).as_bytes(), RIG.as_bytes());
    for flags in [
        &["fit", "--window", "-1"][..],
        &["fit", "--method", "magic"],
        &["simulate", "--windoww"],
        &["discover", "--seed", "-1"],
    ] {
        let ran = bench.run(flags, "record.csv", "rig.toml");
        assert_eq!(ran.code, Some(2), "{flags:?}: {ran:?}");
    }
}
