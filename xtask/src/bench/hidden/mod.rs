//! `cargo xtask bench hidden-effects`: how often the hidden effect is found, and named rightly.
//!
//! A case is drawn from its seed; the analyst gets the rig file and the record, and only the scorer the key.
//! Seeds below 100 000 are for tuning, those from 1 000 000 on for scoring.

mod case;
mod files;
mod matrix;
mod row;
mod score;
mod table;
mod value;

use crate::{
    cli::{HIDDEN, HiddenArgs},
    exit::{Exit, Failure},
    output,
};
use anyhow::anyhow;
use record::write_whole;
use row::Row;
use std::{
    fs,
    path::Path,
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

/// Where the table is kept, from the project's folder.
const TABLE: &str = "data/benchmarks/hidden-effects.csv";
/// Where truth against answer is drawn.
const FIGURE: &str = "data/benchmarks/hidden-effects.svg";

/// Makes records, has them answered, and judges the answers.
pub(super) fn run(root: &Path, arguments: &HiddenArgs) -> Result<Exit, Failure> {
    let processors = || thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.map_or_else(processors, usize::from);
    if let Some(folder) = &arguments.write {
        files::write_cases(folder, &arguments.seeds, arguments.seconds)?;
        return Ok(Exit::Done);
    }
    let (rows, at_once) = match &arguments.from {
        _ if arguments.kept => (kept(root)?, None),
        Some(folder) => (files::rows(folder, arguments.records, arguments.save)?, Some(1)),
        None => (rows(arguments, threads)?, Some(threads)),
    };
    if arguments.json {
        output::line(&format!("{:#}", table::json(&rows)));
    } else if arguments.markdown {
        output::line(table::markdown(&rows).trim_end());
    } else {
        output::line(table::words(&rows, at_once).trim_end());
    }
    if arguments.save {
        if !arguments.kept {
            let (records, seed) = match (&arguments.from, rows.first()) {
                // The same records, for all hangs on their seeds.
                (Some(_), Some(first)) => (rows.len(), first.seed),
                _ => (records(arguments), arguments.seed),
            };
            let command = format!(
                "cargo xtask bench hidden-effects --records {records} --seed {seed} --save"
            );
            write_whole(&root.join(TABLE), row::csv(&rows, &command).as_bytes())?;
        }
        let figure = report::confusion(&matrix::confusion(&rows))?;
        write_whole(&root.join(FIGURE), figure.as_bytes())?;
        output::note(&format!("kept as {TABLE}, drawn as {FIGURE}"));
    }
    let held = score::measures(&rows).iter().all(|measure| measure.held() != Some(false));
    Ok(if held { Exit::Done } else { Exit::CheckFailed })
}

/// How many records are drawn.
fn records(arguments: &HiddenArgs) -> usize {
    arguments.records.unwrap_or(HIDDEN)
}

/// The rows of the table that is kept.
fn kept(root: &Path) -> Result<Vec<Row>, Failure> {
    let text = fs::read_to_string(root.join(TABLE))
        .map_err(|e| Failure::usage(format!("{TABLE}: {e}; make it with --save")))?;
    row::parse(&text).map_err(|why| Failure { exit: Exit::Input, error: anyhow!("{TABLE}: {why}") })
}

/// The records, answered, in the order of their seeds; whoever is free takes the next.
fn rows(arguments: &HiddenArgs, threads: usize) -> Result<Vec<Row>, Failure> {
    let next = AtomicUsize::new(0);
    let records = records(arguments);
    let parts: Vec<Vec<Result<Row, Failure>>> = thread::scope(|scope| {
        let work = || {
            let mut done = Vec::new();
            loop {
                let i = next.fetch_add(1, Ordering::Relaxed);
                if i >= records {
                    return done;
                }
                done.push(case::run(arguments.seed + i as u64));
                if !arguments.json && (i + 1).is_multiple_of(25) {
                    output::note(&format!("{} of {records} records", i + 1));
                }
            }
        };
        let spawned: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let joined = spawned.into_iter().map(thread::ScopedJoinHandle::join);
        joined.map(|part| part.unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
    });
    let mut rows = parts.into_iter().flatten().collect::<Result<Vec<Row>, Failure>>()?;
    rows.sort_by_key(|row| row.seed);
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use crate::cli::{HIDDEN, SCORED};
    use twin::bench::{Hides, Recipe};

    /// What the full set is to hold at least, and what the default command draws.
    #[test]
    fn the_default_set_has_enough_of_every_kind() {
        let [mut quiet, mut single, mut foreign, mut pairs] = [0; 4];
        for seed in SCORED..SCORED + HIDDEN as u64 {
            match Recipe::drawn(seed).hides {
                Hides::Nothing | Hides::Parameter => quiet += 1,
                Hides::Effects(names) if names.len() == 2 => pairs += 1,
                Hides::Effects(names) if names[0].starts_with("foreign_") => foreign += 1,
                Hides::Effects(_) => single += 1,
            }
        }
        let all = quiet + single + foreign + pairs;
        assert!(all >= 700, "{all} records");
        assert!(quiet >= 200, "{quiet} with nothing hidden or a wrong parameter");
        assert!(single >= 300, "{single} with one effect");
        assert!(foreign >= 100, "{foreign} with what is in no library");
        assert!(pairs >= 60, "{pairs} with two effects");
    }
}
