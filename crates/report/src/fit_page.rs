//! The page of one fit: a file of its own, in the theme of the report.

use crate::escape::html;
use crate::fit_drawing::{FitDrawing, write_drawing};
use crate::plot::{Axis, CSS, Chart, Line, Look, align, inline};

/// What one fit has to say, all of it plain text and numbers; every text is escaped where it is shown.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitPage {
    /// What was fitted.
    pub title: String,
    /// What came out, in a sentence or two.
    pub opening: String,
    /// The parts, in reading order.
    pub parts: Vec<FitPart>,
}

/// A part of the page under its own heading.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitPart {
    /// Its heading.
    pub title: String,
    /// Paragraphs.
    pub text: Vec<String>,
    /// A table: its header and its rows. No table if the header is empty.
    pub head: Vec<String>,
    /// The rows of the table, each as long as its header.
    pub rows: Vec<Vec<String>>,
    /// Statements in a list, below the table.
    pub list: Vec<String>,
    /// Figures.
    pub figures: Vec<FitFigure>,
    /// Ladders of values and maps, below the figures.
    pub drawings: Vec<FitDrawing>,
}

/// A figure: panels of curves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitFigure {
    /// What is seen.
    pub title: String,
    /// How to read it.
    pub caption: String,
    /// Its panels, below one another if they are histories, else side by side.
    pub panels: Vec<FitPanel>,
    /// Whether the panels are histories over one time.
    pub over_time: bool,
}

/// Curves on two axes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitPanel {
    /// Its title; may be empty.
    pub title: String,
    /// The horizontal axis, with unit.
    pub x: String,
    /// The vertical axis, with unit.
    pub y: String,
    /// The curves by name; a value that is not finite breaks a line.
    pub curves: Vec<FitCurve>,
    /// The vertical values between which the record scatters by its noise alone, drawn as two grey lines.
    pub noise: Option<f64>,
    /// The same where it changes on the way, above zero and as far below.
    pub local_noise: Vec<(f64, f64)>,
}

/// A curve.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitCurve {
    /// Its name.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// What it shows.
    pub role: FitRole,
}

/// What a curve shows; it looks the same in every figure.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FitRole {
    /// The record.
    #[default]
    Measured,
    /// The model before the fit, which may leave the panel.
    Before,
    /// The model after the fit.
    After,
}

/// Renders the page: one HTML file without network and script.
pub fn fit_page(page: &FitPage) -> String {
    let title = html(&page.title);
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n\
         <style>\n{}{CSS}{}</style>\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n<p class=\"count\">{}</p>\n",
        crate::html::PAGE,
        crate::fit_drawing::CSS,
        html(&page.opening)
    );
    for (n, part) in page.parts.iter().enumerate() {
        put!(out, "<section>\n<h2>{}</h2>\n", html(&part.title));
        for text in &part.text {
            put!(out, "<p>{}</p>\n", html(text));
        }
        write_table(&mut out, part);
        if !part.list.is_empty() {
            out.push_str("<ul>\n");
            for text in &part.list {
                put!(out, "<li>{}\n", html(text));
            }
            out.push_str("</ul>\n");
        }
        for (m, figure) in part.figures.iter().enumerate() {
            write_figure(&mut out, figure, &format!("figure-{n}-{m}"));
        }
        for (m, drawing) in part.drawings.iter().enumerate() {
            write_drawing(&mut out, drawing, &format!("drawing-{n}-{m}"));
        }
        out.push_str("</section>\n");
    }
    out.push_str("</main>\n</body>\n</html>\n");
    out
}

fn write_table(out: &mut String, part: &FitPart) {
    if part.head.is_empty() {
        return;
    }
    put!(
        out,
        "<div class=\"box\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">\
         <table class=\"across\"><thead><tr>",
        html(&part.title)
    );
    for cell in &part.head {
        put!(out, "<th scope=\"col\">{}", html(cell));
    }
    out.push_str("</thead><tbody>\n");
    for row in &part.rows {
        out.push_str("<tr>");
        for (i, cell) in row.iter().enumerate() {
            put!(out, "{}{}", if i == 0 { "<th scope=\"row\">" } else { "<td>" }, html(cell));
        }
        out.push('\n');
    }
    out.push_str("</tbody></table></div>\n");
}

fn write_figure(out: &mut String, figure: &FitFigure, id: &str) {
    let columns = if figure.over_time { 1 } else { 2 };
    let mut charts: Vec<Chart> =
        figure.panels.iter().map(|panel| chart(panel, figure.over_time)).collect();
    align(&mut charts, columns);
    let width = charts.iter().map(|chart| chart.size.0).fold(0.0, f64::max);
    put!(
        out,
        "<figure class=\"wide\" aria-labelledby=\"{id}\"><div class=\"panels\" role=\"region\" \
         tabindex=\"0\" aria-label=\"{}\" style=\"max-width:{}px\">\n",
        html(&figure.title),
        (columns as f64 * (width + 20.0)).ceil()
    );
    for (n, chart) in charts.iter_mut().enumerate() {
        match drawn(chart) {
            Ok(panel) => out.push_str(&inline(&panel, &format!("{id}-{n}"), &figure.title)),
            Err(why) => put!(out, "<p>not drawn: {}</p>\n", html(&why)),
        }
    }
    put!(
        out,
        "</div>\n<figcaption><b id=\"{id}\">{}</b> {}</figcaption></figure>\n",
        html(&figure.title),
        html(&figure.caption)
    );
}

/// The most that a panel may take [bytes].
const MOST: usize = 140_000;

