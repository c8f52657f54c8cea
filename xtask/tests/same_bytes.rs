//! The same bytes: on any number of threads, in a second run, from another folder, after `kill -9`.

mod common;

use common::{Project, REAL, difference};
use std::{
    fs,
    path::PathBuf,
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

const QUICK: &str = "target/duhem/quick";

fn project() -> Project {
    Project::new(&[("dahl-gamma-sweep.toml", REAL)])
}

fn quick(project: &Project, more: &[&str]) {
    let ran = project.run(&[&["reproduce", "--quick"], more].concat());
    assert_eq!(ran.code, Some(0), "{more:?}: {ran:?}");
}

#[test]
fn threads_and_folders_and_second_runs_change_no_byte() {
    let one = project();
    quick(&one, &["--threads", "1"]);
    let expected = one.files(QUICK);
    assert!(expected.len() > 20, "only {} files", expected.len());
    quick(&one, &["--threads", "2"]);
    assert_eq!(difference(&expected, &one.files(QUICK)), None, "a second run, from its records");
    for threads in ["2", "8"] {
        let other = project();
        quick(&other, &["--threads", threads]);
        assert_eq!(difference(&expected, &other.files(QUICK)), None, "{threads} threads");
    }
    let mut inside = one.command(&["reproduce", "--quick", "--fresh"]);
    let status = inside.current_dir(one.path().join("experiments")).stdout(Stdio::null()).status();
    assert!(status.expect("the built program").success());
    assert_eq!(difference(&expected, &one.files(QUICK)), None, "from another folder, afresh");
}

#[test]
fn a_run_killed_at_any_moment_is_simply_started_again() {
    let whole = project();
    let start = now();
    quick(&whole, &[]);
    let length = start.elapsed();
    let expected = whole.files(QUICK);
    // The moments are spread over the run and a little beyond by a fixed sequence, so that a failure comes back.
    let mut random = 2_463_534_242_u32;
    let mut in_flight = 0;
    for round in 0..20 {
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        let moment = length.mul_f64(1.05 * f64::from(random) / f64::from(u32::MAX));
        let project = project();
        let mut child = project
            .command(&["reproduce", "--quick"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the built program");
        thread::sleep(moment);
        child.kill().expect("SIGKILL");
        child.wait().expect("an end");
        let left = project.files("target/duhem/records").len();
        let written = project.files(QUICK).len();
        in_flight += usize::from(left > 0 && written < expected.len());
        quick(&project, &[]);
        let found = difference(&expected, &project.files(QUICK));
        assert_eq!(found, None, "round {round}: killed after {moment:?} with {left} records");
    }
    assert!(in_flight > 0, "no run was killed in flight: the test proved nothing");
}

#[test]
fn a_damaged_record_is_found_and_made_again() {
    let project = project();
    quick(&project, &[]);
    let expected = project.files(QUICK);
    let records: Vec<_> = project.files("target/duhem/records").into_keys().collect();
    let damage: [&dyn Fn(Vec<u8>) -> Vec<u8>; 3] = [
        &|mut bytes| {
            let middle = bytes.len() / 2;
            bytes[middle] ^= 1;
            bytes
        },
        &|bytes| bytes[..bytes.len() - 3].to_vec(),
        &|_| Vec::new(),
    ];
    for (record, damage) in records.iter().zip(damage) {
        let path = project.path().join(record);
        fs::write(&path, damage(fs::read(&path).unwrap())).unwrap();
    }
    let ran = project.run(&["reproduce", "--quick", "--explain"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(ran.err.matches("is damaged").count(), 3, "{}", ran.err);
    assert_eq!(ran.err.matches(": reused").count(), records.len() - 3);
    assert_eq!(difference(&expected, &project.files(QUICK)), None);
}

#[test]
fn explain_and_fresh_say_and_do_what_they_say() {
    let project = Project::new(&[("small.toml", &common::small("\"rk4\""))]);
    let explained =
        |arguments: &[&str]| project.run(&[&["reproduce", "--explain"], arguments].concat()).err;
    assert_eq!(explained(&[]).matches(": ran: no record").count(), 4);
    assert_eq!(explained(&[]).matches(": reused").count(), 4);
    assert_eq!(explained(&["--fresh"]).matches(": ran: records are ignored").count(), 4);
    let toml = project.path().join("experiments/small.toml");
    let text = fs::read_to_string(&toml).unwrap().replace("sigma = 1.5", "sigma = 1.6");
    fs::write(&toml, text).unwrap();
    assert_eq!(
        explained(&[]).matches(": ran: no record").count(),
        4,
        "another stiffness is another case"
    );
}

#[test]
fn check_passes_on_what_was_committed_and_fails_on_any_change() {
    let project = Project::new(&[("small.toml", &common::small("\"rk4\", \"dopri5\""))]);
    assert_eq!(project.run(&["reproduce", "--check"]).code, Some(1), "nothing is committed yet");
    assert!(project.files("reports").is_empty(), "--check writes nothing");
    assert_eq!(project.run(&["reproduce"]).code, Some(0));
    let ran = project.run(&["reproduce", "--check"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let committed = project.files("reports");
    for (file, from, to) in [
        ("reports/small/cases.csv", ",solved,", ",diverged,"),
        ("reports/index.html", "small", "smail"),
        ("reports/small/studies.csv", "dahl", "dohl"),
    ] {
        let path = project.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{file} has no `{from}`");
        fs::write(&path, text.replacen(from, to, 1)).unwrap();
        let ran = project.run(&["reproduce", "--check"]);
        assert_eq!(ran.code, Some(1), "{file}: {ran:?}");
        assert!(ran.err.contains(file), "{}", ran.err);
        fs::write(&path, text).unwrap();
    }
    assert_eq!(difference(&committed, &project.files("reports")), None, "--check wrote something");
}

#[expect(clippy::disallowed_methods, reason = "how long the run takes decides when to kill it")]
fn now() -> Instant {
    Instant::now()
}

#[test]
fn an_interrupted_run_ends_with_5_and_is_simply_started_again() {
    let whole = project();
    quick(&whole, &[]);
    let expected = whole.files(QUICK);
    let project = project();
    let mut child = project
        .command(&["reproduce", "--quick", "--threads", "1"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the built program");
    // Not before the first record: the program has to be listening. Only names are asked for: what it writes is under another
    // one until it is whole, which may be gone before it can be opened.
    let has_a_record = || {
        let below = |folder: PathBuf| {
            fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path())
        };
        let records = project.path().join("target/duhem/records");
        below(records)
            .flat_map(below)
            .any(|path| path.extension().is_some_and(|ending| ending == "json"))
    };
    while !has_a_record() {
        assert_eq!(child.try_wait().unwrap(), None, "it ended before it wrote a record");
        thread::sleep(Duration::from_millis(5));
    }
    let sent = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status();
    assert!(sent.expect("a shell").success());
    let status = child.wait().expect("an end");
    assert_eq!(status.code(), Some(5));
    assert!(!project.files("target/duhem/records").is_empty());
    assert!(project.files(QUICK).is_empty(), "a report was written for half a run");
    quick(&project, &[]);
    assert_eq!(difference(&expected, &project.files(QUICK)), None);
}

#[test]
fn tables_that_cannot_be_read_any_more_are_written_again() {
    // As after a change of a table's columns: what is made anew need not be read.
    let project = Project::new(&[("small.toml", &common::small("\"rk4\""))]);
    assert_eq!(project.run(&["reproduce"]).code, Some(0));
    let committed = project.files("reports");
    for file in ["cases.csv", "figures.csv"] {
        let path = project.path().join("reports/small").join(file);
        let text = fs::read_to_string(&path).unwrap().replacen("study", "stud", 1);
        fs::write(&path, text).unwrap();
        let ran = project.run(&["reproduce"]);
        assert_eq!(ran.code, Some(0), "{file}: {ran:?}");
        assert_eq!(difference(&committed, &project.files("reports")), None, "{file}");
    }
}

#[test]
fn a_figure_that_is_drawn_no_more_is_removed_and_other_files_are_not() {
    let project = Project::new(&[("small.toml", &common::small("\"rk4\""))]);
    assert_eq!(project.run(&["reproduce"]).code, Some(0));
    fs::write(project.path().join("reports/small/notes.md"), "mine").unwrap();
    let toml = project.path().join("experiments/small.toml");
    let text = fs::read_to_string(&toml).unwrap().replace("= \"work\"", "= \"effort\"");
    fs::write(&toml, text).unwrap();
    assert_eq!(project.run(&["reproduce"]).code, Some(0));
    let there = |name: &str| project.path().join("reports/small").join(name).is_file();
    assert!(there("effort.svg") && there("effort.csv") && there("notes.md"));
    assert!(!there("work.svg") && !there("work.csv"), "the old figure is still there");
}
