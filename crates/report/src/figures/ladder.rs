//! From the gap to the floor: the residual of a model as given, refitted, and with each effect that was named.

use super::{Drawing, fault, incomplete, of_ladders};
use crate::{ReportError, discoveries};
use record::{DiscoveryRow, FigureRow, Summary};

/// One panel for the search that is meant, or for each if none is.
pub(super) fn draw(figure: &FigureRow, summary: &Summary) -> Result<Drawing, ReportError> {
    let meant = |row: &&DiscoveryRow| figure.study.is_empty() || row.discovery == figure.study;
    let rows: Vec<&DiscoveryRow> = summary.discoveries.iter().filter(meant).collect();
    if rows.is_empty() {
        return Err(incomplete(figure, "no search of that name", "one of the experiment's"));
    }
    let mut ladders: Vec<_> = rows.iter().map(|row| discoveries::ladder(summary, row)).collect();
    if let [ladder] = &mut ladders[..] {
        ladder.title.clear();
    }
    of_ladders(&ladders).map_err(fault(figure))
}
