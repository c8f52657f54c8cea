//! The counts in words, as Markdown and as JSON, and what failed.

use super::{
    row::{Kind, Row},
    score::{Aim, Measure, Shown, measures, right},
};
use serde_json::{Value, json};
use std::fmt::Write;

/// Seeds below this are for tuning …
pub(super) const TUNING: u64 = 100_000;
/// … and from this on for scoring.
pub(super) const SCORING: u64 = 1_000_000;

/// What the seeds are for.
pub(super) fn purpose(rows: &[Row]) -> &'static str {
    if rows.iter().all(|row| row.seed >= SCORING) {
        "scoring seeds, never used for tuning"
    } else if rows.iter().all(|row| row.seed < TUNING) {
        "tuning seeds"
    } else {
        "seeds neither all for tuning nor all for scoring"
    }
}

fn range(rows: &[Row]) -> String {
    let seeds = rows.iter().map(|row| row.seed);
    match (seeds.clone().min(), seeds.max()) {
        (Some(first), Some(last)) => format!("{first} to {last}"),
        _ => "none".to_owned(),
    }
}

/// What the records are: how many of each kind, and how many of them can be seen.
fn composition(rows: &[Row]) -> String {
    let of = |kind: Kind| rows.iter().filter(move |row| row.kind == kind);
    let seen = |kind| format!("{} visible", of(kind).filter(|row| row.visible()).count());
    format!(
        "{} records, seeds {} ({}): {} with nothing hidden, {} with a wrong parameter ({}), {} with one effect ({}), \
         {} with two ({}), {} with what is in no library ({})",
        rows.len(),
        range(rows),
        purpose(rows),
        of(Kind::Nothing).count(),
        of(Kind::Parameter).count(),
        seen(Kind::Parameter),
        of(Kind::Single).count(),
        seen(Kind::Single),
        of(Kind::Pair).count(),
        seen(Kind::Pair),
        of(Kind::Foreign).count(),
        seen(Kind::Foreign),
    )
}

fn number(shown: Shown, value: f64) -> String {
    match shown {
        Shown::Share => format!("{:.1} %", 100.0 * value),
        Shown::Plain => format!("{value:.3}"),
        Shown::Seconds => format!("{value:.2} s"),
    }
}

fn aim(measure: &Measure) -> String {
    let bound = |value: f64| match measure.shown {
        Shown::Share => format!("{} %", 100.0 * value),
        Shown::Plain => format!("{value}"),
        Shown::Seconds => format!("{value} s"),
    };
    match measure.aim {
        Aim::Least(value) => format!("≥ {}", bound(value)),
        Aim::Most(value) => format!("≤ {}", bound(value)),
        Aim::Told => String::new(),
    }
}

fn word(measure: &Measure) -> &'static str {
    match measure.held() {
        Some(true) => "reached",
        Some(false) => "not reached",
        None => "",
    }
}

/// As lines for a screen, with what failed.
pub(super) fn words(rows: &[Row], at_once: Option<usize>) -> String {
    let mut text = format!("{}\n", composition(rows));
    if let Some(at_once) = at_once.filter(|n| *n > 1) {
        let _ = writeln!(text, "times are those of {at_once} records at a time; see --threads 1");
    }
    for m in measures(rows) {
        let value = m.value.map_or("–".to_owned(), |value| number(m.shown, value));
        let of = format!("of {}", m.of);
        let _ = writeln!(text, "  {:<48} {value:>9} {of:<8} {:<8} {}", m.words, aim(&m), word(&m));
    }
    let failures = failures(rows);
    let _ = writeln!(text, "{} answers are not right:", failures.len());
    for failure in failures {
        let _ = writeln!(text, "  {failure}");
    }
    text
}

