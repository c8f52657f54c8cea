//! The front: what does not hold, what does, and every figure at a glance.

use super::{code, solvers};
use crate::across::{Across, TITLE};
use crate::chapter::{Chapter, Figure, PAPER};
use crate::claims::{
    HELD, OPEN, Part, decided, few_held, in_short, of_part, ours, sign, tally, undecided,
};
use crate::escape::{html, slug};
use crate::number;
use crate::plot::thumbnail;
use crate::prose;
use record::ClaimRow;

/// A claim with its chapter.
type Judged<'a, 'b> = (&'b Chapter<'a>, &'a ClaimRow);

/// Writes the front.
pub(super) fn write(out: &mut String, chapters: &[Chapter], across: Option<&Across>) {
    let claims: Vec<&ClaimRow> = chapters.iter().flat_map(|c| &c.summary.claims).collect();
    put!(
        out,
        "<header>\n<h1>Duhem</h1>\n<p>{PAPER}</p>\n<p class=\"count\">{}</p>\n</header>\n",
        html(&tally(&claims))
    );
    let [no, open, held, own] = [Part::Contradicted, Part::Undecided, Part::Reproduced, Part::Ours]
        .map(|part| of_part(chapters, part));
    let held = !held.is_empty() || !own.is_empty();
    let drawn = chapters.iter().any(|chapter| !chapter.figures.is_empty());
    out.push_str("<nav aria-label=\"Contents\"><ol>\n");
    let parts = [
        (!no.is_empty() || !open.is_empty(), "claims", OPEN),
        (held, "held", HELD),
        (across.is_some(), "solvers", TITLE),
        (drawn, "figures", "All figures"),
    ];
    for (_, id, name) in parts.iter().filter(|(there, _, _)| *there) {
        put!(out, "<li><a href=\"#{id}\">{name}</a>\n");
    }
    for chapter in chapters {
        let (id, title) = (&chapter.folder, html(chapter.title()));
        put!(out, "<li><a href=\"#{id}\">{title}</a>\n");
    }
    out.push_str("<li><a href=\"#made\">How it was made</a>\n</ol></nav>\n");
    write_open(out, &no, &open);
    if held {
        write_held(out, chapters);
    }
    if let Some(across) = across {
        solvers::write(out, across);
    }
    write_thumbnails(out, chapters);
}

/// What does not hold, a row each; behind it, folded, what is not decided by what is printed.
fn write_open(out: &mut String, no: &[Judged], open: &[Judged]) {
    if no.is_empty() && open.is_empty() {
        return;
    }
    put!(out, "<section>\n<h2 id=\"claims\">{OPEN}</h2>\n");
    if !no.is_empty() {
        write_claims(out, no);
    }
    if !open.is_empty() {
        put!(out, "<details><summary>Not decided: {}</summary>\n", undecided(open));
        write_claims(out, open);
        out.push_str("</details>\n");
    }
    out.push_str("</section>\n");
}

fn write_claims(out: &mut String, claims: &[Judged]) {
    out.push_str(
        "<table class=\"claims\"><thead><tr><th scope=\"col\">Verdict<th scope=\"col\">The paper says\
         <th scope=\"col\">Printed<th scope=\"col\">Ours</thead>\n",
    );
    for (chapter, claim) in claims {
        write_claim(out, chapter, claim);
    }
    out.push_str("</table>\n");
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

/// One compact row, and all there is to say folded under it.
fn write_claim(out: &mut String, chapter: &Chapter, claim: &ClaimRow) {
    let cell = |name: &str, number: &str| {
        let none = if number == number::NONE { " none" } else { "" };
        format!("<td data-label=\"{name}\" class=\"n{none}\">{}", html(number))
    };
    put!(
        out,
        "<tbody id=\"claim--{id}\"><tr><td rowspan=\"2\"><span class=\"verdict {class}\">\
         <b aria-hidden=\"true\">{sign}</b>{verdict}</span><td class=\"says\">{says}{printed}{ours}\
         <tr><td colspan=\"3\" class=\"why\"><details><summary>Why</summary>{told}</details></tbody>\n",
        id = slug(&claim.id),
        class = class(claim),
        sign = sign(&claim.verdict),
        verdict = html(&claim.verdict),
        says = prose::html(&claim.says),
        printed = cell("Printed", &number::printed(claim.printed, claim.digits, &claim.unit)),
        ours = cell("Ours", &ours(claim)),
        told = told(chapter, claim)
    );
}

/// What is told of a claim on request.
fn told(chapter: &Chapter, claim: &ClaimRow) -> String {
    let mut lines = vec![format!("{} · {}", html(&claim.place), html(&claim.id))];
    lines.extend(decided(claim).map(|text| prose::html(&text)));
    if let Some(figure) = chapter.shown(claim) {
        lines.push(format!("<a href=\"#{}\">{}</a>", figure.id, prose::html(&figure.row.title)));
    }
    if !claim.code.is_empty() {
        lines.push(code(&claim.code));
    }
    format!("<p>{}<small>{}</small></p>", prose::html(&claim.why), lines.join("<br>"))
}

/// What holds: a line each, by experiment, with all there is to say folded behind it; our own statements last.
fn write_held(out: &mut String, chapters: &[Chapter]) {
    put!(out, "<section>\n<h2 id=\"held\">{HELD}</h2>\n");
    let open = if few_held(chapters) { " open" } else { "" };
    for chapter in chapters {
        let held = chapter.claims_of(Part::Reproduced);
        if held.is_empty() {
            continue;
        }
        let title = html(chapter.title());
        put!(out, "<details{open}><summary>{title}: {} reproduced</summary>\n", held.len());
        for claim in held {
            write_line(out, chapter, claim);
        }
        out.push_str("</details>\n");
    }
    let own = of_part(chapters, Part::Ours);
    if !own.is_empty() {
        put!(out, "<details><summary>Statements of our own: {}</summary>\n", own.len());
        for (chapter, claim) in own {
            write_line(out, chapter, claim);
        }
        out.push_str("</details>\n");
    }
    out.push_str("</section>\n");
}

fn write_line(out: &mut String, chapter: &Chapter, claim: &ClaimRow) {
    let short = match in_short(claim).as_str() {
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
        told = told(chapter, claim)
    );
}

/// Every figure once more, small and folded: the chapters show them large.
fn write_thumbnails(out: &mut String, chapters: &[Chapter]) {
    if chapters.iter().all(|chapter| chapter.figures.is_empty()) {
        return;
    }
    out.push_str(
        "<section>\n<details class=\"data\" id=\"figures\"><summary>All figures at a glance</summary>\n",
    );
    for chapter in chapters.iter().filter(|chapter| !chapter.figures.is_empty()) {
        put!(out, "<p><b>{}</b></p>\n", html(chapter.title()));
        write_thumbs(out, &chapter.figures);
    }
    out.push_str("</details>\n</section>\n");
}

fn write_thumbs(out: &mut String, figures: &[Figure]) {
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
