//! Verdicts: decided by rule, from what was measured.

use crate::{
    checks::Checked,
    plan::{Claim, Decision, Plan},
    spec::PrintedSpec,
};
use record::{ClaimRow, MeasureRow};

/// The measures, taken.
pub(crate) fn measures(plan: &Plan) -> Result<Vec<MeasureRow>, String> {
    plan.measures
        .iter()
        .map(|measure| {
            let found = (measure.quantity.measure)(plan, &measure.subject)
                .map_err(|e| format!("measure `{}`: {e}", measure.id))?;
            Ok(MeasureRow {
                id: measure.id.clone(),
                what: measure.quantity.what.to_owned(),
                value: found.value,
                error: found.error,
                unit: measure.unit.clone(),
                method: measure.quantity.method.to_owned(),
                second: measure.quantity.second.to_owned(),
                code: measure.quantity.code.to_owned(),
            })
        })
        .collect()
}

/// The claims, judged.
pub(crate) fn claims(plan: &Plan, measures: &[MeasureRow]) -> Result<Vec<ClaimRow>, String> {
    plan.claims.iter().map(|claim| judge(plan, claim, measures)).collect()
}

fn judge(plan: &Plan, claim: &Claim, measures: &[MeasureRow]) -> Result<ClaimRow, String> {
    let written = &claim.written;
    let mut row = ClaimRow {
        id: written.id.clone(),
        place: written.place.clone(),
        says: written.says.clone(),
        printed: claim.printed.as_ref().map(|p| p.value),
        digits: claim.printed.as_ref().map(|p| p.digits),
        figure: written.figure.clone(),
        ..ClaimRow::default()
    };
    match &claim.decision {
        Decision::Measure(index) => {
            let measure = &measures[*index];
            let printed = claim.printed.as_ref().ok_or("a number without its print")?;
            row.ours = Some(measure.value);
            row.error = Some(measure.error);
            row.unit.clone_from(&measure.unit);
            let rounds = rounds_to(measure.value, printed);
            row.holds = (rounds || !written.between_prints).then_some(rounds);
            row.code.clone_from(&measure.code);
            row.how = format!(
                "{} ({}); {} if it rounds to the printed digits, within {} {}",
                measure.what,
                measure.method,
                if written.between_prints { "the paper's two places agree" } else { "holds" },
                half_digit(printed),
                printed.unit
            );
        }
        Decision::Nothing => "nothing here can decide it".clone_into(&mut row.how),
        Decision::Check(check, subject) => {
            let found: Checked =
                (check.run)(plan, subject).map_err(|e| format!("claim `{}`: {e}", written.id))?;
            row.ours = found.value;
            row.error = found.error;
            row.unit = found.unit.to_owned();
            row.holds = Some(found.holds);
            check.code.clone_into(&mut row.code);
            row.how = found.how;
        }
    }
    let excluded = written.between_prints && row.holds.is_none();
    let reason = written.under_specified.as_deref().or_else(|| excluded.then_some(""));
    let verdict = verdict(row.holds, reason, written.qualitative);
    verdict.clone_into(&mut row.verdict);
    row.why = fill(&written.why, measures);
    if let Some(reason) = &written.under_specified {
        row.why = format!("{} {}", row.why, reason.trim());
    }
    Ok(row)
}

/// Contradicted before under-specified before qualitative before reproduced, as the paper's restatement says.
fn verdict(holds: Option<bool>, under_specified: Option<&str>, qualitative: bool) -> &'static str {
    match holds {
        Some(false) => "contradicted",
        _ if under_specified.is_some() => "under-specified",
        _ if qualitative || holds.is_none() => "qualitative",
        _ => "reproduced",
    }
}

/// Half a unit of the last printed digit.
fn half_digit(printed: &PrintedSpec) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "the exponent of a number is small")]
    let exponent = printed.value.abs().log10().floor() as i32;
    let digits = i32::try_from(printed.digits).unwrap_or(1);
    0.5 * 10f64.powi(exponent + 1 - digits)
}

