//! The margin lane: cases that failed, one row for each solver, one letter for each way to fail.

use super::Look;
use super::canvas::{Canvas, Fault, Side};
use super::chart::{NAME, SAMPLE};
use super::ink::Ink;
use super::labels::{fit, spread};

/// The height of a row [px].
pub(crate) const ROW: f64 = 15.0;

/// The room a bold letter takes [px].
const LETTER: f64 = 12.0;

/// One solver's failures.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LaneRow {
    /// The solver.
    pub(crate) name: String,
    /// How it looks.
    pub(crate) look: Look,
    /// Where along the horizontal axis, and how it failed.
    pub(crate) marks: Vec<(f64, String)>,
}

/// The letter of a failure.
pub(crate) fn failure_letter(status: &str) -> char {
    match status {
        "diverged" => 'D',
        "not finite" => 'N',
        "step too small" => 'S',
        "too many evaluations" => 'E',
        "no convergence" => 'C',
        "panicked" => 'P',
        "stopped" => 'X',
        "watchdog" => 'W',
        _ => '?',
    }
}

/// What the letters in these rows mean, in lines no longer than `most` pixels.
pub(crate) fn key(rows: &[LaneRow], most: f64) -> Vec<String> {
    let mut kinds: Vec<&str> =
        rows.iter().flat_map(|row| row.marks.iter().map(|(_, status)| status.as_str())).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let mut lines: Vec<String> = Vec::new();
    for kind in kinds {
        let entry = format!("{}: {kind}", failure_letter(kind));
        match lines.last_mut() {
            Some(line) if super::text_width(line) + super::text_width(&entry) < most => {
                line.push_str(", ");
                line.push_str(&entry);
            }
            _ => lines.push(entry),
        }
    }
    lines
}

/// Draws the rows below `top`, between `left` and `right`; `place` gives a mark's horizontal place.
pub(crate) fn draw(
    canvas: &Canvas,
    rows: &[LaneRow],
    (left, top, right): (f64, f64, f64),
    place: impl Fn(f64) -> f64,
) -> Result<(), Fault> {
    if rows.is_empty() {
        return Ok(());
    }
    let bottom = top + ROW * rows.len() as f64;
    canvas.block((left, top), (right, bottom), Ink::Band)?;
    canvas.text("failed", (left - 7.0, top + ROW / 2.0), Side::Left, Ink::Muted)?;
    for (i, row) in rows.iter().enumerate() {
        let y = top + ROW * (i as f64 + 0.5);
        let wished: Vec<f64> = row.marks.iter().map(|(x, _)| place(*x)).collect();
        let places = spread(&wished, LETTER, left + 6.0, right - 6.0);
        for ((_, status), x) in row.marks.iter().zip(places) {
            let letter = failure_letter(status).to_string();
            canvas.text(&letter, (x, y), Side::Middle, Ink::Letter(row.look))?;
        }
        canvas.mark((right + 10.0 + SAMPLE / 2.0, y), row.look)?;
        canvas.text(
            &fit(&row.name, NAME),
            (right + 15.0 + SAMPLE, y),
            Side::Right,
            Ink::Label(row.look),
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_names_every_failure_once() {
        let row = |status: &str| LaneRow {
            name: "x".to_owned(),
            look: Look::nth(0),
            marks: vec![(1.0, status.to_owned()), (2.0, "panicked".to_owned())],
        };
        let lines = key(&[row("diverged"), row("too many evaluations")], 1000.0);
        assert_eq!(lines, ["D: diverged, P: panicked, E: too many evaluations"]);
        assert_eq!(key(&[row("diverged")], 10.0).len(), 2);
    }
}
