//! Tables of text, the same for the page and for Markdown.

use crate::escape;
use crate::number::{self, NONE};
use crate::prose;
use crate::select::{SOLVED, by_solver, distinct, response};
use record::{CaseRow, OrderRow, Summary};

/// A table to be shown: plain text in every cell, lines parted by `\n`.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Grid {
    /// The headers.
    pub(crate) head: Vec<String>,
    /// The rows.
    pub(crate) rows: Vec<Vec<String>>,
    /// What it is, for the page's style.
    pub(crate) class: &'static str,
    /// How many of the first columns are words and not numbers.
    pub(crate) words: usize,
}

impl Grid {
    /// As HTML, in a box that scrolls by itself.
    pub(crate) fn html(&self, label: &str) -> String {
        let lines = |text: &str| prose::html(text).replace('\n', "<br>");
        let mut out = format!(
            "<div class=\"box\" role=\"region\" tabindex=\"0\" aria-label=\"{}\"><table class=\"{}\"><thead><tr>",
            escape::html(label),
            self.class
        );
        for cell in &self.head {
            put!(out, "<th scope=\"col\">{}", lines(cell));
        }
        out.push_str("</thead><tbody>\n");
        for row in &self.rows {
            out.push_str("<tr>");
            for (i, cell) in row.iter().enumerate() {
                let tag = if i == 0 { "<th scope=\"row\">" } else { "<td>" };
                out.push_str(tag);
                out.push_str(&lines(cell));
            }
            out.push('\n');
        }
        out.push_str("</tbody></table></div>\n");
        out
    }

    /// As a Markdown table.
    pub(crate) fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            let cells: Vec<String> = cells
                .iter()
                .map(|cell| cell.split('\n').map(prose::markdown).collect::<Vec<_>>().join("<br>"))
                .collect();
            format!("| {} |\n", cells.join(" | "))
        };
        let rule = |i| if i < self.words { "---" } else { "---:" };
        let rules: Vec<&str> = (0..self.head.len()).map(rule).collect();
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        format!("{}|{}|\n{rows}", line(&self.head), rules.join("|"))
    }
}

/// The measured quantities, if there are any.
pub(crate) fn measures(summary: &Summary) -> Option<Grid> {
    let rows: Vec<_> = summary
        .measures
        .iter()
        .map(|row| {
            let value = number::with_error(row.value, Some(row.error), &row.unit);
            let mut how = vec![row.method.clone()];
            if !row.second.is_empty() {
                how.push(format!("against {}", row.second));
            }
            how.push(row.code.clone());
            how.retain(|part| !part.is_empty());
            vec![format!("{}\n{}", row.what, row.id), value, how.join("\n")]
        })
        .collect();
    let head = ["quantity", "value", "how"].map(str::to_owned).to_vec();
    (!rows.is_empty()).then_some(Grid { head, rows, class: "measures", words: 3 })
}

/// How the table of orders is read.
pub(crate) const ORDERS_READ: &str = "Each cell: above restarted at corners, below with corners ignored. \
     Against steps the number is to be held against the declared order. \
     Against rtol it is the slope of the error over the tolerance: 1 is proportional, and a method of order p \
     that controls the error of each step without extrapolating has p/(p+1). \
     A ~ stands before a slope through three runs or fewer.";

/// How the table of smallest errors is read.
const BEST_READ: &str = "Each cell: the largest error of a run, at the step or tolerance where it is smallest; \
     above restarted at corners, below with corners ignored. \
     Then, after ✗, how many of the runs failed.";

/// How the table of smallest errors of one study is read, and what its errors are relative to.
pub(crate) fn best_read(summary: &Summary, study: &str) -> String {
    let of = match response(summary, study) {
        "" => "value",
        response => response,
    };
    format!("{BEST_READ} Errors are relative to the largest {of} of the reference.")
}

/// Fewer points than these make a slope, but not an order.
const FEW: u64 = 4;

/// The observed orders of one study: restarted above ignored, for each sweep point.
pub(crate) fn orders(summary: &Summary, study: &str) -> Option<Grid> {
    let all: Vec<&OrderRow> = summary.orders.iter().filter(|row| row.study == study).collect();
    let points = distinct(all.iter().map(|row| row.point.as_str()));
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut seen: Vec<(&str, &str)> = Vec::new();
    for row in &all {
        let (solver, against) = (row.solver.as_str(), row.against.as_str());
        if seen.contains(&(solver, against)) {
            continue;
        }
        seen.push((solver, against));
        let order = |point: &str, corners: &str| {
            let same = |r: &&&OrderRow| r.solver == solver && r.against == against;
            let found = all.iter().filter(same).find(|r| r.point == point && r.corners == corners);
            let rough = found.is_some_and(|r| r.order.is_some() && r.points < FEW);
            let sign = if rough { "~" } else { "" };
            format!("{sign}{}", number::maybe(found.and_then(|r| r.order), 2))
        };
        let ours = row.library == "own" && against == "rtol";
        let otherwise = if ours { NONE } else { "variable" };
        let declared = row.declared.map_or_else(|| otherwise.to_owned(), |d| d.to_string());
        let mut cells = vec![solver.to_owned(), declared, against.to_owned()];
        cells.extend(
            points.iter().map(|p| format!("{}\n{}", order(p, "restart"), order(p, "ignore"))),
        );
        rows.push(cells);
    }
    let mut head = vec!["solver".to_owned(), "declared".to_owned(), "against".to_owned()];
    head.extend(points.iter().map(|point| column_title(point, "observed")));
    (!rows.is_empty()).then_some(Grid { head, rows, class: "orders", words: 3 })
}

