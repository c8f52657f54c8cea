//! `fit` and `simulate`: a rig's model and a record of its drive.

pub(crate) mod page;
mod regressed;
pub(crate) mod shown;

use crate::{
    cli::{FitArgs, FitMethod, SimulateArgs},
    exit::{Exit, Failure},
    output,
    recorded::{read_record, read_rig, safe},
};
use identify::{
    Recording, Rig,
    fit::{
        Data, FitError, Misfit, Options, Simulated, Trace, fit as identified, hold,
        simulate as simulated,
    },
};
use record::{Sheet, write_sheet_csv, write_whole};
use serde_json::{Value, json};
use std::{path::Path, time::Instant};

/// The version of what is written.
pub(crate) const FORMAT: u32 = 1;

/// The failure for what is wrong with the file at `path`.
pub(crate) fn of_file<E: Into<anyhow::Error>>(path: &Path) -> impl Fn(E) -> Failure {
    move |error| {
        let error = error.into().context(safe(&path.display().to_string()));
        Failure { exit: Exit::Input, error }
    }
}

/// The channels of a record, SI, by the rig file's columns; an error says in which line.
pub(crate) fn read_channels(rig: &Rig, path: &Path) -> Result<Recording, Failure> {
    let sheet = read_record(path)?;
    let column = |name: &str| sheet.column(name).map_err(|e| e.to_string());
    Recording::new(rig, &column).map_err(|error| {
        let place = place(&sheet, error.row());
        let file = safe(&path.display().to_string());
        let error = anyhow::Error::new(error).context(format!("{file}{place}"));
        Failure { exit: Exit::Input, error }
    })
}

fn place(sheet: &Sheet, row: Option<usize>) -> String {
    match (row, row.and_then(|row| sheet.line(row))) {
        (_, Some(line)) => format!(", line {line}"),
        (Some(row), None) => format!(", row {}", row + 1),
        (None, _) => String::new(),
    }
}

/// Fits what the rig file leaves free, says how sure it is, and writes the model.
#[expect(clippy::disallowed_methods, reason = "the answer says how many seconds it took")]
pub(crate) fn fit(arguments: &FitArgs) -> Result<Exit, Failure> {
    let started = Instant::now();
    let rig = read_rig(&arguments.rig)?;
    let recording = read_channels(&rig, &arguments.record)?;
    let holdout = arguments.holdout.as_deref().map(|p| read_channels(&rig, p)).transpose()?;
    if arguments.method == FitMethod::Regression {
        return regressed::regression(arguments, &rig, (&recording, holdout.as_ref()), started);
    }
    let options = Options {
        window: arguments.window,
        starts: usize::from(arguments.starts),
        seed: arguments.seed,
        profiles: !arguments.quick,
        models: !arguments.quick,
        ..Options::default()
    };
    let mut data = Data::of(&rig, &recording);
    let threads = arguments.threads.map(usize::from);
    let rig = identify::on_threads(threads, || heard(rig, &mut data));
    let rig = rig.map_err(of_file(&arguments.record))?;
    let fitted = identify::on_threads(threads, || identified(&rig, &data, &options));
    let fitted = fitted.map_err(of_file(&arguments.record))?;
    let held = holdout.zip(arguments.holdout.as_deref()).map(|(recording, path)| {
        let data = Data::of(&rig, &recording);
        let [given, found] = [&rig, &fitted.rig]
            .map(|rig| simulated(rig, &data, arguments.window).map_err(of_file::<FitError>(path)));
        Ok::<Held, Failure>([given?, found?])
    });
    let held = held.transpose()?;
    let mut value = shown::as_json(&rig, &fitted, held.as_ref());
    value["seconds"] = json!(rounded(started.elapsed().as_secs_f64()));
    if let Some(out) = &arguments.out {
        leave(out, &fitted.rig, &value, &fitted.traces)?;
        let page = page::of_fit(&rig, &data, &fitted, held.as_ref());
        write_whole(&out.join("fit.html"), page.as_bytes())?;
    }
    if arguments.json {
        output::line(&format!("{value:#}"));
    } else {
        for line in shown::lines(&rig, &fitted, held.as_ref()) {
            output::line(&safe(&line));
        }
        say_where(arguments.out.as_deref());
    }
    Ok(Exit::Done)
}

