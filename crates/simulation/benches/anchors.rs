//! The anchors timed: the one program here that has a clock, that of its thread's CPU time.
//!
//! `anchors [P1 …] [--quick] [--refs DIR]`, started by `cargo xtask bench anchors`, writes JSON, a line for
//! each thing it has to tell: how it was built, the references, the rows, what went wrong.

use cpu_time::{ProcessTime, ThreadTime};
use integrate::Limits;
use serde_json::{Value, json};
use simulation::anchors::{
    Anchor, Answer, Contest, PROBLEMS, RTOLS, Timing, anchors, answer, error, run, table,
};
use std::{
    error::Error,
    fs,
    io::Write,
    path::{Path, PathBuf},
    process::ExitCode,
};

fn main() -> ExitCode {
    // A solver that panics is a row of the table.
    std::panic::set_hook(Box::new(|_| ()));
    match all() {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failed { code, words }) => {
            let _ = tell(&json!({ "wrong": words }));
            ExitCode::from(code)
        }
    }
}

/// What went wrong, and the code to end with.
struct Failed {
    code: u8,
    words: String,
}

/// A table that cannot be read, or is another's.
const INPUT: u8 = 4;

/// Our own mistake.
const BUG: u8 = 70;

impl<E: Error> From<E> for Failed {
    fn from(error: E) -> Self {
        Failed { code: BUG, words: error.to_string() }
    }
}

/// What was asked for.
#[derive(Default)]
struct Asked {
    problems: Vec<String>,
    quick: bool,
    refs: Option<PathBuf>,
}

fn asked() -> Result<Asked, Failed> {
    let mut asked = Asked::default();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            // Cargo adds it.
            "--bench" => {}
            "--quick" => asked.quick = true,
            "--refs" => asked.refs = arguments.next().map(PathBuf::from),
            name if PROBLEMS.contains(&name) => asked.problems.push(name.to_owned()),
            other => {
                let words = format!("{other} is neither a problem nor a flag");
                return Err(Failed { code: BUG, words });
            }
        }
    }
    Ok(asked)
}

fn all() -> Result<(), Failed> {
    let asked = asked()?;
    tell(
        &json!({ "built": { "target_features": features(), "optimised": !cfg!(debug_assertions) } }),
    )?;
    let (process, start) = (ProcessTime::try_now()?, ThreadTime::try_now()?);
    let mut clock = || start.elapsed().as_secs_f64();
    let wanted = |anchor: &Anchor| {
        asked.problems.is_empty() || asked.problems.iter().any(|p| p == anchor.problem)
    };
    // A table that cannot be read is told before minutes are spent.
    let mut chosen = Vec::new();
    for anchor in anchors()?.into_iter().filter(wanted) {
        let read = asked.refs.as_ref().map(|refs| read(&anchor, refs)).transpose()?;
        chosen.push((anchor, read.flatten()));
    }
    for (anchor, read) in chosen {
        let reference = reference(&anchor, read)?;
        for row in run(&anchor, &reference.values, &contest(&anchor, asked.quick), &mut clock)? {
            tell(&json!({ "row": row }))?;
        }
    }
    alone(process.elapsed().as_secs_f64(), clock())
}

/// Refuses a run whose methods worked on other threads too: this thread's clock did not see it.
fn alone(process_s: f64, thread_s: f64) -> Result<(), Failed> {
    if process_s <= 1.02 * thread_s + 0.1 {
        return Ok(());
    }
    let words =
        format!("{process_s} s of CPU in all, {thread_s} s of this thread: expected the same");
    Err(Failed { code: BUG, words })
}

/// The table of an anchor in the folder, if there is one.
fn read(anchor: &Anchor, refs: &Path) -> Result<Option<Answer>, Failed> {
    let name = format!("{}_{}.txt", anchor.problem, anchor.parameter.unwrap_or(0.0));
    let path = refs.join(name);
    if !path.is_file() {
        return Ok(None);
    }
    let refuse = |why: String| Failed { code: INPUT, words: format!("{}: {why}", path.display()) };
    let text = fs::read_to_string(&path).map_err(|why| refuse(why.to_string()))?;
    table(anchor, &text).map(Some).map_err(|why| refuse(why.to_string()))
}

/// The reference of an anchor: the table if there is one, else our own; how far both are apart is told.
fn reference(anchor: &Anchor, read: Option<Answer>) -> Result<Answer, Failed> {
    let ours = answer(anchor)?;
    let apart = read.as_ref().map(|read| error(&ours.values, &read.values));
    tell(&json!({ "reference": {
        "problem": anchor.problem, "parameter": anchor.parameter, "way": ours.way, "error": ours.error,
        "table": read.is_some(), "apart": apart,
    }}))?;
    Ok(read.unwrap_or(ours))
}

/// What is asked of all on this anchor. Under an imposed motion a run that needs more than a million
/// evaluations for three periods has lost; an explicit method on a stiff plant needs several.
fn contest(anchor: &Anchor, quick: bool) -> Contest {
    let evaluations = match (anchor.task.plant.is_some(), quick) {
        (false, true) => 200_000,
        (true, false) => 5_000_000,
        _ => 1_000_000,
    };
    let timing = if quick {
        Timing { least: 1, most: 7, share_s: 0.005, batch_s: 1e-4 }
    } else {
        Timing { least: 5, most: 31, share_s: 0.1, batch_s: 2e-4 }
    };
    let every = if quick { 2 } else { 1 };
    let rtols = RTOLS.into_iter().step_by(every).collect();
    Contest { rtols, limits: Limits { evaluations }, timing }
}

fn tell(what: &Value) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{what}")?;
    out.flush()
}

/// The features of the processor that the compiler was allowed to use, of those that matter here.
fn features() -> Vec<&'static str> {
    let known = [
        ("sse4.2", cfg!(target_feature = "sse4.2")),
        ("avx", cfg!(target_feature = "avx")),
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("avx512f", cfg!(target_feature = "avx512f")),
        ("neon", cfg!(target_feature = "neon")),
        ("sve", cfg!(target_feature = "sve")),
    ];
    known.into_iter().filter(|(_, there)| *there).map(|(name, _)| name).collect()
}
