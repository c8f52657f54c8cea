//! The solvers across all experiments: what is counted, what is said of it, and that five experiments fit.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

mod fixture;

use record::{CaseRow, ClaimRow, StudyRow, Summary};
use report::render;
use std::{collections::BTreeMap, sync::OnceLock};

fn rendered(summaries: &[Summary]) -> BTreeMap<String, String> {
    let outputs = render(summaries).unwrap().into_iter();
    outputs.map(|output| (output.path, String::from_utf8(output.bytes).unwrap())).collect()
}

/// The five experiments, rendered once for all tests.
fn five() -> &'static BTreeMap<String, String> {
    static FILES: OnceLock<BTreeMap<String, String>> = OnceLock::new();
    FILES.get_or_init(|| rendered(&fixture::five()))
}

/// A run of one solver on the only study.
fn run(solver: &str, control: (&str, f64), error: Option<f64>, evaluations: u64) -> CaseRow {
    CaseRow {
        study: "slip".to_owned(),
        solver: solver.to_owned(),
        control: control.0.to_owned(),
        value: control.1,
        corners: "restart".to_owned(),
        status: if error.is_some() { "solved" } else { "diverged" }.to_owned(),
        error_max: error,
        evaluations,
        ..CaseRow::default()
    }
}

/// One study whose reference is exact to 1e-9, with runs that are good, failed, or silent failures.
fn lying() -> Summary {
    let study = StudyRow {
        study: "slip".to_owned(),
        reference: "exact".to_owned(),
        response: "displacement q".to_owned(),
        budget: 1000,
        reference_error: Some(1e-9),
        ..StudyRow::default()
    };
    let cases = vec![
        run("bdf", ("rtol", 1e-3), Some(0.5), 10), // gross: half the answer, though asked for 1e-3
        run("bdf", ("rtol", 1e-5), Some(0.0101), 20), // missed: just above 1000 times 1e-5
        run("bdf", ("rtol", 1e-6), Some(0.000_99), 40), // short by two digits and something: no silent failure
        run("bdf", ("rtol", 1e-13), Some(0.9e-9), 300), // within the reference's own error
        run("bdf", ("rtol", 1e-9), None, 999),          // it said so itself
        run("rk4", ("step", 33.0), Some(0.11), 130),    // gross
        run("rk4", ("step", 65.0), Some(0.1), 260),     // a fixed step promises nothing below that
        run("rk4", ("step", 129.0), Some(5e-7), 520),
    ];
    Summary { name: "staircase".to_owned(), studies: vec![study], cases, ..Summary::default() }
}

/// The cells of the row of a Markdown table that begins with this one.
fn row<'a>(text: &'a str, first: &str) -> Vec<&'a str> {
    let start = format!("| {first} |");
    let line = text.lines().find(|line| line.starts_with(&start));
    let line = line.unwrap_or_else(|| panic!("no row {first}"));
    line.trim_matches('|').split('|').map(str::trim).collect()
}

#[test]
fn a_run_that_said_solved_and_was_not_is_counted_and_one_that_failed_is_not() {
    let files = rendered(&[lying()]);
    let front = &files["README.md"];
    // solver, solved, to 1e-3, to 1e-6, to 1e-8, cost at 1e-3, at 1e-6, gross, missed
    assert_eq!(
        row(front, "bdf"),
        ["bdf", "4/5", "1/1", "1/1", "1/1", "1.0\u{202f}×", "1.0\u{202f}×", "1", "1"]
    );
    assert_eq!(
        row(front, "rk4"),
        ["rk4", "3/3", "1/1", "1/1", "0/1", "13\u{202f}×", "1.7\u{202f}×", "1", "–"]
    );
    let worst = front.split("<summary>The worst silent failures").nth(1).unwrap();
    let bdf = row(worst, "bdf");
    assert_eq!(
        bdf[2..],
        ["rtol 10⁻⁵, restarted at corners", "0.010", "3.0 digits", "“solved” (+1)"]
    );
    assert_eq!(row(worst, "rk4")[3..], ["0.11", "–", "“solved”"]);
    assert!(front.contains("2 solvers ran 8 times on 1 problem ("), "{}", &front[..1500]);
    assert!(front.contains("by rk4 (1 of 1) and bdf (1 of 1), of"), "who delivers 1e-3");
    assert!(front.contains("most often bdf, on 1 of the 1 problems"), "who is cheapest at 1e-6");
    assert!(front.contains("there are 2 (rk4 1, bdf 1).\nNo solver is without."), "who lies");
    assert!(front.contains("(1000)"), "the budget of the study is not told");
}

