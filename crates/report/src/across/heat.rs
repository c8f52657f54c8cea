//! The map of errors: problems in rows, solvers in columns, each cell the error delivered there.

use super::{NAME, Problem};
use crate::figures::{Datum, Drawing};
use crate::plot::{Canvas, Fault, Ink, Panel, Side, fit, sketch, text_width};
use crate::select::{SOLVED, is_exact, is_ours};
use crate::{ReportError, number};
use record::CaseRow;

/// The height of a row and the width of a column [px].
const CELL: (f64, f64) = (38.0, 20.0);
/// The widest name of a problem, and of a solver, which stands upright [px].
const NAMES: (f64, f64) = (200.0, 150.0);
/// More problems than these are drawn study by study, the worst point of each.
const MOST_ROWS: usize = 44;
/// Between groups of columns [px].
const GAP: f64 = 16.0;
/// The tolerance that the map compares at, or the study's next to it.
const TOLERANCE: f64 = 1e-6;
/// The bounds of the shades, and what the key says of them.
const SHADES: [(f64, &str); 3] = [(1e-6, "≤ 10⁻⁶"), (1e-3, "≤ 10⁻³"), (0.1, "≤ 0.1")];

/// A row: its name, its chapter, its problems.
struct Row<'a> {
    name: String,
    chapter: usize,
    problems: Vec<&'a Problem<'a>>,
}

/// A column: a solver, or several methods of ours of which at most a few hold on any problem.
struct Column<'a> {
    name: &'a str,
    members: Vec<&'a str>,
}

/// A cell.
struct Cell<'a> {
    /// The run shown: of several the worst.
    case: &'a CaseRow,
    /// Whether it, or one of the others of several, is a silent failure.
    silent: bool,
}

struct Map<'a> {
    rows: Vec<Row<'a>>,
    /// The title of a group of columns, and its columns.
    groups: Vec<(&'static str, Vec<Column<'a>>)>,
    titles: &'a [&'a str],
    left: f64,
    head: f64,
}

/// The map of all problems and solvers.
pub(super) fn draw<'a>(
    problems: &'a [Problem<'a>],
    solvers: &[&'a str],
    titles: &'a [&'a str],
) -> Result<Drawing, ReportError> {
    let rows = rows(problems);
    let groups = groups(problems, solvers);
    let widest = rows.iter().map(|row| text_width(&row.name)).fold(60.0, f64::max);
    let columns = groups.iter().flat_map(|(_, columns)| columns);
    let tallest = columns.map(|column| text_width(column.name)).fold(40.0, f64::max);
    let head = tallest.min(NAMES.1) + 78.0;
    let map = Map { rows, groups, titles, left: widest.min(NAMES.0) + 12.0, head };
    let (width, height) = (map.right().max(560.0), map.bottom() + 8.0);
    let fault = |why| ReportError::Drawing { figure: NAME.to_owned(), why };
    let body = sketch((width, height), |canvas| map.draw(canvas)).map_err(fault)?;
    let description = format!(
        "A table of {} problems by {} solvers; each cell holds the power of ten that bounds the largest error, \
         or a cross where the run failed, and an exclamation mark where a run said solved and was not.",
        map.rows.len(),
        solvers.len()
    );
    Ok(Drawing {
        panels: vec![Panel { title: String::new(), description, width, height, body }],
        columns: 1,
        data: map.data(),
        x: "control value".to_owned(),
        y: "largest error, relative".to_owned(),
    })
}

/// The solvers by what controls them, and behind them what is given the task.
fn groups<'a>(problems: &[Problem], solvers: &[&'a str]) -> Vec<(&'static str, Vec<Column<'a>>)> {
    let of = |fits: &dyn Fn(&CaseRow) -> bool| {
        let first = |s: &&&str| problems.iter().flat_map(|p| p.of(s)).next().is_some_and(fits);
        solvers.iter().filter(first).copied().collect::<Vec<&str>>()
    };
    let each = |all: Vec<&'a str>| -> Vec<Column<'a>> {
        all.into_iter().map(|name| Column { name, members: vec![name] }).collect()
    };
    let whole =
        |name, members: Vec<&'a str>| (!members.is_empty()).then_some(Column { name, members });
    let exact = of(&|case| is_exact(case));
    let adaptive = of(&|case| is_ours(case) && !is_exact(case));
    let mut ours: Vec<Column> = whole("exact", exact).into_iter().collect();
    ours.extend(each(adaptive));
    let mut groups: Vec<(&str, Vec<Column>)> = vec![
        ("finest step", each(of(&|case| case.control == "step"))),
        ("rtol next to 10⁻⁶", each(of(&|case| case.control == "rtol" && !is_ours(case)))),
        ("ours", ours),
    ];
    groups.retain(|(_, columns)| !columns.is_empty());
    groups
}

