//! Largest error against steps per period: what order each fixed-step method has, corner by corner.
//!
//! Rows are sweep points, and the two treatments of corners stand side by side, so that the cost of a missed
//! corner is read across; on a narrow screen they follow one another in the same order.

use super::{Drawing, of_charts};
use crate::plot::{Axis, Chart, Guide, LaneRow, Line, Look};
use crate::select::{SOLVED, Selection, by_solver, corners_in_words, select};
use crate::{ReportError, number};
use record::{CaseRow, FigureRow, StudyRow, Summary};

/// The figure.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    let cases = select(figure, summary, Some("step"));
    // A study over a span of seconds counts its steps over all of it.
    let whole = |row: &&StudyRow| row.study == figure.study && row.period == row.span;
    let run = summary.studies.iter().any(|row| whole(&row));
    let label = if run { "steps over the run" } else { "steps per period" };
    let x = Axis::values(label, cases.cases.iter().map(|c| c.value).collect());
    let mut slopes: Vec<u64> = cases
        .orders
        .iter()
        .filter(|row| cases.cases.iter().any(|case| case.solver == row.solver))
        .filter_map(|row| row.declared)
        .collect();
    slopes.sort_unstable();
    slopes.dedup();
    let charts = charts(&cases, &x, "steps", &[Guide::Slopes(slopes)]);
    of_charts(figure, charts, cases.corners().len())
}

/// One panel for each sweep point and treatment of corners, errors against the controls' values.
pub(super) fn charts(cases: &Selection, x: &Axis, against: &str, guides: &[Guide]) -> Vec<Chart> {
    let y = error_axis(cases);
    let mut charts = Vec::new();
    for point in &cases.points {
        for corners in cases.corners() {
            let here = |case: &&&CaseRow| case.point == *point && cases.shows(case, corners);
            let mut chart = Chart {
                title: title(point, corners_in_words(corners)),
                x: x.clone(),
                y: y.clone(),
                guides: guides.to_vec(),
                size: (414.0, 215.0),
                ..Chart::default()
            };
            for (solver, own) in by_solver(cases.cases.iter().filter(here).copied()) {
                let order = own.first().and_then(|case| cases.order(case, against));
                let note = order.map_or_else(String::new, |order| number::decimal(order, 1));
                add(&mut chart, solver, &own, |case| case.value);
                if let Some(line) = chart.lines.last_mut().filter(|line| line.name == solver) {
                    line.note = note;
                }
            }
            charts.push(chart);
        }
    }
    charts
}

/// `γ = 0.25, corners ignored`.
pub(super) fn title(point: &str, rest: &str) -> String {
    let parts = [number::point(point), rest.to_owned()];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

/// The axis of largest errors: above ten times the answer there is nothing to compare, and below round-off
/// nothing to see.
pub(super) fn error_axis(selection: &Selection) -> Axis {
    let solved = selection.cases.iter().filter(|case| case.status == SOLVED);
    let label = match selection.response {
        "" => "largest error, relative".to_owned(),
        response => format!("largest error of {response}, relative"),
    };
    let errors = solved.filter_map(|case| case.error_max);
    let axis = Axis::decades(&label, errors.map(|e| e.clamp(number::ROUND_OFF, 10.0)));
    let below = axis.from < 2.0 * number::ROUND_OFF;
    Axis { below, ..axis }
}

/// A solver's solved cases as a line, the others as marks in the lane.
pub(super) fn add(
    chart: &mut Chart,
    solver: &str,
    cases: &[&CaseRow],
    x: impl Fn(&CaseRow) -> f64,
) {
    let look = Look::of_solver(solver);
    let floor = chart.y.from;
    let height = |case: &CaseRow| match case.error_max {
        Some(error) if case.status == SOLVED && error.is_finite() => error.abs().max(floor),
        _ => f64::NAN,
    };
    let mut points: Vec<_> = cases.iter().map(|case| (x(case), height(case))).collect();
    points.sort_by(|a, b| chart.x.share(a.0).total_cmp(&chart.x.share(b.0)));
    if points.iter().any(|point| point.1.is_finite()) {
        let name = solver.to_owned();
        chart.lines.push(Line { name, note: String::new(), look, points, marks: true });
    }
    let failed = cases.iter().filter(|case| case.status != SOLVED);
    let marks: Vec<_> = failed.map(|case| (x(case), case.status.clone())).collect();
    if !marks.is_empty() {
        chart.lane.push(LaneRow { name: solver.to_owned(), look, marks });
    }
}
