//! One experiment: its physics, its figures, its tables.

use super::paragraphs;
use crate::chapter::{Chapter, Figure, heading, told};
use crate::escape::html;
use crate::grid;
use crate::number;
use crate::plot::inline;
use crate::prose;
use crate::select::distinct;
use record::StudyRow;

/// Writes the experiment.
pub(super) fn write(out: &mut String, chapter: &Chapter) {
    let (id, title) = (&chapter.folder, html(chapter.title()));
    let summary = chapter.summary;
    put!(out, "<section id=\"{id}\" class=\"chapter\">\n<h2>{title}</h2>\n");
    if !summary.about("paper").is_empty() {
        put!(out, "<p class=\"place\">{}</p>\n", prose::html(summary.about("paper")));
    }
    out.push_str(&paragraphs(summary.about("text")));
    for study in &summary.studies {
        write_study(out, study);
        chapter.figures_of(&study.study).for_each(|figure| write_figure(out, chapter, figure));
    }
    chapter.figures_of("").for_each(|figure| write_figure(out, chapter, figure));
    if let Some(table) = grid::measures(summary) {
        out.push_str("<h3>Measured quantities</h3>\n");
        out.push_str(&table.html("Measured quantities"));
    }
    for study in distinct(summary.cases.iter().map(|case| case.study.as_str())) {
        write_errors(out, chapter, study);
    }
    out.push_str("</section>\n");
}

fn write_study(out: &mut String, study: &StudyRow) {
    let name = prose::html(heading(study));
    put!(out, "<h3>{name}</h3>\n{}", paragraphs(&study.text));
    out.push_str("<dl class=\"study\">");
    for (key, text) in told(study) {
        put!(out, "<dt>{key}<dd>{}", prose::html(&text));
    }
    out.push_str("</dl>\n");
}

fn write_figure(out: &mut String, chapter: &Chapter, figure: &Figure) {
    let (row, drawing) = (figure.row, &figure.drawing);
    let width = drawing.panels.iter().map(|panel| panel.width).fold(0.0, f64::max);
    let columns = drawing.columns.max(1) as f64;
    put!(
        out,
        "<figure id=\"{id}\" aria-labelledby=\"{id}-caption\"><div class=\"panels\" role=\"region\" tabindex=\"0\" \
         aria-label=\"{title}\" style=\"max-width:{room}px\">\n",
        id = figure.id,
        title = html(&row.title),
        room = (columns * (width + 20.0)).ceil()
    );
    for (n, panel) in drawing.panels.iter().enumerate() {
        out.push_str(&inline(panel, &format!("{}-{n}", figure.id), &row.title));
    }
    put!(
        out,
        "</div>\n<figcaption><b id=\"{id}-caption\">{title}</b> {caption}<span class=\"sr\"> {description}</span>\n\
         <small>{reads} <a href=\"{folder}/{name}.svg\">SVG</a> · \
         <a href=\"{folder}/{name}.csv\">data</a></small></figcaption></figure>\n",
        id = figure.id,
        title = prose::html(&row.title),
        caption = prose::html(&row.caption),
        description = html(&row.description),
        reads = html(figure.reads),
        folder = chapter.folder,
        name = figure.name
    );
}

fn write_errors<'a>(out: &mut String, chapter: &Chapter<'a>, study: &'a str) {
    let summary = chapter.summary;
    let heading = chapter.heading_of(study);
    let name = prose::html(heading);
    if let Some(table) = grid::orders(summary, study) {
        put!(
            out,
            "<h3>{name}: observed orders</h3>\n<p>{}</p>\n{}",
            html(grid::ORDERS_READ),
            table.html(&format!("Observed orders of {heading}"))
        );
    }
    if let Some(table) = grid::best(summary, study) {
        put!(
            out,
            "<h3>{name}: errors</h3>\n<p>{}</p>\n{}",
            html(&grid::best_read(summary, study)),
            table.html(&format!("Smallest errors of {heading}"))
        );
    }
    let own = summary.cases.iter().filter(|case| case.study == study);
    for point in distinct(own.clone().map(|case| case.point.as_str())) {
        let count = own.clone().filter(|case| case.point == point).count();
        let title =
            if point.is_empty() { String::new() } else { format!(", {}", number::point(point)) };
        let table = grid::cases(summary, study, point);
        put!(
            out,
            "<details><summary>All {count} cases of {name}{}</summary>\n{}</details>\n",
            html(&title),
            table.html(&format!("Cases of {heading}{title}"))
        );
    }
    if let Some(signs) = grid::signs(summary, study) {
        put!(out, "<p><small>{}</small></p>\n", prose::html(&signs));
    }
    let folder = &chapter.folder;
    put!(out, "<p><a href=\"{folder}/cases.csv\">All cases as CSV</a></p>\n");
}
