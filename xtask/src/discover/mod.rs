//! `discover`: where a model and a record disagree, and what the model lacks.

mod answer;
mod page;
mod picture;
mod shown;

use crate::{
    check_data::count,
    cli::DiscoverArgs,
    exit::{Exit, Failure},
    fit::{of_file, read_channels, rounded, say_where},
    output,
    recorded::{read_record, read_rig, safe},
};
use discover::{Confirmed, Discovery, Gap, Options, Verdict};
use identify::{
    Rig,
    doctor::{Examination, Finding, Severity, examine},
    fit::{Data, FitError, Trace, moves, simulate},
};
use page::Pictures;
use record::write_whole;
use serde_json::{Value, json};
pub(crate) use shown::between;
use std::{
    io::{IsTerminal, stderr},
    path::Path,
    time::Instant,
};

/// All that is told.
struct Told {
    /// The rig as given.
    rig: Rig,
    /// The rig with the effects, what was free in it free as before.
    model: Rig,
    /// What the doctor says of the record.
    check: Check,
    /// The answer.
    found: Discovery,
    /// The two models run on the record, and on the one held out.
    runs: Vec<Run>,
}

/// The doctor's findings, in short.
struct Check {
    problems: usize,
    notes: usize,
    gravest: Option<Finding>,
}

/// The nominal and the final model run on a record.
struct Run {
    /// Whether it was held out.
    held: bool,
    /// The gap of every channel.
    gap: Vec<Gap>,
    /// The error of the simulated command before and after [%], where there is a controller.
    command: Option<[f64; 2]>,
}

/// Says where the rig's model and the record disagree, and what the model lacks.
#[expect(clippy::disallowed_methods, reason = "the answer says how many seconds it took")]
pub(crate) fn discover(arguments: &DiscoverArgs) -> Result<Exit, Failure> {
    let started = Instant::now();
    let rig = read_rig(&arguments.rig)?;
    let mut data = Data::of(&rig, &read_channels(&rig, &arguments.record)?);
    let mut held = arguments.holdout.as_deref().map(|path| read_held(&rig, path)).transpose()?;
    if let Some(out) = &arguments.out {
        // Better now than after the work.
        std::fs::create_dir_all(out).map_err(|e| {
            let named = safe(&out.display().to_string());
            Failure::environment(anyhow::Error::new(e).context(named))
        })?;
    }
    if data.time.len() < FEWEST {
        let short = FitError::TooShort { found: data.time.len(), expected: FEWEST };
        return Err(of_file(&arguments.record)(short));
    }
    let check = check(&rig, &arguments.record)?;
    let told = stderr().is_terminal().then_some(output::note as fn(&str));
    let options = Options { seed: arguments.seed, told, ..Options::default() };
    let found = discover::discover(&rig, &data, &options).map_err(of_file(&arguments.record))?;
    // What the record tells of its input holds for all that is run from here on.
    let hold = found.hold;
    let rig = rig.saying(hold);
    for data in [Some(&mut data), held.as_mut()].into_iter().flatten() {
        data.hold = hold.unwrap_or(data.hold);
    }
    let model = model(&rig, &found);
    // A model without a motion explains nothing, whatever the answer is.
    if !moves(&model, &data, rigs_window(&rig)).map_err(of_file(&arguments.record))? {
        return Err(of_file(&arguments.record)(FitError::NoMotion));
    }
    let mut runs = Vec::new();
    if rig.controller.is_some() {
        runs.push(run((&rig, &model), &data, false).map_err(of_file(&arguments.record))?);
    }
    if let Some((held, path)) = held.zip(arguments.holdout.as_deref()) {
        runs.push(run((&rig, &model), &held, true).map_err(of_file(path))?);
    }
    let told = Told { rig, model, check, found, runs };
    let mut value = answer::as_json(&told);
    value["seconds"] = json!(rounded(started.elapsed().as_secs_f64()));
    if let Some(out) = &arguments.out {
        leave(out, &told, &value)?;
        let pictures = pictures(&told, &data, arguments.seed);
        let page = page::page(&told, &data, &pictures);
        write_whole(&out.join("page.html"), page.as_bytes())?;
    }
    if arguments.json {
        output::line(&format!("{value:#}"));
    } else {
        for line in shown::lines(&told) {
            output::line(&safe(&line));
        }
        say_where(arguments.out.as_deref());
    }
    Ok(Exit::Done)
}

/// The record held out, with the channels that the rig file names.
fn read_held(rig: &Rig, path: &Path) -> Result<Data, Failure> {
    Ok(Data::of(rig, &read_channels(rig, path)?))
}

