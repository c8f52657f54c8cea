//! What is rendered from made-up summaries: every figure kind, hostile text, nothing at all.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

mod fixture;

use fixture::HOSTILE;
use record::{FigureRow, Summary};
use report::{FIGURES, Output, ReportError, render};
use std::collections::BTreeSet;

fn text(output: &Output) -> &str {
    std::str::from_utf8(&output.bytes).unwrap()
}

fn ending(output: &Output) -> &str {
    output.path.rsplit('.').next().unwrap()
}

fn all() -> Vec<Output> {
    render(&[fixture::summary(), fixture::empty(), fixture::hostile()]).unwrap()
}

fn find<'a>(outputs: &'a [Output], path: &str) -> &'a str {
    text(outputs.iter().find(|output| output.path == path).unwrap_or_else(|| panic!("no {path}")))
}

/// Reads XML as far as it goes: every tag closed by its own name, attributes quoted, no stray `<` or `&`.
fn check_xml(path: &str, svg: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        check_entities(path, &rest[..start]);
        let end = rest[start..].find('>').unwrap_or_else(|| panic!("{path}: unclosed tag")) + start;
        let tag = &rest[start + 1..end];
        assert!(tag.matches('"').count().is_multiple_of(2), "{path}: odd quotes in <{tag}>");
        assert!(!tag.contains('<'), "{path}: < inside <{tag}>");
        let name = tag.trim_start_matches('/').split([' ', '/']).next().unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "{path}: </{name}> closes another element");
        } else if !tag.ends_with('/') {
            open.push(name);
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty(), "{path}: {open:?} left open");
}

fn check_entities(path: &str, text: &str) {
    for (at, _) in text.match_indices('&') {
        let entity = text[at..].split(';').next().unwrap();
        assert!(entity.len() < 8, "{path}: bare & in {text}");
    }
    assert!(!text.contains('\u{1}'), "{path}: a control character");
}

#[test]
fn every_kind_of_figure_is_drawn_well_formed_and_small() {
    let outputs = all();
    let figures: Vec<_> = outputs.iter().filter(|output| ending(output) == "svg").collect();
    assert_eq!(figures.len(), 16);
    for figure in figures {
        let svg = text(figure);
        check_xml(&figure.path, svg);
        let size = svg.len();
        assert!(size < 150_000, "{}: {size} bytes", figure.path);
        for part in ["<title id=", "<desc id=", "role=\"img\"", "prefers-color-scheme:dark"] {
            assert!(svg.contains(part), "{}: no {part}", figure.path);
        }
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", figure.path);
    }
}

#[test]
fn every_kind_in_the_list_draws_the_made_up_experiment() {
    let mut summary = fixture::summary();
    let used: BTreeSet<String> = summary.figures.iter().map(|row| row.kind.clone()).collect();
    let listed: BTreeSet<String> = FIGURES.iter().map(|kind| kind.name.to_owned()).collect();
    assert_eq!(used, listed);
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/figures");
    for file in std::fs::read_dir(folder).unwrap() {
        let name = file.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
        assert!(name == "mod" || listed.contains(&name), "{name} is not in the list");
    }
    for row in std::mem::take(&mut summary.figures) {
        let kind = FIGURES.iter().find(|kind| kind.name == row.kind).unwrap();
        let drawing = (kind.draw)(&row, &summary).unwrap();
        assert!(!drawing.panels.is_empty() && !drawing.data.is_empty(), "{}", row.figure);
        for panel in &drawing.panels {
            assert!(panel.body.contains("<text"), "{}: {}", row.figure, panel.title);
        }
    }
}

#[test]
fn text_is_drawn_at_twelve_pixels_or_more_and_exponents_are_raised() {
    let outputs = all();
    let svg = find(&outputs, "dahl-gamma-sweep/fig01-tolerance.svg");
    assert!(svg.contains("font:13px"));
    assert!(svg.contains("10<tspan dy=\"-.5em\" font-size=\"9.5\">−11</tspan>"));
    assert!(!svg.contains("e-1"), "a tick in computer notation");
    let page = find(&outputs, "index.html");
    // 414 px drawn at 13 px text may shrink to 383 px, where text is 12 px.
    assert!(page.contains("style=\"width:414px;min-width:383px\""));
}

