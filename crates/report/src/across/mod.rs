//! The solvers across all experiments: who is reliable on what, at what cost, and who says solved and is not.

mod cheapest;
mod heat;
mod opening;
mod ours;
mod tables;

pub(crate) use heat::READS;

use crate::chapter::Chapter;
use crate::figures::Drawing;
use crate::grid::Grid;
use crate::number;
use crate::select::{SOLVED, by_solver, distinct, is_exact, is_ours};
use crate::{Output, ReportError};
use record::CaseRow;

/// A run that said solved and whose largest error is above this is a gross silent failure.
const GROSS: f64 = 0.1;
/// A run that said solved and whose largest error is above so many times its tolerance missed it by three digits.
const MISSED: f64 = 1000.0;

/// A problem: one study at one point of its sweep, with every run of it.
#[derive(Debug)]
struct Problem<'a> {
    /// Which of the chapters it is from.
    chapter: usize,
    /// The name of that experiment.
    experiment: &'a str,
    /// The study.
    study: &'a str,
    /// The point of its sweep; empty without one.
    point: &'a str,
    /// The most evaluations a run of it may use.
    budget: u64,
    /// The bound of the reference's own error, relative.
    own: f64,
    /// The runs.
    cases: Vec<&'a CaseRow>,
}

/// How a run that said solved was not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Silence {
    /// The answer is wrong, whatever was asked for.
    Gross,
    /// The tolerance is missed by three digits or more.
    Missed,
}

impl<'a> Problem<'a> {
    /// Whether this run said solved and was not. What lies within the reference's own error is not counted.
    fn silence(&self, case: &CaseRow) -> Option<Silence> {
        let error = case.error_max.filter(|_| case.status == SOLVED)?;
        let above = |bound: f64| error.is_nan() || error > bound.max(self.own);
        match case.control.as_str() {
            _ if above(GROSS) => Some(Silence::Gross),
            "rtol" if above(MISSED * case.value) => Some(Silence::Missed),
            _ => None,
        }
    }

    /// The runs of one solver.
    fn of<'b>(&'b self, solver: &'b str) -> impl Iterator<Item = &'a CaseRow> + Clone + 'b {
        self.cases.iter().copied().filter(move |case| case.solver == solver)
    }

    /// The runs of solvers, which are given a right-hand side and nothing else.
    fn of_solvers(&self) -> impl Iterator<Item = &'a CaseRow> {
        self.ordered().filter(|case| !is_ours(case))
    }

    /// The runs in the order of the solvers, so that the first of equals is always the same.
    fn ordered(&self) -> impl Iterator<Item = &'a CaseRow> {
        by_solver(self.cases.iter().copied()).into_iter().flat_map(|(_, cases)| cases)
    }

    /// The study and the point, as in `fig01, γ = 0.25`.
    fn name(&self) -> String {
        match self.point {
            "" => self.study.to_owned(),
            point => format!("{}, {}", self.study, number::point(point)),
        }
    }
}

/// The run that delivered this error for the least evaluations.
fn cheapest<'b>(cases: impl Iterator<Item = &'b CaseRow>, bound: f64) -> Option<&'b CaseRow> {
    cases
        .filter(|case| case.status == SOLVED && case.error_max.is_some_and(|e| e <= bound))
        .min_by_key(|case| case.evaluations)
}

/// What a run was told, as in `rtol 10⁻⁶, corners ignored`.
fn told(case: &CaseRow) -> String {
    let control = match case.control.as_str() {
        "step" => format!("{} steps per period or run", number::short(case.value)),
        other => format!("{other} {}", number::short(case.value)),
    };
    if is_ours(case) {
        return if is_exact(case) { "exact".to_owned() } else { control };
    }
    format!("{control}, {}", crate::select::corners_in_words(&case.corners))
}

/// A table with its title and how it is read.
#[derive(Debug)]
pub(crate) struct Table {
    /// The title.
    pub(crate) title: String,
    /// How it is read.
    pub(crate) reads: String,
    /// The table.
    pub(crate) grid: Grid,
    /// Whether it stands folded.
    pub(crate) folded: bool,
}

/// The section.
#[derive(Debug)]
pub(crate) struct Across {
    /// What was found, and the terms it is said in.
    pub(crate) text: Vec<String>,
    /// What is counted and how; it stands folded.
    pub(crate) counted: Vec<String>,
    /// The map of errors.
    pub(crate) map: Drawing,
    /// The tables, in the order of reading.
    pub(crate) tables: Vec<Table>,
}

