//! Largest error against evaluations of the right-hand side: what accuracy costs, solver by solver.
//!
//! Fixed steps and step control stand side by side on the same axes, each with the other's lines in grey:
//! fourteen lines in one panel could not be told apart. An exact method is one mark, at its cost and its round-off.

use super::convergence::{add, error_axis, title};
use super::{Drawing, of_charts};
use crate::ReportError;
use crate::plot::{Axis, Chart};
use crate::select::{SOLVED, by_solver, corners_in_words, distinct, is_exact, is_ours, select};
use record::{CaseRow, FigureRow, Summary};

/// A row of panels for each sweep point, ours with step control; where both treatments of corners were run, the restarted ones.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    let mut cases = select(figure, summary, None);
    let corners = cases.corners().first().copied().unwrap_or_default();
    cases.cases.retain(|case| is_ours(case) || case.corners == corners);
    let work = |case: &CaseRow| case.evaluations.max(1) as f64;
    // A run that failed spent its budget: it would squeeze those that solved, and stands at the edge instead.
    let all = cases.cases.iter();
    let solved: Vec<f64> = all.clone().filter(|c| c.status == SOLVED).map(|c| work(c)).collect();
    let set_by = if solved.is_empty() { all.map(|c| work(c)).collect() } else { solved };
    let x = Axis::tight("evaluations", set_by.into_iter());
    let y = error_axis(&cases);
    let mut controls = distinct(cases.cases.iter().map(|case| case.control.as_str()));
    controls.sort_by_key(|name| (*name == "none", *name != "step"));
    // An exact method needs no control: it stands with those that control themselves.
    if controls.len() > 1 {
        controls.retain(|name| *name != "none");
    }
    let last = controls.last().copied().unwrap_or_default();
    let mut charts = Vec::new();
    for point in &cases.points {
        let mut row: Vec<Chart> = Vec::new();
        for control in &controls {
            let name = match *control {
                "step" => "fixed step",
                "rtol" => "step control",
                "none" => "exact",
                other => other,
            };
            let mut chart = Chart {
                title: title(point, &format!("{name}, {}", corners_in_words(corners))),
                x: x.clone(),
                y: y.clone(),
                size: (414.0, 230.0),
                ..Chart::default()
            };
            let here = |case: &&CaseRow| {
                let exact = is_exact(case) && *control == last;
                case.point == *point && (exact || case.control == *control)
            };
            for (solver, own) in by_solver(cases.cases.iter().copied().filter(here)) {
                add(&mut chart, solver, &own, work);
            }
            row.push(chart);
        }
        let lines: Vec<Vec<_>> =
            row.iter().map(|c| c.lines.iter().map(|line| line.points.clone()).collect()).collect();
        for (i, chart) in row.iter_mut().enumerate() {
            let others = lines.iter().enumerate().filter(|(other, _)| *other != i);
            chart.ghosts = others.flat_map(|(_, lines)| lines.iter().cloned()).collect();
        }
        charts.extend(row);
    }
    of_charts(figure, charts, controls.len())
}