/// The rig with what the record tells of its input between samples, where its file does not say.
fn heard(rig: Rig, data: &mut Data) -> Result<Rig, FitError> {
    let told = hold::told(&rig, data)?.map(|told| told.hold);
    data.hold = told.unwrap_or(data.hold);
    if let Some(hold) = told {
        output::note(&format!("the input {}", crate::discover::between(hold)));
    }
    Ok(rig.saying(told))
}

/// Runs the model on the record's inputs, beside the record.
pub(crate) fn simulate(arguments: &SimulateArgs) -> Result<Exit, Failure> {
    let rig = read_rig(&arguments.rig)?;
    let recording = read_channels(&rig, &arguments.record)?;
    let mut data = Data::of(&rig, &recording);
    let rig = heard(rig, &mut data).map_err(of_file(&arguments.record))?;
    let run = simulated(&rig, &data, arguments.window);
    let run = run.map_err(of_file(&arguments.record))?;
    if let Some(out) = &arguments.out {
        traces(&out.join("simulated.csv"), &run.traces)?;
    }
    if arguments.json {
        let value = json!({ "format": FORMAT, "way": shown::way(run.way, run.windows), "gap": gaps(&rig, &run.gap) });
        output::line(&format!("{value:#}"));
    } else {
        for line in shown::beside(&rig, &run) {
            output::line(&safe(&line));
        }
        say_where(arguments.out.as_deref());
    }
    Ok(Exit::Done)
}

pub(crate) fn say_where(out: Option<&Path>) {
    if let Some(out) = out {
        output::line(&format!("written to {}", safe(&out.display().to_string())));
    }
}

/// The misfit of each channel as the answer has it.
fn gaps(rig: &Rig, gap: &[Misfit]) -> Vec<Value> {
    gap.iter()
        .map(|g| {
            json!({ "channel": g.channel, "unit": shown::unit(rig, &g.channel), "before": g.before,
                    "refit": g.after, "after": g.after, "floor": g.noise,
                    "relative_before": 100.0 * g.before / g.size,
                    "relative_after": 100.0 * g.after / g.size })
        })
        .collect()
}

/// Writes the fitted rig file, the answer, the C header and the traces.
fn leave(out: &Path, rig: &Rig, value: &Value, all: &[Trace]) -> Result<(), Failure> {
    write_whole(&out.join("model.toml"), rig.write().as_bytes())?;
    write_whole(&out.join("fit.json"), format!("{value:#}\n").as_bytes())?;
    match identify::export::c_header(rig) {
        Ok(header) => {
            write_whole(&out.join("model.h"), header.as_bytes())?;
        }
        Err(error) => output::note(&format!("no C header: {error}")),
    }
    traces(&out.join("simulated.csv"), all)
}

/// Writes every channel over time, as measured and simulated.
fn traces(path: &Path, all: &[Trace]) -> Result<(), Failure> {
    let Some(first) = all.first() else { return Ok(()) };
    let named: Vec<(String, &[f64])> = all
        .iter()
        .flat_map(|t| {
            let of = |what: &str| format!("{}_{what}", t.channel);
            [
                (of("measured"), t.measured.as_slice()),
                (of("before"), t.before.as_slice()),
                (of("after"), t.after.as_slice()),
            ]
        })
        .collect();
    let mut columns: Vec<(&str, &[f64])> = vec![("time_s", &first.time)];
    columns.extend(named.iter().map(|(name, values)| (name.as_str(), *values)));
    write_sheet_csv(path, &columns)?;
    Ok(())
}

pub(crate) fn rounded(seconds: f64) -> f64 {
    (seconds * 1e3).round() / 1e3
}

/// A record not fitted, before and after.
type Held = [Simulated; 2];
