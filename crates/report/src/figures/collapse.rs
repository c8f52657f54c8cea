//! Evaluations against the sweep at one tolerance: where a model without a Lipschitz constant breaks step control.

use super::{Drawing, incomplete, of_charts};
use crate::plot::{Axis, Chart, LaneRow, Line, Look};
use crate::select::{SOLVED, by_solver, corners_in_words, select};
use crate::{ReportError, number};
use record::{CaseRow, FigureRow, Summary};

/// The figure: one line for each adaptive solver, broken where it failed.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    let value = figure
        .value
        .ok_or_else(|| incomplete(figure, "no value", "the one tolerance it compares at"))?;
    let mut cases = select(figure, summary, Some("rtol"));
    cases.cases.retain(|case| (case.value / value - 1.0).abs() < 1e-6);
    let corners = cases.corners().first().map(|name| (*name).to_owned()).unwrap_or_default();
    cases.cases.retain(|case| case.corners == corners);
    if cases.cases.is_empty() {
        let found = format!("no case with tolerance {value:e}");
        return Err(incomplete(figure, &found, "a tolerance of its study"));
    }
    let points = cases.points.clone();
    let place = |case: &CaseRow| {
        let n = points.iter().position(|point| *point == case.point).unwrap_or(0);
        number::point_value(&case.point).unwrap_or(n as f64)
    };
    let name = points.iter().find_map(|point| point.split_once('=')).map_or("", |(name, _)| name);
    let mut x = Axis::linear(&number::symbol(name), cases.cases.iter().map(|case| place(case)));
    x.at = cases.cases.iter().map(|case| place(case)).collect();
    x.at.sort_by(f64::total_cmp);
    x.at.dedup();
    let work = |case: &CaseRow| case.evaluations.max(1) as f64;
    let solved = cases.cases.iter().filter(|case| case.status == SOLVED);
    let y = Axis::decades("evaluations", solved.map(|case| work(case)));
    let mut told = format!("tolerance {}, {}", number::short(value), corners_in_words(&corners));
    if let Some(study) = summary.studies.iter().find(|study| study.study == figure.study) {
        put!(told, ", at most {} evaluations", number::count(study.budget));
    }
    let mut chart = Chart { title: told, x, y, size: (640.0, 280.0), ..Chart::default() };
    for (solver, own) in by_solver(cases.cases.iter().copied()) {
        let look = Look::of_solver(solver);
        let height = |case: &CaseRow| if case.status == SOLVED { work(case) } else { f64::NAN };
        let mut points: Vec<_> = own.iter().map(|case| (place(case), height(case))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if points.iter().any(|point| point.1.is_finite()) {
            let name = solver.to_owned();
            chart.lines.push(Line { name, note: String::new(), look, points, marks: true });
        }
        let failed = own.iter().filter(|case| case.status != SOLVED);
        let marks: Vec<_> = failed.map(|case| (place(case), case.status.clone())).collect();
        if !marks.is_empty() {
            chart.lane.push(LaneRow { name: solver.to_owned(), look, marks });
        }
    }
    of_charts(figure, vec![chart], 1)
}
