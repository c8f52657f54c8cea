//! `cargo xtask bench fit`: the fit of six parameters to the record of P6.

use super::{built, table::seconds};
use crate::{
    cli::FitBenchArgs,
    exit::{Exit, Failure},
    output,
};
use serde_json::Value;
use std::{ffi::OsString, path::Path};

/// Builds the program, runs it and prints what it tells.
pub(super) fn run(root: &Path, arguments: &FitBenchArgs) -> Result<Exit, Failure> {
    let told: Vec<OsString> = vec!["--repeats".into(), arguments.repeats.to_string().into()];
    let target = root.join("target/duhem/bench");
    let program = built::build((root, "identify", "fit"), &target, !arguments.portable, true)?;
    built::run(&program.program, &told, |value| {
        let row = &value["fit"];
        output::line(&if arguments.json { row.to_string() } else { words(row) });
        Ok(())
    })?;
    Ok(Exit::Done)
}

/// A line of the table.
fn words(row: &Value) -> String {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    format!(
        "start `{}`: {} of CPU time, {}; misfit {:.5} of the truth's; {} simulations, {} with derivatives",
        row["start"].as_str().unwrap_or("?"),
        seconds(number(&row["cpu_s"])),
        row["end"].as_str().unwrap_or("?"),
        number(&row["misfit_of_the_truths"]),
        row["simulations"],
        row["with_derivatives"],
    )
}

#[cfg(test)]
mod tests {
    use super::words;
    use serde_json::json;

    #[test]
    fn a_row_is_told_with_how_the_fit_ended() {
        let row = json!({
            "start": "alt", "cpu_s": 0.076, "end": "converged", "misfit_of_the_truths": 0.99967,
            "simulations": 12, "with_derivatives": 10,
        });
        let told = words(&row);
        for part in ["`alt`", "76.0 ms", "converged", "0.99967", "12 simulations", "10 with"] {
            assert!(told.contains(part), "no `{part}` in `{told}`");
        }
    }
}
