//! What counts as right, and how often it was.
//!
//! A change is **visible** if [`twin::bench::Case::seen`] finds it to be 5 σ or more: the norm of what it changes in all
//! channels without noise, in units of the sensors' noise, after everything that the free parameters could take up
//! has been projected out.
//! Of two effects each is looked at beside the other, and the pair is visible only if both are; a wrong parameter is
//! looked at beside the other free parameters.
//! What is not visible is left out where a name is asked for, and left in where a wrong name is counted.
//!
//! - **exact**: one effect is named, and it is the hidden one; or the hidden one stands in its set, and the library
//!   lists the two as confused with one another.
//! - **inside**: one effect is named, and the hidden one is in its set.
//! - **wrong**: something is named, and it is not so: another effect, or one more beside the right one.
//! - **called so**: a wrong parameter by the verdict `parameter` and its own name among those that moved; what is in no
//!   library by the verdict `not_in_library`.
//! - **both right**: two effects are named, and each hidden one is in the set of another of them.
//!
//! An answer that is an error is right nowhere.

use super::row::{Kind, Row};
use Aim::{Least, Most, Told};
use identify::effects;

/// What a number is to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Aim {
    /// At least this.
    Least(f64),
    /// At most this.
    Most(f64),
    /// It is told and not judged.
    Told,
}

/// How a number is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shown {
    /// In per cent.
    Share,
    /// As it is.
    Plain,
    /// In seconds.
    Seconds,
}

/// One line of the table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measure {
    /// Its key.
    pub(super) name: &'static str,
    /// What it is, in words.
    pub(super) words: &'static str,
    /// The number; none where there is nothing to count.
    pub(super) value: Option<f64>,
    /// How many records it is of.
    pub(super) of: usize,
    pub(super) aim: Aim,
    pub(super) shown: Shown,
}

impl Measure {
    /// Whether the aim is reached; none where there is no aim or nothing to count.
    pub(super) fn held(&self) -> Option<bool> {
        match (self.value?, self.aim) {
            (value, Aim::Least(aim)) => Some(value >= aim),
            (value, Aim::Most(aim)) => Some(value <= aim),
            (_, Aim::Told) => None,
        }
    }
}

/// Whether the library lists two effects as confused with one another.
fn confused(a: &str, b: &str) -> bool {
    let lists = |a: &str, b: &str| {
        effects::Kind::named(a).is_some_and(|kind| kind.about().confused.contains(&b))
    };
    lists(a, b) || lists(b, a)
}

/// Whether the one hidden effect is the one named, or cannot be told from it.
pub(super) fn exact(row: &Row) -> bool {
    let ([set], [truth]) = (&row.named[..], &row.truth[..]) else { return false };
    set[0] == *truth || set.contains(truth) && confused(&set[0], truth)
}

/// Whether the one hidden effect is in the set of the one named.
pub(super) fn inside(row: &Row) -> bool {
    matches!((&row.named[..], &row.truth[..]), ([set], [truth]) if set.contains(truth))
}

/// Whether a wrong name was given where one effect is hidden.
pub(super) fn wrong(row: &Row) -> bool {
    row.names() && !inside(row)
}

/// Whether the wrong parameter was called so.
pub(super) fn parameter(row: &Row) -> bool {
    row.verdict == "parameter" && row.truth.iter().all(|name| row.moved.contains(name))
}

/// Whether what is in no library was called so.
pub(super) fn foreign(row: &Row) -> bool {
    row.verdict == "not_in_library"
}

/// Whether two effects were named, and each hidden one is in the set of another of them.
pub(super) fn both(row: &Row) -> bool {
    let ([a, b], [one, two]) = (&row.named[..], &row.truth[..]) else { return false };
    a.contains(one) && b.contains(two) || a.contains(two) && b.contains(one)
}

/// Whether what was answered is right, by the rule of its kind; a single effect must be exact.
pub(super) fn right(row: &Row) -> bool {
    match row.kind {
        Kind::Nothing => row.verdict == "nothing_missing",
        Kind::Parameter => parameter(row),
        Kind::Single => exact(row),
        Kind::Pair => both(row),
        Kind::Foreign => foreign(row),
    }
}

