//! `cargo xtask reproduce`: run, write, render; or check that nothing committed would change.

use crate::{
    claims,
    cli::ReproduceArgs,
    exit::{Exit, Failure},
    list, output,
    progress::Line,
    root, screen,
};
use experiment::{Drift, Finished, Options, Plan, WATCHDOG, Why, drift, run, summary};
use record::{CaseRow, Key, Store, Summary, write_whole};
use serde_json::json;
use std::{
    fs,
    path::Path,
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
    let (mut found, mut given_up) = (Vec::new(), 0);
    for plan in &plans {
        let finished = run_one(root, plan, arguments)?;
        given_up += finished.iter().filter(|f| f.record.row.status == WATCHDOG).count();
        found.push(summary(plan, &finished)?);
    }
    if arguments.check {
        for tables in &found {
            moved.extend(run_again(&reports, tables)?);
        }
        return Ok(verdict(&moved, given_up, arguments.json));
    }
    write(root, &reports, &found)?;
    claims::print(&found, arguments.json, screen::short);
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
        // A check that reuses what an earlier run computed checks nothing.
        fresh: arguments.fresh || arguments.check,
        threads: arguments.threads.map_or_else(processors, usize::from),
        watchdog: Duration::from_secs_f64(arguments.watchdog),
        stop: &STOP,
    };
    let line = Line::new(&plan.name);
    let finished = run(plan, &options, &|progress| line.tell(progress))?;
    drop(line);
    if arguments.explain {
        let fits = plan.fits.iter().filter_map(|fit| Some((fit, fit.done()?)));
        for (fit, done) in fits {
            output::note(&explain(&format!("fit {}", fit.name), (&done.key, &done.why)));
        }
        let searches = plan.discoveries.iter().filter_map(|search| Some((search, search.done()?)));
        for (search, done) in searches {
            output::note(&explain(&format!("search {}", search.name), (&done.key, &done.why)));
        }
        for case in &finished {
            output::note(&explain(&name(&case.record.row), (&case.key, &case.why)));
        }
    }
    Ok(finished)
}

fn explain(name: &str, (key, why): (&Key, &Why)) -> String {
    let key = &key.as_str()[..12];
    let why = match why {
        Why::Reused => format!("reused: record {key} holds it"),
        Why::New => format!(
            "ran: no record {key} (it never ran, or its parameters, our sources or a dependency changed)"
        ),
        Why::Damaged(how) => format!("ran: record {key} is damaged: {how}"),
        Why::Fresh => "ran: records are ignored (--fresh)".to_owned(),
    };
    format!("{name}: {why}")
}

fn name(row: &CaseRow) -> String {
    let words = [&row.study, &row.point, &row.solver, &row.control];
    let words: Vec<&str> =
        words.into_iter().map(String::as_str).filter(|w| !w.is_empty()).collect();
    format!("{} {:e} {}", words.join(" "), row.value, row.corners)
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
    let experiments = root::experiments(root)?;
    for path in files(reports) {
        let ours = outputs.iter().any(|o| o.path == path)
            || path.split_once('/').is_some_and(|(name, file)| {
                Summary::FILES.contains(&file) && experiments.iter().any(|e| e == name)
            });
        if !ours {
            moved.push(format!("reports/{path}: nothing writes it"));
        }
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

fn verdict(moved: &[String], given_up: usize, as_json: bool) -> Exit {
    let passed = moved.is_empty() && given_up == 0;
    if as_json {
        let told = json!({ "format": record::FORMAT, "passed": passed, "moved": moved, "given_up": given_up });
        output::line(&format!("{told:#}"));
    } else {
        for line in moved.iter().take(MOST_DRIFTS) {
            output::note(line);
        }
        if moved.len() > MOST_DRIFTS {
            output::note(&format!("… and {} more", moved.len() - MOST_DRIFTS));
        }
    }
    if given_up > 0 {
        output::note(&format!("{given_up} cases were given up by the watchdog"));
    }
    if passed {
        output::note("check: nothing committed would change");
        return Exit::Done;
    }
    output::error(&format!(
        "{} committed things would change; if that is meant, run `cargo xtask reproduce` and commit reports/",
        moved.len()
    ));
    Exit::CheckFailed
}

/// Renders everything, then writes what changed; figures of ours that nothing draws any more are removed.
fn write(root: &Path, reports: &Path, found: &[Summary]) -> Result<(), Failure> {
    let mut all = found.to_vec();
    for name in root::experiments(root)? {
        if !found.iter().any(|new| new.name == name) {
            all.extend(claims::committed_one(reports, &name)?);
        }
    }
    all.sort_by(|a, b| a.name.cmp(&b.name));
    let outputs = report::render(&all)?;
    // Old tables that cannot be read any more name no figures, and are about to be replaced.
    let old: Vec<Summary> =
        found.iter().filter_map(|new| Summary::read(&reports.join(&new.name)).ok()).collect();
    for tables in found {
        for (file, bytes) in tables.files() {
            write_whole(&reports.join(&tables.name).join(file), &bytes)?;
        }
    }
    for output in &outputs {
        write_whole(&reports.join(&output.path), &output.bytes)?;
    }
    let drawn = old.iter().flat_map(|tables| {
        let file = |figure: &str, kind| format!("{}/{figure}.{kind}", tables.name);
        tables.figures.iter().flat_map(move |f| [file(&f.figure, "svg"), file(&f.figure, "csv")])
    });
    for path in drawn.filter(|path| !outputs.iter().any(|o| o.path == *path)) {
        if reports.join(&path).is_file() {
            fs::remove_file(reports.join(&path)).map_err(Failure::environment)?;
        }
    }
    Ok(())
}

/// Every file below a folder, by its path in it with `/`, sorted.
fn files(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            found.extend(files(&entry.path()).into_iter().map(|inner| format!("{name}/{inner}")));
        } else {
            found.push(name);
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
