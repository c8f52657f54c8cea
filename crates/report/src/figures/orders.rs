//! Observed orders, with corners restarted against ignored, beside the declared one: what a missed reversal costs.

use super::{Datum, Drawing, fault, incomplete};
use crate::plot::{Canvas, Fault, Ink, Look, MARK, Panel, Side, fit, rank, sketch, text_width};
use crate::select::{Selection, distinct, select};
use crate::{ReportError, number};
use record::{FigureRow, OrderRow, Summary};

/// The height of a solver's row [px].
const ROW: f64 = 22.0;
/// The widest name [px]; a longer one is cut.
const NAME: f64 = 180.0;
/// Between two columns [px].
const GAP: f64 = 14.0;
/// Above the rows: two lines, the key and the columns' titles [px].
const HEAD: f64 = 52.0;

/// Where things stand.
struct Layout<'a> {
    selection: &'a Selection<'a>,
    solvers: Vec<&'a str>,
    left: f64,
    column: f64,
    most: f64,
}

/// The figure: solvers in rows, sweep points in columns.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    let mut selection = select(figure, summary, None);
    selection.orders.retain(|row| row.against == "steps" && row.declared.is_some());
    if selection.orders.is_empty() {
        return Err(incomplete(
            figure,
            "no order against steps with a declared one",
            "one or more",
        ));
    }
    selection.points = distinct(selection.orders.iter().map(|row| row.point.as_str()));
    let mut solvers = distinct(selection.orders.iter().map(|row| row.solver.as_str()));
    solvers.sort_by_key(|solver| rank(solver));
    let declared = selection.orders.iter().filter_map(|row| row.declared).max().unwrap_or(1);
    let left = solvers.iter().map(|name| text_width(name)).fold(0.0, f64::max).min(NAME) + 26.0;
    let columns = selection.points.len() as f64;
    let column = ((848.0 - left) / columns - GAP).clamp(90.0, 320.0);
    let layout =
        Layout { selection: &selection, solvers, left, column, most: declared as f64 + 0.9 };
    let width = left + columns * (column + GAP);
    let height = HEAD + ROW * layout.solvers.len() as f64 + 44.0;
    let body = sketch((width, height), |canvas| layout.draw(canvas)).map_err(fault(figure))?;
    let description =
        "Observed order of each solver, restarted at corners and with corners ignored, \
                       beside its declared order."
            .to_owned();
    Ok(Drawing {
        panels: vec![Panel { title: String::new(), description, width, height, body }],
        columns: 1,
        data: selection.orders.iter().map(|row| data(row)).collect(),
        x: "observed order [1]".to_owned(),
        y: "declared order [1]".to_owned(),
    })
}

fn data(row: &OrderRow) -> Datum {
    Datum {
        panel: number::point(&row.point),
        series: format!("{}, {}", row.solver, row.corners),
        x: row.order,
        y: row.declared.map(|declared| declared as f64),
        note: if row.failed > 0 { format!("{} failed", row.failed) } else { String::new() },
    }
}

impl Layout<'_> {
    fn place(&self, column: usize, order: f64) -> f64 {
        let start = self.left + column as f64 * (self.column + GAP);
        start + order.clamp(0.0, self.most) / self.most * self.column
    }

    fn draw(&self, canvas: &Canvas) -> Result<(), Fault> {
        let bottom = HEAD + ROW * self.solvers.len() as f64;
        draw_key(canvas, self.left, self.selection.orders.iter().any(|row| row.order.is_none()))?;
        for (n, solver) in self.solvers.iter().enumerate() {
            let y = HEAD + ROW * (n as f64 + 0.5);
            if n % 2 == 0 {
                let right = self.place(self.selection.points.len() - 1, self.most);
                let half = ROW / 2.0;
                canvas.block((0.0, y - half), (right, y + half), Ink::Band)?;
            }
            canvas.mark((10.0, y), Look::of_solver(solver))?;
            canvas.text(
                &fit(solver, NAME),
                (20.0, y),
                Side::Right,
                Ink::Label(Look::of_solver(solver)),
            )?;
        }
        for (column, point) in self.selection.points.iter().enumerate() {
            let title = fit(&number::point(point), self.column + GAP - 4.0);
            canvas.text(&title, (self.place(column, 0.0), HEAD - 12.0), Side::Right, Ink::Title)?;
            let stride = if self.most > 5.0 { 2 } else { 1 };
            for order in (0..=9).step_by(stride).map(f64::from).take_while(|o| *o <= self.most) {
                let x = self.place(column, order);
                canvas.line(&[(x, HEAD), (x, bottom)], Ink::Grid)?;
                let label = number::short(order);
                canvas.text(&label, (x, bottom + 12.0), Side::Middle, Ink::Text)?;
            }
            for (n, solver) in self.solvers.iter().enumerate() {
                self.draw_cell(canvas, (column, HEAD + ROW * (n as f64 + 0.5)), (point, solver))?;
            }
        }
        let right = self.place(self.selection.points.len() - 1, self.most);
        canvas.text("observed order", (right, bottom + 32.0), Side::Left, Ink::Muted)
    }

    /// The dumbbell of one solver at one point.
    fn draw_cell(
        &self,
        canvas: &Canvas,
        (column, y): (usize, f64),
        (point, solver): (&str, &str),
    ) -> Result<(), Fault> {
        let row = |corners: &str| {
            self.selection
                .orders
                .iter()
                .find(|row| row.point == point && row.solver == solver && row.corners == corners)
        };
        let rows = [row("restart"), row("ignore")];
        let Some(declared) = rows.iter().flatten().find_map(|row| row.declared) else {
            return Ok(());
        };
        let tick = self.place(column, declared as f64);
        canvas.line(&[(tick, y - 7.0), (tick, y + 7.0)], Ink::Tick)?;
        let orders = rows.map(|row| row.and_then(|row| row.order).filter(|o| o.is_finite()));
        if let [Some(a), Some(b)] = orders {
            let ends = [(self.place(column, a), y), (self.place(column, b), y)];
            canvas.line(&ends, Ink::Line(IGNORED))?;
        }
        for (order, look) in [(orders[1], IGNORED), (orders[0], RESTARTED)] {
            if let Some(order) = order {
                canvas.mark((self.place(column, order), y), look)?;
            }
        }
        if orders == [None, None] && rows.iter().any(Option::is_some) {
            canvas.text("✗", (self.place(column, 0.0), y), Side::Middle, Ink::Letter(IGNORED))?;
        }
        Ok(())
    }
}

const RESTARTED: Look = Look::filled(1);
const IGNORED: Look = Look::hollow(3);

/// The signs; `missing` if there is a solver without an order.
fn draw_key(canvas: &Canvas, left: f64, missing: bool) -> Result<(), Fault> {
    let mut x = left + MARK;
    let y = 11.0;
    let entries = [
        (Some(RESTARTED), "restarted at corners"),
        (Some(IGNORED), "corners ignored"),
        (None, "declared"),
    ];
    for (look, text) in entries {
        match look {
            Some(look) => canvas.mark((x, y), look)?,
            None => canvas.line(&[(x, y - 7.0), (x, y + 7.0)], Ink::Tick)?,
        }
        canvas.text(text, (x + 9.0, y), Side::Right, Ink::Text)?;
        x += text_width(text) + 28.0;
    }
    if missing {
        canvas.text("✗", (x, y), Side::Middle, Ink::Letter(IGNORED))?;
        canvas.text("too many runs failed", (x + 9.0, y), Side::Right, Ink::Text)?;
    }
    Ok(())
}
