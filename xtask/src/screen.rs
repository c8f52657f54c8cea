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
    lines.push(counts(&rows));
    lines
}

/// The same in one screen: the claims that are not simply reproduced, and each experiment's count.
pub(crate) fn short(summaries: &[Summary]) -> Vec<String> {
    let colours = stdout().is_terminal() && env::var_os("NO_COLOR").is_none_or(|v| v.is_empty());
    let all = || summaries.iter().flat_map(|s| &s.claims);
    let open: Vec<&ClaimRow> = all().filter(|row| row.verdict != "reproduced").collect();
    let width = open.iter().map(|r| r.id.len()).max().unwrap_or(0);
    let mut lines: Vec<String> = open.iter().map(|row| claim(row, width, colours)).collect();
    if summaries.len() > 1 {
        let of =
            |s: &Summary| format!("{}: {}", s.name, counts(&s.claims.iter().collect::<Vec<_>>()));
        lines.extend(summaries.iter().map(of));
    }
    lines.push(counts(&all().collect::<Vec<_>>()));
    lines
}

/// How many claims there are of each verdict.
pub(crate) fn counts(rows: &[&ClaimRow]) -> String {
    let count = |verdict: &str| rows.iter().filter(|r| r.verdict == verdict).count();
    format!(
        "{} claims: {} reproduced, {} contradicted, {} under-specified, {} qualitative",
        rows.len(),
        count("reproduced"),
        count("contradicted"),
        count("under-specified"),
        count("qualitative")
    )
}

fn claim(row: &ClaimRow, width: usize, colours: bool) -> String {
    let (mark, colour) = match row.verdict.as_str() {
        "reproduced" => ("=", "32"),
        "contradicted" => ("x", "31"),
        _ => ("~", "33"),
    };
    let verdict = format!("{mark} {:<15}", row.verdict);
    let verdict = if colours { format!("\x1b[{colour}m{verdict}\x1b[0m") } else { verdict };
    let told = match numbers(row) {
        Some([printed, ours]) => format!("printed {printed}, ours {ours}"),
        None if row.says.chars().count() > SAID => {
            format!("{}…", row.says.chars().take(SAID).collect::<String>().trim_end())
        }
        None => row.says.clone(),
    };
    format!("{verdict} {:<width$}  {told}", row.id)
}

/// The characters shown of a sentence without a number.
const SAID: usize = 64;

/// The printed number and ours, with the unit, where the paper prints one.
pub(crate) fn numbers(row: &ClaimRow) -> Option<[String; 2]> {
    let unit = if row.unit == "1" { "" } else { &row.unit };
    let text = |value| format!("{} {unit}", four_digits(value)).trim_end().to_owned();
    Some([text(row.printed?), row.ours.map_or("-".to_owned(), text)])
}
