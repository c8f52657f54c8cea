//! How far each field of each table may move.

use serde_json::{Map, Value};

/// How a field is compared.
pub(super) enum Tolerance {
    Exact,
    /// Equal if |a − b| ≤ relative · max(|a|, |b|) + absolute.
    Close {
        relative: f64,
        absolute: f64,
    },
    /// Equal if neither is more than this many times the other, or both are tiny.
    Within(f64),
    /// A text whose words are the same and whose numbers differ by no more than this share.
    Words(f64),
    Ignored,
}

pub(super) use Tolerance::{Close, Exact, Ignored, Within, Words};

/// Errors, orders and other results of a reproducible case.
pub(super) const RESULT: Tolerance = Close { relative: 2e-3, absolute: 2e-12 };
/// Step and evaluation counts: a last bit may cost or save a step or two.
pub(super) const WORK: Tolerance = Close { relative: 0.05, absolute: 20.0 };
/// Closed forms.
pub(super) const TIGHT: Tolerance = Close { relative: 1e-9, absolute: 1e-12 };
/// What follows from a minimum that is found to a share of its standard errors.
pub(super) const FITTED: Tolerance = Close { relative: FITTED_SHARE, absolute: 1e-9 };
/// What a search leaves.
pub(super) const NEAR: Tolerance = Close { relative: 0.1, absolute: 1e-9 };
/// What is drawn of a simulation with fitted parameters.
pub(super) const DRAWN_FITTED: Tolerance = Close { relative: 1e-3, absolute: 1e-3 };
/// What is drawn of a plant that was solved for: finer than a line is wide.
pub(super) const DRAWN: Tolerance = Close { relative: 1e-5, absolute: 1e-5 };
/// Below this, errors and bounds of errors are rounding.
pub(super) const TINY: f64 = 1e-12;

/// Names are compared exactly. A search ends near a minimum, and where something is missing there is none: what is left
/// there has a size and no more. A rival that was never near has a number of some size, too.
pub(super) fn searched(field: &str, row: &Row) -> Tolerance {
    match field {
        // Even of the given model the starts of the windows are searched for.
        "before" | "after" | "floor" => NEAR,
        "refit" | "standard_error" => Within(1.5),
        "value" => Close { relative: 1e-9, absolute: SHORT * standard_error(row) },
        "shrink" => Close { relative: 0.05, absolute: 0.05 },
        // Where a model lacks much some windows follow another way on another processor, and are far off there: of the 33 of
        // the rig's record, refitted without its bias, four, which count as a ninth of all that is in excess.
        "share" => Close { relative: 0.0, absolute: 0.2 },
        "t" => Close { relative: 0.3, absolute: 0.5 },
        "truth" => TIGHT,
        _ => Exact,
    }
}

/// By how many standard errors a search may stop short of the minimum: along a valley the steps' own errors hide the way.
const SHORT: f64 = 3.0;

/// A parameter at the end of a search.
pub(super) fn searched_parameter(field: &str, row: &Row) -> Tolerance {
    let error = standard_error(row);
    match field {
        "found" => Close { relative: 1e-9, absolute: SHORT * error },
        "low" | "high" => Close { relative: 1e-9, absolute: 1.5 * SHORT * error },
        "standard_error" => Within(1.5),
        _ => parameter(field, row),
    }
}

/// A text that tells of what was found: its words exactly, and its numbers to a `share`, as far as what is told is.
pub(super) fn told(share: f64) -> impl Fn(&str, &Row) -> Tolerance {
    move |field, row| match field {
        "how" | "why" | "caption" => Words(share),
        _ => value(field, row),
    }
}

/// The share to which what a search ends with is the same on another processor.
pub(super) const SEARCHED: f64 = 0.5;
/// The same of a fit.
pub(super) const FITTED_SHARE: f64 = 0.02;

fn standard_error(row: &Row) -> f64 {
    row.get("standard_error").and_then(Value::as_f64).unwrap_or(0.0)
}

pub(super) fn fit(field: &str, _: &Row) -> Tolerance {
    match field {
        "simulations" => WORK,
        "step_error" => Within(10.0),
        "variance" | "neighbours" => FITTED,
        _ => Exact,
    }
}

/// A minimum is found to a share of its standard errors, no better, and so are the ends of an interval.
pub(super) fn parameter(field: &str, row: &Row) -> Tolerance {
    let error = standard_error(row);
    match field {
        "found" | "low" | "high" => Close { relative: 0.0, absolute: 0.05 * error },
        "standard_error" => FITTED,
        "truth" | "given" => TIGHT,
        _ => Exact,
    }
}

pub(super) fn misfit(field: &str, _: &Row) -> Tolerance {
    match field {
        "trained" | "held_out" | "before" | "after" => FITTED,
        "noise" => TIGHT,
        _ => Exact,
    }
}

/// The fields of a row.
pub(super) type Row = Map<String, Value>;

fn irreproducible(row: &Row) -> bool {
    row.get("irreproducible").and_then(Value::as_str).is_some_and(|why| !why.is_empty())
}

pub(super) fn study(field: &str, _: &Row) -> Tolerance {
    // A bound of rounding errors is itself made of last bits.
    if field == "reference_error" { Within(2.0) } else { TIGHT }
}

pub(super) fn case(field: &str, row: &Row) -> Tolerance {
    let error = row.get("error_max").and_then(Value::as_f64).unwrap_or(0.0);
    match field {
        "status" | "detail" | "reached" | "error_final" | "error_max" | "error_l2"
        | "error_away" | "digits" | "order" | "evaluations" | "jacobians" | "accepted"
        | "rejected"
            if row.get("any_status") == Some(&Value::Bool(true)) =>
        {
            Ignored
        }
        // What chatters or meets a kink untold still has an error and a cost of some size; the error at one
        // moment of a motion that rings has none.
        "error_max" | "error_l2" | "error_away" if irreproducible(row) => Within(1e3),
        "evaluations" | "jacobians" | "accepted" | "rejected" if irreproducible(row) => {
            Within(10.0)
        }
        "reached" if irreproducible(row) => Close { relative: 0.0, absolute: 0.1 },
        "error_final" | "digits" | "order" | "detail" if irreproducible(row) => Ignored,
        "error_final" | "error_max" | "error_l2" | "error_away" => RESULT,
        // They are logarithms of errors, and of nothing near round-off.
        "digits" | "order" if error < 1e-9 => Ignored,
        "digits" | "order" => Close { relative: 0.0, absolute: 0.05 },
        "reached" => Close { relative: 1e-3, absolute: 0.0 },
        "evaluations" | "jacobians" | "accepted" | "rejected" => WORK,
        _ => Exact,
    }
}

pub(super) fn order(field: &str, row: &Row) -> Tolerance {
    match field {
        // How many failed follows from the cases' statuses.
        "order" | "points" | "failed" if irreproducible(row) => Ignored,
        "order" => Close { relative: 0.02, absolute: 0.02 },
        _ => Exact,
    }
}

pub(super) fn value(field: &str, row: &Row) -> Tolerance {
    match field {
        // A bound of an error may breathe, but not lose its size.
        "error" => Within(10.0),
        // What was solved for, and not by a closed form, is as good as its stated error.
        "value" | "ours" => {
            let error = row.get("error").and_then(Value::as_f64).unwrap_or(0.0);
            Close { relative: 1e-9, absolute: 4.0 * error + 1e-12 }
        }
        _ => TIGHT,
    }
}
