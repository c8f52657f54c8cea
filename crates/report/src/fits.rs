//! Fits to records: what was found beside what is true and what was tuned by hand, and the models compared.

use crate::grid::Grid;
use crate::number::{self, NONE};
use record::{FitRow, ModelRow, ParameterRow, Summary};

/// How the table of parameters is read.
const PARAMETERS_READ: &str = "Given is what the rig file has. The interval is the one of 95 % by profile likelihood; a side without a \
     number was not found, and the record does not identify the parameter on that side. \
     ✗ stands behind an interval that does not hold the truth.";

/// How the table of models is read.
const MODELS_READ: &str = "Each model was fitted to half of the blocks of the record and judged on the \
     others. Errors are root mean squares of the residuals in units of the channels' noise: 1 is as good as the \
     record itself.";

/// How the table of misfits is read.
const MISFITS_READ: &str = "Root mean square of the residuals; the noise is what the channel shows by \
     itself.";

/// The heading of a fit.
pub(crate) fn heading(fit: &FitRow) -> &str {
    if fit.title.is_empty() { &fit.fit } else { &fit.title }
}

/// What is told of a fit: its record, its rig, and how it went.
pub(crate) fn told(fit: &FitRow) -> Vec<(&'static str, String)> {
    let windows = if fit.windows > 1 { format!(", {}", fit.windows) } else { String::new() };
    let mut told = vec![
        ("Record", format!("{}, {} samples", fit.record, number::count(fit.samples))),
        ("Rig", fit.rig.clone()),
        ("Simulated", format!("{}{windows}", fit.way)),
        ("Search", format!("{} after {} simulations", fit.end, number::count(fit.simulations))),
        (
            "Residuals",
            format!(
                "variance {} in units of the noise; correlation of neighbours {}",
                number::significant(fit.variance, 3),
                number::decimal(fit.neighbours, 2)
            ),
        ),
    ];
    told.retain(|(_, text)| !text.is_empty());
    told
}

/// The parameters: truth, tuned by hand, fitted, interval.
fn parameters(summary: &Summary, fit: &str) -> Option<Grid> {
    let own: Vec<&ParameterRow> = summary.parameters.iter().filter(|row| row.fit == fit).collect();
    let truth = own.iter().any(|row| row.truth.is_some());
    let mut head = vec!["parameter".to_owned(), "given".to_owned()];
    if truth {
        head.push("truth".to_owned());
    }
    head.extend(["fitted", "95 % interval", "identified"].map(str::to_owned));
    let row = |row: &&ParameterRow| {
        let mut cells = vec![
            number::symbol(&row.parameter),
            number::short(row.given) + &number::unit(&row.unit),
        ];
        if truth {
            cells.push(row.truth.map_or_else(|| NONE.to_owned(), number::short));
        }
        cells.push(number::with_error(row.found, Some(row.standard_error), ""));
        cells.push(interval(row));
        cells.push(identified(row));
        cells
    };
    let rows: Vec<_> = own.iter().map(row).collect();
    (!rows.is_empty()).then_some(Grid { head, rows, class: "fits", words: 1 })
}

/// The interval, its ends with one digit more than its standard error has, and whether it holds the truth.
fn interval(row: &ParameterRow) -> String {
    let digits = |value: f64| {
        let more = (value.abs() / row.standard_error).log10().ceil();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 2 and 10"
        )]
        let digits = (more + 1.0).clamp(2.0, 10.0) as usize;
        number::significant(value, digits)
    };
    let end = |value: Option<f64>| value.map_or_else(|| "?".to_owned(), digits);
    let beyond = |truth: f64| {
        row.low.is_some_and(|low| truth < low) || row.high.is_some_and(|high| truth > high)
    };
    let sign = if row.truth.is_some_and(beyond) { " ✗" } else { "" };
    if row.low.is_none() && row.high.is_none() {
        return NONE.to_owned();
    }
    format!("{} to {}{sign}", end(row.low), end(row.high))
}

/// Whether the record identifies the parameter, and if not, what fits equally well.
fn identified(row: &ParameterRow) -> String {
    match (row.identified, row.low, row.high) {
        (true, ..) => "yes".to_owned(),
        (false, Some(low), None) => {
            format!("no: all above {} fit", number::significant(low, 2))
        }
        (false, None, Some(high)) => {
            format!("no: all below {} fit", number::significant(high, 2))
        }
        (false, ..) => "no: any value fits".to_owned(),
    }
}

/// The friction models against one another.
fn models(summary: &Summary, fit: &str) -> Option<Grid> {
    let row = |row: &ModelRow| {
        let error = |value| number::significant(value, 3);
        vec![row.model.clone(), row.free.to_string(), error(row.held_out), error(row.trained)]
    };
    let rows: Vec<_> = summary.models.iter().filter(|row| row.fit == fit).map(row).collect();
    let head = ["friction model", "free parameters", "error held out", "error fitted"];
    let head = head.map(str::to_owned).to_vec();
    (!rows.is_empty()).then_some(Grid { head, rows, class: "fits", words: 1 })
}

/// The misfit of every channel.
fn misfits(summary: &Summary, fit: &str) -> Option<Grid> {
    let own = summary.misfits.iter().filter(|row| row.fit == fit);
    let rows: Vec<_> = own
        .map(|row| {
            let size = |value| number::significant(value, 3) + &number::unit(&row.unit);
            vec![row.channel.clone(), size(row.before), size(row.after), size(row.noise)]
        })
        .collect();
    let head = ["channel", "as given", "fitted", "noise"].map(str::to_owned).to_vec();
    (!rows.is_empty()).then_some(Grid { head, rows, class: "fits", words: 1 })
}

/// The tables of a fit, each with its title and how it is read.
pub(crate) fn tables(summary: &Summary, fit: &str) -> Vec<(&'static str, &'static str, Grid)> {
    [
        ("Parameters", PARAMETERS_READ, parameters(summary, fit)),
        ("Friction models compared", MODELS_READ, models(summary, fit)),
        ("Misfit of the channels", MISFITS_READ, misfits(summary, fit)),
    ]
    .into_iter()
    .filter_map(|(title, reads, grid)| Some((title, reads, grid?)))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::{identified, interval};
    use record::ParameterRow;

    fn row(low: Option<f64>, high: Option<f64>) -> ParameterRow {
        let identified = low.is_some() && high.is_some();
        let (found, standard_error, truth) = (1.0, 0.01, Some(1.03));
        ParameterRow { found, standard_error, low, high, identified, truth, ..Default::default() }
    }

    #[test]
    fn an_interval_that_misses_the_truth_is_marked() {
        assert_eq!(interval(&row(Some(0.98), Some(1.02))), "0.980 to 1.020 ✗");
        assert_eq!(interval(&row(Some(0.98), Some(1.04))), "0.980 to 1.040");
    }

    #[test]
    fn a_parameter_without_a_bound_is_said_to_be_unidentified() {
        let above = row(Some(0.8), None);
        assert_eq!(interval(&above), "0.800 to ?");
        assert_eq!(identified(&above), "no: all above 0.80 fit");
        assert_eq!(identified(&row(None, None)), "no: any value fits");
    }
}
