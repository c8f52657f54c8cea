//! The same as Markdown, one sentence per line.

use crate::across::{Across, COUNTED, MAP, NAME, READS, TITLE};
use crate::chapter::{Chapter, Figure, PAPER, heading, told};
use crate::claims::{
    HELD, OPEN, Part, decided, few_held, in_short, of_part, ours, sign, tally, undecided,
};
use crate::discoveries::{self, OVERVIEW_READ};
use crate::escape::{code_path, markdown, markdown_attribute, sentences};
use crate::fits;
use crate::grid;
use crate::number;
use crate::prose;
use crate::select::distinct;
use record::{ClaimRow, DiscoveryRow, FitRow};

/// The front.
pub(crate) fn front(chapters: &[Chapter], across: Option<&Across>) -> String {
    let claims: Vec<&ClaimRow> = chapters.iter().flat_map(|c| &c.summary.claims).collect();
    let mut out = format!(
        "# Duhem\n\n{PAPER}\n\n{}\n\nThe same as one page: [index.html](index.html).\n",
        markdown(&tally(&claims))
    );
    open(&mut out, chapters);
    held(&mut out, chapters);
    if let Some(across) = across {
        solvers(&mut out, across);
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

/// What does not hold, and behind it, folded, what is not decided.
fn open(out: &mut String, chapters: &[Chapter]) {
    let [no, open] = [Part::Contradicted, Part::Undecided].map(|part| of_part(chapters, part));
    if no.is_empty() && open.is_empty() {
        return;
    }
    put!(out, "\n## {OPEN}\n");
    if !no.is_empty() {
        put!(out, "\n{}", claim_table(&no));
    }
    if !open.is_empty() {
        out.push_str(&folded(&format!("Not decided: {}", undecided(&open)), &claim_table(&open)));
    }
}

fn claim_table(claims: &[(&Chapter, &ClaimRow)]) -> String {
    let head = "| verdict | the paper says | printed | ours |\n|---|---|---:|---:|\n".to_owned();
    claims.iter().fold(head, |mut out, (chapter, claim)| {
        put!(
            out,
            "| {sign} {verdict} | {says} <details><summary>Why</summary>{more}</details> | {printed} | {ours} |\n",
            sign = sign(&claim.verdict),
            verdict = markdown(&claim.verdict),
            says = prose::markdown(&claim.says),
            more = more(chapter, claim).join("<br>"),
            printed = markdown(&number::printed(claim.printed, claim.digits, &claim.unit)),
            ours = markdown(&ours(claim)),
        );
        out
    })
}

/// What is told of a claim on request.
fn more(chapter: &Chapter, claim: &ClaimRow) -> Vec<String> {
    let mut all = vec![prose::markdown(&claim.why)];
    all.push(format!("{} · {}", markdown(&claim.place), markdown(&claim.id)));
    all.extend(decided(claim).map(|text| prose::markdown(&text)));
    if let Some(figure) = chapter.shown(claim) {
        let title = prose::markdown(&figure.row.title);
        all.push(format!("[{title}]({}/{}.svg)", chapter.folder, figure.name));
    }
    all.push(code(&claim.code, "../"));
    all.retain(|part| !part.is_empty());
    all
}

/// What holds: a line each, by experiment, with all there is to say folded behind it; our own statements last.
fn held(out: &mut String, chapters: &[Chapter]) {
    let own = of_part(chapters, Part::Ours);
    if own.is_empty() && of_part(chapters, Part::Reproduced).is_empty() {
        return;
    }
    put!(out, "\n## {HELD}\n");
    for chapter in chapters {
        let claims = chapter.claims_of(Part::Reproduced);
        if claims.is_empty() {
            continue;
        }
        let inside: String = claims.iter().map(|claim| held_line(chapter, claim)).collect();
        let title = prose::markdown_html(chapter.title());
        let open = if few_held(chapters) { " open" } else { "" };
        let line = format!("<summary>{title}: {} reproduced</summary>", claims.len());
        put!(out, "\n<details{open}>{line}\n{inside}\n</details>\n");
    }
    if !own.is_empty() {
        let inside: String = own.iter().map(|(chapter, claim)| held_line(chapter, claim)).collect();
        out.push_str(&folded(&format!("Statements of our own: {}", own.len()), &inside));
    }
}

fn held_line(chapter: &Chapter, claim: &ClaimRow) -> String {
    let short = in_short(claim);
    let short = if short.is_empty() { short } else { format!(" – {short}") };
    let says = prose::markdown_html(&claim.says);
    let line = format!("{} {says}{}", sign(&claim.verdict), prose::markdown_html(&short));
    folded(&line, &more(chapter, claim).join("<br>\n"))
}

/// A line, and behind it what is Markdown again.
fn folded(line: &str, inside: &str) -> String {
    format!("\n<details><summary>{line}</summary>\n\n{}\n\n</details>\n", inside.trim())
}

/// The solvers across all experiments.
fn solvers(out: &mut String, across: &Across) {
    put!(out, "\n## {TITLE}\n");
    across.text.iter().for_each(|text| out.push_str(&paragraphs(text)));
    let counted: String = across.counted.iter().map(|text| paragraphs(text)).collect();
    out.push_str(&folded(COUNTED, &counted));
    put!(out, "\n![{MAP}]({NAME}.svg)\n{}\n[Data]({NAME}.csv)\n", paragraphs(READS));
    for table in &across.tables {
        let inside = format!("{}\n{}", paragraphs(&table.reads), table.grid.markdown());
        if table.folded {
            out.push_str(&folded(&prose::markdown_html(&table.title), &inside));
        } else {
            put!(out, "\n### {}\n{inside}", prose::markdown(&table.title));
        }
    }
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
        chapter.figures_of(&study.study).into_iter().for_each(|f| out.push_str(&picture(f)));
    }
    summary.fits.iter().for_each(|fit| a_fit(&mut out, chapter, fit));
    if let Some(table) = discoveries::overview(summary) {
        put!(out, "\n## All records\n{}\n{}", paragraphs(OVERVIEW_READ), table.markdown());
    }
    chapter.figures_of("").into_iter().for_each(|figure| out.push_str(&picture(figure)));
    summary.discoveries.iter().for_each(|search| a_search(&mut out, chapter, search));
    let more = chapter.more_figures();
    if !more.is_empty() {
        let inside: String = more.iter().map(|figure| picture(figure)).collect();
        out.push_str(&folded(&format!("More figures: {}", more.len()), &inside));
    }
    if let Some(table) = grid::measures(summary) {
        let title = format!("Measured quantities: {}", table.rows.len());
        out.push_str(&folded(&title, &table.markdown()));
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

/// A fit: its text, how it went, its tables and its figures.
fn a_fit(out: &mut String, chapter: &Chapter, fit: &FitRow) {
    put!(out, "\n## {}\n{}\n", prose::markdown(fits::heading(fit)), paragraphs(&fit.text));
    for (key, text) in fits::told(fit) {
        put!(out, "- {key}: {}\n", prose::markdown(&text));
    }
    for (title, reads, grid) in fits::tables(chapter.summary, &fit.fit) {
        put!(out, "\n### {title}\n{}\n{}", paragraphs(reads), grid.markdown());
    }
    chapter.figures_of(&fit.fit).into_iter().for_each(|figure| out.push_str(&picture(figure)));
}

/// A search for what a model lacks: its text, its answer, its tables and its figures.
fn a_search(out: &mut String, chapter: &Chapter, search: &DiscoveryRow) {
    let heading = prose::markdown(discoveries::heading(search));
    put!(out, "\n## {heading}\n{}\n", paragraphs(&search.text));
    for (key, text) in discoveries::told(chapter.summary, search) {
        put!(out, "- {key}: {}\n", prose::markdown(&text));
    }
    for (title, reads, grid) in discoveries::tables(chapter.summary, &search.discovery) {
        put!(out, "\n### {title}\n{}\n{}", paragraphs(reads), grid.markdown());
    }
    chapter.figures_of(&search.discovery).into_iter().for_each(|f| out.push_str(&picture(f)));
}

fn errors<'a>(out: &mut String, chapter: &Chapter<'a>, study: &'a str) {
    let name = prose::markdown_html(chapter.heading_of(study));
    if let Some(table) = grid::orders(chapter.summary, study) {
        let inside = format!("{}\n{}", paragraphs(grid::ORDERS_READ), table.markdown());
        out.push_str(&folded(&format!("{name}: observed orders"), &inside));
    }
    if let Some(table) = grid::best(chapter.summary, study) {
        let inside = format!(
            "{}\n{}\nEvery case: [cases.csv](cases.csv).",
            paragraphs(&grid::best_read(chapter.summary, study)),
            table.markdown()
        );
        out.push_str(&folded(&format!("{name}: errors"), &inside));
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
        reads = paragraphs(figure.kind.reads),
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