/// The rows of a kind.
fn of(rows: &[Row], kind: Kind) -> Vec<&Row> {
    rows.iter().filter(|row| row.kind == kind).collect()
}

/// Those in which what is hidden can be seen.
fn seen(rows: &[Row], kind: Kind) -> Vec<&Row> {
    of(rows, kind).into_iter().filter(|row| row.visible()).collect()
}

/// Those with nothing hidden or a wrong parameter.
fn quiet(rows: &[Row]) -> Vec<&Row> {
    [Kind::Nothing, Kind::Parameter].into_iter().flat_map(|kind| of(rows, kind)).collect()
}

/// The table of these rows: the names, what was measured of them, and what is told besides.
pub(super) fn measures(rows: &[Row]) -> Vec<Measure> {
    [names(rows), sizes(rows), told(rows)].concat()
}

fn names(rows: &[Row]) -> Vec<Measure> {
    let (single, all) = (seen(rows, Kind::Single), of(rows, Kind::Single));
    let (changed, strange, pairs) =
        (seen(rows, Kind::Parameter), seen(rows, Kind::Foreign), seen(rows, Kind::Pair));
    let named = "false name, nothing hidden or a wrong parameter";
    let two = "two effects, both right or in their sets";
    vec![
        share("exact", "exact name, visible single effects", &single, exact, Least(0.95)),
        share("inside", "exact or inside the reported set", &single, inside, Least(0.98)),
        share("wrong", "wrong name, all single effects", &all, wrong, Most(0.01)),
        share("false_name", named, &quiet(rows), Row::names, Most(0.01)),
        share("parameter", "wrong parameter called so", &changed, parameter, Least(0.95)),
        share("foreign", "not in the library called so", &strange, foreign, Least(0.95)),
        share("both", two, &pairs, both, Least(0.85)),
    ]
}

fn sizes(rows: &[Row]) -> Vec<Measure> {
    let single = seen(rows, Kind::Single);
    let sets: Vec<f64> =
        single.iter().flat_map(|row| row.named.iter().map(|set| set.len() as f64)).collect();
    let gaps = median(single.iter().filter_map(|r| r.gap).collect());
    let errors = median(single.iter().filter_map(|r| r.error).collect());
    let times = median(rows.iter().filter_map(|row| row.seconds).collect());
    let value = plain("value", "value of the effect, median error", errors, Most(0.01));
    let time = plain("time", "wall time of 60 s at 200 Hz, median", times, Most(1.0));
    vec![
        plain("gap", "gap after / floor, median", gaps, Most(1.05)),
        Measure { shown: Shown::Share, ..value },
        plain("set", "mean size of a reported set", mean(&sets), Most(1.5)),
        Measure { shown: Shown::Seconds, ..time },
    ]
}

fn told(rows: &[Row]) -> Vec<Measure> {
    let (single, pairs) = (of(rows, Kind::Single), of(rows, Kind::Pair));
    let (changed, strange) = (seen(rows, Kind::Parameter), of(rows, Kind::Foreign));
    let everything: Vec<&Row> = rows.iter().collect();
    let called = |r: &Row| r.verdict == "parameter";
    let failed = |r: &Row| r.verdict == "error";
    let mistaken = "given a name of the library, what is not in it";
    vec![
        share("exact_all", "exact name, all single effects", &single, exact, Told),
        share("both_all", "two effects, both right, all pairs", &pairs, both, Told),
        share("called", "verdict parameter, whichever it is", &changed, called, Told),
        share("quiet", "nothing hidden called so", &of(rows, Kind::Nothing), right, Told),
        share("foreign_named", mistaken, &strange, Row::names, Told),
        share("failed", "no answer but an error", &everything, failed, Told),
    ]
}

fn share(
    name: &'static str,
    words: &'static str,
    rows: &[&Row],
    counts: fn(&Row) -> bool,
    aim: Aim,
) -> Measure {
    let hits = rows.iter().filter(|row| counts(row)).count();
    let value = (!rows.is_empty()).then(|| hits as f64 / rows.len() as f64);
    Measure { name, words, value, of: rows.len(), aim, shown: Shown::Share }
}