/// The panel, its lines thinned until it is small enough.
fn drawn(chart: &mut Chart) -> Result<crate::Panel, String> {
    for coarse in 0..=8 {
        chart.coarse = coarse;
        let panel = chart.draw()?;
        if panel.body.len() <= MOST {
            return Ok(panel);
        }
    }
    Err(format!("more points than {} kB of picture hold", MOST / 1000))
}

impl FitRole {
    /// Colour and dash tell it from the others.
    fn look(self) -> Look {
        let (colour, dash) = match self {
            Self::Measured => (2, 0),
            Self::Before => (3, 2),
            Self::After => (1, 1),
        };
        Look { dash, ..Look::filled(colour) }
    }
}

fn chart(panel: &FitPanel, over_time: bool) -> Chart {
    let points =
        || panel.curves.iter().filter(|c| c.role != FitRole::Before).flat_map(|c| &c.points);
    let x = Axis::linear(&panel.x, points().map(|p| p.0)).checked();
    let noise = panel.noise.into_iter().flat_map(|n| [-n, n]);
    let local: Vec<Vec<(f64, f64)>> = [-1.0, 1.0]
        .map(|side| panel.local_noise.iter().map(|(x, n)| (*x, side * n)).collect())
        .into_iter()
        .filter(|line: &Vec<_>| !line.is_empty())
        .collect();
    let heights = points().map(|p| p.1).chain(noise.clone());
    let y = widened(Axis::linear(&panel.y, heights), panel).checked();
    let ghosts = noise.map(|n| vec![(x.from, n), (x.to, n)]).chain(local).collect();
    let lines: Vec<Line> = panel
        .curves
        .iter()
        .map(|curve| Line {
            name: curve.name.clone(),
            note: String::new(),
            look: curve.role.look(),
            points: curve.points.clone(),
            marks: false,
        })
        .collect();
    Chart {
        title: panel.title.clone(),
        x,
        y,
        ghosts,
        unnamed: lines.len() < 2,
        lines,
        size: if over_time { (848.0, 170.0) } else { (560.0, 300.0) },
        ..Chart::default()
    }
}

/// The axis with room for the curves that it need not hold, at most half as high again on either side.
fn widened(mut axis: Axis, panel: &FitPanel) -> Axis {
    let half = 0.5 * (axis.to - axis.from);
    let (low, high) = (axis.from - half, axis.to + half);
    let others =
        panel.curves.iter().filter(|c| c.role == FitRole::Before).flat_map(|curve| &curve.points);
    for y in others.map(|point| point.1).filter(|y| y.is_finite()) {
        axis.from = axis.from.min(y.max(low));
        axis.to = axis.to.max(y.min(high));
    }
    axis
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page() -> FitPage {
        let wave = |scale: f64| (0..500).map(move |i| (f64::from(i), scale * f64::from(i).sin()));
        let curve = |name: &str, scale: f64, role| FitCurve {
            name: name.to_owned(),
            points: wave(scale).collect(),
            role,
        };
        let panel = FitPanel {
            title: "<b>angle".to_owned(),
            x: "t [s]".to_owned(),
            y: "\u{1b}angle [rad]".to_owned(),
            curves: vec![
                curve("measured", 1.0, FitRole::Measured),
                curve("before", 1e9, FitRole::Before),
            ],
            noise: Some(0.1),
            local_noise: vec![(0.0, 0.2), (499.0, f64::NAN)],
        };
        let figure = FitFigure {
            title: "over & time".to_owned(),
            caption: "<i>how".to_owned(),
            panels: vec![panel],
            over_time: true,
        };
        let part = FitPart {
            title: "<script>".to_owned(),
            text: vec!["a < b".to_owned()],
            head: vec!["x".to_owned(), "y\"".to_owned()],
            rows: vec![vec!["<img src=x>".to_owned(), "1".to_owned()]],
            list: vec!["<li onclick=1>".to_owned()],
            figures: vec![figure],
            drawings: Vec::new(),
        };
        FitPage {
            title: "</title><script>alert(1)</script>\u{7}".to_owned(),
            opening: "converged".to_owned(),
            parts: vec![part],
        }
    }

    #[test]
    fn no_text_of_a_record_becomes_markup() {
        let page = fit_page(&page());
        for bad in ["<script", "<img", "<i>", "<li o", "\u{7}", "\u{1b}", "http://", "url("] {
            assert!(!page.contains(bad), "{bad:?} in the page");
        }
        assert!(page.contains("&lt;/title&gt;&lt;script&gt;alert(1)"), "the title is not there");
        assert!(page.contains("&lt;img src=x&gt;"), "the table is not there");
    }

    #[test]
    fn a_model_that_runs_away_leaves_the_panel_and_the_record_stays_visible() {
        let page = page();
        let chart = chart(&page.parts[0].figures[0].panels[0], true);
        let height = chart.y.to - chart.y.from;
        assert!((2.0..5.0).contains(&height), "the axis is {height} rad high, the record 2");
    }

    #[test]
    fn a_long_record_makes_a_small_picture() {
        let mut page = page();
        let panel = &mut page.parts[0].figures[0].panels[0];
        for curve in &mut panel.curves {
            curve.points =
                (0..200_000).map(|i| (f64::from(i), (0.37 * f64::from(i)).sin())).collect();
        }
        let bytes = fit_page(&page).len();
        assert!(bytes < 170_000, "{bytes} bytes");
    }

    #[test]
    fn a_curve_without_points_and_one_that_is_not_finite_are_drawn_as_nothing() {
        let mut page = page();
        let panel = &mut page.parts[0].figures[0].panels[0];
        panel.curves[0].points.clear();
        panel.curves[1].points = vec![(0.0, f64::NAN), (f64::INFINITY, 1.0)];
        panel.noise = Some(f64::NAN);
        assert!(!fit_page(&page).contains("NaN"), "a place that is no number");
    }
}
