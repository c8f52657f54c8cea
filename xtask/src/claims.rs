//! The ledger, from the committed records.

use crate::{
    exit::{Exit, Failure},
    output, root, screen,
};
use record::Summary;
use serde_json::{Value, json};
use std::{fmt::Write, path::Path};

/// Prints the ledger of all experiments that have been run.
pub(crate) fn claims(root: &Path, as_json: bool) -> Result<Exit, Failure> {
    let summaries = committed(root, &root.join("reports"))?;
    print(&summaries, as_json, screen::claims);
    Ok(Exit::Done)
}

/// Prints the table of claims that the README shows.
pub(crate) fn markdown(root: &Path) -> Result<Exit, Failure> {
    output::line(table(&committed(root, &root.join("reports"))?).trim_end());
    Ok(Exit::Done)
}

/// The ledger's summary in Markdown: each experiment's count, and what is not simply reproduced, each linked
/// to its place in the report.
pub(crate) fn table(summaries: &[Summary]) -> String {
    let kinds = ["reproduced", "contradicted", "under-specified", "qualitative"];
    let mut text = format!("| experiment | {} |\n|---|---:|---:|---:|---:|\n", kinds.join(" | "));
    for summary in summaries {
        let count = |kind: &&str| summary.claims.iter().filter(|c| c.verdict == **kind).count();
        let counts: Vec<String> = kinds.iter().map(|kind| count(kind).to_string()).collect();
        let name = &summary.name;
        let _ = writeln!(text, "| [{name}](reports/{name}/README.md) | {} |", counts.join(" | "));
    }
    text += "\n| claim | the paper | printed | ours | verdict |\n|---|---|---|---|---|\n";
    for summary in summaries {
        for row in summary.claims.iter().filter(|row| row.verdict != "reproduced") {
            let says = row.says.replace('|', "\\|");
            let [printed, ours] = screen::numbers(row).unwrap_or_default();
            let id = format!("[`{}`](reports/{}/README.md)", row.id, summary.name);
            let _ = writeln!(text, "| {id} | {says} | {printed} | {ours} | {} |", row.verdict);
        }
    }
    text
}

/// The summaries in `reports` of all experiments that have one, in the order of their names.
pub(crate) fn committed(root: &Path, reports: &Path) -> Result<Vec<Summary>, Failure> {
    let mut summaries = Vec::new();
    for name in root::experiments(root)? {
        summaries.extend(committed_one(reports, &name)?);
    }
    Ok(summaries)
}

/// The summary of this experiment, if there is one.
pub(crate) fn committed_one(reports: &Path, name: &str) -> Result<Option<Summary>, Failure> {
    let folder = reports.join(name);
    let there = folder.join(Summary::FILES[0]).is_file();
    Ok(there.then(|| Summary::read(&folder)).transpose()?)
}

/// Prints claims and measures as JSON, or the claims in words.
pub(crate) fn print(summaries: &[Summary], as_json: bool, words: fn(&[Summary]) -> Vec<String>) {
    if as_json {
        output::line(&format!("{:#}", ledger(summaries)));
    } else {
        for line in words(summaries) {
            output::line(&line);
        }
    }
}

fn ledger(summaries: &[Summary]) -> Value {
    let claims = summaries.iter().flat_map(|s| &s.claims).map(|c| {
        let printed = c.printed.map(|value| json!({ "value": value, "unit": c.unit }));
        // A number that answers no printed one is evidence: the sentence itself has none.
        let number = c.ours.map(|value| json!({ "value": value, "error": c.error, "unit": c.unit }));
        let (ours, evidence) = if printed.is_some() { (number, None) } else { (None, number) };
        json!({
            "id": c.id, "place": c.place, "says": c.says, "printed": printed, "ours": ours,
            "evidence": evidence, "holds": c.holds, "verdict": c.verdict, "why": c.why, "how": c.how,
        })
    });
    let claims: Vec<Value> = claims.collect();
    let measures: Vec<Value> = summaries
        .iter()
        .flat_map(|s| &s.measures)
        .map(|m| {
            json!({
                "id": m.id, "value": m.value, "error": m.error, "unit": m.unit, "method": m.method,
                "second_way": m.second,
            })
        })
        .collect();
    json!({ "format": record::FORMAT, "claims": claims, "measures": measures })
}
