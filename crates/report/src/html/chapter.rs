//! One experiment: its physics, its figures, its tables.

use super::paragraphs;
use crate::chapter::{Chapter, Figure, heading, split_first, told};
use crate::discoveries::{self, OVERVIEW_READ};
use crate::escape::html;
use crate::fits;
use crate::grid::{self, Grid};
use crate::number;
use crate::plot::inline;
use crate::prose;
use crate::select::distinct;
use record::{DiscoveryRow, FitRow, StudyRow};

/// Writes the experiment.
pub(super) fn write(out: &mut String, chapter: &Chapter) {
    let (id, title) = (&chapter.folder, html(chapter.title()));
    let summary = chapter.summary;
    put!(out, "<section id=\"{id}\" class=\"chapter\">\n<h2>{title}</h2>\n");
    if !summary.about("paper").is_empty() {
        put!(out, "<p class=\"place\">{}</p>\n", prose::html(summary.about("paper")));
    }
    write_text(out, summary.about("text"));
    let (shown, more): (Vec<&StudyRow>, Vec<&StudyRow>) =
        summary.studies.iter().partition(|row| !chapter.figures_of(&row.study).is_empty());
    for study in shown {
        write_study(out, chapter, study);
    }
    for fit in &summary.fits {
        write_fit(out, chapter, fit);
    }
    if let Some(table) = discoveries::overview(summary) {
        put!(out, "<p>{}</p>\n{}", html(OVERVIEW_READ), table.html("All records"));
    }
    for figure in chapter.figures_of("") {
        write_figure(out, chapter, figure);
    }
    for search in &summary.discoveries {
        write_search(out, chapter, search);
    }
    write_folded(out, chapter);
    if !more.is_empty() {
        put!(out, "<details><summary>More studies: {}</summary>\n", more.len());
        for study in more {
            put!(out, "<h3>{}</h3>\n", prose::html(heading(study)));
            write_told(out, study, &study.text);
        }
        out.push_str("</details>\n");
    }
    if let Some(table) = grid::measures(summary) {
        put!(
            out,
            "<details><summary>Measured quantities: {}</summary>\n{}</details>\n",
            table.rows.len(),
            table.html("Measured quantities")
        );
    }
    let studies = distinct(summary.cases.iter().map(|case| case.study.as_str()));
    if !studies.is_empty() {
        out.push_str("<details><summary>Orders, errors and every case</summary>\n");
        for study in studies {
            write_errors(out, chapter, study);
        }
        out.push_str("</details>\n");
    }
    out.push_str("</section>\n");
}

/// The text of the experiment: what the model is and what is asked of it, in two sentences, the others folded.
fn write_text(out: &mut String, text: &str) {
    let (opening, others) = text.split_once("\n\n").unwrap_or((text, ""));
    let (first, rest) = split_first(opening);
    let (second, rest) = split_first(&rest);
    out.push_str(&paragraphs(&format!("{first} {second}")));
    let rest = paragraphs(&rest) + &paragraphs(others);
    if !rest.is_empty() {
        put!(out, "<details><summary>More of it</summary>\n{rest}</details>\n");
    }
}

/// A study: its first sentence and the figures of the model, all else folded.
fn write_study(out: &mut String, chapter: &Chapter, study: &StudyRow) {
    let (first, rest) = split_first(&study.text);
    put!(out, "<h3>{}</h3>\n{}", prose::html(heading(study)), paragraphs(&first));
    out.push_str("<details><summary>The study</summary>\n");
    write_told(out, study, &rest);
    out.push_str("</details>\n");
    for figure in chapter.figures_of(&study.study) {
        write_figure(out, chapter, figure);
    }
}

fn write_told(out: &mut String, study: &StudyRow, text: &str) {
    out.push_str(&paragraphs(text));
    write_list(out, told(study));
}

