//! Truth against answer: single effects, what is in no library, wrong parameters, and nothing.

use super::{
    row::{Kind, Row},
    score::{exact, inside, right},
};
use report::{Confusion, ConfusionCell, Shading};
use std::collections::BTreeMap;

/// Answers that are no effect, behind the effects.
const OTHERS: [(&str, &str); 4] = [
    ("several", "several effects"),
    ("not_in_library", "not in the library"),
    ("parameter", "a parameter"),
    ("nothing_missing", "nothing missing"),
];

/// The figure's table. What cannot be seen is not in it, nor are pairs; an effect stands under the name it was given
/// first.
pub(super) fn confusion(rows: &[Row]) -> Confusion {
    let shown = |row: &&Row| row.kind != Kind::Pair && row.visible() && row.verdict != "error";
    let mut counts: BTreeMap<(String, String), (usize, Shading)> = BTreeMap::new();
    for row in rows.iter().filter(shown) {
        let cell = counts.entry((truth(row), answer(row))).or_insert((0, Shading::Right));
        *cell = (cell.0 + 1, worse(cell.1, shading(row)));
    }
    let truths = keys(rows.iter().filter(shown).map(truth));
    let answers = keys(rows.iter().filter(shown).map(answer));
    let cell = |truth: &String, answer: &String| {
        let (count, shading) = *counts.get(&(truth.clone(), answer.clone()))?;
        Some(ConfusionCell { count, shading })
    };
    let line = |truth: &String| answers.iter().map(|answer| cell(truth, answer)).collect();
    let all = rows.iter().filter(shown).count();
    Confusion {
        title: format!("What was hidden, and what was answered: {all} records"),
        description: format!(
            "A table of {} truths by {} answers; each cell holds how many visible records of that truth got that answer.",
            truths.len(),
            answers.len()
        ),
        key: ["right", "right one in its set", "not named", "wrong"].map(str::to_owned),
        cells: truths.iter().map(line).collect(),
        rows: truths.iter().map(|key| words(key)).collect(),
        columns: answers.iter().map(|key| words(key)).collect(),
    }
}

/// The effects in the order of the alphabet, then the others in theirs.
fn keys(all: impl Iterator<Item = String>) -> Vec<String> {
    let place = |key: &str| OTHERS.iter().position(|(known, _)| *known == key);
    let mut keys: Vec<String> = all.collect();
    keys.sort_by(|a, b| (place(a), a).cmp(&(place(b), b)));
    keys.dedup();
    keys
}

fn words(key: &str) -> String {
    let known = OTHERS.iter().find(|(known, _)| *known == key);
    known.map_or(key, |(_, words)| words).to_owned()
}

/// What is hidden, by the name of the answer that would be right.
fn truth(row: &Row) -> String {
    match row.kind {
        Kind::Nothing => "nothing_missing".to_owned(),
        Kind::Parameter => "parameter".to_owned(),
        Kind::Foreign => "not_in_library".to_owned(),
        Kind::Single | Kind::Pair => row.truth.join("+"),
    }
}

fn answer(row: &Row) -> String {
    match &row.named[..] {
        [] => row.verdict.clone(),
        [set] => set[0].clone(),
        _ => "several".to_owned(),
    }
}

fn shading(row: &Row) -> Shading {
    let called = row.kind == Kind::Parameter && row.verdict == "parameter";
    if row.kind == Kind::Single && exact(row) && row.named[0][0] == row.truth[0] {
        Shading::Right
    } else if row.kind == Kind::Single && inside(row) {
        Shading::Inside
    } else if row.kind != Kind::Single && right(row) {
        Shading::Right
    } else if called {
        // Of the parameters called wrong none is the one.
        Shading::Inside
    } else if row.names() || row.kind == Kind::Nothing {
        Shading::Wrong
    } else {
        Shading::Silent
    }
}

fn worse(a: Shading, b: Shading) -> Shading {
    if a as u8 >= b as u8 { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::hidden::row::tests::row;

    #[test]
    fn each_answer_stands_in_the_row_of_its_truth_under_its_first_name() {
        let mut faint = row(Kind::Single, &["cogging"], "nothing_missing", &[]);
        faint.seen = vec![2.0];
        let rows = [
            row(Kind::Single, &["cogging"], "effect", &[&["cogging"]]),
            row(Kind::Single, &["cogging"], "effect", &[&["gravity_unbalance", "cogging"]]),
            row(Kind::Single, &["cogging"], "not_in_library", &[]),
            row(Kind::Single, &["stribeck"], "effect", &[&["cogging"]]),
            row(Kind::Nothing, &[], "nothing_missing", &[]),
            row(Kind::Nothing, &[], "nothing_missing", &[]),
            row(Kind::Pair, &["cogging", "stribeck"], "nothing_missing", &[]),
            faint,
        ];
        let table = confusion(&rows);
        assert_eq!(table.rows, ["cogging", "stribeck", "nothing missing"]);
        let columns = ["cogging", "gravity_unbalance", "not in the library", "nothing missing"];
        assert_eq!(table.columns, columns);
        let cell = |count, shading| Some(ConfusionCell { count, shading });
        let expected = [
            vec![cell(1, Shading::Right), cell(1, Shading::Inside), cell(1, Shading::Silent), None],
            vec![cell(1, Shading::Wrong), None, None, None],
            vec![None, None, None, cell(2, Shading::Right)],
        ];
        assert_eq!(table.cells, expected);
        assert!(table.title.ends_with("6 records"), "{}", table.title);
    }
}
