//! The answer for a screen: one short block for each step.

use super::{Run, Told, answer::identified, verdict};
use crate::fit::shown::sure;
use discover::{Found, Gap, Limit, MapOf, Moved, Of};
use experiment::four_digits;
use identify::{Hold, effects::Kind, rig};

/// The most parameters that are listed.
const PARAMETERS: usize = 8;

/// The most limits that are listed.
const LIMITS: usize = 4;

/// An amount from which on nothing is said: the record does not show the effect at all.
const INVISIBLE: f64 = 1e30;

/// The whole answer, at most a screen of it.
pub(super) fn lines(told: &Told) -> Vec<String> {
    let found = &told.found;
    let mut lines = vec![
        format!("{} ({}, {})", told.rig.title, told.rig.kind, told.rig.friction.name),
        check(told),
    ];
    lines.extend(found.hold.map(|hold| block("input", between(hold))));
    let [before, refit, after] = found.chi_squared.map(four_digits);
    lines.push(block("before", &format!("χ² {before} with the model as given")));
    lines.push(block("refit", &format!("χ² {refit} with its own parameters fitted")));
    lines.push(block("floor", "χ² 1 is what the noise of sensors and input leaves"));
    lines.push(block("where", &places(told)));
    lines.push(block("verdict", &verdict(told)));
    lines.extend(found.effects.iter().flat_map(effect));
    if !found.effects.is_empty() {
        lines.push(block("after", &format!("χ² {after} with what is named")));
    }
    lines.push(block("values", "of the final model, as given and as found"));
    lines.extend(parameters(&found.parameters));
    lines.extend(gaps("gap", &found.gap, true));
    lines.extend(found.map.as_ref().map(|m| block("map", &acts(told, m))));
    lines.extend(found.tone.map(|f| block("tone", &sounds(f))));
    for run in &told.runs {
        lines.extend(confirmed(run));
    }
    lines.extend(limits(told));
    lines
}

/// What the record tells of its input.
pub(crate) fn between(hold: Hold) -> &'static str {
    match hold {
        Hold::Linear => {
            "goes straight from sample to sample, as the record tells; the rig file does not say"
        }
        Hold::Smooth => {
            "goes on smoothly between samples, as the record tells; the rig file does not say"
        }
        Hold::ZeroOrder => {
            "is held from sample to sample, as the record tells; the rig file does not say"
        }
    }
}

/// A line under the name of its step.
fn block(step: &str, text: &str) -> String {
    format!("{step:9} {text}")
}

fn check(told: &Told) -> String {
    let check = &told.check;
    let gravest = check.gravest.as_ref().map_or(String::new(), |finding| {
        let whom = if finding.channel.is_empty() { "record" } else { &finding.channel };
        format!("; the gravest: {whom}: {}", cut(&finding.text, 90))
    });
    let problems = counted(check.problems, "problem");
    block("check", &format!("{problems}, {}{gravest}", counted(check.notes, "note")))
}

/// So many things of a kind.
pub(super) fn counted(many: usize, what: &str) -> String {
    if many == 1 { format!("1 {what}") } else { format!("{many} {what}s") }
}

/// The first so many characters of a text.
fn cut(text: &str, most: usize) -> String {
    let short: String = text.chars().take(most).collect();
    if short.len() < text.len() { format!("{short}…") } else { short }
}

/// The parameters, those that moved first.
fn parameters(all: &[Moved]) -> Vec<String> {
    let mut order: Vec<&Moved> = all.iter().collect();
    order.sort_by_key(|p| !p.moved);
    let row = |p: &&Moved| {
        let [value, error] = [p.found.value, p.found.standard_error];
        let note = match (p.moved, identified(p)) {
            (true, _) => "  moved",
            (_, false) => "  not told by this record",
            _ => "",
        };
        format!(
            "  {:16} {:>11} → {:>11} ± {:10} {}{note}",
            p.found.name,
            four_digits(p.given),
            sure(value, error),
            four_digits(error),
            p.found.unit
        )
    };
    let mut lines: Vec<String> = order.iter().take(PARAMETERS).map(row).collect();
    if order.len() > PARAMETERS {
        lines.push(format!("  and {} more: --json has them", order.len() - PARAMETERS));
    }
    lines
}

/// Where the excess of the refitted model is.
fn places(told: &Told) -> String {
    let shares = &told.found.shares;
    let shares: Vec<String> = shares
        .iter()
        .filter(|s| s.share.is_finite())
        .map(|s| format!("{} {:.0} %", s.part, 100.0 * s.share))
        .collect();
    if shares.is_empty() || told.found.chi_squared[1] <= 1.0 {
        return "no excess over the floor".to_owned();
    }
    format!("of the excess: {}", shares.join(", "))
}

/// A standard error so many times the value says that any value does as well.
const UNTOLD: f64 = 100.0;

/// What an effect is, in a line.
pub(super) fn physics(name: &str) -> &'static str {
    Kind::named(name).map_or("", |kind| kind.about().physics)
}

/// A value with its standard error, if the record tells it at all.
pub(super) fn with_error(value: f64, error: f64) -> String {
    if value != 0.0 && error > UNTOLD * value.abs() {
        return format!("{}, not told by this record", four_digits(value));
    }
    format!("{} ± {}", sure(value, error), four_digits(error))
}

