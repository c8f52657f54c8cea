//! Sentences about what a search for a missing effect answered.

use super::{Check, Checked};
use crate::{
    judge::four_digits,
    plan::{Hidden, Plan, Subject},
    quantities::{NORMAL, OF_A_DISCOVERY, discovery::at},
};
use record::{DiscoveryRecord, EffectRow};
use std::collections::BTreeSet;

/// Whether the answer is what was hidden: its verdict, and every hidden name in the set of another effect that is
/// named, or among the parameters that were wrong; and nothing else is named.
pub(super) const ANSWER: Check = Check {
    name: "right-answer",
    code: "crates/experiment/src/checks/discovery.rs, answer",
    model: OF_A_DISCOVERY,
    expects: &[],
    takes: &[],
    many: false,
    run: answer,
};

/// Whether what is named takes the residual down to the floor, within so many parts of it.
pub(super) const CLOSES: Check = Check {
    name: "closes-the-gap",
    code: "crates/experiment/src/checks/discovery.rs, closes",
    model: OF_A_DISCOVERY,
    expects: &[],
    takes: &["within"],
    many: false,
    run: closes,
};

fn answer(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let search = at(plan, subject);
    let record = search.found()?;
    let hidden = search.hidden.as_ref().ok_or("no truth file says what was hidden")?;
    let row = &record.row;
    let said = |names: &str| if names.is_empty() { "nothing" } else { names }.replace(';', ", ");
    let values: Vec<String> = record.effects.iter().map(told).collect();
    let off = record.effects.iter().filter_map(|e| Some((e, e.truth?)));
    let off = off
        .max_by(|(a, x), (b, y)| (a.value / x - 1.0).abs().total_cmp(&(b.value / y - 1.0).abs()));
    Ok(Checked {
        holds: is_right(record, hidden),
        value: off.map(|(effect, truth)| (effect.value / truth - 1.0).abs()),
        error: off.and_then(|(effect, truth)| Some(NORMAL * effect.standard_error? / truth.abs())),
        unit: "1",
        how: format!(
            "answered: {} ({}); hidden: {} ({}){}; holds if the verdict is the same, and what was hidden is named or \
             in the set of what is named, and nothing besides; the number is how far the value that is furthest off \
             is from the hidden one, of that, its error the 95 % interval",
            row.verdict,
            said(&row.names),
            row.truth,
            said(&row.hidden),
            if values.is_empty() { String::new() } else { format!("; {}", values.join(", ")) }
        ),
    })
}

/// A value with its standard error and what was hidden.
fn told(effect: &EffectRow) -> String {
    let error = effect.standard_error.map_or("?".to_owned(), four_digits);
    let truth = effect
        .truth
        .map_or(String::new(), |truth| format!(" where {} was hidden", four_digits(truth)));
    let unit = if effect.unit == "1" { "" } else { &effect.unit };
    let EffectRow { effect: name, key, value, .. } = effect;
    format!("{name}.{key} = {} ± {error} {unit}{truth}", four_digits(*value))
}

/// Whether a record's answer is what was hidden.
fn is_right(record: &DiscoveryRecord, hidden: &Hidden) -> bool {
    if record.row.verdict != hidden.verdict {
        return false;
    }
    match hidden.verdict.as_str() {
        "parameter" => hidden.parameters.keys().all(|name| record.moved.contains(name)),
        "effect" => named(&record.effects, hidden),
        _ => true,
    }
}

/// Whether as many effects were named as were hidden, and each hidden one is in the set of another of them.
fn named(effects: &[EffectRow], hidden: &Hidden) -> bool {
    let sets: BTreeSet<&str> = effects.iter().map(|row| row.set.as_str()).collect();
    let names: BTreeSet<&str> = effects.iter().map(|row| row.effect.as_str()).collect();
    let in_a_set = |name: &String| sets.iter().any(|set| set.split(';').any(|one| one == name));
    let of_one = |set: &&str| hidden.effects.keys().any(|name| set.split(';').any(|n| n == name));
    names.len() == hidden.effects.len()
        && hidden.effects.keys().all(in_a_set)
        && sets.iter().all(of_one)
}

fn closes(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let record = at(plan, subject).found()?;
    let [within] = subject.argument("within")?;
    let ratios = record.gaps.iter().map(|gap| Some(gap.after? / gap.floor));
    let ratios: Vec<f64> = ratios.collect::<Option<_>>().ok_or("the model has no motion")?;
    let worst = ratios.iter().copied().fold(0.0, f64::max);
    let level = record.row.after.ok_or("the model has no motion")?.max(0.0).sqrt();
    Ok(Checked {
        holds: worst <= 1.0 + within,
        value: Some(worst),
        error: Some((worst - level).abs()),
        unit: "1",
        how: format!(
            "root mean square of the residual of every channel on blocks that were not fitted, over what noise \
             alone leaves; the number is the largest, its error the difference to that of all channels together; \
             holds if it is at most {}",
            1.0 + within
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::DiscoveryRow;
    use std::collections::BTreeMap;

    fn record(verdict: &str, sets: &[&str]) -> DiscoveryRecord {
        let effect = |set: &&str| EffectRow {
            effect: set.split(';').next().unwrap_or_default().to_owned(),
            set: (*set).to_owned(),
            ..EffectRow::default()
        };
        DiscoveryRecord {
            row: DiscoveryRow { verdict: verdict.to_owned(), ..DiscoveryRow::default() },
            effects: sets.iter().map(effect).collect(),
            moved: vec!["f_c".to_owned()],
            ..DiscoveryRecord::default()
        }
    }

    fn hidden(verdict: &str, effects: &[&str], parameters: &[&str]) -> Hidden {
        let none = BTreeMap::new;
        Hidden {
            verdict: verdict.to_owned(),
            effects: effects.iter().map(|name| ((*name).to_owned(), none())).collect(),
            parameters: parameters.iter().map(|name| ((*name).to_owned(), 1.0)).collect(),
        }
    }

    #[test]
    fn an_answer_is_right_if_it_names_what_was_hidden_and_nothing_else() {
        let one = hidden("effect", &["viscous"], &[]);
        let two = hidden("effect", &["viscous", "cogging"], &[]);
        for (sets, truth, right) in [
            (&["viscous"][..], &one, true),
            (&["sublinear_drag;viscous"], &one, true),
            (&["sublinear_drag"], &one, false),
            (&["viscous", "cogging"], &one, false),
            (&["cogging", "viscous"], &two, true),
            (&["viscous"], &two, false),
            (&["viscous;cogging", "stribeck"], &two, false),
        ] {
            assert_eq!(is_right(&record("effect", sets), truth), right, "{sets:?}");
        }
        assert!(!is_right(&record("partial", &["viscous"]), &one), "more is said to be missing");
        let wrong = |name| hidden("parameter", &[], &[name]);
        assert!(is_right(&record("parameter", &[]), &wrong("f_c")));
        assert!(!is_right(&record("parameter", &[]), &wrong("sigma_2")), "another parameter");
        assert!(!is_right(&record("nothing_missing", &[]), &wrong("f_c")));
    }
}
