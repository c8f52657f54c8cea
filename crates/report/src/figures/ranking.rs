//! What each candidate takes away of the excess over the floor, in every round of a search.

use super::{Drawing, fault, incomplete, of_ladders};
use crate::{ReportError, discoveries};
use record::{FigureRow, Summary};

/// One panel for each round.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    let row = summary.discoveries.iter().find(|row| row.discovery == figure.study);
    let row = row.ok_or_else(|| incomplete(figure, "no search of that name", "a `study`"))?;
    let ladders = discoveries::rankings(summary, row);
    if ladders.is_empty() {
        return Err(incomplete(figure, "no candidate", "a search that looked for effects"));
    }
    of_ladders(&ladders).map_err(fault(figure))
}