#[test]
fn the_cheapest_run_is_that_of_the_error_delivered_and_not_of_the_one_asked_for() {
    let files = rendered(&[lying()]);
    let table = files["README.md"].split("The cheapest solver of each problem").nth(1).unwrap();
    let cells = row(table, "slip<br>staircase");
    assert!(cells[1].starts_with("bdf 40<br>rtol 10⁻⁶"), "{cells:?}");
    assert!(cells[2].starts_with("bdf 300<br>"), "{cells:?}: nobody else delivers 1e-6 so cheaply");
    assert!(cells[3].starts_with("bdf 300<br>"), "{cells:?}");
}

#[test]
fn without_a_silent_failure_none_is_listed_and_without_a_run_there_is_no_section() {
    let mut summary = lying();
    summary.cases.retain(|case| case.error_max.is_some_and(|error| error < 1e-6));
    let files = rendered(&[summary.clone()]);
    assert!(!files["README.md"].contains("The worst silent failures"));
    summary.cases.clear();
    let files = rendered(&[summary]);
    assert!(!files["README.md"].contains("across all experiments"));
    assert!(!files.contains_key("solvers.svg"));
}

#[test]
fn the_map_marks_what_failed_and_what_lied() {
    let files = rendered(&[lying()]);
    let (svg, csv) = (&files["solvers.svg"], &files["solvers.csv"]);
    assert!(svg.contains(">−3</text>"), "bdf at 1e-6 delivers below 1e-3, and lies elsewhere only");
    assert!(!svg.contains(" !</text>"), "a mark for a run that is not shown");
    let mut nearest = lying();
    nearest.cases.retain(|case| case.value != 1e-6);
    let nearest = rendered(&[nearest]);
    assert!(nearest["solvers.svg"].contains(">−1 !</text>"), "bdf at 1e-5 is shown and lies");
    assert!(svg.contains("rotate(-90 "), "the solvers' names stand upright");
    assert!(csv.contains("staircase: slip,bdf,1e-6,0.00099,\n"));
    let mut failed = lying();
    failed.cases.retain(|case| case.status != "solved" || case.solver == "rk4");
    let svg = &rendered(&[failed])["solvers.svg"];
    assert!(svg.contains(">✗</text>"), "a failure is labelled without colour");
}

#[test]
fn errors_are_named_after_the_response_of_their_study() {
    let files = five();
    let label = "largest error of displacement q, relative";
    for (folder, there) in [("mass-spring-staircase", true), ("dahl-gamma-sweep", false)] {
        for figure in ["fig01-work.svg", "fig01-convergence.svg", "fig01-tolerance.csv"] {
            let text = &files[&format!("{folder}/{figure}")];
            assert_eq!(text.contains(label), there, "{folder}/{figure}");
            assert_eq!(text.contains("largest error of force F, relative"), !there, "{folder}");
        }
    }
    let chapter = &files["gearbox/README.md"];
    assert!(chapter.contains("relative to the largest angle θ of the reference"));
}

#[test]
fn all_five_experiments_are_linked_from_both_fronts() {
    let files = five();
    let (page, front) = (&files["index.html"], &files["README.md"]);
    for summary in fixture::five() {
        let name = summary.name;
        assert!(page.contains(&format!("<li><a href=\"#{name}\">")), "{name}: not in the contents");
        assert!(page.contains(&format!("<section id=\"{name}\"")), "{name}: no chapter");
        assert!(front.contains(&format!("]({name}/README.md)")), "{name}: not on the front");
        assert!(files.contains_key(&format!("{name}/README.md")), "{name}: no chapter in Markdown");
        for figure in &summary.figures {
            let id = format!("{name}--{}", figure.figure);
            assert!(page.contains(&format!("<li><a href=\"#{id}\">")), "{id}: no thumbnail");
            assert!(page.contains(&format!("<figure id=\"{id}\"")), "{id}: no figure");
        }
    }
}