fn column_title(point: &str, otherwise: &str) -> String {
    if point.is_empty() { otherwise.to_owned() } else { number::point(point) }
}

/// One study at a glance: each solver's smallest error, restarted and not, and how many of its cases failed.
pub(crate) fn best(summary: &Summary, study: &str) -> Option<Grid> {
    let all: Vec<&CaseRow> = summary.cases.iter().filter(|case| case.study == study).collect();
    let points = distinct(all.iter().map(|case| case.point.as_str()));
    let rows: Vec<Vec<String>> = by_solver(all.iter().copied())
        .into_iter()
        .map(|(solver, own)| {
            let cell = |point: &&str| {
                best_cell(&own.iter().copied().filter(|c| c.point == **point).collect::<Vec<_>>())
            };
            std::iter::once(solver.to_owned()).chain(points.iter().map(cell)).collect()
        })
        .collect();
    let head = std::iter::once("solver".to_owned());
    let head = head.chain(points.iter().map(|point| column_title(point, "smallest"))).collect();
    (!rows.is_empty()).then_some(Grid { head, rows, class: "best", words: 1 })
}

fn best_cell(cases: &[&CaseRow]) -> String {
    let least = |corners: &'static str| {
        let solved = cases.iter().filter(|c| c.corners == corners && c.status == SOLVED);
        let errors = solved.filter_map(|c| c.error_max).filter(|e| e.is_finite());
        number::error(errors.min_by(f64::total_cmp))
    };
    let (all, failed) = (cases.len(), cases.iter().filter(|c| c.status != SOLVED).count());
    if all == 0 {
        return NONE.to_owned();
    }
    let errors = format!("{}\n{}", least("restart"), least("ignore"));
    if failed == 0 { errors } else { format!("{errors}\n✗ {failed} of {all}") }
}

/// Every case of one study at one sweep point.
pub(crate) fn cases(summary: &Summary, study: &str, point: &str) -> Grid {
    let own = summary.cases.iter().filter(|case| case.study == study && case.point == point);
    let rows = by_solver(own).into_iter().flat_map(|(_, own)| own).map(case_row).collect();
    let head = [
        "solver",
        "control",
        "corners",
        "status",
        "final error",
        "largest",
        "ℓ²",
        "away from kinks",
        "digits",
        "order",
        "evaluations",
        "accepted",
        "rejected",
    ];
    Grid { head: head.map(str::to_owned).to_vec(), rows, class: "cases", words: 4 }
}

fn case_row(case: &CaseRow) -> Vec<String> {
    let control = match case.control.as_str() {
        "step" => format!("{} steps", number::short(case.value)),
        "rtol" => format!("rtol {}", number::short(case.value)),
        "none" => "exact".to_owned(),
        other => format!("{other} {}", number::short(case.value)),
    };
    let mut row = vec![case.solver.clone(), control, case.corners.clone(), status(case)];
    row.extend(
        [case.error_final, case.error_max, case.error_l2, case.error_away].map(number::error),
    );
    row.push(number::maybe(case.digits, 1));
    row.push(number::maybe(case.order, 2));
    row.push(number::count(case.evaluations));
    row.push(number::count(case.accepted));
    row.push(case.rejected.map_or_else(|| NONE.to_owned(), number::count));
    row
}

/// What the signs behind a status mean, and why, if a case of the study has one.
pub(crate) fn signs(summary: &Summary, study: &str) -> Option<String> {
    let own = summary.cases.iter().filter(|case| case.study == study);
    let reasons = distinct(own.map(|case| case.irreproducible.as_str()));
    let why: Vec<&str> = reasons
        .into_iter()
        .filter(|reason| !reason.is_empty())
        .map(|reason| match summary.about(&format!("irreproducible {reason}")) {
            "" => reason,
            told => told,
        })
        .collect();
    (!why.is_empty()).then(|| {
        let what = "† another processor gives other numbers, ‡ or even another ending.";
        format!("{what} {}", why.join(" "))
    })
}

/// How a case ended, how far it got, and what it said.
fn status(case: &CaseRow) -> String {
    let mut text = if case.status == SOLVED {
        case.status.clone()
    } else {
        format!("✗ {} at {}\u{202f}%", case.status, number::decimal(case.reached * 100.0, 1))
    };
    match (case.irreproducible.is_empty(), case.any_status) {
        (_, true) => text.push_str(" ‡"),
        (false, false) => text.push_str(" †"),
        (true, false) => {}
    }
    if !case.detail.is_empty() {
        put!(text, "\n{}", case.detail);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_keeps_its_columns_whatever_stands_in_it() {
        let cells = |a: &str, b: &str| vec![a.to_owned(), b.to_owned()];
        let rows = vec![cells("<b>|`x`", "two\nlines")];
        let grid = Grid { head: cells("a", "b"), rows, class: "best", words: 1 };
        assert_eq!(
            grid.markdown(),
            "| a | b |\n|---|---:|\n| &lt;b&gt;\\|\\`x\\` | two<br>lines |\n"
        );
        assert!(grid.html("x").contains("<th scope=\"row\">&lt;b&gt;|`x`<td>two<br>lines"));
    }
}
