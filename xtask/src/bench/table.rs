//! The rows in words: per problem the cheapest run at each delivered error, and who was wrong in silence.

use crate::saved::{Reference, Saved};
use simulation::anchors::Row;
use std::fmt::Write;

/// The delivered errors at which times are compared.
const ERRORS: [f64; 3] = [1e-3, 1e-6, 1e-8];

/// Silent failures named per problem; the rest are counted.
const NAMED: usize = 8;

/// The whole run in words.
pub(super) fn text(run: &Saved) -> String {
    let mut text = built(run);
    let mut problems: Vec<(&str, Option<f64>)> = Vec::new();
    for row in &run.rows {
        let problem = (row.problem.as_str(), row.parameter);
        if !problems.contains(&problem) {
            problems.push(problem);
        }
    }
    for (problem, parameter) in problems {
        let of = |name: &str, value: Option<f64>| name == problem && value == parameter;
        let rows: Vec<&Row> =
            run.rows.iter().filter(|row| of(&row.problem, row.parameter)).collect();
        let reference = run.references.iter().find(|r| of(&r.problem, r.parameter));
        let symbol = if problem == "P2" { "ω" } else { "γ" };
        let title = parameter.map_or(String::new(), |value| format!(", {symbol} = {value}"));
        let _ = writeln!(text, "\n{problem}{title}");
        if let Some(reference) = reference {
            let _ = writeln!(text, "  judged by {}", judged_by(reference));
        }
        section(&mut text, &rows);
    }
    text
}

fn built(run: &Saved) -> String {
    let machine = &run.machine;
    let native = if machine.native { "for this processor" } else { "portable" };
    let libraries: Vec<String> =
        run.libraries.iter().map(|(name, version)| format!("{name} {version}")).collect();
    let patch = run.patch.as_ref().map_or(String::new(), |patch| {
        let sources = patch.sources.get(..12).unwrap_or(&patch.sources);
        format!("; {} from CHANGED sources {sources}", patch.library)
    });
    format!(
        "{}, one thread; {}, built {native} ({}); {}{patch}\n",
        machine.processor,
        machine.rustc,
        machine.target_features.join(" "),
        libraries.join(", ")
    )
}

fn judged_by(reference: &Reference) -> String {
    let bound = |error: Option<f64>| error.map_or("?".to_owned(), |error| format!("{error:.0e}"));
    if reference.table {
        format!("a table; ours ({}) is {} from it", reference.way, bound(reference.apart))
    } else {
        format!("{}, right to {}", reference.way, bound(reference.error))
    }
}

fn section(text: &mut String, rows: &[&Row]) {
    let _ = writeln!(text, "  error ≤  {:<44}{:<44}ratio", "ours", "best library");
    for error in ERRORS {
        let best = |ours: bool| cheapest(rows, ours, error);
        let (ours, library) = (best(true), best(false));
        let ratio =
            ours.zip(library).and_then(|(ours, library)| Some(library.cpu_s? / ours.cpu_s?));
        let ratio = ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}"));
        let [ours, library] = [ours, library].map(|row| row.map_or("none".to_owned(), told));
        let _ = writeln!(text, "  {error:<8.0e} {ours:<44}{library:<44}{ratio}");
    }
    let mut silent: Vec<&&Row> = rows.iter().filter(|row| row.silent_failure()).collect();
    let error = |row: &Row| row.error.unwrap_or(f64::INFINITY);
    silent.sort_by(|a, b| error(b).total_cmp(&error(a)));
    let failed = rows.iter().filter(|row| row.status != simulation::anchors::SOLVED).count();
    let _ = writeln!(
        text,
        "  {} rows: {failed} failed and said so, {} solved and wrong{}",
        rows.len(),
        silent.len(),
        if silent.is_empty() { "" } else { ":" }
    );
    for row in silent.iter().take(NAMED) {
        let error = row.error.map_or("not a number".to_owned(), |error| format!("{error:.1e}"));
        let _ = writeln!(text, "    {} {}: error {error}", row.solver, asked(row));
    }
    if silent.len() > NAMED {
        let _ = writeln!(text, "    and {} more", silent.len() - NAMED);
    }
}

/// The row that takes least time of those whose error is no more than this.
fn cheapest<'a>(rows: &[&'a Row], ours: bool, error: f64) -> Option<&'a Row> {
    let reach = |row: &&&Row| {
        row.ours == ours && row.cpu_s.is_some() && row.error.is_some_and(|e| e <= error)
    };
    let time = |row: &Row| row.cpu_s.unwrap_or(f64::INFINITY);
    let reached = rows.iter().filter(reach).copied();
    reached.min_by(|a, b| time(a).total_cmp(&time(b)))
}

fn told(row: &Row) -> String {
    let time = row.cpu_s.map_or("–".to_owned(), seconds);
    format!("{} {} {time}", row.solver, asked(row))
}

fn asked(row: &Row) -> String {
    let restart = if row.restart && !row.ours { " restart" } else { "" };
    row.control.map_or("exact".to_owned(), |control| format!("{:.0e}{restart}", control.rtol))
}

/// A time in the unit that suits it.
pub(super) fn seconds(time: f64) -> String {
    match time {
        t if t < 1e-3 => format!("{} µs", Three(1e6 * t)),
        t if t < 1.0 => format!("{} ms", Three(1e3 * t)),
        t => format!("{} s", Three(t)),
    }
}

/// Three digits of a number from 0.1 to 1000.
struct Three(f64);

impl std::fmt::Display for Three {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let decimals = match self.0 {
            v if v >= 100.0 => 0,
            v if v >= 10.0 => 1,
            _ => 2,
        };
        write!(f, "{:.decimals$}", self.0)
    }
}
