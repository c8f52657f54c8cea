//! The same as Markdown, one sentence per line.

use crate::chapter::{
    Chapter, Figure, PAPER, claims_by_outcome, count_of_claims, heading, holds, ours, sign, told,
};
use crate::escape::{code_path, markdown, markdown_attribute, sentences};
use crate::grid;
use crate::number;
use crate::prose;
use crate::select::distinct;
use record::ClaimRow;

/// The front.
pub(crate) fn front(chapters: &[Chapter]) -> String {
    let all = claims_by_outcome(chapters);
    let claims: Vec<&ClaimRow> = all.iter().map(|(_, claim)| *claim).collect();
    let mut out = format!(
        "# Duhem\n\n{PAPER}\n\n{}\n\nThe same as one page: [index.html](index.html).\n",
        markdown(&count_of_claims(&claims))
    );
    if !claims.is_empty() {
        out.push_str("\n## Claims\n\nWhat does not hold comes first.\n\n");
        out.push_str(
            "| verdict | the paper says | printed | ours | why |\n|---|---|---:|---:|---|\n",
        );
        for (chapter, claim) in &all {
            out.push_str(&claim_row(chapter, claim));
        }
    }
    out.push_str("\n## Experiments\n");
    for chapter in chapters {
        let (folder, title) = (&chapter.folder, markdown(chapter.title()));
        put!(out, "\n### [{title}]({folder}/README.md)\n\n");
        for figure in &chapter.figures {
            let (name, title) = (&figure.name, markdown_attribute(&figure.row.title));
            put!(
                out,
                "<a href=\"{folder}/README.md#{}\"><img src=\"{folder}/{name}.svg\" height=\"150\" \
                 alt=\"{title}\" title=\"{title}\"></a>\n",
                figure.id
            );
        }
    }
    out
}

fn claim_row(chapter: &Chapter, claim: &ClaimRow) -> String {
    let mut verdict = format!("{} {}", sign(&claim.verdict), markdown(&claim.verdict));
    if !holds(claim).is_empty() {
        put!(verdict, "<br>{}", holds(claim));
    }
    let mut why = vec![prose::markdown(&claim.why)];
    if !claim.how.is_empty() {
        why.push(format!("Decided by: {}", prose::markdown(&claim.how)));
    }
    if let Some(figure) = chapter.shown(claim) {
        let title = prose::markdown(&figure.row.title);
        why.push(format!("[{title}]({}/{}.svg)", chapter.folder, figure.name));
    }
    why.push(code(&claim.code, "../"));
    why.retain(|part| !part.is_empty());
    format!(
        "| {verdict} | {says}<br>{place}<br>{id} | {printed} | {ours} | {why} |\n",
        says = prose::markdown(&claim.says),
        place = markdown(&claim.place),
        id = markdown(&claim.id),
        printed = markdown(&number::printed(claim.printed, claim.digits, &claim.unit)),
        ours = markdown(&ours(claim)),
        why = why.join("<br>"),
    )
}

fn code(place: &str, up: &str) -> String {
    match code_path(place) {
        Some(path) => format!("[{}]({up}{path})", markdown(place)),
        None => markdown(place),
    }
}

/// One experiment.
pub(crate) fn chapter(chapter: &Chapter) -> String {
    let summary = chapter.summary;
    let mut out = format!("# {}\n", markdown(chapter.title()));
    out.push_str(&paragraphs(summary.about("paper")));
    out.push_str(&paragraphs(summary.about("text")));
    out.push_str("\n[All reports](../README.md)\n");
    for study in &summary.studies {
        put!(out, "\n## {}\n{}", prose::markdown(heading(study)), paragraphs(&study.text));
        let told = told(study);
        if !told.is_empty() {
            out.push('\n');
        }
        for (key, text) in told {
            put!(out, "- {key}: {}\n", prose::markdown(&text));
        }
        chapter.figures_of(&study.study).for_each(|figure| out.push_str(&picture(figure)));
    }
    chapter.figures_of("").for_each(|figure| out.push_str(&picture(figure)));
    if let Some(table) = grid::measures(summary) {
        put!(out, "\n## Measured quantities\n\n{}", table.markdown());
    }
    for study in distinct(summary.cases.iter().map(|case| case.study.as_str())) {
        errors(&mut out, chapter, study);
    }
    out.push_str("\n## How it was made\n\n");
    let told = ["title", "paper", "text"];
    for row in summary.about.iter().filter(|row| !told.contains(&row.key.as_str())) {
        let plain = !row.key.starts_with("irreproducible");
        let value = if plain { markdown(&row.value) } else { prose::markdown(&row.value) };
        put!(out, "- {}: {value}\n", markdown(&row.key));
    }
    out
}

fn errors<'a>(out: &mut String, chapter: &Chapter<'a>, study: &'a str) {
    let name = prose::markdown(chapter.heading_of(study));
    if let Some(table) = grid::orders(chapter.summary, study) {
        put!(
            out,
            "\n## {name}: observed orders\n{}\n{}",
            paragraphs(grid::ORDERS_READ),
            table.markdown()
        );
    }
    if let Some(table) = grid::best(chapter.summary, study) {
        put!(
            out,
            "\n## {name}: errors\n{}\n{}\nEvery case: [cases.csv](cases.csv).\n",
            paragraphs(&grid::best_read(chapter.summary, study)),
            table.markdown()
        );
    }
}

fn picture(figure: &Figure) -> String {
    let row = figure.row;
    format!(
        "\n<a id=\"{id}\"></a>\n\n### {title}\n\n![{description}]({name}.svg)\n{caption}{reads}\n[Data]({name}.csv)\n",
        id = figure.id,
        title = prose::markdown(&row.title),
        description = markdown(&row.description),
        name = figure.name,
        caption = paragraphs(&row.caption),
        reads = paragraphs(figure.reads),
    )
}

/// Paragraphs, one sentence per line.
fn paragraphs(text: &str) -> String {
    let mut out = String::new();
    for part in text.split("\n\n").filter(|part| !part.trim().is_empty()) {
        out.push('\n');
        for sentence in sentences(part) {
            out.push_str(&prose::markdown(&sentence));
            out.push('\n');
        }
    }
    out
}