/// As a table for the README; without the clock if it was read.
pub(super) fn markdown(rows: &[Row]) -> String {
    let mut text = format!("{}.\n\n| | | of | aim | |\n|---|---|---|---|---|\n", composition(rows));
    for m in measures(rows) {
        let Some(value) = m.value else { continue };
        let value = number(m.shown, value);
        let _ = writeln!(text, "| {} | {value} | {} | {} | {} |", m.words, m.of, aim(&m), word(&m));
    }
    text
}

/// What was not answered rightly though it can be seen, and what was named wrongly though it cannot.
fn failures(rows: &[Row]) -> Vec<String> {
    let bad = |row: &&Row| !right(row) && (row.visible() || row.names());
    rows.iter().filter(bad).map(failure).collect()
}

fn failure(row: &Row) -> String {
    let sets: Vec<String> = row.named.iter().map(|set| set.join("|")).collect();
    let seen: Vec<String> = row.seen.iter().map(|sigmas| format!("{sigmas:.0} σ")).collect();
    format!(
        "{} {} {} {} {}: {} {} ({}) → {} {} {}",
        row.seed,
        row.family,
        row.excitation,
        row.noise,
        row.friction,
        row.kind.name(),
        row.truth.join(" + "),
        seen.join(", "),
        row.verdict,
        sets.join(" + "),
        row.moved.join(", ")
    )
    .trim_end()
    .to_owned()
}

/// All of it.
pub(super) fn json(rows: &[Row]) -> Value {
    let measures: Vec<Value> = measures(rows)
        .iter()
        .map(|m| {
            let (least, most) = match m.aim {
                Aim::Least(aim) => (Some(aim), None),
                Aim::Most(aim) => (None, Some(aim)),
                Aim::Told => (None, None),
            };
            json!({ "name": m.name, "value": m.value, "of": m.of, "least": least, "most": most, "held": m.held() })
        })
        .collect();
    let rows_told: Vec<Value> = rows
        .iter()
        .map(|row| {
            json!({
                "seed": row.seed, "family": row.family, "excitation": row.excitation, "noise": row.noise,
                "friction": row.friction, "kind": row.kind.name(), "truth": row.truth, "visible_sigma": row.seen,
                "verdict": row.verdict, "sets": row.named, "moved": row.moved, "shrink": row.shrink,
                "gap_ratio": row.gap, "value_error": row.error, "seconds": row.seconds, "right": right(row),
            })
        })
        .collect();
    json!({ "format": record::FORMAT, "seeds": purpose(rows), "measures": measures, "records": rows_told,
            "failures": failures(rows) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::hidden::row::tests::row;

    #[test]
    fn the_table_says_what_the_seeds_are_for_and_names_what_failed() {
        let mut wrong = row(Kind::Single, &["stribeck"], "effect", &[&["cogging", "viscous"]]);
        wrong.seed = SCORING + 3;
        let mut right = row(Kind::Nothing, &[], "nothing_missing", &[]);
        right.seed = SCORING;
        let text = words(&[right.clone(), wrong.clone()], None);
        assert!(text.starts_with("2 records, seeds 1000000 to 1000003 (scoring seeds,"), "{text}");
        assert!(text.contains("1 with one effect (1 visible)"), "{text}");
        let told =
            "1000003 pendulum sine low lu_gre: single stribeck (40 σ) → effect cogging|viscous";
        assert!(text.trim_end().ends_with(told), "{text}");
        wrong.seed = 99_999;
        assert_eq!(purpose(&[wrong.clone()]), "tuning seeds");
        assert!(purpose(&[wrong, right]).starts_with("seeds neither"));
    }

    #[test]
    fn the_markdown_has_a_line_for_every_number_there_is_and_its_aim() {
        let text = markdown(&[row(Kind::Single, &["stribeck"], "effect", &[&["stribeck"]])]);
        let line = "| exact name, visible single effects | 100.0 % | 1 | ≥ 95 % | reached |";
        assert!(text.lines().any(|l| l == line), "{text}");
        assert!(!text.contains("wall time"), "nothing was timed: {text}");
    }
}