#[test]
fn every_fold_is_closed_has_a_line_to_show_and_opens_on_paper() {
    let mut all = fixture::five();
    all.push(fixture::hostile());
    for (path, text) in rendered(&all) {
        let (mut depth, mut rest) = (0_usize, text.as_str());
        while let Some(at) = rest.find("details") {
            let before = &rest[..at];
            if before.ends_with("</") {
                depth = depth.checked_sub(1).unwrap_or_else(|| panic!("{path}: closed twice"));
            } else if before.ends_with('<') {
                depth += 1;
                let tag = rest[at..].split_once('>').unwrap().1;
                assert!(tag.trim_start().starts_with("<summary>"), "{path}: {}", &tag[..60]);
            }
            rest = &rest[at + 7..];
        }
        assert_eq!(depth, 0, "{path}: folds left open");
        assert_eq!(text.matches("<summary>").count(), text.matches("</summary>").count(), "{path}");
    }
    let page = &five()["index.html"];
    assert!(page.contains(
        "@media print{details:not(.data)::details-content{display:block;content-visibility:visible"
    ));
}

#[test]
fn many_claims_that_hold_are_folded_and_what_does_not_hold_is_not() {
    let claim = |n: usize| ClaimRow {
        id: format!("c{n}"),
        says: format!("sentence {n}"),
        why: "First reason. Second reason.".to_owned(),
        verdict: if n == 0 { "contradicted" } else { "reproduced" }.to_owned(),
        holds: Some(n > 0),
        ..ClaimRow::default()
    };
    let summary = |n: usize| Summary { claims: (0..=n).map(claim).collect(), ..fixture::empty() };
    for (n, open) in [(30, true), (31, false)] {
        for (path, text) in rendered(&[summary(n)]) {
            if !["index.html", "README.md"].contains(&path.as_str()) {
                continue;
            }
            let place = |what: &str| text.find(what).unwrap_or_else(|| panic!("{path}: no {what}"));
            assert_eq!(text.contains("<details open>"), open, "{path}: {n} claims hold");
            let held = text.rfind("What holds").unwrap();
            assert!(place("sentence 0") < held && held < place("sentence 1"), "{path}");
            let row = &text[place("sentence 0")..place("First reason.")];
            assert!(row.contains("<details><summary>Why</summary>"), "{path}: the reason is shown");
        }
    }
}

#[test]
fn our_own_statements_are_counted_and_listed_apart_from_the_paper() {
    let mut summary = fixture::summary();
    let held = summary.claims.iter_mut().find(|claim| claim.verdict == "reproduced").unwrap();
    held.place = "ours; not said by the paper".to_owned();
    let id = held.id.clone();
    let files = rendered(&[summary]);
    for path in ["index.html", "README.md"] {
        let text = &files[path];
        let tally = "Of 3 claims of the paper, 1 is contradicted, 1 under-specified and 1 qualitative. \
                     1 statement of our own is measured besides.";
        assert!(text.replace("\\-", "-").contains(tally), "{path}: {}", &text[..900]);
        assert!(
            !text.contains("1 reproduced"),
            "{path}: a statement of ours counted as the paper's"
        );
        let own = text.find("Statements of our own: 1").unwrap();
        assert!(text.rfind(&id).unwrap() > own, "{path}: {id} is not among ours");
    }
}

#[test]
fn chapters_and_claims_stand_in_the_order_of_the_paper() {
    let places = [
        ("a", "Figures 13 to 15"),
        ("b", "pages without a number"),
        ("c", "Figures 3, 4 and 9"),
        ("d", "Figure 13"),
        ("e", "Figures 1, 2 and 8"),
    ];
    let summary = |(name, paper): (&str, &str)| {
        let mut summary = Summary { name: name.to_owned(), ..fixture::summary() };
        let row = summary.about.iter_mut().find(|row| row.key == "paper").unwrap();
        row.value = paper.to_owned();
        summary.about.retain(|row| row.key != "title");
        summary.claims.iter_mut().for_each(|claim| claim.id = format!("{name}.{}", claim.id));
        summary
    };
    let files = rendered(&places.map(summary));
    let (page, front) = (&files["index.html"], &files["README.md"]);
    let check = |text: &str, pattern: fn(&str) -> String| {
        let place = |name: &str| text.find(&pattern(name)).unwrap_or_else(|| panic!("no {name}"));
        let found = ["e", "c", "a", "d", "b"].map(place);
        assert!(found.is_sorted(), "{}: {found:?}", pattern("*"));
    };
    check(page, |name| format!("<li><a href=\"#{name}\">"));
    check(page, |name| format!("<section id=\"{name}\""));
    check(page, |name| format!("claim--{name}.dahl.energy\""));
    check(front, |name| format!("]({name}/README.md)"));
    check(front, |name| format!("{name}.dahl.energy"));
}

