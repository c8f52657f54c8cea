//! Our own methods, which are given the task, beside the best of the libraries' solvers, which are given a
//! right-hand side.

use super::{Problem, Table, cheapest};
use crate::grid::Grid;
use crate::number;
use crate::select::{SOLVED, by_solver, distinct, is_exact, is_ours};
use record::CaseRow;

/// The delivered errors that costs are compared at.
const BOUNDS: [(f64, &str); 3] = [(1e-3, "10⁻³"), (1e-6, "10⁻⁶"), (1e-8, "10⁻⁸")];

/// The cheapest run of ours and the cheapest of the libraries that deliver some error.
#[derive(Debug, Clone, Copy)]
struct Pair<'a> {
    ours: Option<&'a CaseRow>,
    library: Option<&'a CaseRow>,
}

impl<'a> Pair<'a> {
    fn of(problem: &Problem<'a>, bound: f64) -> Self {
        let all = || problem.ordered();
        let foreign = |case: &&CaseRow| !is_ours(case) && case.library != "own";
        let ours = cheapest(all().filter(|case| is_ours(case)), bound);
        Self { ours, library: cheapest(all().filter(foreign), bound) }
    }

    /// Our evaluations over theirs, if both arrive.
    fn ratio(self) -> Option<f64> {
        let work = |case: &CaseRow| case.evaluations.max(1) as f64;
        Some(work(self.ours?) / work(self.library?))
    }

    fn cell(self) -> String {
        let told = |case: Option<&CaseRow>| {
            let one =
                |case: &CaseRow| format!("{} {}", case.solver, number::count(case.evaluations));
            case.map_or_else(|| "nobody".to_owned(), one)
        };
        let cell = format!("{}\n{}", told(self.ours), told(self.library));
        self.ratio().map_or_else(|| cell.clone(), |ratio| format!("{cell}\n{}", times(ratio)))
    }
}

/// A ratio as in `0.034×`.
fn times(ratio: f64) -> String {
    format!(
        "{}\u{202f}×",
        if ratio < 9.95 { number::significant(ratio, 2) } else { number::decimal(ratio, 0) }
    )
}

/// The problems that one of ours was run on.
fn held<'b, 'a>(problems: &'b [Problem<'a>]) -> Vec<&'b Problem<'a>> {
    problems.iter().filter(|p| p.cases.iter().any(|case| is_ours(case))).collect()
}

/// What is said first; empty if none of ours was run.
pub(super) fn told(problems: &[Problem]) -> String {
    let held = held(problems);
    if held.is_empty() {
        return String::new();
    }
    let with = |exact: bool| {
        let fits = |case: &CaseRow| is_ours(case) && is_exact(case) == exact;
        held.iter().filter(|p| p.cases.iter().any(|case| fits(case))).count()
    };
    let mut text = format!(
        "Of our own methods, which know the task and not only its right-hand side, an exact one holds on {} and an \
         adaptive one on {} of the {} problems.",
        with(true),
        with(false),
        problems.len()
    );
    failed(&mut text, &held);
    text.push_str(" Evaluations of the cheapest of ours over those of the best library solver:");
    let each = BOUNDS.map(|(bound, name)| {
        let pairs: Vec<Pair> = held.iter().map(|p| Pair::of(p, bound)).collect();
        format!("at {name} {}", compared(&pairs))
    });
    put!(text, " {}.", each.join("; "));
    text.push_str(
        " These are counts and not times: times at equal delivered error are told by *cargo xtask bench anchors*.",
    );
    text
}

/// How many of our runs failed, and whose.
fn failed(text: &mut String, held: &[&Problem]) {
    let runs: Vec<&CaseRow> =
        held.iter().flat_map(|p| p.ordered()).filter(|case| is_ours(case)).collect();
    let failed = by_solver(runs.iter().copied().filter(|case| case.status != SOLVED));
    let names = failed.iter().map(|(name, cases)| format!("{name} {}", cases.len()));
    let told = match failed.iter().map(|(_, cases)| cases.len()).sum::<usize>() {
        0 => "none".to_owned(),
        n => format!("{n} ({})", names.collect::<Vec<_>>().join(", ")),
    };
    put!(text, " Of their {} runs {told} failed.", runs.len());
}

/// The ratios in the middle and at their ends, and who arrives alone.
fn compared(pairs: &[Pair]) -> String {
    let mut ratios: Vec<f64> = pairs.iter().filter_map(|pair| pair.ratio()).collect();
    ratios.sort_by(f64::total_cmp);
    let n = ratios.len();
    let mut text = match (ratios.first(), ratios.last()) {
        (Some(least), Some(most)) => {
            let middle = f64::midpoint(ratios[(n - 1) / 2], ratios[n / 2]);
            let fewer = ratios.iter().filter(|ratio| **ratio < 1.0).count();
            format!(
                "in the middle {} ({} to {}), below 1 on {fewer} of the {n} problems that both bring there",
                times(middle),
                times(*least),
                times(*most)
            )
        }
        _ => "no problem that both bring there".to_owned(),
    };
    for (ours, who) in [(true, "ours alone"), (false, "a library alone")] {
        let only = |pair: &&Pair| pair.ours.is_some() == ours && pair.library.is_some() != ours;
        let count = pairs.iter().filter(only).count();
        if count > 0 {
            put!(text, ", and {who} on {count} more");
        }
    }
    text
}

/// What their counts count.
pub(super) fn counted() -> String {
    "Our own methods are given the model and the motion, find corners and reversals themselves, and deliver on a \
     grid: start, end, kinks and 200 equal times a period, or 2000 over a span without one; their errors are taken \
     there, the others’ at their own accepted steps. \
     An evaluation of an exact method is one update of its closed form, and each time delivered takes one; \
     of lugre-linear a point of a panel, or a whole stretch of constant speed; of radau-located a stage; \
     of dahl-series a coefficient of its power series. \
     An exact method follows the same closed form as the reference, as lugre-linear does at constant speed, and \
     exact-slip-plant the same solution: there an error is rounding and no proof. What proves the forms is the \
     second way that the tests and the reference’s own error hold them against."
        .to_owned()
}

/// The table: a problem in each row, a bound in each column; none if none of ours was run.
pub(super) fn table(problems: &[Problem]) -> Option<Table> {
    let held = held(problems);
    let row = |problem: &&Problem| {
        let name = format!("{}\n{}", problem.name(), problem.experiment);
        let cells = BOUNDS.map(|(bound, _)| Pair::of(problem, bound).cell());
        std::iter::once(name).chain(cells).collect()
    };
    let rows: Vec<Vec<String>> = held.iter().map(row).collect();
    let head = std::iter::once("problem".to_owned());
    let names = distinct(
        held.iter().flat_map(|p| p.ordered()).filter(|c| is_ours(c)).map(|c| c.solver.as_str()),
    );
    (!rows.is_empty()).then(|| Table {
        title: "Ours and the best library solver".to_owned(),
        reads: format!(
            "Each cell: the cheapest of ours that delivers the error, with its evaluations; the cheapest solver of a \
             library; the first over the second. Ours are {}.",
            super::opening::joined(names)
        ),
        grid: Grid {
            head: head.chain(BOUNDS.map(|(_, name)| format!("at {name}"))).collect(),
            rows,
            class: "words",
            words: 4,
        },
        folded: true,
    })
}
