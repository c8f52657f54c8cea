//! `cargo xtask reproduce`: run, write, render; or check that nothing committed would change.

use crate::{
    claims,
    cli::ReproduceArgs,
    exit::{Exit, Failure},
    list, output,
    progress::Line,
    root,
};
use experiment::{Drift, Finished, Options, Plan, WATCHDOG, Why, drift, run, summary};
use record::{Store, Summary, write_whole};
use report::Output;
use std::{
    fs,
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};

/// Set by Ctrl-C.
static STOP: AtomicBool = AtomicBool::new(false);

/// The most differences `--check` prints; the rest is counted.
const MOST_DRIFTS: usize = 40;

/// Runs the experiments, writes their tables and the report, prints the claims.
pub(crate) fn reproduce(root: &Path, arguments: &ReproduceArgs) -> Result<Exit, Failure> {
    let names = root::chosen(root, &arguments.names)?;
    // All are read before the first one runs: a slip of the pen costs no time and writes nothing.
    let plans = names.iter().map(|name| {
        let plan = Plan::read(&root::toml(root, name), &list::kinds())?;
        Ok(Arc::new(if arguments.quick { plan.quick() } else { plan }))
    });
    let plans: Vec<Arc<Plan>> = plans.collect::<Result<_, Failure>>()?;
    stop_on_ctrl_c()?;
    let reports =
        if arguments.quick { root.join("target/duhem/quick") } else { root.join("reports") };
    let mut moved: Vec<String> =
        if arguments.check { rendered_again(root, &reports)? } else { vec![] };
    let (mut fresh, mut given_up) = (Vec::new(), 0);
    for plan in &plans {
        let finished = run_one(root, plan, arguments)?;
        given_up += finished.iter().filter(|f| f.record.row.status == WATCHDOG).count();
        let found = summary(plan, &finished)?;
        if arguments.check {
            moved.extend(run_again(&reports, &found)?);
        } else {
            for (file, bytes) in found.files() {
                write_whole(&reports.join(&plan.name).join(file), &bytes)?;
            }
        }
        fresh.push(found);
    }
    if arguments.check {
        return Ok(verdict(&moved, given_up));
    }
    write_report(root, &reports)?;
    claims::print(&fresh, arguments.json);
    if given_up > 0 {
        output::error(&format!(
            "{given_up} cases gave no answer and were given up by the watchdog"
        ));
        return Ok(Exit::CheckFailed);
    }
    Ok(Exit::Done)
}

fn run_one(
    root: &Path,
    plan: &Arc<Plan>,
    arguments: &ReproduceArgs,
) -> Result<Vec<Finished>, Failure> {
    let store = arguments.store.clone().unwrap_or_else(|| root.join("target/duhem/records"));
    let processors = || thread::available_parallelism().map_or(1, usize::from);
    let options = Options {
        store: Store::new(store),
        fresh: arguments.fresh,
        threads: arguments.threads.map_or_else(processors, usize::from),
        watchdog: Duration::from_secs_f64(arguments.watchdog),
        stop: &STOP,
    };
    let line = Line::new(&plan.name);
    let finished = run(plan, &options, &|progress| line.tell(progress))?;
    drop(line);
    if arguments.explain {
        for case in &finished {
            output::note(&explain(case));
        }
    }
    Ok(finished)
}

fn explain(case: &Finished) -> String {
    let row = &case.record.row;
    let key = &case.key.as_str()[..12];
    let why = match &case.why {
        Why::Reused => format!("reused: record {key} holds it"),
        Why::New => format!(
            "ran: no record {key} (it never ran, or its parameters, our sources or a dependency changed)"
        ),
        Why::Damaged(how) => format!("ran: record {key} is damaged: {how}"),
        Why::Fresh => "ran: records are ignored (--fresh)".to_owned(),
    };
    let words = [&row.study, &row.point, &row.solver, &row.control];
    let name: Vec<&str> = words.into_iter().map(String::as_str).filter(|w| !w.is_empty()).collect();
    format!("{} {:e} {}: {why}", name.join(" "), row.value, row.corners)
}