#[test]
fn figures_put_aside_stand_folded_with_those_of_the_solvers_at_the_end() {
    let mut summary = fixture::summary();
    summary.figures.iter_mut().find(|row| row.figure == "fig08").unwrap().aside = true;
    let open = ["loop", "curves", "collapse", "ladder", "ranking"];
    let solvers = summary.figures.iter().filter(|row| !open.contains(&&*row.kind));
    let more = solvers.count() + 1;
    let files = rendered(&[summary]);
    let page = &files["index.html"];
    let chapter = page.split("<section id=\"dahl-gamma-sweep\"").nth(1).unwrap();
    for text in [chapter, &files["dahl-gamma-sweep/README.md"]] {
        let fold = format!("<summary>More figures: {more}</summary>");
        let (shown, folded) = text.split_once(&fold).unwrap_or_else(|| panic!("no {fold}"));
        assert_eq!(text.matches("More figures").count(), 1, "one fold for the chapter");
        let name = |name: &str| format!("id=\"dahl-gamma-sweep--{name}\"");
        assert!(shown.contains(&name("fig01")) && !shown.contains(&name("fig08")));
        let place = |figure: &str| folded.find(&name(figure)).unwrap();
        assert!(place("fig08") < place("fig01-orders"), "what is put aside comes first");
    }
    let glance = page.split("<summary>All figures at a glance").nth(1).unwrap();
    let glance = glance.split("</details>").next().unwrap();
    assert!(glance.contains("class=\"thumbs\""), "the thumbnails are not folded");
}

#[test]
fn long_histories_in_ten_curves_stay_small_and_stand_below_one_another() {
    let mut summary = fixture::five().swap_remove(3);
    let svg = &five()["mass-spring-staircase/fig15.svg"];
    assert!(svg.len() < 150_000, "{} bytes", svg.len());
    let width = svg.split("width=\"").nth(1).unwrap().split('"').next().unwrap();
    assert_eq!(width, "872", "one panel wide, not two");
    for n in 0..10 {
        assert_eq!(svg.matches(&format!(">curve {n}</text>")).count(), 2, "curve {n} unnamed");
    }
    // A log axis and three such figures' worth of points in one are no trouble either.
    summary.cases.clear();
    summary.figures.retain(|row| row.figure == "fig15");
    summary.panels.iter_mut().filter(|row| row.figure == "fig15").for_each(|row| {
        (row.x_log, row.x_min) = (true, 1.0);
    });
    let more: Vec<_> = summary.curves.iter().filter(|row| row.figure == "fig15").cloned().collect();
    for shift in [7000.0, 14000.0] {
        let late = more.iter().cloned().map(|mut row| {
            row.x += shift;
            row
        });
        summary.curves.extend(late);
    }
    let svg = &rendered(&[summary])["mass-spring-staircase/fig15.svg"];
    assert!(svg.len() < 150_000, "{} bytes", svg.len());
    assert!(svg.contains(">10<tspan dy=\"-.5em\" font-size=\"9.5\">3</tspan>"), "no tick at 10³");
}

#[test]
fn more_problems_than_a_map_can_hold_are_drawn_study_by_study() {
    let all = fixture::five();
    let again = all.iter().cloned().map(|mut summary| {
        summary.name.push_str("-again");
        summary
    });
    let mut all: Vec<Summary> = all.iter().cloned().chain(again).collect();
    for summary in &mut all {
        summary.figures.clear();
    }
    let few = &five()["solvers.svg"];
    assert!(few.contains(">fig01, γ = 0.25</text>"), "35 problems have a row each");
    let many = &rendered(&all)["solvers.svg"];
    assert!(many.contains(">fig01</text>") && !many.contains("γ"), "70 problems are too many");
    assert!(few.len() < 150_000 && many.len() < 150_000, "{} and {} bytes", few.len(), many.len());
}

#[test]
fn the_same_five_experiments_give_the_same_bytes() {
    assert_eq!(*five(), rendered(&fixture::five()));
}
