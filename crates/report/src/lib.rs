//! Records in; HTML, SVG and Markdown out.
//!
//! **Invariant**: knows no model and no solver, runs nothing, reads nothing and writes nothing.
//! The same summaries give the same bytes.
//!
//! Read first: [`render`] (everything there is to render), [`FigureKind`] (one kind of figure),
//! [`Drawing`] (a drawn figure).

mod error;
mod figures;
mod plot;

pub use error::ReportError;
pub use figures::{Datum, Drawing, FIGURES, FigureKind};
pub use plot::Panel;

use record::Summary;

/// One file to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    /// Where, relative to `reports/`, with `/`: `index.html`, `dahl-gamma-sweep/fig01.svg`.
    pub path: String,
    /// What.
    pub bytes: Vec<u8>,
}

/// Renders everything there is to render from the summaries.
pub fn render(summaries: &[Summary]) -> Result<Vec<Output>, ReportError> {
    let _ = summaries;
    Ok(vec![Output { path: "index.html".to_owned(), bytes: Vec::new() }])
}
