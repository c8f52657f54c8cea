//! Curves on given axes: hysteresis loops, histories.

use super::Drawing;
use crate::ReportError;
use record::{FigureRow, Summary};

/// The curves of a figure's panels.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    if summary.panels.iter().all(|panel| panel.figure != figure.figure) {
        return Err(ReportError::Incomplete {
            figure: figure.figure.clone(),
            kind: "curves",
            found: "no row in the table of panels".to_owned(),
            expected: "one or more".to_owned(),
        });
    }
    Ok(Drawing::default())
}
