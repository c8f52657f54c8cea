//! The page of a fit for people: what came out, in tables and figures.

use super::Held;
use super::shown::{self, correlated, paired, sure, unit, untold, way};
use crate::recorded::safe;
use experiment::four_digits;
use identify::{
    Rig,
    fit::{Data, Estimate, Fit, Misfit, Trace, search::End},
    regression::drive_gain,
    rig::Kind,
};
use report::{FitCurve, FitFigure, FitPage, FitPanel, FitPart, FitRole};

/// How many of a channel's noises hold nearly all of it [1].
const NEARLY_ALL: f64 = 2.0;

/// The page of a fit by simulation.
pub(super) fn of_fit(rig: &Rig, data: &Data, fit: &Fit, held: Option<&Held>) -> String {
    let mut parts = vec![parameters(rig, fit), cannot_tell(rig, fit), gap(rig, fit, held)];
    if !fit.models.is_empty() {
        parts.push(models(fit));
    }
    let mut figures = vec![histories(rig, &fit.traces, fit.windows > 1)];
    figures.extend(residuals(rig, fit));
    figures.extend(loops(rig, data, &fit.traces));
    parts.push(FitPart { title: "The record and the model".to_owned(), figures, ..part() });
    report::fit_page(&FitPage { title: safe(&rig.title), opening: opening(rig, fit), parts })
}

pub(crate) fn part() -> FitPart {
    FitPart::default()
}

pub(crate) fn words(all: &[&str]) -> Vec<String> {
    all.iter().map(|word| (*word).to_owned()).collect()
}

fn opening(rig: &Rig, fit: &Fit) -> String {
    let ended = match fit.end {
        End::Converged => "the search converged".to_owned(),
        end => format!("the search did not converge: it {}", shown::ended(end)),
    };
    let moved = fit.parameters.iter().filter(|p| p.moved).count();
    let open = fit.parameters.iter().filter(|p| !p.identified).count();
    let open = match open {
        _ if fit.end != End::Converged => String::new(),
        0 => String::new(),
        1 => "; 1 is not identified by this record".to_owned(),
        n => format!("; {n} are not identified by this record"),
    };
    format!(
        "{} friction, simulated in {}; {ended}. {moved} of {} free parameters moved from what the rig file gives{open}.",
        rig.friction.name,
        way(fit.way, fit.windows),
        fit.parameters.len()
    )
}

fn parameters(rig: &Rig, fit: &Fit) -> FitPart {
    let row = |p: &Estimate| {
        let error = p.standard_error;
        let bootstrap = p.bootstrap.map_or("–".to_owned(), |ends| between(ends, error));
        vec![
            named(&p.name, rig.unit(&p.name)),
            four_digits(p.given),
            format!("{} ± {}", sure(p.found, error), four_digits(error)),
            interval(p),
            bootstrap,
            if p.moved { "yes" } else { "no" }.to_owned(),
        ]
    };
    let mut list = correlated(fit);
    list.extend(
        fit.parameters
            .iter()
            .filter(|p| p.at_bound)
            .map(|p| format!("{} ended as far from its nominal size as the search may go", p.name)),
    );
    FitPart {
        title: "Parameters".to_owned(),
        text: vec![format!(
            "Intervals are of 95 %: by profile likelihood where they were asked for, and by a bootstrap over blocks of \
             the residuals. Residuals have {} of the variance that they are weighed by, neighbours correlate with {}.",
            four_digits(fit.variance),
            four_digits(fit.neighbours)
        )],
        head: words(&["parameter", "given", "found ± s.e.", "95 % interval", "bootstrap", "moved"]),
        rows: fit.parameters.iter().map(row).collect(),
        list,
        ..part()
    }
}

pub(crate) fn named(name: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "1" { name.to_owned() } else { format!("{name} [{unit}]") }
}

fn between([low, high]: [f64; 2], error: f64) -> String {
    format!("{} … {}", sure(low, error), sure(high, error))
}

/// The interval of a parameter, a side that is open said in words.
fn interval(p: &Estimate) -> String {
    let error = p.standard_error;
    match p.interval {
        [Some(low), Some(high)] => between([low, high], error),
        [Some(low), None] => format!("above {}, no upper bound", sure(low, error)),
        [None, Some(high)] => format!("below {}, no lower bound", sure(high, error)),
        // Where none was asked for, the standard error makes one.
        [None, None] if p.identified => format!("{} (from s.e.)", between(p.asymptotic, error)),
        [None, None] => "no bound on either side".to_owned(),
    }
}

/// What this record leaves open.
fn cannot_tell(rig: &Rig, fit: &Fit) -> FitPart {
    let list = untold(rig, fit);
    let asked = fit.parameters.iter().any(|p| p.interval.iter().any(Option::is_some));
    let text = if list.is_empty() && !asked {
        words(&["Not asked: intervals by profile likelihood, which tell it, were left away."])
    } else if list.is_empty() {
        vec![
            "Nothing of what was asked: each free parameter has an interval closed on both sides."
                .to_owned(),
        ]
    } else {
        vec!["check-data says which motion would tell it.".to_owned()]
    };
    FitPart { title: "What this record cannot tell".to_owned(), text, list, ..part() }
}

