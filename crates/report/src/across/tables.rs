//! The tables: every solver in one line, the worst silent failures, and solver × study.

use super::{Problem, Silence, Table, cheapest, told};
use crate::grid::Grid;
use crate::number::{self, NONE};
use crate::plot::rank;
use crate::select::{SOLVED, distinct};
use record::CaseRow;

/// The most silent failures listed of methods with step control, and of fixed steps.
const LISTED: (usize, usize) = (7, 3);

fn of(part: usize, all: usize) -> String {
    if all == 0 { NONE.to_owned() } else { format!("{part}/{all}") }
}

fn silent(problems: &[&Problem], solver: &str, kind: Silence) -> usize {
    let own = problems.iter().map(|p| p.of(solver).filter(|c| p.silence(c) == Some(kind)).count());
    own.sum()
}

/// Every solver in one line.
pub(super) fn solvers(problems: &[Problem], solvers: &[&str]) -> Table {
    let row = |solver: &&str| {
        let own: Vec<&Problem> =
            problems.iter().filter(|p| p.of(solver).next().is_some()).collect();
        let runs = own.iter().flat_map(|p| p.of(solver));
        let reached = |bound: f64| {
            let n = own.iter().filter(|p| cheapest(p.of(solver), bound).is_some()).count();
            of(n, own.len())
        };
        let adaptive = runs.clone().any(|case| case.control == "rtol");
        let missed = silent(&own, solver, Silence::Missed).to_string();
        vec![
            (*solver).to_owned(),
            of(runs.clone().filter(|case| case.status == SOLVED).count(), runs.count()),
            reached(1e-3),
            reached(1e-6),
            reached(1e-8),
            dearness(&own, solver, 1e-3),
            dearness(&own, solver, 1e-6),
            silent(&own, solver, Silence::Gross).to_string(),
            if adaptive { missed } else { NONE.to_owned() },
        ]
    };
    let head = [
        "solver",
        "runs\nsolved",
        "problems\nto 10⁻³",
        "problems\nto 10⁻⁶",
        "problems\nto 10⁻⁸",
        "cost\nat 10⁻³",
        "cost\nat 10⁻⁶",
        "silent:\ngross",
        "silent: missed\nby 3 digits",
    ];
    Table {
        title: "Every solver in one line".to_owned(),
        reads: "Problems: on how many the solver delivered that error with any control it was given. \
                Cost: evaluations over those of the cheapest that is given a right-hand side, the median over the problems \
                it reached; our own methods, which are given the task, come last and may take less. \
                Silent: runs that said solved and were not."
            .to_owned(),
        grid: Grid {
            head: head.map(str::to_owned).to_vec(),
            rows: solvers.iter().map(row).collect(),
            class: "across",
            words: 1,
        },
        folded: false,
    }
}

/// The median, over the problems it reached, of its evaluations over the least of anybody.
fn dearness(problems: &[&Problem], solver: &str, bound: f64) -> String {
    let ratio = |problem: &&&Problem| {
        let own = cheapest(problem.of(solver), bound)?.evaluations;
        let least = cheapest(problem.of_solvers(), bound)?.evaluations;
        Some(own.max(1) as f64 / least.max(1) as f64)
    };
    let mut ratios: Vec<f64> = problems.iter().filter_map(|p| ratio(&p)).collect();
    ratios.sort_by(f64::total_cmp);
    match ratios.len() {
        0 => NONE.to_owned(),
        n => {
            let middle = f64::midpoint(ratios[(n - 1) / 2], ratios[n / 2]);
            let text = match middle {
                m if m < 0.095 => number::significant(m, 1),
                m => number::decimal(m, usize::from(m < 9.95)),
            };
            format!("{text}\u{202f}×")
        }
    }
}

/// A silent failure: how bad, the run, and its problem.
struct Lie<'a> {
    /// Digits short of the tolerance; of a fixed step, digits above round numbers: log₁₀ of the error.
    digits: f64,
    case: &'a CaseRow,
    problem: &'a Problem<'a>,
    /// How many of the same solver in the same study.
    count: usize,
}

