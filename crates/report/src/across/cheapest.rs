//! Who solves each problem for the least evaluations.

use super::{Problem, Table, cheapest, told};
use crate::grid::Grid;
use crate::number;
use crate::select::by_solver;
use record::CaseRow;

/// The delivered errors that prices are asked for.
const BOUNDS: [(f64, &str); 3] = [(1e-3, "10⁻³"), (1e-6, "10⁻⁶"), (1e-8, "10⁻⁸")];

/// The table: a problem in each row, a bound in each column.
pub(super) fn table(problems: &[Problem]) -> Table {
    let winners: Vec<[Option<&CaseRow>; 3]> =
        problems.iter().map(|p| BOUNDS.map(|(bound, _)| cheapest(p.of_solvers(), bound))).collect();
    let cell = |case: Option<&CaseRow>| {
        case.map_or_else(
            || number::NONE.to_owned(),
            |case| format!("{} {}\n{}", case.solver, number::count(case.evaluations), told(case)),
        )
    };
    let rows = problems.iter().zip(&winners).map(|(problem, row)| {
        let name = format!("{}\n{}", problem.name(), problem.experiment);
        std::iter::once(name).chain(row.map(cell)).collect()
    });
    let head = ["problem".to_owned()].into_iter();
    let head = head.chain(BOUNDS.map(|(_, name)| format!("cheapest at {name}"))).collect();
    let often: Vec<String> =
        (0..BOUNDS.len()).map(|n| often(BOUNDS[n].1, winners.iter().map(|row| row[n]))).collect();
    Table {
        title: "The cheapest solver of each problem".to_owned(),
        reads: format!(
            "{} Our own methods, which know more, are told apart. A price is what the run cost that happened to deliver; a user who does not know the answer pays more.",
            often.join(" ")
        ),
        grid: Grid { head, rows: rows.collect(), class: "words", words: 4 },
        folded: true,
    }
}

/// Who is the cheapest most often at one bound, in words.
fn often<'a>(bound: &str, winners: impl Iterator<Item = Option<&'a CaseRow>> + Clone) -> String {
    let all = winners.clone().count();
    let mut names: Vec<(&str, usize)> = by_solver(winners.flatten())
        .into_iter()
        .map(|(solver, cases)| (solver, cases.len()))
        .collect();
    let reached: usize = names.iter().map(|(_, n)| n).sum();
    names.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
    let told: Vec<String> = names.iter().take(3).map(|(name, n)| format!("{name} {n}×")).collect();
    if told.is_empty() {
        return format!("At {bound}: nobody.");
    }
    format!("At {bound}: {} ({reached} of {all} problems reached).", told.join(", "))
}
