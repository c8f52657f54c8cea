//! Curves on given axes: hysteresis loops, histories of steps.

use super::{Drawing, incomplete, of_charts};
use crate::plot::{Axis, Chart, LaneRow, Line, Look};
use crate::select::{SOLVED, distinct, select};
use crate::{ReportError, number};
use record::{CaseRow, CurveRow, FigureRow, PanelRow, Summary};

/// More points than these are a line, fewer are marked one by one.
const FEW: usize = 12;

/// The figure's panels with their curves.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    let panels: Vec<&PanelRow> =
        summary.panels.iter().filter(|row| row.figure == figure.figure).collect();
    if panels.is_empty() {
        return Err(incomplete(figure, "no row in the table of panels", "one or more"));
    }
    let rows: Vec<&CurveRow> =
        summary.curves.iter().filter(|row| row.figure == figure.figure).collect();
    let names = distinct(rows.iter().map(|row| row.series.as_str()));
    // Where no panel has two curves there is nothing to tell apart.
    let in_panel = |panel: &&&PanelRow| {
        let own = rows.iter().filter(|row| row.panel == panel.panel);
        distinct(own.map(|row| row.series.as_str())).len()
    };
    let alone = panels.iter().map(|panel| in_panel(&panel)).all(|n| n < 2);
    let (size, columns) = match panels.len() {
        1 => ((640.0, 340.0), 1),
        _ if are_histories(&panels) => ((848.0, 170.0), 1),
        _ => ((414.0, 260.0), 2),
    };
    let chart = |panel: &&PanelRow| {
        let axis = |label: &str, from, to, log| {
            Axis { label: label.to_owned(), from, to, log, ..Axis::default() }.checked()
        };
        let lines = lines(&rows, panel, &names, alone);
        let lane = failures(figure, summary, panel, &lines);
        Chart {
            title: number::point(&panel.panel),
            x: axis(&panel.x, panel.x_min, panel.x_max, panel.x_log),
            y: axis(&panel.y, panel.y_min, panel.y_max, panel.y_log),
            unnamed: lines.len() < 2 && lane.is_empty(),
            lane,
            lines: lines.into_iter().map(|(_, line)| line).collect(),
            size,
            ..Chart::default()
        }
    };
    of_charts(figure, panels.iter().map(chart).collect(), columns)
}

/// Whether the panels show different quantities over one and the same time: they stand below one another.
fn are_histories(panels: &[&PanelRow]) -> bool {
    let over = |row: &PanelRow| (row.x.clone(), row.x_min, row.x_max, row.x_log);
    let same = panels.windows(2).all(|pair| over(pair[0]) == over(pair[1]));
    let quantities = distinct(panels.iter().map(|row| row.y.as_str()));
    same && quantities.len() == panels.len()
}

/// The curves of one panel, each with the name of its series in the table.
fn lines<'a>(
    rows: &[&CurveRow],
    panel: &PanelRow,
    names: &[&'a str],
    alone: bool,
) -> Vec<(&'a str, Line)> {
    let line = |(n, name): (usize, &&'a str)| {
        let own = rows.iter().filter(|row| row.panel == panel.panel && row.series == **name);
        let points: Vec<_> = own.map(|row| (row.x, row.y)).collect();
        let marks = points.len() <= FEW;
        let n = if alone || lonely(rows, name) { 0 } else { n };
        let look = if Look::is_solver(name) { Look::of_solver(name) } else { Look::nth(n) };
        (*name, Line { name: number::point(name), note: String::new(), look, points, marks })
    };
    let drawn = |(_, line): &(&str, Line)| !line.points.is_empty();
    names.iter().enumerate().map(line).filter(drawn).collect()
}

/// Whether a series shares no panel with another: it needs no look of its own.
fn lonely(rows: &[&CurveRow], name: &str) -> bool {
    let panels = distinct(rows.iter().filter(|r| r.series == name).map(|r| r.panel.as_str()));
    !rows.iter().any(|row| row.series != name && panels.contains(&row.panel.as_str()))
}

/// The histories that end where their run failed: a line that just stops would seem to have arrived.
fn failures(
    figure: &FigureRow,
    summary: &Summary,
    panel: &PanelRow,
    lines: &[(&str, Line)],
) -> Vec<LaneRow> {
    let study = summary.studies.iter().find(|study| study.study == figure.study);
    let Some(span) = study.map(|study| study.span).filter(|_| figure.kind == "history") else {
        return Vec::new();
    };
    let cases = select(figure, summary, None).cases;
    let row = |(name, line): &(&str, Line)| {
        let end = line.points.last()?.0;
        let here = |case: &&&CaseRow| {
            let point = [name, panel.panel.as_str(), ""].contains(&case.point.as_str());
            let solver = case.solver == *name || !Look::is_solver(name);
            point && solver && case.status != SOLVED
        };
        let ends = |case: &&&CaseRow| (case.reached * span - end).abs() <= 1e-6 * span;
        let case = cases.iter().filter(here).find(ends)?;
        let marks = vec![(end, case.status.clone())];
        Some(LaneRow { name: line.name.clone(), look: line.look, marks })
    };
    lines.iter().filter_map(row).collect()
}