/// The worst silent failures by name, the worst of each solver in each study; none if there is none.
pub(super) fn lies(problems: &[Problem]) -> Option<Table> {
    let mut all: Vec<Lie> = Vec::new();
    for problem in problems {
        for case in problem.cases.iter().filter(|case| problem.silence(case).is_some()) {
            let error = case
                .error_max
                .map_or(f64::INFINITY, |e| if e.is_nan() { f64::INFINITY } else { e });
            let digits = if case.control == "rtol" { error / case.value } else { error }.log10();
            let same = |lie: &&mut Lie| {
                lie.case.solver == case.solver
                    && lie.problem.chapter == problem.chapter
                    && lie.case.study == case.study
            };
            match all.iter_mut().find(same) {
                Some(lie) if lie.digits >= digits => lie.count += 1,
                Some(lie) => *lie = Lie { digits, case, problem, count: lie.count + 1 },
                None => all.push(Lie { digits, case, problem, count: 1 }),
            }
        }
    }
    all.sort_by(|a, b| {
        let rank = |lie: &Lie| rank(&lie.case.solver).0;
        b.digits.total_cmp(&a.digits).then(rank(a).cmp(&rank(b)))
    });
    let (adaptive, fixed): (Vec<&Lie>, Vec<&Lie>) =
        all.iter().partition(|lie| lie.case.control == "rtol");
    let rows: Vec<_> = adaptive
        .iter()
        .take(LISTED.0)
        .chain(fixed.iter().take(LISTED.1))
        .map(|lie| lie_row(lie))
        .collect();
    let head = ["solver", "problem", "asked for", "largest error", "short by", "said"];
    (!rows.is_empty()).then(|| Table {
        title: "The worst silent failures".to_owned(),
        reads: "Of each solver in each study the worst run, after + how many more; step control first, then fixed steps."
            .to_owned(),
        grid: Grid { head: head.map(str::to_owned).to_vec(), rows, class: "lies", words: 3 },
        folded: true,
    })
}

fn lie_row(lie: &Lie) -> Vec<String> {
    let more = match lie.count - 1 {
        0 => String::new(),
        n => format!(" (+{n})"),
    };
    let short = if lie.case.control == "rtol" {
        format!("{} digits", number::decimal(lie.digits, 1))
    } else {
        NONE.to_owned()
    };
    vec![
        lie.case.solver.clone(),
        format!("{}: {}", lie.problem.experiment, lie.problem.name()),
        told(lie.case),
        number::error(lie.case.error_max),
        short,
        format!("“{}”{more}", lie.case.status),
    ]
}

/// Solver × study of one experiment.
pub(super) fn matrix(problems: &[&Problem], solvers: &[&str]) -> Table {
    let experiment = problems.first().map_or("", |problem| problem.experiment);
    let studies = distinct(problems.iter().map(|problem| problem.study));
    let row = |solver: &&str| {
        let cell = |study: &&str| {
            let own: Vec<&Problem> =
                problems.iter().copied().filter(|p| p.study == *study).collect();
            matrix_cell(&own, solver)
        };
        let cells: Vec<String> = studies.iter().map(cell).collect();
        let run = cells.iter().any(|cell| cell != NONE);
        run.then(|| std::iter::once((*solver).to_owned()).chain(cells).collect())
    };
    let named = |study: &&str| {
        let budget = problems.iter().find(|p| p.study == *study).map_or(0, |p| p.budget);
        format!("{study}\nbudget {}", number::count(budget))
    };
    let head = std::iter::once("solver".to_owned());
    Table {
        title: format!("Solver by study: {experiment}"),
        reads: "Each cell: runs solved; the smallest error of a run; the least evaluations for a largest error \
                of 10⁻³ and of 10⁻⁶, at the point of the sweep that costs most, – if a point is never reached; \
                after ⚠ the silent failures, gross + missed by three digits."
            .to_owned(),
        grid: Grid {
            head: head.chain(studies.iter().map(named)).collect(),
            rows: solvers.iter().filter_map(row).collect(),
            class: "across",
            words: 1,
        },
        folded: true,
    }
}

fn matrix_cell(problems: &[&Problem], solver: &str) -> String {
    let runs: Vec<&CaseRow> = problems.iter().flat_map(|p| p.of(solver)).collect();
    if runs.is_empty() {
        return NONE.to_owned();
    }
    let solved: Vec<_> = runs.iter().filter(|case| case.status == SOLVED).collect();
    let best = solved.iter().filter_map(|case| case.error_max).filter(|e| e.is_finite());
    let price = |bound: f64| {
        let each = problems.iter().filter(|p| p.of(solver).next().is_some());
        let prices: Option<Vec<u64>> =
            each.map(|p| cheapest(p.of(solver), bound).map(|case| case.evaluations)).collect();
        prices.and_then(|all| all.into_iter().max()).map_or_else(|| NONE.to_owned(), number::count)
    };
    let mut text = format!(
        "{}\n{}\n{}; {}",
        of(solved.len(), runs.len()),
        number::error(best.min_by(f64::total_cmp)),
        price(1e-3),
        price(1e-6)
    );
    let kinds = [Silence::Gross, Silence::Missed].map(|kind| silent(problems, solver, kind));
    if kinds != [0, 0] {
        put!(text, "\n⚠ {} + {}", kinds[0], kinds[1]);
    }
    text
}
