//! The front: what does not hold, what does, and every figure at a glance.

use super::{code, solvers};
use crate::across::{Across, TITLE};
use crate::chapter::{
    Chapter, Figure, OPEN, PAPER, count_of_claims, decided, few_held, holds, in_short, open_claims,
    ours, sign, split_first,
};
use crate::escape::{html, slug};
use crate::number;
use crate::plot::thumbnail;
use crate::prose;
use record::ClaimRow;

/// Writes the front.
pub(super) fn write(out: &mut String, chapters: &[Chapter], across: Option<&Across>) {
    let claims: Vec<&ClaimRow> = chapters.iter().flat_map(|c| &c.summary.claims).collect();
    put!(
        out,
        "<header>\n<h1>Duhem</h1>\n<p>{PAPER}</p>\n<p class=\"count\">{}</p>\n</header>\n",
        html(&count_of_claims(&claims))
    );
    let open = open_claims(chapters);
    let held = chapters.iter().any(|chapter| !chapter.held_claims().is_empty());
    let drawn = chapters.iter().any(|chapter| !chapter.figures.is_empty());
    out.push_str("<nav aria-label=\"Contents\"><ol>\n");
    let parts = [
        (!open.is_empty(), "claims", "What does not hold"),
        (held, "held", "What holds"),
        (across.is_some(), "solvers", TITLE),
        (drawn, "figures", "Figures"),
    ];
    for (_, id, name) in parts.iter().filter(|(there, _, _)| *there) {
        put!(out, "<li><a href=\"#{id}\">{name}</a>\n");
    }
    for chapter in chapters {
        let (id, title) = (&chapter.folder, html(chapter.title()));
        put!(out, "<li><a href=\"#{id}\">{title}</a>\n");
    }
    out.push_str("<li><a href=\"#made\">How it was made</a>\n</ol></nav>\n");
    write_open(out, &open);
    if held {
        write_held(out, chapters);
    }
    if let Some(across) = across {
        solvers::write(out, across);
    }
    write_thumbnails(out, chapters);
}

/// What does not hold, with the first sentence of the reason.
fn write_open(out: &mut String, open: &[(&Chapter, &ClaimRow)]) {
    if open.is_empty() {
        return;
    }
    put!(
        out,
        "<section>\n<h2 id=\"claims\">{OPEN}</h2>\n<table class=\"claims\"><thead><tr>\
         <th scope=\"col\">Verdict<th scope=\"col\">The paper says<th scope=\"col\">Printed\
         <th scope=\"col\">Ours</thead>\n"
    );
    for (chapter, claim) in open {
        write_claim(out, chapter, claim);
    }
    out.push_str("</table>\n</section>\n");
}

/// The style of a verdict.
fn class(claim: &ClaimRow) -> &'static str {
    match claim.verdict.as_str() {
        "reproduced" => "yes",
        "contradicted" => "no",
        "under-specified" => "open",
        _ => "soft",
    }
}

fn write_claim(out: &mut String, chapter: &Chapter, claim: &ClaimRow) {
    let note = holds(claim);
    let note = if note.is_empty() { String::new() } else { format!("<small>{note}</small>") };
    let printed = number::printed(claim.printed, claim.digits, &claim.unit);
    let (why, rest) = split_first(&claim.why);
    put!(
        out,
        "<tbody id=\"claim--{id}\"><tr><td rowspan=\"2\"><span class=\"verdict {class}\">\
         <b aria-hidden=\"true\">{sign}</b>{verdict}</span>{note}\
         <td class=\"says\">{says}<small>{place}</small><td data-label=\"Printed\" class=\"n\">{printed}\
         <td data-label=\"Ours\" class=\"n\">{ours}\
         <tr><td colspan=\"3\" class=\"why\"><p>{why}</p>{more}</tbody>\n",
        id = slug(&claim.id),
        class = class(claim),
        sign = sign(&claim.verdict),
        verdict = html(&claim.verdict),
        says = prose::html(&claim.says),
        place = html(&claim.place),
        printed = html(&printed),
        ours = html(&ours(claim)),
        why = prose::html(&why),
        more = more(chapter, claim, &rest)
    );
}