fn gap(rig: &Rig, fit: &Fit, held: Option<&Held>) -> FitPart {
    let rows_of = |whose: &str, gap: &[Misfit]| {
        gap.iter().map(|g| gap_row(rig, whose, g)).collect::<Vec<Vec<String>>>()
    };
    let mut rows = rows_of("", &fit.gap);
    if let Some([before, after]) = held {
        rows.extend(rows_of("held out: ", &paired(before, after)));
    }
    FitPart {
        title: "Gap".to_owned(),
        text: words(&[
            "Root mean square of measured less simulated, with the parameters given and found, against \
                       the noise that the channel itself shows; the last two columns in per cent of what was measured.",
        ]),
        head: words(&["channel", "before", "after", "noise", "% before", "% after"]),
        rows,
        ..part()
    }
}

fn gap_row(rig: &Rig, whose: &str, g: &Misfit) -> Vec<String> {
    let mut row = vec![format!("{whose}{}", named(&g.channel, unit(rig, &g.channel)))];
    let [before, after] = [g.before, g.after].map(|rms| 100.0 * rms / g.size);
    row.extend([g.before, g.after, g.noise, before, after].map(four_digits));
    row
}

fn models(fit: &Fit) -> FitPart {
    let mut ranked: Vec<_> = fit.models.iter().collect();
    ranked.sort_by(|a, b| a.held_out_error.total_cmp(&b.held_out_error));
    let row = |m: &&identify::fit::Candidate| {
        vec![
            m.name.clone(),
            m.free.to_string(),
            four_digits(m.trained_error),
            four_digits(m.held_out_error),
        ]
    };
    FitPart {
        title: "Friction models".to_owned(),
        text: words(&[
            "Root mean square on the blocks fitted and on those between, of each channel's noise; \
                       the best on held-out blocks first.",
        ]),
        head: words(&["friction model", "free", "trained", "held out"]),
        rows: ranked.iter().map(row).collect(),
        ..part()
    }
}

pub(crate) fn curve(name: &str, x: &[f64], y: &[f64], role: FitRole) -> FitCurve {
    let points = x.iter().copied().zip(y.iter().copied()).collect();
    FitCurve { name: name.to_owned(), points, role }
}

/// Every channel over time, as measured, before and after; `anew` in windows.
pub(crate) fn histories(rig: &Rig, traces: &[Trace], anew: bool) -> FitFigure {
    let panel = |t: &Trace| FitPanel {
        x: "t [s]".to_owned(),
        y: named(&t.channel, unit(rig, &t.channel)),
        curves: vec![
            curve("measured", &t.time, &t.measured, FitRole::Measured),
            curve("before", &t.time, &t.before, FitRole::Before),
            curve("after", &t.time, &t.after, FitRole::After),
        ],
        ..FitPanel::default()
    };
    let windows = if anew {
        " Each window starts anew from where the record is, so that the lines of the model jump between windows."
    } else {
        ""
    };
    FitFigure {
        title: "Every channel over time".to_owned(),
        caption: format!(
            "Measured, and simulated with the parameters given (before) and found (after). \
             A line before the fit may leave the panel.{windows}"
        ),
        panels: traces.iter().map(panel).collect(),
        over_time: true,
    }
}

fn residuals(rig: &Rig, fit: &Fit) -> Option<FitFigure> {
    let panel = |t: &Trace| {
        let left: Vec<f64> = t.measured.iter().zip(&t.after).map(|(m, a)| m - a).collect();
        let noise = fit.gap.iter().find(|g| g.channel == t.channel).map(|g| NEARLY_ALL * g.noise);
        FitPanel {
            x: "t [s]".to_owned(),
            y: format!("{}, measured less after", named(&t.channel, unit(rig, &t.channel))),
            curves: vec![curve("left", &t.time, &left, FitRole::Measured)],
            noise,
            ..FitPanel::default()
        }
    };
    (!fit.traces.is_empty()).then(|| FitFigure {
        title: "What the fit leaves".to_owned(),
        caption: "Between the grey lines, two standard deviations of the channel's noise on either side, \
                  a right model would stay for 95 % of the time and show no pattern."
            .to_owned(),
        panels: fit.traces.iter().map(panel).collect(),
        over_time: true,
    })
}

