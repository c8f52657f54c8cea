//! Which cases a figure or a table shows, in the order it shows them.

use crate::plot::rank;
use record::{CaseRow, FigureRow, OrderRow, Summary};

/// The status of a case that came to its end.
pub(crate) const SOLVED: &str = "solved";

/// Whether it is a run of an exact method: nothing controls it.
pub(crate) fn is_exact(case: &CaseRow) -> bool {
    case.control == "none"
}

/// Whether it is a run of a method of our own that was given the task, and knew the corners. Our own
/// solvers of a right-hand side all take fixed steps.
pub(crate) fn is_ours(case: &CaseRow) -> bool {
    is_exact(case) || (case.library == "own" && case.control == "rtol")
}

/// The cases of one figure.
#[derive(Debug)]
pub(crate) struct Selection<'a> {
    /// The cases, in the table's order.
    pub(crate) cases: Vec<&'a CaseRow>,
    /// The orders of the same solvers and points.
    pub(crate) orders: Vec<&'a OrderRow>,
    /// The sweep points in the table's order; one empty name without a sweep.
    pub(crate) points: Vec<&'a str>,
    /// What errors are errors of, as the study says it.
    pub(crate) response: &'a str,
}

/// What the errors of this study are errors of, as `displacement q`; empty if it does not say.
pub(crate) fn response<'a>(summary: &'a Summary, study: &str) -> &'a str {
    summary.studies.iter().find(|row| row.study == study).map_or("", |row| &row.response)
}

/// The cases with this control that a figure's row asks for; any control if none is given.
pub(crate) fn select<'a>(
    figure: &FigureRow,
    summary: &'a Summary,
    control: Option<&str>,
) -> Selection<'a> {
    let listed = |list: &str, name: &str| {
        list.trim().is_empty() || list.split(';').any(|entry| entry.trim() == name)
    };
    let cases: Vec<&CaseRow> = summary
        .cases
        .iter()
        .filter(|case| case.study == figure.study)
        .filter(|case| control.is_none_or(|control| case.control == control))
        .filter(|case| listed(&figure.points, &case.point) && listed(&figure.solvers, &case.solver))
        .collect();
    let orders: Vec<&OrderRow> = summary
        .orders
        .iter()
        .filter(|row| row.study == figure.study)
        .filter(|row| listed(&figure.points, &row.point) && listed(&figure.solvers, &row.solver))
        .collect();
    let names = cases.iter().map(|case| case.point.as_str());
    let points = distinct(names.chain(orders.iter().map(|row| row.point.as_str())));
    let response = response(summary, &figure.study);
    Selection { cases, orders, points, response }
}

impl<'a> Selection<'a> {
    /// The corner treatments that occur: `restart` first. What knows its corners counts only if alone.
    pub(crate) fn corners(&self) -> Vec<&'a str> {
        let of = |ours: bool| {
            let cases = self.cases.iter().filter(move |case| ours || !is_ours(case));
            distinct(cases.map(|case| case.corners.as_str()))
        };
        let told = of(false);
        let mut corners = if told.is_empty() { of(true) } else { told };
        corners.sort_by_key(|name| std::cmp::Reverse(*name));
        corners
    }

    /// Whether a panel of this corner treatment shows the case: what knows its corners stands in the first.
    pub(crate) fn shows(&self, case: &CaseRow, corners: &str) -> bool {
        if is_ours(case) {
            return self.corners().first().is_some_and(|first| *first == corners);
        }
        case.corners == corners
    }

    /// The observed order against `steps` or `rtol`.
    pub(crate) fn order(&self, case: &CaseRow, against: &str) -> Option<f64> {
        self.orders
            .iter()
            .find(|row| {
                (row.against == against)
                    && (&row.point, &row.solver, &row.corners)
                        == (&case.point, &case.solver, &case.corners)
            })
            .and_then(|row| row.order)
    }
}

/// Every solver of these cases with its cases, in the order of the list of solvers.
pub(crate) fn by_solver<'a>(
    cases: impl Iterator<Item = &'a CaseRow>,
) -> Vec<(&'a str, Vec<&'a CaseRow>)> {
    let mut all: Vec<(&str, Vec<&CaseRow>)> = Vec::new();
    for case in cases {
        match all.iter_mut().find(|(solver, _)| *solver == case.solver) {
            Some((_, cases)) => cases.push(case),
            None => all.push((&case.solver, vec![case])),
        }
    }
    all.sort_by_key(|(solver, _)| rank(solver));
    all
}

/// The names, each once, in the order of their first appearance.
pub(crate) fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut all = Vec::new();
    for name in names {
        if !all.contains(&name) {
            all.push(name);
        }
    }
    all
}

/// How a treatment of corners is told.
pub(crate) fn corners_in_words(corners: &str) -> &str {
    match corners {
        "restart" => "restarted at corners",
        "ignore" => "corners ignored",
        other => other,
    }
}
