//! Largest error against the tolerance asked for: does a method deliver what it is told to?

use super::convergence::charts;
use super::{Drawing, of_charts};
use crate::ReportError;
use crate::plot::{Axis, Guide};
use crate::select::select;
use record::{FigureRow, Summary};

/// The figure; the tolerance tightens to the right.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    let cases = select(figure, summary, Some("rtol"));
    let values = Axis::values("relative tolerance", cases.cases.iter().map(|c| c.value).collect());
    let x = Axis { at: Vec::new(), ..values }.reversed();
    let charts = charts(&cases, &x, "rtol", &[Guide::Equal("error = tolerance")]);
    of_charts(figure, charts, cases.corners().len())
}