fn write_list(out: &mut String, told: Vec<(&'static str, String)>) {
    out.push_str("<dl class=\"study\">");
    for (key, text) in told {
        put!(out, "<dt>{key}<dd>{}", prose::html(&text));
    }
    out.push_str("</dl>\n");
}

/// A fit: its text, its tables, its figures; how it went is folded.
fn write_fit(out: &mut String, chapter: &Chapter, fit: &FitRow) {
    let heading = fits::heading(fit);
    put!(out, "<h3>{}</h3>\n{}", prose::html(heading), paragraphs(&fit.text));
    for (title, reads, grid) in fits::tables(chapter.summary, &fit.fit) {
        let label = format!("{title} of {heading}");
        put!(out, "<p><b>{title}.</b> {}</p>\n{}", html(reads), grid.html(&label));
    }
    out.push_str("<details><summary>The fit</summary>\n");
    write_list(out, fits::told(fit));
    out.push_str("</details>\n");
    for figure in chapter.figures_of(&fit.fit) {
        write_figure(out, chapter, figure);
    }
}

/// A search for what a model lacks: its text, its answer, its tables, its figures; the parameters are folded.
fn write_search(out: &mut String, chapter: &Chapter, search: &DiscoveryRow) {
    let heading = discoveries::heading(search);
    put!(out, "<h3>{}</h3>\n{}", prose::html(heading), paragraphs(&search.text));
    write_list(out, discoveries::told(chapter.summary, search));
    let mut tables = discoveries::tables(chapter.summary, &search.discovery);
    let last = tables.pop();
    let table = |(title, reads, grid): &(&str, &str, Grid)| {
        format!("{}</p>\n{}", html(reads), grid.html(&format!("{title} of {heading}")))
    };
    for shown in &tables {
        put!(out, "<p><b>{}.</b> {}", shown.0, table(shown));
    }
    for figure in chapter.figures_of(&search.discovery) {
        write_figure(out, chapter, figure);
    }
    if let Some(last) = &last {
        put!(out, "<details><summary>{}</summary>\n<p>{}</details>\n", last.0, table(last));
    }
}

/// The figures put aside and those of how the solvers did, all of the chapter in one fold.
fn write_folded(out: &mut String, chapter: &Chapter) {
    let figures = chapter.more_figures();
    if figures.is_empty() {
        return;
    }
    put!(out, "<details class=\"figures\"><summary>More figures: {}</summary>\n", figures.len());
    for figure in figures {
        write_figure(out, chapter, figure);
    }
    out.push_str("</details>\n");
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
    let (first, mut more) = split_first(&row.caption);
    let reads = figure.kind.reads;
    if !reads.is_empty() {
        put!(more, " {reads}");
    }
    put!(
        out,
        "</div>\n<figcaption><b id=\"{id}-caption\">{title}</b> {first}<span class=\"sr\"> {description}</span>\n\
         {more}<small><a href=\"{folder}/{name}.svg\">SVG</a> · \
         <a href=\"{folder}/{name}.csv\">data</a></small></figcaption></figure>\n",
        id = figure.id,
        title = prose::html(&row.title),
        first = prose::html(&first),
        description = html(&row.description),
        more = if more.trim().is_empty() {
            String::new()
        } else {
            format!("<details><summary>More</summary><p>{}</p></details>", prose::html(more.trim()))
        },
        folder = chapter.folder,
        name = figure.name
    );
}

fn write_errors<'a>(out: &mut String, chapter: &Chapter<'a>, study: &'a str) {
    let summary = chapter.summary;
    let heading = chapter.heading_of(study);
    let name = prose::html(heading);
    put!(out, "<details><summary>{name}</summary>\n");
    if let Some(table) = grid::orders(summary, study) {
        put!(
            out,
            "<p><b>Observed orders.</b> {}</p>\n{}",
            html(grid::ORDERS_READ),
            table.html(&format!("Observed orders of {heading}"))
        );
    }
    if let Some(table) = grid::best(summary, study) {
        put!(
            out,
            "<p><b>Errors.</b> {}</p>\n{}",
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
            "<details class=\"data\"><summary>All {count} cases of {name}{}</summary>\n{}</details>\n",
            html(&title),
            table.html(&format!("Cases of {heading}{title}"))
        );
    }
    if let Some(signs) = grid::signs(summary, study) {
        put!(out, "<p><small>{}</small></p>\n", prose::html(&signs));
    }
    let folder = &chapter.folder;
    put!(out, "<p><a href=\"{folder}/cases.csv\">All cases as CSV</a></p>\n</details>\n");
}