/// One row for each problem, or for each study if the problems are too many.
fn rows<'a>(problems: &'a [Problem<'a>]) -> Vec<Row<'a>> {
    let mut rows: Vec<Row> = Vec::new();
    for problem in problems {
        let same = |row: &&mut Row| {
            row.chapter == problem.chapter && row.problems[0].study == problem.study
        };
        match rows.iter_mut().find(same).filter(|_| problems.len() > MOST_ROWS) {
            Some(row) => row.problems.push(problem),
            None => rows.push(Row {
                name: if problems.len() > MOST_ROWS {
                    problem.study.to_owned()
                } else {
                    problem.name()
                },
                chapter: problem.chapter,
                problems: vec![problem],
            }),
        }
    }
    rows
}

/// The run of a solver on a problem that the map shows: restarted at corners, at the tolerance next to the
/// map's, or at the finest step.
fn shown<'a>(problem: &'a Problem, solver: &'a str) -> Option<&'a CaseRow> {
    let corners = problem.of(solver).map(|case| case.corners.as_str()).max()?;
    let far = |case: &CaseRow| match case.control.as_str() {
        // Of two tolerances as far away the tighter one.
        "rtol" => {
            (case.value / TOLERANCE).log10().abs() + if case.value > TOLERANCE { 1e-3 } else { 0.0 }
        }
        _ => -case.value,
    };
    problem
        .of(solver)
        .filter(|case| case.corners == corners)
        .min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// Its error if it solved; what failed is worse than any error.
fn severity(case: &CaseRow) -> f64 {
    case.error_max.filter(|e| case.status == SOLVED && !e.is_nan()).unwrap_or(f64::INFINITY)
}

impl<'a> Row<'a> {
    /// What the map shows of a column here, if one of its members was run.
    fn cell(&'a self, column: &'a Column<'a>) -> Option<Cell<'a>> {
        let of = |p: &'a &'a Problem<'a>| {
            column.members.iter().filter_map(move |solver| Some((p, shown(p, solver)?)))
        };
        let runs = self.problems.iter().flat_map(of);
        let silent = runs.clone().any(|(problem, case)| problem.silence(case).is_some());
        let worst = runs.max_by(|a, b| severity(a.1).total_cmp(&severity(b.1)));
        worst.map(|(_, case)| Cell { case, silent })
    }
}

impl<'a> Map<'a> {
    /// Every column with its left edge.
    fn columns(&self) -> Vec<(&Column<'a>, f64)> {
        let mut x = self.left;
        let mut all = Vec::new();
        for (_, columns) in &self.groups {
            for column in columns {
                all.push((column, x));
                x += CELL.0;
            }
            x += GAP;
        }
        all
    }

    fn right(&self) -> f64 {
        self.columns().last().map_or(self.left, |(_, x)| x + CELL.0)
    }

    /// The upper edge of a row: a line for the title stands before the first of each chapter.
    fn top(&self, row: usize) -> f64 {
        let of = |n: usize| self.rows.get(n).map(|row| row.chapter);
        let titles = (0..=row.min(self.rows.len().saturating_sub(1)))
            .filter(|n| *n == 0 || of(*n) != of(n - 1))
            .count();
        self.head + CELL.1 * row as f64 + 26.0 * titles as f64
    }

    fn bottom(&self) -> f64 {
        self.top(self.rows.len())
    }

    fn draw(&self, canvas: &Canvas) -> Result<(), Fault> {
        draw_key(canvas)?;
        let mut first = self.left;
        for (n, (title, columns)) in self.groups.iter().enumerate() {
            let room = CELL.0 * columns.len() as f64 + GAP;
            let last = n + 1 == self.groups.len();
            let title = fit(title, if last { room.max(90.0) } else { room });
            canvas.text(&title, (first, 48.0), Side::Right, Ink::Title)?;
            first += room;
        }
        for (column, x) in self.columns() {
            canvas.text_up(&fit(column.name, NAMES.1), (x + CELL.0 / 2.0, self.head), Ink::Text)?;
        }
        for (n, row) in self.rows.iter().enumerate() {
            let y = self.top(n);
            if n == 0 || self.rows[n - 1].chapter != row.chapter {
                let title = fit(self.titles[row.chapter], self.right());
                canvas.text(&title, (0.0, y - 10.0), Side::Right, Ink::Title)?;
            }
            let middle = y + CELL.1 / 2.0;
            canvas.text(&fit(&row.name, NAMES.0), (8.0, middle), Side::Right, Ink::Text)?;
            for (column, x) in self.columns() {
                if let Some(cell) = row.cell(column) {
                    draw_cell(canvas, (x, y), &cell)?;
                }
            }
        }
        Ok(())
    }

    fn data(&self) -> Vec<Datum> {
        let mut all = Vec::new();
        for row in &self.rows {
            for (column, _) in self.columns() {
                let Some(cell) = row.cell(column) else { continue };
                let mut note = Vec::new();
                if cell.case.status != SOLVED {
                    note.push(cell.case.status.clone());
                }
                if cell.silent {
                    note.push("said solved and was not".to_owned());
                }
                all.push(Datum {
                    panel: format!("{}: {}", self.titles[row.chapter], row.name),
                    series: cell.case.solver.clone(),
                    x: Some(cell.case.value),
                    y: cell.case.error_max.filter(|_| cell.case.status == SOLVED),
                    note: note.join("; "),
                });
            }
        }
        all
    }
}

/// The shade of a run: 0 the best, 3 a wrong answer; none for a failed one.
fn shade(case: &CaseRow) -> Option<u8> {
    let error = case.error_max.filter(|_| case.status == SOLVED)?;
    (0..).zip(SHADES).find(|(_, (bound, _))| error <= *bound).map_or(Some(3), |(n, _)| Some(n))
}

/// The power of ten that bounds the error: `−5`.
#[expect(clippy::cast_possible_truncation, reason = "clamped to what fits")]
fn bound(error: f64) -> String {
    if !error.is_finite() {
        return "∞".to_owned();
    }
    let exponent = (error.abs().log10() - 1e-9).ceil().clamp(-13.0, 99.0) as i32;
    number::decimal(f64::from(exponent), 0)
}

fn draw_cell(canvas: &Canvas, (x, y): (f64, f64), cell: &Cell) -> Result<(), Fault> {
    let middle = (x + CELL.0 / 2.0, y + CELL.1 / 2.0);
    let text = if let (Some(shade), Some(error)) = (shade(cell.case), cell.case.error_max) {
        let (low, high) = ((x + 1.0, y + 1.0), (x + CELL.0 - 1.0, y + CELL.1 - 1.0));
        canvas.block(low, high, Ink::Shade(shade))?;
        bound(error)
    } else {
        hatch(canvas, (x, y), CELL.0)?;
        "✗".to_owned()
    };
    let text = if cell.silent { format!("{text} !") } else { text };
    canvas.text(&text, middle, Side::Middle, Ink::Text)
}

/// A zigzag over a cell of this width, one element of the file: told from a shade without colour.
fn hatch(canvas: &Canvas, (x, y): (f64, f64), width: f64) -> Result<(), Fault> {
    const STEP: f64 = 5.0;
    let (ends, mut places, mut at) = ([y + CELL.1 - 1.5, y + 1.5], Vec::new(), x + 1.5);
    while at <= x + width - 1.0 {
        places.push((at, ends[places.len() % 2]));
        at += STEP;
    }
    canvas.line(&places, Ink::Grid)
}

fn draw_key(canvas: &Canvas) -> Result<(), Fault> {
    let mut x = 0.0;
    let shades = SHADES.iter().map(|(_, text)| *text).chain(["> 0.1"]);
    for (shade, text) in (0..).zip(shades) {
        canvas.block((x, 2.0), (x + 20.0, 18.0), Ink::Shade(shade))?;
        canvas.text(text, (x + 25.0, 10.0), Side::Right, Ink::Text)?;
        x += 25.0 + text_width(text) + 14.0;
    }
    hatch(canvas, (x, 0.0), 30.0)?;
    canvas.text("✗", (x + 15.0, 10.0), Side::Middle, Ink::Text)?;
    canvas.text("failed", (x + 35.0, 10.0), Side::Right, Ink::Text)?;
    x += 35.0 + text_width("failed") + 14.0;
    canvas.text("! said solved and was not", (x, 10.0), Side::Right, Ink::Text)
}

/// How the map is read.
pub(crate) const READS: &str = "A number k stands for a largest error of at most 10^k, relative. \
     Fixed steps are shown at the finest step of their study, step control at the tolerance next to 10⁻⁶, \
     both restarted at corners where that was run. \
     Ours are the methods that are given the task; of exact ones that hold on the same problem the worst is shown. \
     An empty cell is a solver that was not run on that problem.";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_bounded_by_its_power_of_ten() {
        let table = [(1e-6, "−6"), (1.1e-6, "−5"), (0.0, "−13"), (0.5, "0"), (f64::INFINITY, "∞")];
        for (error, text) in table {
            assert_eq!(bound(error), text, "{error:e}");
        }
    }
}
