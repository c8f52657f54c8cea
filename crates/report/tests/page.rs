//! What a browser would find wrong and a test can find without one: dead links, levels skipped,
//! pictures without a name, colours too weak to read, dark colours on paper.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

mod fixture;

use report::{Output, render};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Every text the made-up experiments render to, by its path.
fn rendered() -> BTreeMap<String, String> {
    let outputs = render(&[fixture::summary(), fixture::empty()]).unwrap();
    let text = |output: Output| (output.path, String::from_utf8(output.bytes).unwrap());
    outputs.into_iter().map(text).collect()
}

/// The part of a path behind its last point.
fn ending(path: &str) -> &str {
    path.rsplit('.').next().unwrap()
}

/// What stands between `before` and the next `after`, wherever it does.
fn between<'a>(text: &'a str, before: &str, after: &str) -> Vec<&'a str> {
    let ends = text.match_indices(before).map(|(at, _)| &text[at + before.len()..]);
    ends.map(|rest| rest.split(after).next().unwrap()).collect()
}

/// Every link and picture of a page or a Markdown file.
fn links(path: &str, text: &str) -> Vec<String> {
    let mut all = between(text, "href=\"", "\"");
    all.extend(between(text, "src=\"", "\""));
    if ending(path) == "md" {
        all.extend(between(text, "](", ")"));
    }
    all.into_iter().map(str::to_owned).collect()
}

/// A relative link as a path from where the link's file stands, its `..` resolved.
fn resolved(from: &str, link: &str) -> PathBuf {
    let mut path = Path::new(from).parent().unwrap().to_owned();
    for part in link.split('/') {
        match part {
            ".." if path.pop() => {}
            part => path.push(part),
        }
    }
    path
}

#[test]
fn every_link_in_every_page_leads_to_a_file_and_an_anchor() {
    let files = rendered();
    for (path, text) in files.iter().filter(|(path, _)| ["html", "md"].contains(&ending(path))) {
        for link in links(path, text) {
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = if file.is_empty() { PathBuf::from(path) } else { resolved(path, file) };
            let name = target.to_str().unwrap().replace('\\', "/");
            let table = record::Summary::FILES.iter().any(|table| name.ends_with(table));
            let ours = name.starts_with("../crates/") || name.starts_with("crates/");
            assert!(files.contains_key(&name) || table || ours, "{path}: {link} leads nowhere");
            let id = format!("id=\"{anchor}\"");
            let found = anchor.is_empty() || files.get(&name).is_some_and(|to| to.contains(&id));
            assert!(found, "{path}: no {id} in {name}");
        }
    }
}

#[test]
fn the_committed_reports_link_to_files_that_are_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports");
    let page = std::fs::read_to_string(root.join("index.html")).unwrap();
    let ids: BTreeSet<&str> = between(&page, " id=\"", "\"").into_iter().collect();
    for link in links("index.html", &page) {
        match link.strip_prefix('#') {
            Some(id) => assert!(ids.contains(id), "no {id} in the committed page"),
            None => assert!(root.join(&link).exists(), "{link} is linked to and not there"),
        }
    }
    for folder in std::fs::read_dir(&root).unwrap().map(|entry| entry.unwrap().path()) {
        for file in folder.read_dir().into_iter().flatten().map(|entry| entry.unwrap()) {
            let svg = file.path().extension().is_some_and(|ending| ending == "svg");
            let size = file.metadata().unwrap().len();
            assert!(!svg || size < 150_000, "{}: {size} bytes", file.path().display());
        }
    }
}

#[test]
fn no_level_of_heading_is_skipped() {
    for (path, text) in rendered() {
        let levels: Vec<usize> = if ending(&path) == "html" {
            let heads = between(&text, "<h", ">").into_iter();
            heads.filter_map(|rest| rest.split(' ').next().unwrap().parse().ok()).collect()
        } else if ending(&path) == "md" {
            let marks = |line: &str| line.chars().take_while(|c| *c == '#').count();
            text.lines().map(marks).filter(|level| *level > 0).collect()
        } else {
            continue;
        };
        assert_eq!(levels[0], 1, "{path}");
        assert_eq!(levels.iter().filter(|level| **level == 1).count(), 1, "{path}");
        assert!(levels.windows(2).all(|pair| pair[1] <= pair[0] + 1), "{path}: {levels:?}");
    }
}