/// The title of the section.
pub(crate) const TITLE: &str = "The solvers across all experiments";
/// The title of the fold behind what was found.
pub(crate) const COUNTED: &str = "How it is counted";
/// The title of the map.
pub(crate) const MAP: &str = "The error each solver delivers on each problem";
/// The name of the map's files.
pub(crate) const NAME: &str = "solvers";

impl Across {
    /// The section, if there is a run to compare.
    pub(crate) fn new(chapters: &[Chapter]) -> Result<Option<Self>, ReportError> {
        let problems = problems(chapters);
        let all = problems.iter().flat_map(|problem| problem.cases.iter().copied());
        let solvers: Vec<&str> = by_solver(all.clone()).into_iter().map(|(name, _)| name).collect();
        if solvers.is_empty() {
            return Ok(None);
        }
        let titles: Vec<&str> = chapters.iter().map(Chapter::title).collect();
        let mut tables = vec![tables::solvers(&problems, &solvers)];
        tables.extend(tables::lies(&problems));
        tables.push(cheapest::table(&problems));
        tables.extend(ours::table(&problems));
        for chapter in 0..chapters.len() {
            let own: Vec<&Problem> = problems.iter().filter(|p| p.chapter == chapter).collect();
            tables.extend((!own.is_empty()).then(|| tables::matrix(&own, &solvers)));
        }
        let budgets = problems.iter().map(|problem| problem.budget);
        let mut text = vec![opening::findings(&problems, &solvers), ours::told(&problems)];
        text.push(opening::terms(chapters, &problems));
        text.retain(|text| !text.is_empty());
        let (counted, map) = (counted(budgets), heat::draw(&problems, &solvers, &titles)?);
        Ok(Some(Self { text, counted, map, tables }))
    }

    /// The map's own files.
    pub(crate) fn files(&self) -> [Output; 2] {
        let svg = crate::plot::file(&self.map.panels, 1, MAP, &self.map.panels[0].description);
        let csv = crate::chapter::csv(&self.map);
        [("svg", svg), ("csv", csv)].map(|(ending, text)| Output {
            path: format!("{NAME}.{ending}"),
            bytes: text.into_bytes(),
        })
    }
}

/// Every problem with a run that was held against a reference.
fn problems<'a>(chapters: &[Chapter<'a>]) -> Vec<Problem<'a>> {
    let mut all = Vec::new();
    for (n, chapter) in chapters.iter().enumerate() {
        let summary = chapter.summary;
        for study in distinct(summary.cases.iter().map(|case| case.study.as_str())) {
            let own = summary.cases.iter().filter(|case| case.study == study);
            if own.clone().all(|case| case.error_max.is_none()) {
                continue;
            }
            let row = summary.studies.iter().find(|row| row.study == study);
            let budget = row.map_or(0, |row| row.budget);
            let error = row.and_then(|row| row.reference_error).filter(|e| e.is_finite());
            for point in distinct(own.clone().map(|case| case.point.as_str())) {
                let cases = own.clone().filter(|case| case.point == point).collect();
                let own = error.unwrap_or(0.0);
                let experiment = summary.name.as_str();
                all.push(Problem { chapter: n, experiment, study, point, budget, own, cases });
            }
        }
    }
    all
}

/// What is counted, in words.
fn counted(budgets: impl Iterator<Item = u64>) -> Vec<String> {
    let (least, most) = budgets.fold((u64::MAX, 0), |(a, b), n| (a.min(n), b.max(n)));
    let budget = match (least, most) {
        (least, most) if least > most => String::new(),
        (least, most) if least == most => format!(" ({})", number::count(most)),
        (least, most) => format!(" ({} to {})", number::count(least), number::count(most)),
    };
    vec![
        format!(
            "The response is the force where the motion is imposed, the displacement or the angle where a plant \
             is driven; an error is relative to its largest value in the study’s reference. \
             A cost is a count and not a time; Jacobians are counted apart. \
             A run that exceeds its study’s budget of evaluations{budget} has failed: at another price it might not.",
        ),
        "A *silent failure* is a run that said solved and was not: *gross* if its largest error is above 0.1, \
         *missed by three digits* if a method with step control is above 1000 times its relative tolerance. \
         A fixed step promises no accuracy, so only the first can be held against it."
            .to_owned(),
        ours::counted(),
    ]
}
