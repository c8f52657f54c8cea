//! The numbers of every experiment, pinned: errors, orders, failures, claims and measures by relative
//! tolerance, work counts loosely and in a snapshot of their own.

mod common;

use common::run::{experiments, tables};
use insta::{Settings, Snapshot, comparator::Comparator, internals::SnapshotContents};
use record::{CaseRow, Summary};
use std::fmt::Write;

/// Numbers are equal within this; everything else to the letter.
#[derive(Debug, Clone, Copy)]
struct Near {
    relative: f64,
    absolute: f64,
}

/// Four digits are shown; the last may be rounded either way, and round-off is no number.
const RESULTS: Near = Near { relative: 2e-3, absolute: 2e-12 };
/// A search ends near a minimum, or where there is none; on another processor elsewhere.
const SEARCHED: Near = Near { relative: 0.1, absolute: 5e-3 };
/// Slopes are shown with two decimals.
const ORDERS: Near = Near { relative: 0.02, absolute: 0.02 };
/// Another processor may take a step more or less.
const WORK: Near = Near { relative: 0.05, absolute: 20.0 };
/// Errors below this print as `<1e-13`.
const ROUND_OFF: f64 = 1e-13;

impl Near {
    fn equal(self, a: &str, b: &str) -> bool {
        // A number within a sentence, or at its end.
        let (a, b) = match (a.strip_suffix([',', '.']), b.strip_suffix([',', '.'])) {
            (Some(own), Some(other)) if a.chars().last() == b.chars().last() => (own, other),
            _ => (a, b),
        };
        let number = |text: &str| text.trim_start_matches('<').parse::<f64>().ok();
        match (number(a), number(b)) {
            (Some(x), Some(y)) => {
                (x - y).abs() <= self.relative * x.abs().max(y.abs()) + self.absolute
            }
            _ => a == b,
        }
    }

    fn same(self, reference: &str, test: &str) -> bool {
        let lines: [Vec<&str>; 2] = [reference, test].map(|text| text.trim().lines().collect());
        lines[0].len() == lines[1].len()
            && lines[0].iter().zip(&lines[1]).all(|(a, b)| {
                let words: [Vec<&str>; 2] = [a, b].map(|line| line.split_whitespace().collect());
                words[0].len() == words[1].len()
                    && words[0].iter().zip(&words[1]).all(|(a, b)| self.equal(a, b))
            })
    }
}

impl Comparator for Near {
    fn matches(&self, reference: &Snapshot, test: &Snapshot) -> bool {
        match (reference.contents(), test.contents()) {
            (SnapshotContents::Text(a), SnapshotContents::Text(b)) => {
                self.same(&a.to_string(), &b.to_string())
            }
            _ => false,
        }
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(*self)
    }
}

/// Compares with the snapshot of this name beside the experiments.
fn pin(name: &str, near: Near, text: &str) {
    let mut settings = Settings::clone_current();
    settings.set_snapshot_path("../../experiments/snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_comparator(Box::new(near));
    settings.bind(|| insta::assert_snapshot!(name, text));
}

#[test]
fn every_number_is_where_it_was() {
    for path in experiments() {
        let tables = tables(&path);
        let name = |table: &str| format!("{}.{table}", tables.name);
        let results = if tables.discoveries.is_empty() { RESULTS } else { SEARCHED };
        pin(&name("claims"), results, &claims(&tables));
        pin(&name("measures"), results, &measures(&tables));
        pin(&name("orders"), ORDERS, &orders(&tables));
        pin(&name("errors"), RESULTS, &errors(&tables));
        pin(&name("failures"), RESULTS, &failures(&tables));
        pin(&name("work"), WORK, &work(&tables));
    }
}

/// Four significant digits, round-off as such, a dash for none.
fn number(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(v) if v.abs() < ROUND_OFF => format!("<{ROUND_OFF:e}"),
        Some(v) => format!("{v:.3e}"),
    }
}

