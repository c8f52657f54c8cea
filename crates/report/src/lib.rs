//! Records in; HTML, SVG and Markdown out.
//!
//! **Invariant**: knows no model and no solver, runs nothing, reads nothing and writes nothing.
//! The same summaries give the same bytes.
//!
//! Read first: [`render`] (everything there is to render), [`FigureKind`] (one kind of figure),
//! [`Drawing`] (a drawn figure).

/// Adds formatted text to a string, which has no way to fail.
macro_rules! put {
    ($out:expr, $($text:tt)*) => {{
        use std::fmt::Write as _;
        let _ = $out.write_fmt(format_args!($($text)*));
    }};
}

mod across;
mod chapter;
mod claims;
mod confusion;
mod discoveries;
mod error;
mod escape;
mod figures;
mod fit_drawing;
mod fit_page;
mod fits;
mod grid;
mod html;
mod markdown;
mod number;
mod plot;
mod prose;
mod select;

pub use confusion::{Confusion, ConfusionCell, Shading, confusion};
pub use error::ReportError;
pub use figures::{Datum, Drawing, FIGURES, FigureKind};
pub use fit_drawing::{FitCell, FitDrawing, FitHeat, FitLadder, FitRung};
pub use fit_page::{FitCurve, FitFigure, FitPage, FitPanel, FitPart, FitRole, fit_page};
pub use plot::Panel;

use across::Across;
use chapter::Chapter;
use record::Summary;

/// One file to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    /// Where, relative to `reports/`, with `/`: `index.html`, `dahl-gamma-sweep/fig01.svg`.
    pub path: String,
    /// What.
    pub bytes: Vec<u8>,
}

/// Renders everything there is to render from the summaries, in the order of the paper.
///
/// # Errors
/// An unknown kind of figure, a row or table that lacks something, two files of one name.
pub fn render(summaries: &[Summary]) -> Result<Vec<Output>, ReportError> {
    let mut chapters = summaries.iter().map(Chapter::new).collect::<Result<Vec<_>, _>>()?;
    chapters.sort_by_key(|chapter| (chapter.place(), chapter.summary.name.as_str()));
    let across = Across::new(&chapters)?;
    let text = |path: String, text: String| Output { path, bytes: text.into_bytes() };
    let mut all = vec![
        text("index.html".to_owned(), html::page(&chapters, across.as_ref())),
        text("README.md".to_owned(), markdown::front(&chapters, across.as_ref())),
    ];
    all.extend(across.iter().flat_map(Across::files));
    for chapter in &chapters {
        let path = format!("{}/README.md", chapter.folder);
        if all.iter().any(|output| output.path.eq_ignore_ascii_case(&path)) {
            return Err(ReportError::SameName { path });
        }
        all.push(text(path, markdown::chapter(chapter)));
        all.extend(chapter.files());
    }
    Ok(all)
}
