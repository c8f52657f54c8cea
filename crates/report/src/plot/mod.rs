//! The theme: how everything that is drawn looks, and where it stands.

mod axis;
mod canvas;
mod chart;
mod ink;
mod labels;
mod lane;
mod sheet;
mod thin;

pub(crate) use axis::Axis;
pub(crate) use canvas::{Canvas, Fault, MARK, Side, sketch};
pub(crate) use chart::{Chart, Guide, Line, align};
pub(crate) use ink::{CSS, Ink, Look, rank};
pub(crate) use labels::{fit, width as text_width};
pub(crate) use lane::LaneRow;
pub(crate) use sheet::{file, inline, thumbnail};

/// One drawn panel: a picture of its own.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Panel {
    /// Its title; empty if the figure has only one.
    pub title: String,
    /// What is in it, for a reader who cannot see it.
    pub description: String,
    /// Its width [px].
    pub width: f64,
    /// Its height [px].
    pub height: f64,
    /// The inside of its `<svg>`.
    pub body: String,
}
