//! `cargo xtask check-data`: the record's doctor.

use crate::{
    cli::CheckDataArgs,
    exit::{Exit, Failure},
    output,
    recorded::{read_record, read_rig, safe},
};
use experiment::four_digits;
use identify::{
    Rig,
    doctor::{Examination, Facts, Finding, Motion, Severity, examine},
};
use record::Sheet;
use serde_json::{Value, json};

/// The most lines of a kind on the screen; `--json` has them all.
const MOST: usize = 12;

/// Examines a record, prints what was found, and ends with 1 if any of it is a problem.
pub(crate) fn check_data(arguments: &CheckDataArgs) -> Result<Exit, Failure> {
    let rig = arguments.rig.as_deref().map(read_rig).transpose()?;
    let sheet = read_record(&arguments.record)?;
    let names: Vec<&str> = sheet.columns.iter().map(|c| c.name.as_str()).collect();
    let column = |name: &str| sheet.column(name).map_err(|e| e.to_string());
    let seen = examine(rig.as_ref(), &names, &column);
    if arguments.json {
        output::line(&format!("{:#}", as_json(&seen, &sheet)));
    } else {
        for line in lines(&seen, &sheet, rig.as_ref()) {
            output::line(&safe(&line));
        }
    }
    let problems = count(&seen, Severity::Problem);
    Ok(if problems > 0 { Exit::CheckFailed } else { Exit::Done })
}

pub(crate) fn count(seen: &Examination, severity: Severity) -> usize {
    seen.findings.iter().filter(|f| f.severity == severity).count()
}

fn as_json(seen: &Examination, sheet: &Sheet) -> Value {
    let findings = seen.findings.iter().map(|finding| {
        let mut value = json!(finding);
        value["lines"] = json!(finding.rows.and_then(|(a, b)| sheet.line(a).zip(sheet.line(b))));
        value
    });
    json!({
        "format": record::FORMAT,
        "sampling": seen.sampling,
        "channels": seen.channels,
        "motion": seen.motion,
        "findings": findings.collect::<Vec<_>>(),
        "problems": count(seen, Severity::Problem),
        "notes": count(seen, Severity::Note),
    })
}

fn lines(seen: &Examination, sheet: &Sheet, rig: Option<&Rig>) -> Vec<String> {
    let mut lines = vec![head(seen, sheet, rig)];
    lines.extend(table(&seen.channels));
    lines.extend(seen.motion.as_ref().zip(rig).map(|(motion, rig)| moves(motion, rig)));
    let shown = seen.findings.iter().take(MOST);
    lines.extend(shown.flat_map(|finding| told(finding, sheet, rig)));
    if seen.findings.len() > MOST {
        lines.push(format!("… and {} more: --json has them all", seen.findings.len() - MOST));
    }
    let (problems, notes) = (count(seen, Severity::Problem), count(seen, Severity::Note));
    lines.push(format!("{problems} problems, {notes} notes"));
    lines
}

fn head(seen: &Examination, sheet: &Sheet, rig: Option<&Rig>) -> String {
    let rig = rig.map_or(String::new(), |rig| {
        format!("{} ({}, {}): ", rig.title, rig.kind, rig.friction.name)
    });
    let clock = seen.sampling.as_ref().map_or(", no clock".to_owned(), |s| {
        let gaps = if s.gaps == 0 { "no gaps".to_owned() } else { format!("{} gaps", s.gaps) };
        format!(
            ", {} s at {} Hz, jitter {} %, {gaps}",
            short(s.duration),
            short(1.0 / s.step),
            short(100.0 * s.jitter)
        )
    });
    format!("{rig}{} rows{clock}", sheet.rows())
}

/// A number as a table shows it.
fn short(value: f64) -> String {
    // Below what a sum of stamps can tell there is nothing to show.
    if value.abs() < 1e-12 { "0".to_owned() } else { four_digits(value) }
}

fn table(channels: &[Facts]) -> Vec<String> {
    let heads = ["channel", "unit", "least", "largest", "step", "noise", "blank"];
    let mut rows = vec![heads.map(str::to_owned)];
    rows.extend(channels.iter().take(MOST).map(|f| {
        let name: String = safe(&f.name).chars().take(24).collect();
        let step = f.quantum.map_or("-".to_owned(), short);
        let unit = f.unit.to_owned();
        [name, unit, short(f.least), short(f.largest), step, short(f.noise), f.missing.to_string()]
    }));
    let width = |i: usize| rows.iter().map(|r| r[i].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..heads.len()).map(width).collect();
    let mut lines: Vec<String> = rows
        .iter()
        .map(|row| {
            let cells = row.iter().zip(&widths).enumerate();
            let cells = cells.map(|(i, (cell, width))| {
                if i < 2 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            format!("  {}", cells.collect::<Vec<_>>().join("  ").trim_end())
        })
        .collect();
    if channels.len() > MOST {
        lines.push(format!("  … and {} more columns", channels.len() - MOST));
    }
    lines
}

fn moves(motion: &Motion, rig: &Rig) -> String {
    let kind = identify::rig::Kind::of(rig.kind);
    let (q, v) = kind.map_or(("", ""), |k| (k.displacement_unit, k.velocity_unit));
    let (slow, fast) = motion.speeds;
    let decades = if slow > 0.0 { (fast / slow).log10() } else { 0.0 };
    format!(
        "turns {} times, half swings {} to {} {q}; at rest {} % of the time; moves at {} to {} {v} ({} decades), \
         told from rest above {} {v}",
        motion.reversals,
        short(motion.amplitudes.0),
        short(motion.amplitudes.1),
        short(100.0 * motion.at_rest),
        short(slow),
        short(fast),
        short(decades),
        short(motion.resolution)
    )
}

/// A finding in two lines.
pub(crate) fn told(finding: &Finding, sheet: &Sheet, rig: Option<&Rig>) -> [String; 2] {
    let mark = if finding.severity == Severity::Problem { "!" } else { "~" };
    let column = rig.and_then(|rig| rig.channels.get(&finding.channel)).map(|c| c.column.as_str());
    let column = column.filter(|c| *c != finding.channel).map(cut);
    let whom = match column {
        Some(column) => format!("{} (`{column}`)", finding.channel),
        None => cut(&finding.channel),
    };
    let place = finding.rows.map_or(String::new(), |(a, b)| place(sheet, a, b));
    let whom = format!("{whom}{place}");
    let gap = if whom.is_empty() { "" } else { ": " };
    [format!("{mark} {whom}{gap}{}", finding.text), format!("    → {}", finding.remedy)]
}

/// Where rows stand in the file: its lines, or, where it has none, rows from 1.
fn place(sheet: &Sheet, first: usize, last: usize) -> String {
    let (word, a, b) = match sheet.line(first).zip(sheet.line(last)) {
        Some((a, b)) => ("line", a, b),
        None => ("row", first as u64 + 1, last as u64 + 1),
    };
    if a == b { format!(", {word} {a}") } else { format!(", {word}s {a} to {b}") }
}

/// A header as a line of the screen bears it.
fn cut(text: &str) -> String {
    let short: String = text.chars().take(60).collect();
    if short.len() < text.len() { format!("{short}…") } else { short }
}