#[test]
fn every_picture_has_a_name_and_words_for_who_cannot_see_it() {
    let files = rendered();
    let page = &files["index.html"];
    for tag in between(page, "<figure ", ">") {
        assert!(tag.contains("aria-labelledby=\""), "a figure without a name: {tag}");
    }
    for svg in between(page, "<svg ", "</svg>") {
        let told = |before: &str, after: &str| {
            between(svg, before, after).iter().any(|text| !text.ends_with('>'))
        };
        let named = told("<title id=", "</title>") && told("<desc id=", "</desc>");
        assert!(named || svg.starts_with("class=\"fig\" aria-hidden=\"true\""), "{}", &svg[..90]);
    }
    for (path, text) in files.iter().filter(|(path, _)| ending(path) == "md") {
        assert!(!text.contains("![]("), "{path}: a picture without words");
    }
}

/// Red, green and blue of `#rgb` or `#rrggbb`, 0 to 1.
fn colour(hex: &str) -> [f64; 3] {
    let digit = |at: usize| f64::from(u8::from_str_radix(&hex[at..=at], 16).unwrap());
    let two = |at: usize| 16.0 * digit(at) + digit(at + 1);
    let parts =
        if hex.len() == 4 { [1, 2, 3].map(|at| 17.0 * digit(at)) } else { [1, 3, 5].map(two) };
    parts.map(|part| part / 255.0)
}

/// The contrast of two colours by the accessibility guidelines, 1 to 21.
fn contrast(a: &str, b: &str) -> f64 {
    let luminance = |hex: &str| {
        let part = |v: f64| if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
        let [r, g, b] = colour(hex).map(part);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    a.max(b) / a.min(b)
}

/// The variables set by each rule of `selector`, light first, dark second.
fn themes<'a>(page: &'a str, selector: &str) -> Vec<BTreeMap<&'a str, &'a str>> {
    let rules = between(page, &format!("{selector}{{"), "}").into_iter();
    let variable = |rule: &'a str| {
        rule.split(';').filter_map(|one| one.trim().strip_prefix("--")?.split_once(':')).collect()
    };
    rules.map(variable).filter(|rule: &BTreeMap<_, _>| !rule.is_empty()).collect()
}

#[test]
fn text_can_be_read_on_white_and_on_dark_and_lines_can_be_seen() {
    let files = rendered();
    let page = &files["index.html"];
    let check = |theme: &BTreeMap<&str, &str>, names: &[&str], grounds: [&str; 2], least: f64| {
        for (name, ground) in names.iter().flat_map(|name| grounds.map(|ground| (name, ground))) {
            let found = contrast(theme[name], theme[ground]);
            assert!(found >= least, "--{name} on --{ground}: {found:.2}, expected {least}");
        }
    };
    let words = themes(page, ":root");
    let figures = themes(page, ".fig");
    assert_eq!((words.len(), figures.len()), (2, 2), "one theme for light, one for dark");
    for theme in &words {
        let texts = ["ink", "soft", "link", "yes", "no", "open"];
        check(theme, &texts, ["ground", "band"], 4.5);
    }
    for theme in &figures {
        check(theme, &["i", "m", "t1", "t2", "t3", "t4", "t5"], ["g", "b"], 4.5);
        check(theme, &["i"], ["h0", "h1"], 4.5);
        check(theme, &["i"], ["h2", "h3"], 4.5);
        check(theme, &["c1", "c2", "c3", "c4", "c5", "a"], ["g", "g"], 3.0);
    }
}

#[test]
fn dark_colours_are_for_screens_only() {
    for (path, text) in rendered() {
        let all = text.matches("prefers-color-scheme").count();
        let screens = text.matches("@media screen and (prefers-color-scheme:dark)").count();
        assert_eq!(all, screens, "{path}: dark colours would be printed");
    }
}
