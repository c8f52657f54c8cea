//! What changed between the committed tables and those of a new run, beyond each field's tolerance.
//!
//! Another processor gives other last bits (the C library's `exp` and `sin`, SIMD kernels), and a solver
//! turns one bit into another step. So results are compared tightly, work loosely, names, statuses and
//! verdicts exactly, and of rows that are irreproducible by nature only the status, if that.

mod tolerance;

use record::Summary;
use serde::Serialize;
use serde_json::Value;
use std::fmt;
use tolerance::{
    Close, DRAWN, DRAWN_FITTED, Exact, FITTED_SHARE, Ignored, Row, SEARCHED, TIGHT, TINY,
    Tolerance, Within, Words, case, fit, misfit, order, parameter, searched, searched_parameter,
    study, told, value,
};

/// One field that moved.
#[derive(Debug, Clone, PartialEq)]
pub struct Drift {
    /// The table's file.
    pub table: &'static str,
    /// The row, from 1, and what names it.
    pub row: String,
    /// The field; empty if rows are missing or new.
    pub field: String,
    /// What is committed.
    pub committed: String,
    /// What came out.
    pub found: String,
}

impl fmt::Display for Drift {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { table, row, field, committed, found } = self;
        write!(f, "{table}, {row}: {field}: committed {committed}, found {found}")
    }
}

/// Every field that moved between two summaries of the same experiment.
pub fn drift(committed: &Summary, found: &Summary) -> Vec<Drift> {
    let mut moved = Vec::new();
    compare("about.csv", (&committed.about, &found.about), |_, _| Exact, &mut moved);
    compare("studies.csv", (&committed.studies, &found.studies), study, &mut moved);
    compare("cases.csv", (&committed.cases, &found.cases), case, &mut moved);
    compare("orders.csv", (&committed.orders, &found.orders), order, &mut moved);
    compare("measures.csv", (&committed.measures, &found.measures), value, &mut moved);
    let searching = !found.discoveries.is_empty();
    let share = match (searching, found.fits.is_empty()) {
        (true, _) => SEARCHED,
        (_, false) => FITTED_SHARE,
        _ => 0.0,
    };
    compare("claims.csv", (&committed.claims, &found.claims), told(share), &mut moved);
    compare("figures.csv", (&committed.figures, &found.figures), told(share), &mut moved);
    compare("panels.csv", (&committed.panels, &found.panels), |_, _| TIGHT, &mut moved);
    // The steps that an adaptive solver took are as irreproducible as its counts.
    let histories: Vec<&str> =
        found.figures.iter().filter(|f| f.kind == "history").map(|f| f.figure.as_str()).collect();
    let loops = |s: &Summary| {
        let keep = |c: &&record::CurveRow| !histories.contains(&c.figure.as_str());
        s.curves.iter().filter(keep).cloned().collect::<Vec<_>>()
    };
    let (solved, fitted) = (solved(found), fitted(found));
    let curve = |_: &str, row: &Row| {
        let figure = row.get("figure").and_then(Value::as_str).unwrap_or_default();
        match (fitted.contains(&figure), solved.contains(&figure)) {
            (true, _) => DRAWN_FITTED,
            (_, true) => DRAWN,
            _ => TIGHT,
        }
    };
    compare("curves.csv", (&loops(committed), &loops(found)), curve, &mut moved);
    compare("fits.csv", (&committed.fits, &found.fits), fit, &mut moved);
    let values = if searching { searched_parameter } else { parameter };
    compare("parameters.csv", (&committed.parameters, &found.parameters), values, &mut moved);
    compare("models.csv", (&committed.models, &found.models), misfit, &mut moved);
    compare("misfits.csv", (&committed.misfits, &found.misfits), misfit, &mut moved);
    searches(committed, found, &mut moved);
    moved
}