/// Displacement against driving force, or friction force against the displacement imposed.
pub(crate) fn loops(rig: &Rig, data: &Data, traces: &[Trace]) -> Option<FitFigure> {
    let first = traces.first()?;
    let at = |values: &[f64]| -> Vec<f64> { sampled(&data.time, values, &first.time) };
    let turns = Kind::of(rig.kind).is_some_and(Kind::turns);
    let (what, force_unit) = if turns { ("torque", "N·m") } else { ("force", "N") };
    let imposed = data.force.is_some();
    let gain = drive_gain(rig);
    let driven = |values: &[f64]| -> Vec<f64> { values.iter().map(|v| gain * v).collect() };
    let input = traces.iter().find(|t| t.channel == "input");
    let recorded = at(&data.input);
    // Of a loop the displacement is seen, and with a controller its drive, too; under imposed motion the force.
    let pair = |seen: &[f64], drive: &[f64]| {
        if imposed { (recorded.clone(), seen.to_vec()) } else { (driven(drive), seen.to_vec()) }
    };
    let drive = |of: fn(&Trace) -> &Vec<f64>| input.map_or(&recorded, of);
    let measured = pair(&first.measured, &recorded);
    let [x, y] = if imposed {
        ["displacement [m]".to_owned(), "force [N]".to_owned()]
    } else {
        [format!("driving {what} [{force_unit}]"), named(&first.channel, unit(rig, &first.channel))]
    };
    let panel = |title: &str, model: (Vec<f64>, Vec<f64>), role| FitPanel {
        title: title.to_owned(),
        x: x.clone(),
        y: y.clone(),
        curves: vec![
            curve("measured", &measured.0, &measured.1, FitRole::Measured),
            curve(title, &model.0, &model.1, role),
        ],
        ..FitPanel::default()
    };
    let before = pair(&first.before, drive(|t| &t.before));
    let after = pair(&first.after, drive(|t| &t.after));
    Some(FitFigure {
        title: "The loop over the data".to_owned(),
        caption: if imposed {
            "The force against the displacement that was imposed.".to_owned()
        } else {
            format!("The {} against the driving {what}, before and after the fit.", first.channel)
        },
        panels: vec![
            panel("before", before, FitRole::Before),
            panel("after", after, FitRole::After),
        ],
        over_time: false,
    })
}

/// The values at those of the times `wanted` that `time` has, both ascending.
fn sampled(time: &[f64], values: &[f64], wanted: &[f64]) -> Vec<f64> {
    let at = |t: &f64| values.get(time.partition_point(|s| s < t)).copied().unwrap_or(f64::NAN);
    wanted.iter().map(at).collect()
}

/// The page of a regression: its table and what it says of the force.
pub(super) fn of_regression(title: &str, opening: String, rows: Vec<Vec<String>>) -> String {
    let parameters = FitPart {
        title: "Parameters".to_owned(),
        text: words(&[
            "Intervals are of 95 %, from standard errors that allow for residuals alike in time.",
        ]),
        head: words(&["parameter", "given", "found ± s.e.", "95 % interval", "moved"]),
        rows,
        ..part()
    };
    report::fit_page(&FitPage { title: safe(title), opening, parts: vec![parameters] })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(interval: [Option<f64>; 2], identified: bool) -> Estimate {
        Estimate {
            name: "f_s".to_owned(),
            given: 1.0,
            found: 1.234_567,
            standard_error: 1e-3,
            moved: true,
            identified,
            interval,
            asymptotic: [1.232_567, 1.236_567],
            bootstrap: None,
            at_bound: false,
        }
    }

    #[test]
    fn an_interval_that_is_open_is_said_in_words() {
        let said = |interval, identified| super::interval(&estimate(interval, identified));
        assert_eq!(said([Some(1.232_567), Some(1.236_567)], true), "1.2326 … 1.2366");
        assert_eq!(said([Some(1.232_567), None], false), "above 1.2326, no upper bound");
        assert_eq!(said([None, Some(1.236_567)], false), "below 1.2366, no lower bound");
        assert_eq!(said([None, None], false), "no bound on either side");
        assert_eq!(said([None, None], true), "1.2326 … 1.2366 (from s.e.)");
    }

    #[test]
    fn a_value_has_the_digits_that_its_error_makes_sense_of() {
        for (value, error, shown) in [
            (0.580_001_23, 3.8e-6, "0.5800012"),
            (-0.527_999_9, 1e-6, "-0.5279999"),
            (95.31, 0.167, "95.31"),
            (203.45, 5.0, "203.4"),
            (1.5e-7, 1e-10, "1.5000e-7"),
            (1.0, 0.0, "1"),
            (1.0, f64::INFINITY, "1"),
            (0.0, 1e-6, "0"),
        ] {
            assert_eq!(sure(value, error), shown, "{value} ± {error}");
        }
    }

    #[test]
    fn samples_are_found_by_their_time() {
        let (time, values) = ([0.0, 0.1, 0.2, 0.3], [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(sampled(&time, &values, &[0.1, 0.3]), [2.0, 4.0]);
        assert!(sampled(&time, &values, &[0.4])[0].is_nan(), "a sample that is not there");
    }
}
