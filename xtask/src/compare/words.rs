//! A comparison in words, as a table for a pull request, and as JSON.

use super::{Comparison, ledger::Change, times::TimeChange};
use crate::{exit::Exit, saved::Saved};
use serde_json::{Value, json};
use std::fmt::Write;

/// The lines of each kind that are shown; the rest are counted.
const SHOWN: usize = 20;

/// In words.
pub(super) fn text(c: &Comparison<'_>) -> String {
    let mut text = String::new();
    for why in &c.apart {
        let _ = writeln!(text, "not the same {why}");
    }
    if !c.apart.is_empty() {
        text.push_str(
            "what follows is told and fails nothing, since counts differ with last bits\n",
        );
    }
    for run in [c.a, c.b].into_iter().filter_map(patch) {
        let _ = writeln!(text, "{run}");
    }
    let lines = |worse: bool| {
        let of = c.rows.iter().filter(move |change| change.worse == worse);
        of.map(|change| format!("{}: {}", change.key, change.what.join(", "))).collect::<Vec<_>>()
    };
    section(&mut text, "worse", &lines(true));
    section(&mut text, "changed", &lines(false));
    if let Some(times) = &c.times {
        section(&mut text, "slower", &chosen(times, TimeChange::slower));
        section(&mut text, "faster", &chosen(times, TimeChange::faster));
    }
    section(&mut text, "claims", &ids(&c.claims));
    section(&mut text, "measures", &ids(&c.measures));
    for (rows, run) in c.alone.iter().zip(["first", "second"]) {
        if !rows.is_empty() {
            let _ = writeln!(text, "{} rows stand in the {run} run only", rows.len());
        }
    }
    let _ = writeln!(text, "{}", verdict(c));
    text
}

fn patch(run: &Saved) -> Option<String> {
    let patch = run.patch.as_ref()?;
    let sources = patch.sources.get(..12).unwrap_or(&patch.sources);
    Some(format!("built with a changed {} {}, sources {sources}", patch.library, patch.version))
}

fn section(text: &mut String, title: &str, lines: &[String]) {
    if lines.is_empty() {
        return;
    }
    let _ = writeln!(text, "{title} ({}):", lines.len());
    for line in lines.iter().take(SHOWN) {
        let _ = writeln!(text, "  {line}");
    }
    if lines.len() > SHOWN {
        let _ = writeln!(text, "  and {} more", lines.len() - SHOWN);
    }
}

fn ids(changes: &[Change]) -> Vec<String> {
    changes.iter().map(|change| format!("{}: {}", change.id, change.what)).collect()
}

fn chosen(times: &[TimeChange], of: fn(&TimeChange) -> bool) -> Vec<String> {
    let told = |t: &TimeChange| {
        format!("{}: {:.2} times ({:.2} to {:.2})", t.key, t.ratio, t.interval.0, t.interval.1)
    };
    times.iter().filter(|change| of(change)).map(told).collect()
}

/// All of it in one line.
fn verdict(c: &Comparison<'_>) -> String {
    let worse = c.regressions().count();
    let mut line = format!("{} rows compared: {worse} worse", c.shared);
    let _ = write!(line, ", {} otherwise changed", c.rows.len() - worse);
    if let Some(times) = &c.times {
        let faster = times.iter().filter(|change| change.faster()).count();
        let _ = write!(line, "; of {} timed, {} slower, {faster} faster", times.len(), c.slower());
    }
    let _ = write!(line, "; {} claims and {} measures changed", c.claims.len(), c.measures.len());
    line
}

/// As a table for a pull request.
pub(super) fn markdown(c: &Comparison<'_>, (a, b): (&str, &str)) -> String {
    let mut text = format!("**{}**\n\n", verdict(c));
    for why in &c.apart {
        let _ = writeln!(text, "Not the same {}: what follows fails nothing.\n", cell(why));
    }
    for run in [c.a, c.b].into_iter().filter_map(patch) {
        let _ = writeln!(text, "One is {}.\n", cell(&run));
    }
    if !c.rows.is_empty() {
        let (a, b) = (cell(a), cell(b));
        let _ = writeln!(text, "| row | evaluations `{a}` | `{b}` | error `{a}` | `{b}` | what |");
        text.push_str("|---|---:|---:|---:|---:|---|\n");
    }
    let mut rows: Vec<_> = c.rows.iter().collect();
    rows.sort_by_key(|change| !change.worse);
    for change in rows.iter().take(SHOWN) {
        let error = |at: usize| change.error[at].map_or("–".to_owned(), |e| format!("{e:.1e}"));
        let mark = if change.worse { "**worse**: " } else { "" };
        let (key, what) = (cell(&change.key), cell(&change.what.join(", ")));
        let [before, after] = change.work;
        let (first, second) = (error(0), error(1));
        let _ =
            writeln!(text, "| {key} | {before} | {after} | {first} | {second} | {mark}{what} |");
    }
    if rows.len() > SHOWN {
        let _ = writeln!(text, "\n… and {} rows more.", rows.len() - SHOWN);
    }
    timed(&mut text, c);
    for (title, changes) in [("claim", &c.claims), ("measure", &c.measures)] {
        if !changes.is_empty() {
            let _ = writeln!(text, "\n| {title} | what changed |\n|---|---|");
        }
        for change in changes {
            let _ = writeln!(text, "| `{}` | {} |", change.id, cell(&change.what));
        }
    }
    text
}

fn timed(text: &mut String, c: &Comparison<'_>) {
    let clear = |change: &&TimeChange| change.slower() || change.faster();
    let clear: Vec<_> = c.times.iter().flatten().filter(clear).collect();
    if !clear.is_empty() {
        text.push_str("\n| row | times as long | 99.9 % interval |\n|---|---:|---|\n");
    }
    for t in clear.iter().take(SHOWN) {
        let (key, (low, high)) = (cell(&t.key), t.interval);
        let _ = writeln!(text, "| {key} | {:.2} | {low:.2} to {high:.2} |", t.ratio);
    }
    if clear.len() > SHOWN {
        let _ = writeln!(text, "\n… and {} rows more.", clear.len() - SHOWN);
    }
}

/// A text that cannot leave its cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r', '`'], " ")
}

/// As JSON.
pub(super) fn json(c: &Comparison<'_>) -> Value {
    let rows = c.rows.iter().map(|change| {
        json!({
            "row": change.key, "worse": change.worse, "what": change.what,
            "evaluations": change.work, "error": change.error,
        })
    });
    let rows: Vec<Value> = rows.collect();
    let times = c.times.as_ref().map(|times| {
        let told = |t: &TimeChange| {
            json!({
                "row": t.key, "cpu_s": t.times, "ratio": t.ratio,
                "interval": [t.interval.0, t.interval.1], "slower": t.slower(), "faster": t.faster(),
            })
        };
        times.iter().map(told).collect::<Vec<_>>()
    });
    let changes = |changes: &[Change]| -> Vec<Value> {
        changes.iter().map(|c| json!({ "id": c.id, "what": c.what })).collect()
    };
    json!({
        "format": record::FORMAT, "regression": c.exit() == Exit::Regression, "not_the_same": c.apart,
        "compared": c.shared, "rows": rows, "only_in_first": c.alone[0], "only_in_second": c.alone[1],
        "times": times, "claims": changes(&c.claims), "measures": changes(&c.measures),
    })
}