/// What the searches for a missing effect found.
fn searches(committed: &Summary, found: &Summary, moved: &mut Vec<Drift>) {
    let both = (&committed.discoveries[..], &found.discoveries[..]);
    compare("discoveries.csv", both, searched, moved);
    compare("effects.csv", (&committed.effects, &found.effects), searched, moved);
    compare("gaps.csv", (&committed.gaps, &found.gaps), searched, moved);
    let near = [committed, found].map(near);
    compare("ranking.csv", (&near[0], &near[1]), searched, moved);
    compare("shares.csv", (&committed.shares, &found.shares), searched, moved);
}

/// The best candidate of each round, and those of its set that take away nearly as much; where the others stopped on
/// their way is chance.
fn near(summary: &Summary) -> Vec<record::RankedRow> {
    const ALIKE: f64 = 0.97;
    let all = &summary.ranking;
    let best = |row: &record::RankedRow| {
        let same = |r: &&record::RankedRow| (&r.discovery, r.round) == (&row.discovery, row.round);
        all.iter().filter(same).map(|r| r.shrink).fold(0.0, f64::max)
    };
    let named = |row: &record::RankedRow| {
        let own = summary.effects.iter().filter(|e| e.discovery == row.discovery);
        own.flat_map(|e| e.set.split(';')).any(|name| name == row.effect)
    };
    let kept = |row: &&record::RankedRow| {
        let best = best(row);
        row.shrink >= best || (named(row) && row.shrink > ALIKE * best)
    };
    let mut near: Vec<_> = all.iter().filter(kept).cloned().collect();
    // Which of them comes first is chance, too.
    near.sort_by(|a, b| {
        (&a.discovery, a.round, &a.effect).cmp(&(&b.discovery, b.round, &b.effect))
    });
    near
}

/// The figures that show fits and searches.
fn fitted(summary: &Summary) -> Vec<&str> {
    let of_fit = |f: &&record::FigureRow| {
        summary.fits.iter().any(|fit| fit.fit == f.study)
            || summary.discoveries.iter().any(|search| search.discovery == f.study)
    };
    summary.figures.iter().filter(of_fit).map(|f| f.figure.as_str()).collect()
}

/// The figures that show plants.
fn solved(summary: &Summary) -> Vec<&str> {
    let plants = summary.studies.iter().filter(|s| s.response != "force F");
    let plants: Vec<&str> = plants.map(|s| s.study.as_str()).collect();
    let shown = summary.figures.iter().filter(|f| plants.contains(&f.study.as_str()));
    shown.map(|f| f.figure.as_str()).collect()
}

fn compare<T: Serialize>(
    table: &'static str,
    (committed, found): (&[T], &[T]),
    tolerance: impl Fn(&str, &Row) -> Tolerance,
    moved: &mut Vec<Drift>,
) {
    if committed.len() != found.len() {
        moved.push(Drift {
            table,
            row: "all rows".to_owned(),
            field: "count".to_owned(),
            committed: committed.len().to_string(),
            found: found.len().to_string(),
        });
        return;
    }
    for (i, (old, new)) in committed.iter().zip(found).enumerate() {
        let (old, new) = (fields(old), fields(new));
        for (field, was) in &old {
            let is = new.get(field).unwrap_or(&Value::Null);
            if !equal(was, is, &tolerance(field, &new)) {
                moved.push(Drift {
                    table,
                    row: format!("row {} ({})", i + 1, name(&new)),
                    field: field.clone(),
                    committed: was.to_string(),
                    found: is.to_string(),
                });
            }
        }
    }
}

fn fields<T: Serialize>(row: &T) -> Row {
    match serde_json::to_value(row) {
        Ok(Value::Object(fields)) => fields,
        _ => Row::new(),
    }
}

/// What tells a reader which row is meant.
fn name(row: &Row) -> String {
    let keys = [
        "id",
        "study",
        "fit",
        "discovery",
        "effect",
        "part",
        "parameter",
        "model",
        "channel",
        "point",
        "solver",
        "value",
        "corners",
        "figure",
        "panel",
        "series",
        "key",
    ];
    let words = keys.iter().filter_map(|key| row.get(*key)).map(|v| match v {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    });
    words.filter(|w| !w.is_empty()).collect::<Vec<_>>().join(", ")
}