/// A named effect: its values, what it takes away, what would tell it from others.
fn effect(effect: &Found) -> Vec<String> {
    let mut lines = vec![format!("  {}: {}", effect.name, physics(effect.name))];
    for v in &effect.values {
        lines.push(format!("  {:16} {} {}", v.name, with_error(v.value, v.standard_error), v.unit));
    }
    lines.push(format!(
        "  takes away {} % of the excess on blocks not fitted, t = {}",
        four_digits(100.0 * effect.shrink),
        four_digits(effect.t)
    ));
    if effect.set.len() > 1 && !effect.separated_by.is_empty() {
        lines.push(format!("  would be separated by {}", effect.separated_by));
    }
    lines
}

/// A table of gaps; without the refitted model where nothing was refitted.
fn gaps(title: &str, gaps: &[Gap], refitted: bool) -> Vec<String> {
    let refit = |text: String| if refitted { format!(" {text:>11}") } else { String::new() };
    let head = format!(
        "{title:18} {:>11}{} {:>11} {:>11}  unit",
        "before",
        refit("refit".to_owned()),
        "after",
        "floor"
    );
    let row = |g: &Gap| {
        let [before, after, floor] = [g.before, g.after, g.floor].map(four_digits);
        let refit = refit(four_digits(g.refit));
        format!("  {:16} {before:>11}{refit} {after:>11} {floor:>11}  {}", g.channel, g.unit)
    };
    std::iter::once(head).chain(gaps.iter().map(row)).collect()
}

/// The unit of a map's axis.
pub(super) fn axis_unit(told: &Told, axis: &str) -> &'static str {
    let kind = rig::Kind::of(told.rig.kind);
    match (axis, kind) {
        ("time", _) => "s",
        ("displacement", Some(kind)) => kind.displacement_unit,
        ("velocity", Some(kind)) => kind.velocity_unit,
        (_, Some(kind)) if kind.turns() => "N·m",
        _ => "N",
    }
}

/// At which frequency a tone sounds.
pub(super) fn sounds(frequency: f64) -> String {
    format!("{} Hz sound in what is left, which the motion does not have", four_digits(frequency))
}

/// Where the force of a map acts.
pub(super) fn acts(told: &Told, map: &MapOf) -> String {
    let most = map.at.iter().zip(&map.force).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let Some((at, force)) = most.filter(|_| map.shrink > 0.0) else {
        return faint(map);
    };
    format!(
        "what is left acts {} {}, most at {} {} with {} {}; a map takes away {} % of it",
        over(map),
        map.axis,
        four_digits(*at),
        axis_unit(told, map.axis),
        four_digits(*force),
        axis_unit(told, "drive"),
        four_digits(100.0 * map.shrink)
    )
}

/// How what a map is of acts.
fn over(map: &MapOf) -> &'static str {
    match map.of {
        Of::Force => "over",
        Of::Friction => "as friction over",
    }
}

/// Whether a map lowers the sum of squares by far more than as many numbers do by chance.
pub(super) fn shows(map: &MapOf) -> bool {
    map.shrink > 0.0 || map.gain > 3.0 * map.at.len() as f64
}

/// What is said of a map that takes away nothing of the excess.
fn faint(map: &MapOf) -> String {
    let chance = map.at.len();
    if !shows(map) {
        return "no place of the motion, the drive or the record stands out".to_owned();
    }
    format!(
        "what is left {} {}, most of all: a map lowers χ² there by {} in all, by chance by {chance}",
        match map.of {
            Of::Force => "goes with",
            Of::Friction => "is friction that goes with",
        },
        map.axis,
        four_digits(map.gain)
    )
}

/// Both models on a record, in one run.
fn confirmed(run: &Run) -> Vec<String> {
    let title = match (run.held, run.command.is_some()) {
        (true, true) => "held out, closed loop",
        (true, false) => "held out, open loop",
        _ => "closed loop",
    };
    let mut lines = gaps(title, &run.gap, false);
    if let Some([before, after]) = run.command {
        lines.push(format!(
            "  the command is off by {} % before and {} % after",
            four_digits(before),
            four_digits(after)
        ));
    }
    lines
}

/// The limits that say most: of what was not named, those that something else would have hidden first.
pub(super) fn telling(told: &Told) -> Vec<&Limit> {
    let found = &told.found;
    let named = |name: &str| found.effects.iter().any(|e| e.set.contains(&name));
    let other = |l: &&Limit| !named(l.name) && l.amount < INVISIBLE;
    let mut all: Vec<&Limit> = found.detectability.iter().filter(other).collect();
    all.sort_by_key(|l| l.hidden_by.is_none());
    all
}

fn limits(told: &Told) -> Vec<String> {
    let all = telling(told);
    let one = |l: &&Limit| {
        let by = l.hidden_by.as_ref().map_or(String::new(), |by| format!(", or else in {by}"));
        let amount = format!("{} {}", four_digits(l.amount), l.unit);
        format!("  {:18} from {}{by}", l.name, amount.trim_end())
    };
    if all.is_empty() {
        return Vec::new();
    }
    let mut lines = vec![block("visible", "at five standard errors this record would have shown")];
    lines.extend(all.iter().take(LIMITS).map(one));
    if all.len() > LIMITS {
        lines.push(format!("  and {} more: --json has them", all.len() - LIMITS));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::with_error;

    #[test]
    fn what_a_record_does_not_tell_has_no_error() {
        assert_eq!(with_error(1.013, 1.4e158), "1.013, not told by this record");
        assert_eq!(with_error(-36.9612, 0.142), "-36.96 ± 0.142");
    }
}
