//! The page: one file with everything in it.

mod chapter;
mod front;
mod solvers;

use crate::across::Across;
use crate::chapter::Chapter;
use crate::escape::html;
use crate::plot::CSS;

/// How a page looks beside its figures.
pub(crate) const PAGE: &str = include_str!("page.css");

/// The whole page.
pub(crate) fn page(chapters: &[Chapter], across: Option<&Across>) -> String {
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>Duhem: the claims, the figures and the solvers</title>\n\
         <style>\n{PAGE}{CSS}</style>\n</head>\n<body>\n<main>\n"
    );
    front::write(&mut out, chapters, across);
    for chapter in chapters {
        chapter::write(&mut out, chapter);
    }
    made(&mut out, chapters);
    out.push_str("</main>\n</body>\n</html>\n");
    out
}

/// How it was made: command, hashes and versions.
fn made(out: &mut String, chapters: &[Chapter]) {
    out.push_str("<section id=\"made\">\n<h2>How it was made</h2>\n");
    for chapter in chapters {
        put!(out, "<details><summary>{}</summary>\n<dl class=\"made\">\n", html(chapter.title()));
        let told = ["title", "paper", "text"];
        for row in chapter.summary.about.iter().filter(|row| !told.contains(&row.key.as_str())) {
            // A reason is a text, all else is to be copied.
            let value = if row.key.starts_with("irreproducible") {
                crate::prose::html(&row.value)
            } else {
                format!("<code>{}</code>", html(&row.value))
            };
            put!(out, "<dt>{}<dd>{value}\n", html(&row.key));
        }
        out.push_str("</dl>\n</details>\n");
    }
    out.push_str("</section>\n");
}

/// Text in paragraphs, parted by empty lines.
fn paragraphs(text: &str) -> String {
    let parts = text.split("\n\n").map(str::trim).filter(|part| !part.is_empty());
    parts.fold(String::new(), |mut out, part| {
        put!(out, "<p>{}</p>\n", crate::prose::html(part));
        out
    })
}

/// The place in our code: linked if it is a file of ours.
fn code(place: &str) -> String {
    let text = html(place);
    match crate::escape::code_path(place) {
        Some(path) => format!("<a href=\"../{path}\"><code>{text}</code></a>"),
        None => format!("<code>{text}</code>"),
    }
}