fn case(row: &CaseRow) -> String {
    let point = if row.point.is_empty() { "-" } else { &row.point };
    format!("{:<6} {point:<10} {:<18} {:<7e} {:<7}", row.study, row.solver, row.value, row.corners)
}

fn errors(tables: &Summary) -> String {
    let mut text = "study point solver control corners: final max l2 away, relative\n".to_owned();
    for row in
        tables.cases.iter().filter(|row| row.status == "solved" && row.irreproducible.is_empty())
    {
        let numbers = [row.error_final, row.error_max, row.error_l2, row.error_away].map(number);
        let _ = writeln!(text, "{} {}", case(row), numbers.join(" "));
    }
    text
}

fn failures(tables: &Summary) -> String {
    let mut text =
        "study point solver control corners: status, share of the span reached\n".to_owned();
    for row in
        tables.cases.iter().filter(|row| row.status != "solved" || !row.irreproducible.is_empty())
    {
        let reached = if row.irreproducible.is_empty() {
            format!("{:.3}", row.reached)
        } else {
            row.irreproducible.replace(' ', "-")
        };
        let status = if row.any_status { "any".to_owned() } else { row.status.replace(' ', "-") };
        let _ = writeln!(text, "{} {status:<20} {reached}", case(row));
    }
    text
}

fn orders(tables: &Summary) -> String {
    let mut text =
        "study point solver corners: declared, slope against, observed, failed\n".to_owned();
    for row in &tables.orders {
        let point = if row.point.is_empty() { "-" } else { &row.point };
        let declared = row.declared.map_or("-".to_owned(), |d| d.to_string());
        let observed = if row.irreproducible.is_empty() {
            let order = row.order.map_or("-".to_owned(), |order| format!("{order:.2}"));
            format!("{order} {}", row.failed)
        } else {
            row.irreproducible.replace(' ', "-")
        };
        let name = format!("{:<6} {point:<10} {:<18} {:<7}", row.study, row.solver, row.corners);
        let _ = writeln!(text, "{name} {declared} {} {observed}", row.against);
    }
    text
}

fn work(tables: &Summary) -> String {
    let mut text =
        "study point solver control corners: evaluations jacobians accepted rejected\n".to_owned();
    for row in tables.cases.iter().filter(|row| row.irreproducible.is_empty()) {
        let rejected = row.rejected.map_or("-".to_owned(), |r| r.to_string());
        let _ = writeln!(
            text,
            "{} {} {} {} {rejected}",
            case(row),
            row.evaluations,
            row.jacobians,
            row.accepted
        );
    }
    text
}

fn measures(tables: &Summary) -> String {
    tables.measures.iter().fold(String::new(), |mut text, row| {
        let _ = writeln!(text, "{:<40} {} {}", row.id, number(Some(row.value)), row.unit);
        text
    })
}

fn claims(tables: &Summary) -> String {
    tables.claims.iter().fold(String::new(), |mut text, row| {
        let (printed, ours) = (number(row.printed), number(row.ours));
        let _ = writeln!(
            text,
            "{:<36} {:<15} {printed} {ours} {}\n    {}",
            row.id, row.verdict, row.unit, row.why
        );
        text
    })
}

#[test]
fn the_comparator_sees_what_it_should() {
    let same = |a, b| RESULTS.same(a, b);
    assert!(same("rk4 1.234e-6 solved", "rk4   1.235e-6 solved"));
    assert!(!same("rk4 1.234e-6 solved", "rk4 1.240e-6 solved"));
    assert!(!same("rk4 1.234e-6 solved", "rk4 1.234e-6 failed"));
    assert!(!same("rk4 1.234e-6", "rk4 1.234e-6 1"));
    assert!(
        same("off by 1.234, or 1.235.", "off by 1.235, or 1.234.") && !same("1.234,", "1.234.")
    );
    assert!(!same("a\nb", "a"));
    assert!(same("x <1e-13", "x 9.1e-13") && !same("x <1e-13", "x 1e-11"));
    assert!(WORK.same("n 1000", "n 1030") && !WORK.same("n 1000", "n 1100"));
}