fn plain(
    name: &'static str,
    words: &'static str,
    (value, of): (Option<f64>, usize),
    aim: Aim,
) -> Measure {
    Measure { name, words, value, of, aim, shown: Shown::Plain }
}

/// The middle of some values, and how many they are.
fn median(mut values: Vec<f64>) -> (Option<f64>, usize) {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    let middle = (n > 0).then(|| f64::midpoint(values[(n - 1) / 2], values[n / 2]));
    (middle, n)
}

fn mean(values: &[f64]) -> (Option<f64>, usize) {
    let n = values.len();
    ((n > 0).then(|| values.iter().sum::<f64>() / n as f64), n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::hidden::row::tests::row;
    use Kind::{Foreign, Nothing, Pair, Parameter, Single};

    fn value(rows: &[Row], name: &str) -> (Option<f64>, usize) {
        let all = measures(rows);
        let one = all.iter().find(|m| m.name == name).unwrap();
        (one.value, one.of)
    }

    #[test]
    fn a_name_is_exact_if_it_is_the_hidden_one_alone_or_the_library_lists_the_two_as_confused() {
        let single = |named: &[&[&str]]| row(Single, &["current_bias"], "effect", named);
        assert!(exact(&single(&[&["current_bias"]])));
        assert!(exact(&single(&[&["current_bias", "cogging"]])));
        assert!(exact(&single(&[&["coulomb_asymmetry", "current_bias"]])), "always confused");
        assert!(!exact(&single(&[&["cogging", "current_bias"]])), "never confused");
        assert!(!exact(&single(&[&["coulomb_asymmetry"]])), "the hidden one is not in the set");
        assert!(!exact(&single(&[&["current_bias"], &["cogging"]])), "one too many");
        assert!(!exact(&single(&[])));
    }

    #[test]
    fn a_name_is_inside_if_the_hidden_one_is_in_the_set_and_wrong_if_not() {
        let single = |named: &[&[&str]]| row(Single, &["current_bias"], "effect", named);
        let table = [
            (single(&[&["cogging", "current_bias"]]), true, false),
            (single(&[&["cogging"]]), false, true),
            (single(&[&["current_bias"], &["cogging"]]), false, true),
            (row(Single, &["current_bias"], "nothing_missing", &[]), false, false),
            (row(Single, &["current_bias"], "not_in_library", &[]), false, false),
        ];
        for (row, is_inside, is_wrong) in table {
            assert_eq!((inside(&row), wrong(&row)), (is_inside, is_wrong), "{row:?}");
        }
    }

    #[test]
    fn what_cannot_be_seen_need_not_be_named_but_may_not_be_named_wrongly() {
        let right = row(Single, &["stribeck"], "effect", &[&["stribeck"]]);
        let mut faint = row(Single, &["stribeck"], "nothing_missing", &[]);
        faint.seen = vec![4.9];
        let mut guessed = row(Single, &["stribeck"], "effect", &[&["cogging"]]);
        guessed.seen = vec![4.9];
        let rows = [right, faint, guessed];
        assert_eq!(value(&rows, "exact"), (Some(1.0), 1));
        assert_eq!(value(&rows, "inside"), (Some(1.0), 1));
        assert_eq!(value(&rows, "exact_all"), (Some(1.0 / 3.0), 3));
        assert_eq!(value(&rows, "wrong"), (Some(1.0 / 3.0), 3));
    }

    #[test]
    fn a_name_where_nothing_is_hidden_or_a_parameter_is_wrong_is_false() {
        let rows = [
            row(Nothing, &[], "nothing_missing", &[]),
            row(Nothing, &[], "effect", &[&["cogging"]]),
            row(Parameter, &["f_c"], "partial", &[&["stribeck"]]),
            // A false flag is no false name.
            row(Nothing, &[], "not_in_library", &[]),
        ];
        assert_eq!(value(&rows, "false_name"), (Some(0.5), 4));
        assert_eq!(value(&rows, "quiet"), (Some(1.0 / 3.0), 3));
    }

    #[test]
    fn a_wrong_parameter_is_called_so_by_its_own_name() {
        let mut named = row(Parameter, &["f_c"], "parameter", &[]);
        named.moved = vec!["sigma_2".to_owned(), "f_c".to_owned()];
        let mut other = row(Parameter, &["f_c"], "parameter", &[]);
        other.moved = vec!["sigma_2".to_owned()];
        let mut missed = row(Parameter, &["f_c"], "nothing_missing", &[]);
        missed.moved = vec!["f_c".to_owned()];
        let mut faint = row(Parameter, &["f_c"], "nothing_missing", &[]);
        faint.seen = vec![1.0];
        let rows = [named, other, missed, faint];
        assert_eq!(value(&rows, "parameter"), (Some(1.0 / 3.0), 3));
        assert_eq!(value(&rows, "called"), (Some(2.0 / 3.0), 3));
    }

    #[test]
    fn what_is_in_no_library_is_called_so_by_the_verdict_alone() {
        let rows = [
            row(Foreign, &["foreign_tone"], "not_in_library", &[]),
            row(Foreign, &["foreign_tone"], "partial", &[&["cogging"]]),
        ];
        assert_eq!(value(&rows, "foreign"), (Some(0.5), 2));
        assert_eq!(value(&rows, "foreign_named"), (Some(0.5), 2));
    }

    #[test]
    fn of_two_effects_both_must_be_named_each_in_a_set_of_its_own() {
        let pair = |named: &[&[&str]]| row(Pair, &["cogging", "stribeck"], "effect", named);
        assert!(both(&pair(&[&["stribeck"], &["gravity_unbalance", "cogging"]])));
        assert!(!both(&pair(&[&["stribeck", "cogging"]])), "one set is not two effects");
        assert!(!both(&pair(&[&["stribeck", "cogging"], &["viscous"]])), "one set for both");
        assert!(!both(&pair(&[&["stribeck"], &["cogging"], &["viscous"]])), "one too many");
        let mut half = pair(&[&["stribeck"]]);
        half.seen = vec![3.0, 300.0];
        let rows = [pair(&[&["cogging"], &["stribeck"]]), half];
        assert_eq!(value(&rows, "both"), (Some(1.0), 1), "a pair half in the dark does not count");
        assert_eq!(value(&rows, "both_all"), (Some(0.5), 2));
    }

    #[test]
    fn gaps_values_sets_and_times_are_of_those_that_have_them() {
        let with = |gap, error, named: &[&[&str]]| Row {
            gap,
            error,
            seconds: Some(3.0),
            ..row(Single, &["cogging"], "effect", named)
        };
        let rows = [
            with(Some(1.0), Some(0.01), &[&["cogging"]]),
            with(Some(1.2), None, &[&["gravity_unbalance", "cogging", "cubic_spring"]]),
            with(None, None, &[]),
            Row { gap: Some(9.0), seconds: Some(5.0), ..row(Nothing, &[], "nothing_missing", &[]) },
        ];
        assert_eq!(
            value(&rows, "gap"),
            (Some(1.1), 2),
            "the gap of what hides nothing is not in it"
        );
        assert_eq!(value(&rows, "value"), (Some(0.01), 1));
        assert_eq!(value(&rows, "set"), (Some(2.0), 2));
        assert_eq!(value(&rows, "time"), (Some(3.0), 4));
        assert_eq!(value(&[], "time"), (None, 0));
    }

    #[test]
    fn an_aim_is_reached_on_its_own_side() {
        let one = |aim, value| Measure { value, aim, ..measures(&[])[0].clone() };
        assert_eq!(one(Aim::Least(0.95), Some(0.95)).held(), Some(true));
        assert_eq!(one(Aim::Least(0.95), Some(0.94)).held(), Some(false));
        assert_eq!(one(Aim::Most(0.01), Some(0.01)).held(), Some(true));
        assert_eq!(one(Aim::Most(0.01), Some(0.02)).held(), Some(false));
        assert_eq!(one(Aim::Most(0.01), None).held(), None);
        assert_eq!(one(Aim::Told, Some(0.5)).held(), None);
    }

    #[test]
    fn an_error_is_right_nowhere() {
        for kind in [Nothing, Parameter, Single, Pair, Foreign] {
            assert!(!right(&row(kind, &["cogging"], "error", &[])), "{kind:?}");
        }
    }
}
