//! Panels as SVG: in a page, as a file of their own, as a thumbnail.

use super::{CSS, Panel};
use crate::escape::html;

/// Space between panels [px].
const GAP: f64 = 20.0;

/// One panel inside a page, which has the theme's style already.
pub(crate) fn inline(panel: &Panel, id: &str, title: &str) -> String {
    let name =
        if panel.title.is_empty() { title.to_owned() } else { format!("{title}: {}", panel.title) };
    // Text of 13 px may be drawn at 12 px at the least; on a narrower screen the figure's box scrolls.
    format!(
        "<svg class=\"fig\" role=\"img\" aria-labelledby=\"{id}-t {id}-d\" viewBox=\"0 0 {w} {h}\" \
         style=\"width:{w}px;min-width:{least}px\"><title id=\"{id}-t\">{}</title>\
         <desc id=\"{id}-d\">{}</desc><g id=\"{id}\" class=\"fig\">\n{}</g></svg>\n",
        html(&name),
        html(&panel.description),
        panel.body,
        w = panel.width.round(),
        h = panel.height.round(),
        least = (panel.width * 12.0 / 13.0).ceil(),
    )
}

/// The places of panels in rows of so many, and the size of the whole.
fn places(panels: &[Panel], columns: usize) -> (Vec<(f64, f64)>, f64, f64) {
    let (mut all, mut y, mut width) = (Vec::new(), 0.0, 0.0_f64);
    for row in panels.chunks(columns.max(1)) {
        let mut x = 0.0;
        let height = row.iter().map(|panel| panel.height).fold(0.0, f64::max);
        for panel in row {
            all.push((x, y + height - panel.height));
            x += panel.width + GAP;
        }
        width = width.max(x - GAP);
        y += height + GAP;
    }
    (all, width, (y - GAP).max(0.0))
}

/// The whole figure as a file: it brings its style and follows the reader's light or dark screen.
pub(crate) fn file(panels: &[Panel], columns: usize, title: &str, description: &str) -> String {
    const EDGE: f64 = 12.0;
    let (places, width, height) = places(panels, columns);
    let (w, h) = ((width + 2.0 * EDGE).round(), (height + 2.0 * EDGE).round());
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"fig\" role=\"img\" \
         aria-labelledby=\"figure-title figure-description\" width=\"{w}\" height=\"{h}\" \
         viewBox=\"0 0 {w} {h}\">\n<title id=\"figure-title\">{}</title>\n\
         <desc id=\"figure-description\">{}</desc>\n<style>\n{CSS}</style>\n\
         <rect class=\"bg\" width=\"{w}\" height=\"{h}\"/>\n",
        html(title),
        html(description)
    );
    for (panel, (x, y)) in panels.iter().zip(places) {
        let (x, y) = ((x + EDGE).round(), (y + EDGE).round());
        put!(svg, "<g transform=\"translate({x} {y})\">\n{}</g>\n", panel.body);
    }
    svg.push_str("</svg>\n");
    svg
}

/// The first row of a figure, small, drawn by pointing at the panels in the page.
pub(crate) fn thumbnail(panels: &[Panel], columns: usize, id: impl Fn(usize) -> String) -> String {
    let first = &panels[..panels.len().min(columns.max(1))];
    let (places, width, height) = places(first, columns);
    let mut svg = format!(
        "<svg class=\"fig\" aria-hidden=\"true\" viewBox=\"0 0 {} {}\">",
        width.round(),
        height.round()
    );
    for (i, (x, y)) in places.iter().enumerate() {
        put!(svg, "<use href=\"#{}\" x=\"{}\" y=\"{}\"/>", id(i), x.round(), y.round());
    }
    svg.push_str("</svg>");
    svg
}
