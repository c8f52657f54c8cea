//! `fit --method regression`: filtered position, central differences, least squares.

use super::{FORMAT, of_file, page, rounded, say_where};
use crate::{
    cli::FitArgs,
    exit::{Exit, Failure},
    output,
    recorded::safe,
};
use experiment::four_digits;
use identify::{
    Recording, Rig,
    regression::{
        Coefficient, Options, Regression, RegressionError, Samples, drive_gain, regress,
        relative_error,
    },
    rig::Kind,
};
use record::write_whole;
use serde_json::{Value, json};
use std::time::Instant;

/// The 97.5 % quantile of the normal distribution.
const NORMAL: f64 = 1.959_963_984_540_054;

/// Columns for the regression, the force as it drives the plant.
struct Columns {
    time: Vec<f64>,
    position: Vec<f64>,
    force: Vec<f64>,
}

impl Columns {
    fn of(rig: &Rig, recording: &Recording) -> Self {
        let turns = Kind::of(rig.kind).is_some_and(Kind::turns);
        let imposed = rig.kind == "prescribed";
        let position = match (imposed, turns) {
            (true, _) => "displacement",
            (_, true) => "angle",
            _ => "position",
        };
        let gain = drive_gain(rig);
        let force = ["force", "voltage", "current"];
        let force = force.iter().find_map(|name| recording.channels.get(*name));
        Self {
            time: recording.time.clone(),
            position: recording.channels.get(position).cloned().unwrap_or_default(),
            force: force.map(|f| f.iter().map(|f| gain * f).collect()).unwrap_or_default(),
        }
    }

    fn samples(&self) -> Samples<'_> {
        Samples { time: &self.time, position: &self.position, force: &self.force }
    }
}

/// Fits by regression, prints it, and writes what can be written.
pub(super) fn regression(
    arguments: &FitArgs,
    rig: &Rig,
    (recording, holdout): (&Recording, Option<&Recording>),
    started: Instant,
) -> Result<Exit, Failure> {
    let usual = Options::of_rig(rig).map_err(of_file(&arguments.rig))?;
    let options = Options { by_direction: arguments.by_direction, ..usual };
    let columns = Columns::of(rig, recording);
    let fitted = regress(&columns.samples(), &options).map_err(of_file(&arguments.record))?;
    let values: Vec<f64> = fitted.coefficients.iter().map(|c| c.value).collect();
    let held =
        holdout.zip(arguments.holdout.as_deref()).map(|(other, path)| {
            relative_error(&Columns::of(rig, other).samples(), &options, &values)
                .map_err(of_file::<RegressionError>(path))
        });
    let held = held.transpose()?;
    let (model, left) = model(rig, &fitted);
    let mut value = as_json(rig, &fitted, held);
    value["seconds"] = json!(rounded(started.elapsed().as_secs_f64()));
    if let Some(out) = &arguments.out {
        write_whole(&out.join("model.toml"), model.write().as_bytes())?;
        write_whole(&out.join("fit.json"), format!("{value:#}\n").as_bytes())?;
        let page = page::of_regression(&rig.title, summary(&fitted, held), rows(rig, &fitted));
        write_whole(&out.join("fit.html"), page.as_bytes())?;
    }
    if arguments.json {
        output::line(&format!("{value:#}"));
    } else {
        for line in lines(rig, &fitted, held) {
            output::line(&safe(&line));
        }
        if !left.is_empty() && arguments.out.is_some() {
            output::line(&format!(
                "not in the rig file, which has no place for it: {}",
                left.join(", ")
            ));
        }
        say_where(arguments.out.as_deref());
    }
    Ok(Exit::Done)
}

/// The rig with the coefficients that it has a place for, and the names of the others.
fn model(rig: &Rig, fitted: &Regression) -> (Rig, Vec<&'static str>) {
    let mut model = rig.clone();
    let mut left = Vec::new();
    for c in &fitted.coefficients {
        if model.set(c.term.name, c.value).is_err() {
            left.push(c.term.name);
        }
    }
    (model, left)
}

fn as_json(rig: &Rig, fitted: &Regression, held: Option<f64>) -> Value {
    let p = fitted.coefficients.len();
    let parameters = fitted.coefficients.iter().map(|c| {
        let (given, error) = (rig.value(c.term.name), c.standard_error);
        let (interval, moved) = (bounds(c), moved(given, c));
        json!({ "name": c.term.name, "given": given, "found": c.value, "standard_error": error,
                "classical_error": c.classical_error, "unit": c.term.unit, "moved": moved,
                "identified": true, "interval": interval })
    });
    let correlation: Vec<&[f64]> = fitted.correlation.chunks(p.max(1)).collect();
    json!({
        "format": FORMAT,
        "method": "regression",
        "parameters": parameters.collect::<Vec<_>>(),
        "correlation": correlation,
        "relative_error": fitted.relative_error,
        "holdout_relative_error": held,
        "condition": fitted.condition,
        "cutoff_hz": fitted.cutoff,
        "lag": fitted.lag,
    })
}

fn lines(rig: &Rig, fitted: &Regression, held: Option<f64>) -> Vec<String> {
    let mut lines = vec![format!(
        "{}: regression of the driving force, position filtered at {} Hz, {} rows",
        rig.title,
        four_digits(fitted.cutoff),
        fitted.time.len()
    )];
    lines.push(String::new());
    let head = ["given", "found", "± s.e."];
    lines.push(format!(
        "{:14} {:>11} {:>11} {:>10}  {:26} unit",
        "parameter", head[0], head[1], head[2], "95 % interval"
    ));
    for c in &fitted.coefficients {
        let given = rig.value(c.term.name).map_or("–".to_owned(), four_digits);
        let [found, error] = [c.value, c.standard_error].map(four_digits);
        let [low, high] = bounds(c).map(four_digits);
        let interval = format!("{low} … {high}");
        lines.push(format!(
            "{:14} {given:>11} {found:>11} {error:>10}  {interval:26} {}",
            c.term.name, c.term.unit
        ));
    }
    lines.push(String::new());
    lines.push(summary(fitted, held));
    lines
}

/// What the regression leaves of the force, in a sentence.
fn summary(fitted: &Regression, held: Option<f64>) -> String {
    format!(
        "relative force error {} %{}; condition number {}; errors allow for residuals alike over {} rows",
        four_digits(fitted.relative_error),
        held.map_or(String::new(), |e| format!(", on the held-out record {} %", four_digits(e))),
        four_digits(fitted.condition),
        fitted.lag
    )
}

/// The rows of the page's table.
fn rows(rig: &Rig, fitted: &Regression) -> Vec<Vec<String>> {
    let row = |c: &Coefficient| {
        let given = rig.value(c.term.name);
        let [low, high] = bounds(c).map(four_digits);
        vec![
            format!("{} [{}]", c.term.name, c.term.unit),
            given.map_or("–".to_owned(), four_digits),
            format!("{} ± {}", four_digits(c.value), four_digits(c.standard_error)),
            format!("{low} … {high}"),
            if moved(given, c) { "yes" } else { "no" }.to_owned(),
        ]
    };
    fitted.coefficients.iter().map(row).collect()
}

/// The 95 % interval of a coefficient.
fn bounds(c: &Coefficient) -> [f64; 2] {
    [-1.0, 1.0].map(|s| c.value + s * NORMAL * c.standard_error)
}

/// Whether a coefficient lies further from the value given than two standard errors and one per cent.
fn moved(given: Option<f64>, c: &Coefficient) -> bool {
    given.is_some_and(|g| (c.value - g).abs() > (2.0 * c.standard_error).max(0.01 * g.abs()))
}
