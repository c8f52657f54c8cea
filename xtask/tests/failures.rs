//! A solver that fails leaves the others alone and appears in the report.

mod common;

use common::{Project, small};
use std::fs;

fn cases(project: &Project) -> Vec<String> {
    let text =
        fs::read_to_string(project.path().join("reports/faults/cases.csv")).expect("the cases");
    text.lines().skip(1).map(ToOwned::to_owned).collect()
}

fn page(project: &Project) -> String {
    fs::read_to_string(project.path().join("reports/index.html")).expect("the page")
}

#[test]
fn solvers_that_fail_are_rows_and_leave_the_others_alone() {
    let faulty = ["faulty-diverges", "faulty-nan", "faulty-panics", "faulty-calls-forever"];
    let list = faulty.map(|name| format!("\"{name}\"")).join(", ");
    let toml = small(&format!("{list}, \"rk4\", \"dopri5\""));
    let project = Project::new(&[("faults.toml", &toml)]);
    let ran = project.run(&["reproduce"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(!ran.err.contains("panicked"), "a solver's panic reached the terminal: {}", ran.err);
    let rows = cases(&project);
    for (solver, status) in
        faulty.iter().zip(["diverged", "not finite", "panicked", "too many evaluations"])
    {
        let of = |row: &&String| row.split(',').any(|cell| cell == *solver);
        let theirs: Vec<_> = rows.iter().filter(of).collect();
        assert!(
            !theirs.is_empty() && theirs.iter().all(|row| row.contains(status)),
            "{solver}: {theirs:?}"
        );
        assert!(page(&project).contains(solver), "{solver} is not in the report");
        assert!(page(&project).contains(status), "{status} is not in the report");
    }
    for solver in ["rk4", "dopri5"] {
        let theirs: Vec<_> =
            rows.iter().filter(|row| row.split(',').any(|c| c == solver)).collect();
        assert_eq!(theirs.len(), 4, "{solver}");
        assert!(theirs.iter().all(|row| row.contains("solved")), "{theirs:?}");
    }
}

#[test]
fn a_solver_that_never_calls_back_is_given_up_and_never_stored() {
    let toml = small("\"rk4\", \"faulty-never-calls-back\"");
    let project = Project::new(&[("faults.toml", &toml)]);
    let ran = project.run(&["reproduce", "--watchdog", "2"]);
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(ran.err.contains("watchdog"), "{}", ran.err);
    let rows = cases(&project);
    let given_up = rows.iter().filter(|row| row.contains("watchdog")).count();
    let solved = rows.iter().filter(|row| row.contains("solved")).count();
    assert_eq!((given_up, solved), (rows.len() - 4, 4), "{rows:?}");
    assert!(page(&project).contains("watchdog"));
    assert_eq!(project.files("target/duhem/records").len(), 4, "only what was solved is stored");
}

#[test]
fn a_full_disk_is_an_error_of_the_environment_and_not_a_crash() {
    let project = Project::new(&[("small.toml", &small("\"rk4\""))]);
    let ran = project.run(&["reproduce", "--store", "/dev/null/store"]);
    assert_eq!(ran.code, Some(6), "{ran:?}");
    assert!(ran.err.contains("/dev/null/store"), "{}", ran.err);
}
