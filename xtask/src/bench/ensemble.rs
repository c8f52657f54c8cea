//! `cargo xtask bench ensemble`: many rigs at once.

use super::{built, table::seconds};
use crate::{
    cli::EnsembleArgs,
    exit::{Exit, Failure},
    output,
};
use serde_json::Value;
use std::{ffi::OsString, fs, path::Path};

/// Builds the program, runs it and prints what it tells.
pub(super) fn run(root: &Path, arguments: &EnsembleArgs) -> Result<Exit, Failure> {
    let mut told: Vec<OsString> = vec!["--runs".into(), arguments.runs.to_string().into()];
    told.extend(["--threads".into(), arguments.threads.to_string().into()]);
    if let Some(file) = &arguments.parameters {
        if !file.is_file() {
            let words = format!("--parameters {}: expected a table", file.display());
            return Err(Failure::usage(words));
        }
        let whole = fs::canonicalize(file).map_err(Failure::environment)?;
        told.extend(["--parameters".into(), whole.into()]);
    }
    let target = root.join("target/duhem/bench");
    let program =
        built::build((root, "simulation", "ensemble"), &target, !arguments.portable, true)?.program;
    built::run(&program, &told, |value| {
        if arguments.json {
            if !value["ensemble"].is_null() {
                output::line(&value["ensemble"].to_string());
            }
        } else {
            output::line(&words(&value));
        }
        Ok(())
    })?;
    Ok(Exit::Done)
}

/// A line of the table.
fn words(value: &Value) -> String {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    if let Some(worst) = value["checked"].as_f64() {
        return format!("the answers are {worst:.1e} from an independent method's, at most");
    }
    let row = &value["ensemble"];
    format!(
        "rtol {:.0e}: {} of {} runs, median error {:.1e}, worst {:.1e}, {} per run and core, \
         {:.2} times as fast on {} threads ({:.2} for plain arithmetic)",
        number(&row["control"]["rtol"]),
        row["status"].as_str().unwrap_or("?"),
        row["runs"],
        number(&row["error"]),
        number(&row["worst"]),
        seconds(number(&row["cpu_s"])),
        number(&row["speed_up"]),
        row["threads"],
        number(&row["plain_speed_up"]),
    )
}

#[cfg(test)]
mod tests {
    use super::words;
    use serde_json::json;

    #[test]
    fn a_row_is_told_with_its_failures() {
        let row = json!({ "ensemble": {
            "control": { "rtol": 1e-5 }, "status": "3 failed", "runs": 10, "error": 2e-7,
            "worst": 1e-4, "cpu_s": 3.3e-4, "speed_up": 1.9, "threads": 2, "plain_speed_up": 1.95,
        }});
        let told = words(&row);
        for part in ["rtol 1e-5: 3 failed of 10", "2.0e-7", "1.0e-4", "330 µs", "1.90", "(1.95"] {
            assert!(told.contains(part), "no `{part}` in `{told}`");
        }
    }
}
