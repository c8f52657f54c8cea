//! A table of what was true against what was answered, as a figure in a file of its own.

use crate::ReportError;
use crate::plot::{Canvas, Fault, Ink, Panel, Side, file, fit, sketch, text_width};

/// How a cell is shaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shading {
    /// The answer is right.
    Right,
    /// The answer holds what is right beside other things.
    Inside,
    /// The answer does not say it.
    Silent,
    /// The answer is wrong.
    Wrong,
}

/// A cell: how many answers, and how they are to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConfusionCell {
    /// How many.
    pub count: usize,
    /// How they are to be taken.
    pub shading: Shading,
}

/// What was true, in rows, against what was answered, in columns.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Confusion {
    /// What is seen.
    pub title: String,
    /// What is in it, for a reader who cannot see it.
    pub description: String,
    /// What the four shades mean, in their order.
    pub key: [String; 4],
    /// The truths.
    pub rows: Vec<String>,
    /// The answers.
    pub columns: Vec<String>,
    /// A line for each truth, a cell for each answer; none where there were none.
    pub cells: Vec<Vec<Option<ConfusionCell>>>,
}

/// The width of a column and the height of a row [px].
const CELL: (f64, f64) = (27.0, 20.0);
/// The widest name [px].
const NAME: f64 = 190.0;
/// The room of title and key [px].
const TOP: f64 = 52.0;

/// Draws it as an SVG file in the theme of the report.
///
/// # Errors
/// Lines of cells that are not as many as the truths, or not as long as the answers.
pub fn confusion(table: &Confusion) -> Result<String, ReportError> {
    let fault = |why: String| ReportError::Drawing { figure: "confusion".to_owned(), why };
    let (rows, columns) = (table.rows.len(), table.columns.len());
    if table.cells.len() != rows || table.cells.iter().any(|line| line.len() != columns) {
        return Err(fault(format!("expected {rows} lines of {columns} cells")));
    }
    let widest =
        |names: &[String]| names.iter().map(|n| text_width(n)).fold(40.0, f64::max).min(NAME);
    let (left, head) = (widest(&table.rows) + 14.0, TOP + widest(&table.columns) + 22.0);
    // The last name of a column that stands upright needs no room beyond its column.
    let keys: f64 = table.key.iter().map(|text| key_width(text)).sum();
    let width = (left + CELL.0 * columns as f64).max(keys).max(text_width(&table.title) * 1.1);
    let height = head + CELL.1 * rows as f64 + 6.0;
    let draw = |canvas: &Canvas| draw(canvas, table, (left, head));
    let body = sketch((width, height), draw).map_err(fault)?;
    let panel =
        Panel { title: String::new(), description: table.description.clone(), width, height, body };
    Ok(file(&[panel], 1, &table.title, &table.description))
}

fn key_width(text: &str) -> f64 {
    25.0 + text_width(text) + 16.0
}

fn shade(shading: Shading) -> Ink {
    Ink::Shade(match shading {
        Shading::Right => 0,
        Shading::Inside => 1,
        Shading::Silent => 2,
        Shading::Wrong => 3,
    })
}

fn draw(canvas: &Canvas, table: &Confusion, (left, head): (f64, f64)) -> Result<(), Fault> {
    canvas.text(&table.title, (0.0, 8.0), Side::Right, Ink::Title)?;
    let mut x = 0.0;
    let shadings = [Shading::Right, Shading::Inside, Shading::Silent, Shading::Wrong];
    for (text, shading) in table.key.iter().zip(shadings) {
        canvas.block((x, 24.0), (x + 20.0, 40.0), shade(shading))?;
        canvas.text(text, (x + 25.0, 32.0), Side::Right, Ink::Text)?;
        x += key_width(text);
    }
    let (right, bottom) =
        (left + CELL.0 * table.columns.len() as f64, head + CELL.1 * table.rows.len() as f64);
    canvas.text("truth ↓   answer →", (0.0, head - 12.0), Side::Right, Ink::Muted)?;
    for n in 0..=table.columns.len() {
        let x = left + CELL.0 * n as f64;
        canvas.line(&[(x, head), (x, bottom)], Ink::Grid)?;
    }
    for n in 0..=table.rows.len() {
        let y = head + CELL.1 * n as f64;
        canvas.line(&[(left, y), (right, y)], Ink::Grid)?;
    }
    for (n, name) in table.columns.iter().enumerate() {
        let x = left + CELL.0 * (n as f64 + 0.5);
        canvas.text_up(&fit(name, NAME), (x, head - 5.0), Ink::Text)?;
    }
    for (n, (name, line)) in table.rows.iter().zip(&table.cells).enumerate() {
        let y = head + CELL.1 * n as f64;
        let middle = y + CELL.1 / 2.0;
        canvas.text(&fit(name, NAME), (left - 8.0, middle), Side::Left, Ink::Text)?;
        for (m, cell) in line.iter().enumerate() {
            let Some(cell) = cell else { continue };
            let x = left + CELL.0 * m as f64;
            let (low, high) = ((x + 1.0, y + 1.0), (x + CELL.0 - 1.0, y + CELL.1 - 1.0));
            canvas.block(low, high, shade(cell.shading))?;
            let at = (x + CELL.0 / 2.0, middle);
            canvas.text(&cell.count.to_string(), at, Side::Middle, Ink::Text)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Confusion {
        let cell = |count, shading| Some(ConfusionCell { count, shading });
        Confusion {
            title: "Truth & answer".to_owned(),
            rows: vec!["cogging".to_owned(), "nothing".to_owned()],
            columns: vec!["cogging".to_owned(), "nothing".to_owned()],
            cells: vec![
                vec![cell(12, Shading::Right), cell(3, Shading::Silent)],
                vec![None, cell(40, Shading::Right)],
            ],
            ..Confusion::default()
        }
    }

    #[test]
    fn a_cell_shows_its_count_and_an_empty_one_nothing() {
        let svg = confusion(&table()).unwrap();
        for (count, times) in [(">12<", 1), (">3<", 1), (">40<", 1), (">0<", 0)] {
            assert_eq!(svg.matches(count).count(), times, "{count} in {svg}");
        }
        assert!(svg.contains("Truth &amp; answer"), "{svg}");
    }

    #[test]
    fn a_table_that_lacks_a_cell_is_refused() {
        let mut short = table();
        short.cells[1].pop();
        let told = confusion(&short).unwrap_err().to_string();
        assert!(told.contains("expected 2 lines of 2 cells"), "{told}");
    }
}