/// The first half of `--check`: the committed tables must give the committed report, byte for byte.
fn rendered_again(root: &Path, reports: &Path) -> Result<Vec<String>, Failure> {
    let outputs = report::render(&claims::committed(root, reports)?)?;
    let mut moved = Vec::new();
    for output in &outputs {
        let path = reports.join(&output.path);
        match fs::read(&path) {
            Ok(bytes) if bytes == output.bytes => {}
            Ok(_) => moved.push(format!("reports/{}: renders differently", output.path)),
            Err(_) => moved.push(format!("reports/{}: is missing", output.path)),
        }
    }
    for path in strangers(reports, &outputs) {
        let shown = path.strip_prefix(reports).unwrap_or(&path).display().to_string();
        moved.push(format!("reports/{shown}: nothing writes it"));
    }
    Ok(moved)
}

/// The second half: a new run must give the committed tables within each field's tolerance.
fn run_again(reports: &Path, found: &Summary) -> Result<Vec<String>, Failure> {
    let folder = reports.join(&found.name);
    if !folder.is_dir() {
        return Ok(vec![format!("reports/{}: is missing", found.name)]);
    }
    // What is compared went through CSV once, so this must, too.
    let moved: Vec<Drift> = drift(&Summary::read(&folder)?, found);
    Ok(moved.iter().map(|d| format!("reports/{}/{d}", found.name)).collect())
}

fn verdict(moved: &[String], given_up: usize) -> Exit {
    for line in moved.iter().take(MOST_DRIFTS) {
        output::note(line);
    }
    if moved.len() > MOST_DRIFTS {
        output::note(&format!("… and {} more", moved.len() - MOST_DRIFTS));
    }
    if given_up > 0 {
        output::note(&format!("{given_up} cases were given up by the watchdog"));
    }
    if moved.is_empty() && given_up == 0 {
        output::line("check: nothing committed would change");
        return Exit::Done;
    }
    output::error(&format!(
        "{} committed things would change; if that is meant, run `cargo xtask reproduce` and commit reports/",
        moved.len()
    ));
    Exit::CheckFailed
}

/// Renders the tables on disk and writes what changed; files of ours that nothing writes any more are removed.
fn write_report(root: &Path, reports: &Path) -> Result<(), Failure> {
    let outputs = report::render(&claims::committed(root, reports)?)?;
    for output in &outputs {
        write_whole(&reports.join(&output.path), &output.bytes)?;
    }
    for path in strangers(reports, &outputs) {
        fs::remove_file(&path).map_err(Failure::environment)?;
    }
    Ok(())
}

/// Files of the kinds we write, in folders we write, that are neither tables nor output.
fn strangers(reports: &Path, outputs: &[Output]) -> Vec<PathBuf> {
    let ours = |path: &Path| {
        let tail = path.strip_prefix(reports).unwrap_or(path).to_string_lossy().into_owned();
        let table = path.file_name().is_some_and(|n| Summary::FILES.iter().any(|f| n == *f));
        table || outputs.iter().any(|o| o.path == tail)
    };
    let kind =
        |path: &Path| path.extension().is_some_and(|e| e == "svg" || e == "csv" || e == "md");
    let mut found = Vec::new();
    for folder in fs::read_dir(reports).into_iter().flatten().flatten().map(|e| e.path()) {
        // Only folders that hold an experiment's tables are ours to clear.
        if !folder.join(Summary::FILES[0]).is_file() {
            continue;
        }
        for path in fs::read_dir(&folder).into_iter().flatten().flatten().map(|e| e.path()) {
            if kind(&path) && !ours(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Once: the cases in flight finish and are stored. Twice: at once.
fn stop_on_ctrl_c() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(Exit::Interrupted as u8));
        }
        output::note("\nfinishing the cases in flight; press Ctrl-C again to stop at once");
    })
    .map_err(Failure::environment)
}
