//! The claims in one screen.

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
    let unit = if row.unit == "1" { "" } else { &row.unit };
    let number = |v: Option<f64>| v.map_or("-".to_owned(), |v| format!("{} {unit}", short(v)));
    let verdict = format!("{mark} {:<15}", row.verdict);
    let verdict = if colours { format!("\x1b[{colour}m{verdict}\x1b[0m") } else { verdict };
    let numbers = match (row.printed, row.ours) {
        (None, None) => String::new(),
        (printed, ours) => format!("printed {}, ours {}", number(printed), number(ours)),
    };
    format!("{verdict} {:<width$}  {numbers}", row.id).trim_end().to_owned()
}

/// Four significant digits; two where a power of ten is needed.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
        format!("{rounded}")
    } else {
        format!("{value:.1e}")
    }
}
