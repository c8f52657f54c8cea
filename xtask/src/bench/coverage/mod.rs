//! `cargo xtask bench coverage`: how often the intervals of fitted parameters hold the truth.

mod case;
mod tally;

use crate::{
    cli::CoverageArgs,
    exit::{Exit, Failure},
    output,
};
use case::{CASES, Case};
use cpu_time::ProcessTime;
use identify::fit::{Options, fit};
use record::write_whole;
use std::{ops::Range, path::Path, thread};
use tally::Score;

/// Where the table is kept, from the project's folder.
const TABLE: &str = "data/benchmarks/coverage.csv";

/// Fits records of known truth, counts, and judges the counts.
pub(super) fn run(root: &Path, arguments: &CoverageArgs) -> Result<Exit, Failure> {
    let known = CASES.map(|(name, _)| name);
    if let Some(unknown) = arguments.models.iter().find(|m| !known.contains(&m.as_str())) {
        let known = known.join(", ");
        return Err(Failure::usage(format!("--models: no case is called `{unknown}`: {known}")));
    }
    let processors = || thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.map_or_else(processors, usize::from);
    let mut scores = Vec::new();
    for case in CASES {
        if !arguments.models.is_empty() && !arguments.models.iter().any(|m| m == case.0) {
            continue;
        }
        let score = score(&Case::new(case)?, arguments, threads)?;
        if !arguments.json {
            output::line(score.words().trim_end());
        }
        scores.push(score);
    }
    if arguments.json {
        output::line(&format!("{:#}", tally::json(&scores, arguments.seed)));
    }
    if arguments.save {
        let command = format!(
            "cargo xtask bench coverage --records {} --seed {}",
            arguments.records, arguments.seed
        );
        write_whole(&root.join(TABLE), tally::csv(&scores, &command).as_bytes())?;
        output::note(&format!("kept as {TABLE}"));
    }
    let held = scores.iter().all(|score| score.breaches().is_empty());
    Ok(if held { Exit::Done } else { Exit::CheckFailed })
}

/// The records of a case, fitted; the count does not depend on the threads.
fn score(case: &Case, arguments: &CoverageArgs, threads: usize) -> Result<Score, Failure> {
    let begun = ProcessTime::try_now().map_err(Failure::environment)?;
    let share = arguments.records.div_ceil(threads).max(1);
    let parts: Vec<Result<Score, Failure>> = thread::scope(|scope| {
        let spawned: Vec<_> = (0..arguments.records)
            .step_by(share)
            .map(|from| {
                let end = (from + share).min(arguments.records);
                scope.spawn(move || some(case, arguments.seed, from..end))
            })
            .collect();
        let joined = spawned.into_iter().map(thread::ScopedJoinHandle::join);
        joined.map(|part| part.unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
    });
    let mut whole = Score::new(case);
    for part in parts {
        whole.add(&part?);
    }
    whole.seconds = begun.elapsed().as_secs_f64();
    Ok(whole)
}

/// The records with these numbers: drawn, fitted from the nominal rig, counted.
fn some(case: &Case, seed: u64, records: Range<usize>) -> Result<Score, Failure> {
    let mut score = Score::new(case);
    let options = Options { starts: 2, bootstrap: 0, models: false, ..Options::default() };
    for i in records {
        let drawn = case.draw(seed.wrapping_add(i as u64))?;
        match fit(&case.rig, &drawn.data, &options) {
            Ok(fit) => score.count(&fit, &drawn),
            Err(_) => score.failed += 1,
        }
    }
    Ok(score)
}