fn equal(was: &Value, is: &Value, tolerance: &Tolerance) -> bool {
    match (tolerance, was.as_f64(), is.as_f64()) {
        (Ignored, ..) => true,
        (Within(factor), Some(a), Some(b)) => {
            let (small, large) = (a.abs().min(b.abs()), a.abs().max(b.abs()));
            large <= factor * small + TINY
        }
        (Words(share), ..) => match (was.as_str(), is.as_str()) {
            (Some(was), Some(is)) => alike(was, is, *share),
            _ => was == is,
        },
        (Close { relative, absolute }, Some(a), Some(b)) => {
            (a - b).abs() <= relative * a.abs().max(b.abs()) + absolute
        }
        _ => was == is,
    }
}

/// Whether two texts have the same words, and numbers that differ by no more than a `share` of the larger.
fn alike(was: &str, is: &str, share: f64) -> bool {
    let (was, is) = (was.split_whitespace(), is.split_whitespace());
    let number = |word: &str| word.trim_end_matches(['.', ',', ';', ':']).parse::<f64>().ok();
    was.clone().count() == is.clone().count()
        && was.zip(is).all(|(was, is)| match (number(was), number(is)) {
            (Some(a), Some(b)) => (a - b).abs() <= share * a.abs().max(b.abs()),
            _ => was == is,
        })
}

#[cfg(test)]
mod tests {
    use super::drift;
    use record::{
        AboutRow, CaseRow, ClaimRow, CurveRow, DiscoveryRow, FitRow, MeasureRow, OrderRow,
        ParameterRow, Summary,
    };

    fn summary(row: CaseRow) -> Summary {
        Summary { cases: vec![row], ..Summary::default() }
    }

    fn row() -> CaseRow {
        CaseRow {
            solver: "rk4".to_owned(),
            status: "solved".to_owned(),
            error_max: Some(1e-6),
            accepted: 1000,
            ..CaseRow::default()
        }
    }