/// What is told of a claim on request, folded.
fn more(chapter: &Chapter, claim: &ClaimRow, why: &str) -> String {
    format!("<details><summary>More</summary>{}</details>", told(chapter, claim, why))
}

fn told(chapter: &Chapter, claim: &ClaimRow, why: &str) -> String {
    let mut lines = vec![format!("{} · {}", html(&claim.place), html(&claim.id))];
    lines.extend(decided(claim).map(|text| prose::html(&text)));
    if let Some(figure) = chapter.shown(claim) {
        lines.push(format!("<a href=\"#{}\">{}</a>", figure.id, prose::html(&figure.row.title)));
    }
    if !claim.code.is_empty() {
        lines.push(code(&claim.code));
    }
    format!("<p>{}<small>{}</small></p>", prose::html(why), lines.join("<br>"))
}

/// What holds: a line each, by experiment, with all there is to say folded behind it.
fn write_held(out: &mut String, chapters: &[Chapter]) {
    out.push_str("<section>\n<h2 id=\"held\">What holds</h2>\n");
    let open = if few_held(chapters) { " open" } else { "" };
    for chapter in chapters {
        let held = chapter.held_claims();
        if held.is_empty() {
            continue;
        }
        put!(
            out,
            "<details{open}><summary>{}: {} hold</summary>\n",
            html(chapter.title()),
            held.len()
        );
        for claim in held {
            let short = in_short(claim);
            let short = match short.as_str() {
                "" => String::new(),
                short => format!(" <span class=\"n\">{}</span>", html(short)),
            };
            put!(
                out,
                "<details class=\"held\" id=\"claim--{id}\"><summary><span class=\"verdict {class}\">\
                 <b title=\"{verdict}\">{sign}</b></span> {says}{short}</summary>{told}</details>\n",
                id = slug(&claim.id),
                class = class(claim),
                verdict = html(&claim.verdict),
                sign = sign(&claim.verdict),
                says = prose::html(&claim.says),
                told = told(chapter, claim, &claim.why)
            );
        }
        out.push_str("</details>\n");
    }
    out.push_str("</section>\n");
}

fn write_thumbnails(out: &mut String, chapters: &[Chapter]) {
    if chapters.iter().all(|chapter| chapter.figures.is_empty()) {
        return;
    }
    out.push_str("<section>\n<h2 id=\"figures\">Figures</h2>\n");
    for chapter in chapters.iter().filter(|chapter| !chapter.figures.is_empty()) {
        put!(out, "<h3>{}</h3>\n", html(chapter.title()));
        let (solvers, model): (Vec<&Figure>, Vec<&Figure>) =
            chapter.figures.iter().partition(|figure| figure.kind.of_solvers);
        write_thumbs(out, &model);
        if !solvers.is_empty() {
            put!(out, "<details><summary>Of the solvers: {}</summary>\n", solvers.len());
            write_thumbs(out, &solvers);
            out.push_str("</details>\n");
        }
    }
    out.push_str("</section>\n");
}

fn write_thumbs(out: &mut String, figures: &[&Figure]) {
    out.push_str("<ul class=\"thumbs\">\n");
    for figure in figures {
        let drawing = &figure.drawing;
        let part = |n| format!("{}-{n}", figure.id);
        let small = thumbnail(&drawing.panels, drawing.columns, part);
        // Long titles are read at the figures themselves.
        let title = figure.row.title.split(": ").next().unwrap_or_default();
        let (id, title) = (&figure.id, prose::html(title));
        put!(out, "<li><a href=\"#{id}\">{small}<span>{title}</span></a>\n");
    }
    out.push_str("</ul>\n");
}