/// Whether a value rounds to the printed digits.
fn rounds_to(value: f64, printed: &PrintedSpec) -> bool {
    // The printed decimal is not a binary number: allow its own rounding.
    (value - printed.value).abs() <= half_digit(printed) * (1.0 + 1e-12)
}

/// The measures' ids that a text asks for in braces.
pub(crate) fn placeholders(text: &str) -> Vec<&str> {
    text.split('{').skip(1).filter_map(|rest| rest.split_once('}')).map(|(id, _)| id).collect()
}

/// The text with each measure's value in the place of its id, line breaks folded.
pub(crate) fn fill(text: &str, measures: &[MeasureRow]) -> String {
    let mut filled = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for measure in measures {
        let unit = if measure.unit == "1" { String::new() } else { format!(" {}", measure.unit) };
        let value = format!("{}{unit}", four_digits(measure.value));
        filled = filled.replace(&format!("{{{}}}", measure.id), &value);
    }
    filled
}

/// Four significant digits, without an exponent where that reads well.
pub fn four_digits(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        let scientific = format!("{value:.3e}");
        let rounded: f64 = scientific.parse().unwrap_or(value);
        return format!("{rounded}");
    }
    format!("{value:.3e}")
}

#[cfg(test)]
mod tests {
    use super::{claims, four_digits, measures, placeholders, rounds_to, verdict};
    use crate::{Plan, spec::PrintedSpec};
    use std::path::Path;

    fn printed(value: f64, digits: u64) -> PrintedSpec {
        PrintedSpec { value, digits, unit: "J".to_owned() }
    }

    #[test]
    fn a_value_holds_if_it_rounds_to_the_printed_digits() {
        assert!(rounds_to(2.625, &printed(2.6, 2)));
        assert!(rounds_to(2.55, &printed(2.6, 2)));
        assert!(!rounds_to(1.554, &printed(2.6, 2)));
        assert!(!rounds_to(2.66, &printed(2.6, 2)));
        assert!(rounds_to(4.96e-4, &printed(5e-4, 1)));
        assert!(!rounds_to(5.6e-4, &printed(5e-4, 1)));
    }

    #[test]
    fn a_false_sentence_is_contradicted_whatever_else_is_said_of_it() {
        assert_eq!(verdict(Some(false), Some("m is not printed"), true), "contradicted");
        assert_eq!(verdict(Some(true), Some("m is not printed"), false), "under-specified");
        assert_eq!(verdict(None, None, false), "qualitative");
        assert_eq!(verdict(Some(true), None, false), "reproduced");
    }

    #[test]
    fn two_prints_that_exclude_each_other_are_under_specified_and_two_that_agree_are_not() {
        let verdict_of = |printed: f64| {
            let text = format!(
                r#"
title = "t"
paper = "p"
text = "x"
[[study]]
name = "s"
title = "t"
model = {{ name = "coulomb", f_c = 0.75 }}
input = {{ shape = "polyline", t = [0.0, 1.0, 3.0], u = [0.0, 0.01, 0.0] }}
periods = 1
[[measure]]
id = "m"
unit = "m"
study = "s"
what = {{ quantity = "largest_displacement" }}
[[claim]]
id = "c"
place = "p"
says = "s"
printed = {{ value = {printed}, digits = 1, unit = "m" }}
measure = "m"
between_prints = true
why = "w"
"#
            );
            let plan = Plan::from_text("t", Path::new("t.toml"), &text, &[]).unwrap();
            let row = claims(&plan, &measures(&plan).unwrap()).unwrap().remove(0);
            (row.verdict, row.holds)
        };
        assert_eq!(verdict_of(0.02), ("under-specified".to_owned(), None));
        assert_eq!(verdict_of(0.01), ("reproduced".to_owned(), Some(true)));
    }

    #[test]
    fn texts_take_measures_in_four_digits() {
        assert_eq!(placeholders("a {x.y=1} and {z}"), ["x.y=1", "z"]);
        assert_eq!(four_digits(1.554_26), "1.554");
        assert_eq!(four_digits(3.354_626e-4), "3.355e-4");
        assert_eq!(four_digits(2.0), "2");
    }
}
