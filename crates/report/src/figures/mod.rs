//! The kinds of figures: one file each, one line in [`FIGURES`].

mod curves;

use crate::ReportError;
use crate::plot::Panel;
use record::{FigureRow, Summary};

/// One kind of figure.
#[derive(Debug, Clone, Copy)]
pub struct FigureKind {
    /// The name in a figure's row.
    pub name: &'static str,
    /// Draws the figure of that row from the tables.
    pub draw: fn(&FigureRow, &Summary) -> Result<Drawing, ReportError>,
}

/// Every kind.
pub const FIGURES: &[FigureKind] = &[FigureKind { name: "curves", draw: curves::draw }];

/// A drawn figure: its panels, and what is drawn in them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drawing {
    /// The panels, in reading order.
    pub panels: Vec<Panel>,
    /// How many of them stand side by side where there is room.
    pub columns: usize,
    /// What is drawn: the rows of the figure's CSV.
    pub data: Vec<Datum>,
    /// The header of the horizontal values, with unit.
    pub x: String,
    /// The header of the vertical values, with unit.
    pub y: String,
}

/// One drawn value.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Datum {
    /// The panel.
    pub panel: String,
    /// The line it belongs to.
    pub series: String,
    /// Horizontal.
    pub x: Option<f64>,
    /// Vertical; none where there is nothing to measure.
    pub y: Option<f64>,
    /// What became of it, where that is not plain; else empty.
    pub note: String,
}