#[test]
fn hostile_text_stays_text() {
    let outputs = render(&[fixture::hostile()]).unwrap();
    for output in &outputs {
        let (path, text) = (&output.path, text(output));
        assert!(path.chars().all(|c| c.is_ascii_alphanumeric() || "-_./=".contains(c)), "{path}");
        assert!(!path.contains("..") && !path.starts_with('/'), "{path}");
        if ending(output) == "csv" {
            continue;
        }
        assert!(!text.contains("<script"), "{path}");
        assert!(!text.contains("<img src=x"), "{path}");
        assert!(!text.contains("</text></svg><"), "{path}");
        let link = text.replace("\\](", "").contains("](javascript");
        assert!(!link || ending(output) != "md", "{path}");
    }
    let readme = find(&outputs, "hostile/README.md");
    for line in readme.lines().filter(|line| line.starts_with('|')) {
        let bars = line.matches('|').count() - line.matches("\\|").count();
        assert!((3..=6).contains(&bars), "a table of {bars} bars: {line}");
        assert_eq!(line.matches('`').count(), line.matches("\\`").count(), "{line}");
    }
    assert!(HOSTILE.contains("<script"), "the test itself has lost its teeth");
}

#[test]
fn the_page_needs_no_network_and_no_script() {
    for output in render(&[fixture::summary(), fixture::empty()]).unwrap() {
        let text = text(&output).replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        for outside in ["http:", "https:", "src=\"//", "@import", "url(", "<script", "<link"] {
            assert!(!text.contains(outside), "{}: {outside}", output.path);
        }
    }
}

#[test]
fn identifiers_are_unique_and_every_link_in_the_page_has_its_target() {
    let outputs = render(&[fixture::summary(), fixture::empty()]).unwrap();
    let page = find(&outputs, "index.html");
    let values = |name: &str| -> Vec<&str> {
        page.match_indices(name)
            .map(|(i, _)| page[i + name.len()..].split('"').next().unwrap())
            .collect()
    };
    let ids = values(" id=\"");
    let unique: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), unique.len());
    let labels = values("aria-labelledby=\"").into_iter().flat_map(str::split_whitespace);
    assert!(labels.into_iter().all(|id| unique.contains(id)));
    for link in values("href=\"") {
        let table = Summary::FILES.iter().any(|name| link.ends_with(name));
        let file =
            link.starts_with("../crates/") || table || outputs.iter().any(|o| o.path == link);
        let found = link.strip_prefix('#').map_or(file, |id| unique.contains(id));
        assert!(found, "{link} leads nowhere");
    }
}

#[test]
fn the_same_tables_give_the_same_bytes() {
    assert_eq!(all(), all());
}

#[test]
fn nothing_to_show_is_shown_as_nothing() {
    let outputs = render(&[fixture::empty()]).unwrap();
    let paths: Vec<&str> = outputs.iter().map(|output| output.path.as_str()).collect();
    assert_eq!(paths, ["index.html", "README.md", "empty/README.md"]);
    assert!(render(&[]).unwrap()[0].path == "index.html");
}

#[test]
fn the_front_says_what_holds_and_shows_both_numbers() {
    let outputs = all();
    for path in ["index.html", "README.md"] {
        let front = find(&outputs, path);
        assert!(front.contains("1 is reproduced, 1 contradicted, 1 under-specified"), "{path}");
        assert!(front.contains("1.554\u{202f}J"), "{path}: four digits in the row");
        assert!(front.contains("1.554220345\u{202f}J, error"), "{path}: all digits behind it");
        assert!(front.contains("2.6\u{202f}J"), "{path}");
        assert!(
            front.contains("Not decided: 1 under-specified, 1 qualitative and 1 judged"),
            "{path}"
        );
    }
    let page = find(&outputs, "index.html");
    let place = |id: &str| page.find(&format!("id=\"claim--{id}\"")).unwrap();
    let places = ["dahl.energy", "dahl.shape", "dahl.frequency", "dahl.saturation"].map(place);
    assert!(places.is_sorted(), "what does not hold comes first, then what is not decided");
    let fold = page.find("<summary>Not decided").unwrap();
    assert!(places[0] < fold && fold < places[1], "what is not decided stands folded");
    assert!(page.contains("class=\"n none\">–"), "a number that is not there can be left out");
    let readme = find(&outputs, "dahl-gamma-sweep/README.md");
    assert!(readme.contains("see p. 95.\nThe loop saturates there.\n"), "one sentence per line");
}