    #[test]
    fn a_result_may_move_by_its_tolerance_and_no_further() {
        let moved =
            |error| drift(&summary(row()), &summary(CaseRow { error_max: Some(error), ..row() }));
        assert!(moved(1.001e-6).is_empty());
        let found = moved(1.01e-6);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].field, "error_max");
    }

    #[test]
    fn of_an_irreproducible_row_the_status_and_the_sizes_count() {
        let marked = CaseRow { irreproducible: "chatter".to_owned(), ..row() };
        let moved = |other: CaseRow| drift(&summary(marked.clone()), &summary(other)).len();
        let near =
            CaseRow { error_max: Some(5e-4), accepted: 7000, digits: Some(3.3), ..marked.clone() };
        assert_eq!(moved(near), 0);
        assert_eq!(moved(CaseRow { status: "diverged".to_owned(), ..marked.clone() }), 1);
        assert_eq!(moved(CaseRow { error_max: Some(2e-3), ..marked.clone() }), 1);
        assert_eq!(moved(CaseRow { accepted: 50_000, ..marked.clone() }), 1);
        assert_eq!(moved(CaseRow { reached: 0.5, ..marked.clone() }), 1);
        let edge = CaseRow { any_status: true, ..marked.clone() };
        let other = CaseRow { status: "diverged".to_owned(), error_max: Some(1.0), ..edge.clone() };
        assert!(drift(&summary(edge), &summary(other)).is_empty());
    }

    #[test]
    fn each_table_is_compared_just_so_far() {
        let measure = |value, error| Summary {
            measures: vec![MeasureRow { value, error, ..MeasureRow::default() }],
            ..Summary::default()
        };
        let moved = |value, error| drift(&measure(1.5, 1e-9), &measure(value, error)).len();
        assert_eq!((moved(1.5 + 1e-9, 5e-9), moved(1.5 + 1e-8, 1e-9), moved(1.5, 2e-8)), (0, 1, 1));
        let order = |order| Summary {
            orders: vec![OrderRow { order: Some(order), ..OrderRow::default() }],
            ..Summary::default()
        };
        let moved = |found| drift(&order(4.0), &order(found)).len();
        assert_eq!((moved(4.05), moved(4.2)), (0, 1));
        let curve = |y| Summary {
            curves: vec![CurveRow { y, ..CurveRow::default() }],
            ..Summary::default()
        };
        let moved = |found| drift(&curve(0.5), &curve(found)).len();
        assert_eq!((moved(0.5 + 1e-11), moved(0.5 + 1e-8)), (0, 1));
        let work = |accepted| summary(CaseRow { accepted, ..row() });
        let moved = |found| drift(&work(1000), &work(found)).len();
        assert_eq!((moved(1060), moved(1100)), (0, 1));
        let digits = |digits| summary(CaseRow { digits: Some(digits), ..row() });
        assert_eq!(drift(&digits(6.0), &digits(6.2)).len(), 1);
        let text = |value: &str| Summary {
            about: vec![AboutRow { key: "title".to_owned(), value: value.to_owned() }],
            ..Summary::default()
        };
        assert_eq!(drift(&text("a"), &text("b")).len(), 1);
    }

    #[test]
    fn a_fitted_parameter_moves_when_it_moves_by_a_share_of_its_standard_error() {
        let fitted = |found| Summary {
            parameters: vec![ParameterRow { found, standard_error: 0.1, ..Default::default() }],
            ..Summary::default()
        };
        let moved = |found| drift(&fitted(1.0), &fitted(found)).len();
        assert_eq!((moved(1.004), moved(1.006)), (0, 1));
    }

    #[test]
    fn of_a_search_the_words_count_and_the_sizes_of_its_numbers() {
        let search = |why: &str, found: f64, refit: f64| Summary {
            claims: vec![ClaimRow { why: why.to_owned(), ..ClaimRow::default() }],
            parameters: vec![ParameterRow { found, standard_error: 0.1, ..Default::default() }],
            discoveries: vec![DiscoveryRow { refit: Some(refit), ..Default::default() }],
            ..Summary::default()
        };
        let was = search("It leaves 41.2 floors of 716, no more.", 1.0, 1700.0);
        let moved = |why: &str, found, refit| drift(&was, &search(why, found, refit)).len();
        assert_eq!(moved("It leaves 40.3 floors of 700, no more.", 1.29, 1630.0), 0);
        assert_eq!(moved("It leaves 4.12 floors of 716, no more.", 1.0, 1700.0), 1);
        assert_eq!(moved("It leaves 41.2 floors of 716, no less.", 1.0, 1700.0), 1);
        assert_eq!(moved("It leaves 41.2 floors of 716, no more.", 1.31, 1700.0), 1);
        assert_eq!(moved("It leaves 41.2 floors of 716, no more.", 1.0, 1000.0), 1);
    }

    #[test]
    fn what_is_said_of_a_fit_may_differ_as_far_as_the_fit() {
        let said = |why: &str, fits: Vec<FitRow>| Summary {
            claims: vec![ClaimRow { why: why.to_owned(), ..ClaimRow::default() }],
            fits,
            ..Summary::default()
        };
        let moved = |why: &str, fits: &[FitRow]| {
            drift(&said("The error is 3.075.", fits.to_vec()), &said(why, fits.to_vec())).len()
        };
        let fit = [FitRow::default()];
        assert_eq!(moved("The error is 3.076.", &fit), 0);
        assert_eq!(moved("The error is 3.2.", &fit), 1);
        assert_eq!(moved("The distance is 3.075.", &fit), 1);
        assert_eq!(moved("The error is 3.076.", &[]), 1);
    }

    #[test]
    fn a_verdict_is_compared_exactly() {
        let claims = |verdict: &str| Summary {
            claims: vec![ClaimRow { verdict: verdict.to_owned(), ..ClaimRow::default() }],
            ..Summary::default()
        };
        assert_eq!(drift(&claims("reproduced"), &claims("contradicted")).len(), 1);
    }

    #[test]
    fn a_missing_row_is_told() {
        assert_eq!(drift(&summary(row()), &Summary::default()).len(), 1);
    }
}
