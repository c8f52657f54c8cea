//! The front: what holds, what does not, and every figure at a glance.

use super::code;
use crate::chapter::{Chapter, PAPER, claims_by_outcome, count_of_claims, holds, ours, sign};
use crate::escape::html;
use crate::number;
use crate::plot::thumbnail;
use crate::prose;
use record::ClaimRow;

/// Writes the front.
pub(super) fn write(out: &mut String, chapters: &[Chapter]) {
    let all = claims_by_outcome(chapters);
    let claims: Vec<&ClaimRow> = all.iter().map(|(_, claim)| *claim).collect();
    put!(
        out,
        "<header>\n<h1>Duhem</h1>\n<p>{PAPER}</p>\n<p class=\"count\">{}</p>\n</header>\n",
        html(&count_of_claims(&claims))
    );
    out.push_str("<nav aria-label=\"Contents\"><ol>\n");
    if !claims.is_empty() {
        out.push_str("<li><a href=\"#claims\">Claims</a>\n");
    }
    if chapters.iter().any(|chapter| !chapter.figures.is_empty()) {
        out.push_str("<li><a href=\"#figures\">Figures</a>\n");
    }
    for chapter in chapters {
        let (id, title) = (&chapter.folder, html(chapter.title()));
        put!(out, "<li><a href=\"#{id}\">{title}</a>\n");
    }
    out.push_str("<li><a href=\"#made\">How it was made</a>\n</ol></nav>\n");
    if !claims.is_empty() {
        out.push_str(
            "<section>\n<h2 id=\"claims\">Claims</h2>\n<p>What does not hold comes first.</p>\n<table class=\"claims\"><thead><tr>\
             <th scope=\"col\">Verdict<th scope=\"col\">The paper says<th scope=\"col\">Printed\
             <th scope=\"col\">Ours</thead>\n",
        );
        for (chapter, claim) in &all {
            write_claim(out, chapter, claim);
        }
        out.push_str("</table>\n</section>\n");
    }
    write_thumbnails(out, chapters);
}

fn write_claim(out: &mut String, chapter: &Chapter, claim: &ClaimRow) {
    let class = match claim.verdict.as_str() {
        "reproduced" => "yes",
        "contradicted" => "no",
        "under-specified" => "open",
        _ => "soft",
    };
    let note = holds(claim);
    let note = if note.is_empty() { String::new() } else { format!("<small>{note}</small>") };
    let printed = number::printed(claim.printed, claim.digits, &claim.unit);
    let mut more = Vec::new();
    if !claim.how.is_empty() {
        more.push(format!("Decided by: {}", prose::html(&claim.how)));
    }
    if let Some(figure) = chapter.shown(claim) {
        more.push(format!("<a href=\"#{}\">{}</a>", figure.id, prose::html(&figure.row.title)));
    }
    if !claim.code.is_empty() {
        more.push(code(&claim.code));
    }
    put!(
        out,
        "<tbody id=\"claim--{id}\"><tr><td rowspan=\"2\"><span class=\"verdict {class}\">\
         <b aria-hidden=\"true\">{sign}</b>{verdict}</span>{note}\
         <td class=\"says\">{says}<small>{place} · {name}</small>\
         <td data-label=\"Printed\" class=\"n\">{printed}<td data-label=\"Ours\" class=\"n\">{ours}\
         <tr><td colspan=\"3\" class=\"why\"><p>{why}<small>{more}</small></tbody>\n",
        id = crate::escape::slug(&claim.id),
        sign = sign(&claim.verdict),
        verdict = html(&claim.verdict),
        says = prose::html(&claim.says),
        place = html(&claim.place),
        name = html(&claim.id),
        printed = html(&printed),
        ours = html(&ours(claim)),
        why = prose::html(&claim.why),
        more = more.join(" · ")
    );
}

fn write_thumbnails(out: &mut String, chapters: &[Chapter]) {
    if chapters.iter().all(|chapter| chapter.figures.is_empty()) {
        return;
    }
    out.push_str("<section>\n<h2 id=\"figures\">Figures</h2>\n<ul class=\"thumbs\">\n");
    for figure in chapters.iter().flat_map(|chapter| &chapter.figures) {
        let drawing = &figure.drawing;
        let small = thumbnail(&drawing.panels, drawing.columns, |n| format!("{}-{n}", figure.id));
        let (id, title) = (&figure.id, prose::html(&figure.row.title));
        put!(out, "<li><a href=\"#{id}\">{small}<span>{title}</span></a>\n");
    }
    out.push_str("</ul>\n</section>\n");
}
