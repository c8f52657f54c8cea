//! The claims in one screen.

use experiment::four_digits;
use record::{ClaimRow, Summary};
use std::{
    env,
    io::{IsTerminal, stdout},
};

/// The claims of these experiments as lines of text.
pub(crate) fn claims(summaries: &[Summary]) -> Vec<String> {
    let colours = stdout().is_terminal() && env::var_os("NO_COLOR").is_none_or(|v| v.is_empty());
    let rows: Vec<&ClaimRow> = summaries.iter().flat_map(|s| &s.claims).collect();
    let width = rows.iter().map(|r| r.id.len()).max().unwrap_or(0);
    let mut lines: Vec<String> = rows.iter().map(|row| claim(row, width, colours)).collect();
    let count = |verdict: &str| rows.iter().filter(|r| r.verdict == verdict).count();
    lines.push(format!(
        "{} claims: {} reproduced, {} contradicted, {} under-specified, {} qualitative",
        rows.len(),
        count("reproduced"),
        count("contradicted"),
        count("under-specified"),
        count("qualitative")
    ));
    lines
}

fn claim(row: &ClaimRow, width: usize, colours: bool) -> String {
    let (mark, colour) = match row.verdict.as_str() {
        "reproduced" => ("=", "32"),
        "contradicted" => ("x", "31"),
        _ => ("~", "33"),
    };
    let verdict = format!("{mark} {:<15}", row.verdict);
    let verdict = if colours { format!("\x1b[{colour}m{verdict}\x1b[0m") } else { verdict };
    let numbers = numbers(row).map(|text| if text.is_empty() { "-".to_owned() } else { text });
    format!("{verdict} {:<width$}  printed {}, ours {}", row.id, numbers[0], numbers[1])
}

/// The printed number and ours, with the unit; a value lost in its error is 0.
pub(crate) fn numbers(row: &ClaimRow) -> [String; 2] {
    let unit = if row.unit == "1" { "" } else { &row.unit };
    let ours = row.ours.map(|v| if v.abs() <= row.error.unwrap_or(0.0) { 0.0 } else { v });
    [row.printed, ours].map(|value| {
        let text = value.map_or(String::new(), |v| format!("{} {unit}", four_digits(v)));
        text.trim_end().to_owned()
    })
}