#[test]
fn the_values_in_a_figure_stand_beside_it_with_units() {
    let outputs = all();
    let csv = find(&outputs, "dahl-gamma-sweep/fig01.csv");
    assert!(csv.starts_with("panel,series,u [m],F [N],failure\n"), "{}", &csv[..80]);
    let csv = find(&outputs, "dahl-gamma-sweep/fig01-collapse.csv");
    assert!(csv.contains(",dopri5,0.25,,too many evaluations\n"), "a failure without its row");
}

#[test]
fn a_curve_that_is_alone_has_no_name_and_runs_that_failed_set_no_axis() {
    let mut summary = fixture::summary();
    let alone = find(&all(), "dahl-gamma-sweep/fig08.svg").to_owned();
    assert!(!alone.contains(">dahl</text>"), "a legend for a single curve");
    assert!(find(&all(), "dahl-gamma-sweep/fig01.svg").contains(">γ = 0.25</text>"));
    let mut drawn = |spent: u64| {
        let failed = summary.cases.iter_mut().filter(|case| case.status != "solved");
        failed.for_each(|case| case.evaluations = spent);
        let outputs = render(std::slice::from_ref(&summary)).unwrap();
        find(&outputs, "dahl-gamma-sweep/fig01-work.svg").to_owned()
    };
    assert!(drawn(1_000_000_000) == drawn(10_000_000_000), "a failed run moves the axis of work");
}

#[test]
fn a_history_that_stops_early_says_why() {
    let mut summary = fixture::summary();
    summary.figures.retain(|row| row.kind == "history");
    summary.figures[0].study = "fig01".to_owned();
    let span = summary.studies.iter().find(|row| row.study == "fig01").unwrap().span;
    let of = |row: &record::CurveRow| row.panel == "gamma=0.25" && row.series == "dopri5";
    summary.curves.retain(|row| !of(row) || row.x < 0.4 * span);
    let end = summary.curves.iter().rfind(|row| of(row)).unwrap().x;
    let lane = "E: too many evaluations";
    let drawn = |summary: &Summary| render(std::slice::from_ref(summary)).unwrap();
    assert!(!find(&drawn(&summary), "dahl-gamma-sweep/steps.svg").contains(lane));
    let case = summary.cases.iter_mut().find(|case| {
        case.point == "gamma=0.25" && case.solver == "dopri5" && case.status != "solved"
    });
    case.unwrap().reached = end / span;
    let outputs = drawn(&summary);
    assert!(find(&outputs, "dahl-gamma-sweep/steps.svg").contains(lane));
    let row = format!("gamma = 0.25,dopri5,{end:?},,too many evaluations\n").replace("gamma", "γ");
    assert!(find(&outputs, "dahl-gamma-sweep/steps.csv").contains(&row), "no {row}");
}

#[test]
fn an_unknown_kind_names_the_known_ones() {
    let mut summary = fixture::empty();
    let figure = |kind: &str| FigureRow {
        figure: "fig01".to_owned(),
        kind: kind.to_owned(),
        ..FigureRow::default()
    };
    summary.figures = vec![figure("pie")];
    let error = render(&[summary.clone()]).unwrap_err().to_string();
    assert!(error.contains("`pie`") && error.contains("work_precision"), "{error}");
    for kind in FIGURES {
        summary.figures = vec![figure(kind.name)];
        let error = render(&[summary.clone()]).unwrap_err();
        assert!(matches!(error, ReportError::Incomplete { .. }), "{}: {error}", kind.name);
    }
}

#[test]
fn two_files_of_one_name_are_an_error() {
    let mut summary = fixture::summary();
    summary.figures.push(summary.figures[0].clone());
    assert!(matches!(render(&[summary]), Err(ReportError::SameName { .. })));
    let mut summary = fixture::summary();
    summary.figures.truncate(2);
    summary.figures[1].figure = "cases".to_owned();
    let outputs = render(&[summary]).unwrap();
    let tables: Vec<String> =
        Summary::FILES.iter().map(|name| format!("dahl-gamma-sweep/{name}")).collect();
    assert!(outputs.iter().all(|output| !tables.contains(&output.path)), "a table overwritten");
    find(&outputs, "dahl-gamma-sweep/cases-figure.svg");
    let same = [fixture::empty(), fixture::empty()];
    assert!(matches!(render(&same), Err(ReportError::SameName { .. })));
}