/// What the doctor says of the record.
fn check(rig: &Rig, record: &Path) -> Result<Check, Failure> {
    let sheet = read_record(record)?;
    let names: Vec<&str> = sheet.columns.iter().map(|c| c.name.as_str()).collect();
    let column = |name: &str| sheet.column(name).map_err(|e| e.to_string());
    let seen: Examination = examine(Some(rig), &names, &column);
    Ok(Check {
        problems: count(&seen, Severity::Problem),
        notes: count(&seen, Severity::Note),
        gravest: seen.findings.into_iter().next(),
    })
}

/// The rig with what the answer names, and with what was free in it and in the effects free.
fn model(rig: &Rig, found: &Discovery) -> Rig {
    let mut model = found.rig.clone();
    let named = |name: &str| found.effects.iter().any(|effect| effect.name == name);
    let given = |name: &str| rig.effects.iter().any(|effect| effect.name == name);
    model.effects.retain(|effect| named(&effect.name) || given(&effect.name));
    let has = |free: &str| model.effects.iter().any(|e| free.starts_with(&format!("{}.", e.name)));
    model.free.retain(|free| rig.free.contains(free) || has(free));
    model
}

fn run((nominal, model): (&Rig, &Rig), data: &Data, held: bool) -> Result<Run, FitError> {
    let Confirmed { gap, command } = discover::confirm(nominal, model, data)?;
    Ok(Run { held, gap, command })
}

/// Writes the model with the effect and the answer.
fn leave(out: &Path, told: &Told, value: &Value) -> Result<(), Failure> {
    write_whole(&out.join("model.toml"), told.model.write().as_bytes())?;
    write_whole(&out.join("answer.json"), format!("{value:#}\n").as_bytes())?;
    Ok(())
}

/// The fewest samples of which blocks can be made, some fitted and some judging.
const FEWEST: usize = 200;

/// Blocks of the record that are simulated each from its own start, to be shown [s].
const SHOWN: f64 = 3.0;

/// What the page shows beside the answer.
fn pictures(told: &Told, data: &Data, seed: u64) -> Pictures {
    let without = (!told.found.effects.is_empty()).then(|| {
        let given = |name: &str| told.rig.effects.iter().any(|effect| effect.name == name);
        let mut rig = told.model.clone();
        rig.effects.retain(|effect| given(&effect.name));
        rig
    });
    let rigs = [Some(&told.rig), without.as_ref(), Some(&told.model)];
    let residuals = rigs.map(|rig| rig.and_then(|rig| discover::residual(rig, data, seed)));
    let window = rigs_window(&told.rig);
    let runs = [&told.rig, &told.model].map(|rig| simulate(rig, data, window));
    let traces = match runs {
        [Ok(before), Ok(after)] => paired(before.traces, after.traces),
        // What has no motion is shown as none.
        [Err(_), Ok(after)] => {
            let mut all = after.traces;
            for trace in &mut all {
                trace.before.fill(f64::NAN);
            }
            all
        }
        _ => Vec::new(),
    };
    Pictures { residuals, traces }
}

/// A loop that is closed needs no windows.
fn rigs_window(rig: &Rig) -> Option<f64> {
    rig.controller.is_none().then_some(SHOWN)
}

/// The traces of two runs, the first one before, the second after.
fn paired(before: Vec<Trace>, after: Vec<Trace>) -> Vec<Trace> {
    let pairs = before.into_iter().zip(after);
    pairs.map(|(before, after)| Trace { before: before.after, ..after }).collect()
}

/// The verdict in a sentence.
fn verdict(told: &Told) -> String {
    let found = &told.found;
    let name = |effect: &discover::Found| {
        if effect.set.len() > 1 {
            format!("one of {}, which this record cannot tell apart", effect.set.join(", "))
        } else {
            effect.name.to_owned()
        }
    };
    let names = found.effects.iter().map(name).collect::<Vec<_>>().join("; and ");
    let says = match found.verdict {
        Verdict::NothingMissing => "nothing is missing at this noise".to_owned(),
        Verdict::Parameter => {
            let wrong = found.parameters.iter().filter(|p| p.moved);
            let wrong: Vec<&str> = wrong.map(|p| p.found.name.as_str()).collect();
            match wrong.as_slice() {
                [] => "a parameter is wrong".to_owned(),
                [one] => format!("a parameter is wrong: {one}"),
                some => format!("parameters are wrong: {}", some.join(", ")),
            }
        }
        Verdict::Effect => format!("the model lacks {names}"),
        Verdict::Partial => format!("the model lacks {names}; and something more is missing"),
        Verdict::NotInLibrary => "the model lacks something that is not in the library".to_owned(),
    };
    if found.complete { says } else { says + "; the search took too long and was ended" }
}
