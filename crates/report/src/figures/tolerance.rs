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
    let values = cases.cases.iter().map(|case| case.value).collect();
    let x = Axis::values("relative tolerance", values).reversed();
    let charts = charts(&cases, &x, "rtol", &[Guide::Equal("error = tolerance")]);
    of_charts(figure, charts, cases.corners().len())
}
