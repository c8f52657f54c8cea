//! Largest error against evaluations of the right-hand side: what accuracy costs, solver by solver.

use super::convergence::{add, error_axis, title};
use super::{Drawing, of_charts};
use crate::ReportError;
use crate::plot::{Axis, Chart};
use crate::select::{by_solver, corners_in_words, select};
use record::{CaseRow, FigureRow, Summary};

/// One panel for each sweep point; where both treatments of corners were run, the restarted ones.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    let mut cases = select(figure, summary, None);
    let corners = cases.corners().first().map(|name| (*name).to_owned()).unwrap_or_default();
    cases.cases.retain(|case| case.corners == corners);
    let work = |case: &CaseRow| case.evaluations.max(1) as f64;
    let x = Axis::decades("evaluations", cases.cases.iter().map(|case| work(case)));
    let y = error_axis(&cases.cases);
    let mut charts = Vec::new();
    for point in &cases.points {
        let mut chart = Chart {
            title: title(point, corners_in_words(&corners)),
            x: x.clone(),
            y: y.clone(),
            size: (414.0, 250.0),
            ..Chart::default()
        };
        let here = cases.cases.iter().filter(|case| case.point == *point).copied();
        for (solver, own) in by_solver(here) {
            // A line joins the cases of one kind of control.
            add(&mut chart, solver, &own, work);
        }
        charts.push(chart);
    }
    of_charts(figure, charts, 2)
}
