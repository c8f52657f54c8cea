//! Searches for what a model lacks: what was answered beside what was hidden, the gap, the candidates.

use crate::fit_drawing::{FitLadder, FitRung};
use crate::grid::Grid;
use crate::number::{self, NONE};
use record::{DiscoveryRow, EffectRow, RankedRow, Summary};

/// How the table of values is read.
const VALUES_READ: &str = "The value of every effect that was named with its standard error, and what it takes away of the excess over \
     the floor on blocks that were not fitted. A set holds every name that the record cannot tell from the first.";

/// How the table of gaps is read.
const GAPS_READ: &str = "Root mean square of the residuals on blocks of the record that were not fitted: of the model as given, with its \
     own parameters refitted, and after, with what was named. The floor is what the noise of sensors and input leaves.";

/// How the table of parameters is read.
const PARAMETERS_READ: &str = "The nominal parameters as given and in the model that was found; the interval is the one of 95 % by the standard error, \
     and a parameter without one is not told by the record.";

/// From so many floors, squared, there is an excess that can be somewhere [1].
const EXCESS: f64 = 1.1;

/// The heading of a search.
pub(crate) fn heading(row: &DiscoveryRow) -> &str {
    if row.title.is_empty() { &row.discovery } else { &row.title }
}

/// A verdict in words.
fn said(verdict: &str, names: &str) -> String {
    let symbol = |name: &str| {
        if verdict == "parameter" { number::symbol(name) } else { name.to_owned() }
    };
    let names: Vec<String> = names.split(';').map(symbol).collect();
    let names = names.join(", ");
    match verdict {
        "" => String::new(),
        "nothing_missing" => "nothing is missing at this noise".to_owned(),
        "parameter" => format!("a parameter is wrong: {names}"),
        "effect" if names.contains(", ") => format!("effects are missing: {names}"),
        "effect" => format!("an effect is missing: {names}"),
        "partial" => format!("missing is {names}, and something more"),
        "not_in_library" => "something is missing that is not in the library".to_owned(),
        other => format!("{other}: {names}"),
    }
}

/// The answer in words: a name that the record cannot tell from others stands among them.
fn answered(summary: &Summary, row: &DiscoveryRow) -> String {
    let own = |effect: &&EffectRow| effect.discovery == row.discovery && effect.effect == row.names;
    match summary.effects.iter().find(own).map(|effect| effect.set.replace(';', ", ")) {
        Some(set) if row.verdict == "effect" && set.contains(", ") => {
            format!("one of these is missing: {set}")
        }
        _ => said(&row.verdict, &row.names),
    }
}

/// What is told of a search: its record, its rig, the answer and what was hidden.
pub(crate) fn told(summary: &Summary, row: &DiscoveryRow) -> Vec<(&'static str, String)> {
    let shares = summary.shares.iter().filter(|share| share.discovery == row.discovery);
    let shares: Vec<String> = shares
        .filter_map(|share| Some(format!("{} {} %", share.part, percent(share.share?))))
        .collect();
    // What is at the floor has no excess to be anywhere.
    let over = row.refit.is_none_or(|squared| squared > EXCESS);
    let mut told = vec![
        ("Record", format!("{}, {} samples", row.record, number::count(row.samples))),
        ("Rig", row.rig.clone()),
        ("Answer", answered(summary, row)),
        ("Hidden", said(&row.truth, &row.hidden)),
        (
            "Where the excess is (each share to about 10 %)",
            if over { shares.join(", ") } else { String::new() },
        ),
    ];
    told.retain(|(_, text)| !text.is_empty());
    told
}

fn percent(share: f64) -> String {
    format!("{:.0}", 100.0 * share)
}

/// The values of the effects that were named.
fn values(summary: &Summary, name: &str) -> Option<Grid> {
    let own: Vec<&EffectRow> = summary.effects.iter().filter(|r| r.discovery == name).collect();
    let truth = own.iter().any(|row| row.truth.is_some());
    let row = |row: &&EffectRow| {
        let others: Vec<&str> = row.set.split(';').filter(|other| *other != row.effect).collect();
        let set = if others.is_empty() { NONE.to_owned() } else { others.join(", ") };
        let separated = Some(&row.separated_by).filter(|by| !by.is_empty());
        let separated = separated.map_or(String::new(), |by| format!("\ntold apart by {by}"));
        let mut cells = vec![
            row.effect.clone(),
            format!("{} {}", row.key, number::unit(&row.unit)).trim().to_owned(),
            number::with_error(row.value, row.standard_error, ""),
        ];
        if truth {
            cells.push(row.truth.map_or_else(|| NONE.to_owned(), number::short));
        }
        cells.extend([format!("{} %", percent(row.shrink)), set + &separated]);
        cells
    };
    let mut head = vec!["effect", "value", "found"];
    if truth {
        head.push("hidden");
    }
    head.extend(["takes away", "not told from"]);
    let rows: Vec<_> = own.iter().map(row).collect();
    let head = head.into_iter().map(str::to_owned).collect();
    (!rows.is_empty()).then_some(Grid { head, rows, class: "fits", words: 2 })
}

/// The gap of every channel.
fn gaps(summary: &Summary, name: &str) -> Option<Grid> {
    let size =
        |value: Option<f64>| value.map_or_else(|| NONE.to_owned(), |v| number::significant(v, 3));
    let own = summary.gaps.iter().filter(|row| row.discovery == name);
    let rows: Vec<_> = own
        .map(|row| {
            let channel = format!("{}{}", row.channel, number::unit(&format!("[{}]", row.unit)));
            let cells = [row.before, row.refit, row.after, Some(row.floor)].map(size);
            std::iter::once(channel).chain(cells).collect()
        })
        .collect();
    let head = ["channel", "given", "refitted", "after", "floor"];
    let head = head.map(str::to_owned).to_vec();
    (!rows.is_empty()).then_some(Grid { head, rows, class: "fits", words: 1 })
}

/// The nominal parameters.
fn parameters(summary: &Summary, name: &str) -> Option<Grid> {
    let own = summary.parameters.iter().filter(|row| row.fit == name);
    let rows: Vec<_> = own
        .map(|row| {
            let interval = match (row.low, row.high) {
                (Some(low), Some(high)) => {
                    let digits = |value| number::significant(value, 4);
                    format!("{} to {}", digits(low), digits(high))
                }
                _ => NONE.to_owned(),
            };
            vec![
                number::symbol(&row.parameter),
                number::short(row.given) + &number::unit(&row.unit),
                number::with_error(row.found, Some(row.standard_error), ""),
                interval,
            ]
        })
        .collect();
    let head = ["parameter", "given", "found", "95 % interval"].map(str::to_owned).to_vec();
    (!rows.is_empty()).then_some(Grid { head, rows, class: "fits", words: 1 })
}

/// The tables of a search, each with its title and how it is read.
pub(crate) fn tables(summary: &Summary, name: &str) -> Vec<(&'static str, &'static str, Grid)> {
    [
        ("What was named", VALUES_READ, values(summary, name)),
        ("The gap", GAPS_READ, gaps(summary, name)),
        ("Parameters", PARAMETERS_READ, parameters(summary, name)),
    ]
    .into_iter()
    .filter_map(|(title, reads, grid)| Some((title, reads, grid?)))
    .collect()
}

/// All searches of an experiment in one table: what was answered, what was hidden, and the gap.
pub(crate) fn overview(summary: &Summary) -> Option<Grid> {
    let level = |value: Option<f64>| {
        let root = value.map(|squared| squared.max(0.0).sqrt());
        root.map_or_else(|| NONE.to_owned(), |v| number::significant(v, 3))
    };
    let row = |row: &DiscoveryRow| {
        let mut cells =
            vec![heading(row).to_owned(), answered(summary, row), said(&row.truth, &row.hidden)];
        cells.extend([row.before, row.refit, row.after].map(level));
        cells
    };
    let rows: Vec<_> = summary.discoveries.iter().map(row).collect();
    let head = ["record", "answer", "hidden", "given", "refitted", "after"];
    let head = head.map(str::to_owned).to_vec();
    (rows.len() > 1).then_some(Grid { head, rows, class: "answers", words: 3 })
}

/// How the table of all searches is read.
pub(crate) const OVERVIEW_READ: &str = "Residuals of all channels on blocks that were not fitted, root mean square, in units of what noise alone leaves: \
     1 is as good as the record itself. After is with what the answer names.";

/// Residuals in units of the floor, from the model as given to what noise leaves; none where nothing was answered.
pub(crate) fn ladder(summary: &Summary, row: &DiscoveryRow) -> FitLadder {
    let mut effects: Vec<&EffectRow> = Vec::new();
    for effect in summary.effects.iter().filter(|effect| effect.discovery == row.discovery) {
        if effects.iter().all(|other| other.effect != effect.effect) {
            effects.push(effect);
        }
    }
    let mut rungs = vec![("as given".to_owned(), row.before), ("refitted".to_owned(), row.refit)];
    let mut level = row.refit;
    for (n, effect) in effects.iter().enumerate() {
        level = level.map(|level| 1.0 + (level - 1.0) * (1.0 - effect.shrink));
        // The last one is the final model, fitted once more.
        let last = n + 1 == effects.len();
        rungs.push((format!("+ {}", effect.effect), if last { row.after } else { level }));
    }
    rungs.push(("floor".to_owned(), Some(1.0)));
    let rung = |(name, level): (String, Option<f64>)| {
        let value = level.map_or(f64::NAN, |level| level.max(0.0).sqrt());
        let note =
            if value.is_finite() { number::significant(value, 3) } else { "no motion".to_owned() };
        FitRung { chosen: name.starts_with('+'), name, value, whisker: None, note }
    };
    FitLadder {
        title: heading(row).to_owned(),
        axis: "residual / floor [1]".to_owned(),
        log: true,
        rungs: rungs.into_iter().map(rung).collect(),
        against: Some(1.0),
        ..FitLadder::default()
    }
}

/// The most candidates of a round that are shown.
const CANDIDATES: usize = 10;

/// The candidates of every round, the best first.
pub(crate) fn rankings(summary: &Summary, row: &DiscoveryRow) -> Vec<FitLadder> {
    let own = summary.ranking.iter().filter(|ranked| ranked.discovery == row.discovery);
    let mut rounds: Vec<(u64, Vec<&RankedRow>)> = Vec::new();
    for ranked in own {
        match rounds.iter_mut().find(|(round, _)| *round == ranked.round) {
            Some((_, some)) => some.push(ranked),
            None => rounds.push((ranked.round, vec![ranked])),
        }
    }
    let named: Vec<&str> = row.names.split(';').collect();
    let set = |name: &str| {
        let effect =
            summary.effects.iter().find(|e| e.discovery == row.discovery && e.effect == name);
        effect.map_or("", |effect| effect.set.as_str())
    };
    let ladder = |(round, mut some): (u64, Vec<&RankedRow>)| {
        some.sort_by(|a, b| b.shrink.total_cmp(&a.shrink));
        some.truncate(CANDIDATES);
        let place = usize::try_from(round).unwrap_or(0).saturating_sub(1);
        let chosen = named.get(place).map_or("", |name| set(name));
        FitLadder {
            title: format!("round {round}"),
            axis: "taken away [%]".to_owned(),
            rungs: some.into_iter().map(|ranked| candidate(ranked, chosen)).collect(),
            against: Some(0.0),
            ..FitLadder::default()
        }
    };
    rounds.into_iter().map(ladder).collect()
}

fn candidate(ranked: &RankedRow, chosen: &str) -> FitRung {
    // Student's t is of the share itself: its standard error is the share by t.
    let reach = ranked.t.map(|t| 1.96 * (ranked.shrink / t).abs());
    // A rival that makes all worse would take the room of the others.
    let held = |value: f64| 100.0 * value.clamp(-0.25, 1.25);
    let is_chosen = ranked.plausible && chosen.split(';').any(|name| name == ranked.effect);
    FitRung {
        name: ranked.effect.clone(),
        value: held(ranked.shrink),
        whisker: reach.map(|reach| [held(ranked.shrink - reach), held(ranked.shrink + reach)]),
        chosen: is_chosen,
        note: match (ranked.plausible, ranked.t) {
            (false, _) => "not plausible".to_owned(),
            (true, Some(t)) => format!("t = {}", number::significant(t, 2)),
            (true, None) => String::new(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(names: &str) -> Summary {
        let row = DiscoveryRow {
            discovery: "d".to_owned(),
            verdict: "effect".to_owned(),
            names: names.to_owned(),
            before: None,
            refit: Some(101.0),
            after: Some(1.21),
            ..DiscoveryRow::default()
        };
        let effect = |effect: &str, shrink| EffectRow {
            discovery: "d".to_owned(),
            effect: effect.to_owned(),
            set: effect.to_owned(),
            shrink,
            ..EffectRow::default()
        };
        let effects =
            vec![effect("viscous", 0.75), effect("viscous", 0.75), effect("cogging", 0.9)];
        let ranked = |round, name: &str, shrink| RankedRow {
            discovery: "d".to_owned(),
            round,
            effect: name.to_owned(),
            shrink,
            t: Some(2.0),
            plausible: true,
        };
        let ranking =
            vec![ranked(1, "cogging", 0.1), ranked(1, "viscous", 0.8), ranked(2, "cogging", -9.0)];
        Summary { discoveries: vec![row], effects, ranking, ..Summary::default() }
    }

    #[test]
    fn a_ladder_has_a_rung_for_each_effect_and_ends_at_the_floor() {
        let summary = summary("viscous;cogging");
        let ladder = ladder(&summary, &summary.discoveries[0]);
        let names: Vec<&str> = ladder.rungs.iter().map(|rung| rung.name.as_str()).collect();
        assert_eq!(names, ["as given", "refitted", "+ viscous", "+ cogging", "floor"]);
        let values: Vec<f64> = ladder.rungs.iter().map(|rung| rung.value).collect();
        assert!(values[0].is_nan(), "{} floors of a model without a motion", values[0]);
        // Three quarters of an excess of 100 leave 25, and the last rung is the final model's own.
        for (value, square) in values[1..].iter().zip([101.0, 26.0, 1.21, 1.0]) {
            assert!((value * value - square).abs() < 1e-9, "{value} floors, squared {square}");
        }
    }

    #[test]
    fn candidates_stand_by_what_they_take_away_and_what_was_named_stands_out() {
        let summary = summary("viscous;cogging");
        let rounds = rankings(&summary, &summary.discoveries[0]);
        assert_eq!(rounds.len(), 2, "rounds");
        let first: Vec<(&str, bool)> =
            rounds[0].rungs.iter().map(|rung| (rung.name.as_str(), rung.chosen)).collect();
        assert_eq!(first, [("viscous", true), ("cogging", false)]);
        assert_eq!(rounds[0].rungs[0].whisker.map(|ends| ends[0].round()), Some(2.0), "per cent");
        assert_eq!(rounds[1].rungs[0].value, -25.0, "what makes it worse stands at the edge");
    }

    #[test]
    fn a_verdict_names_what_it_is_about() {
        assert_eq!(said("parameter", "inertia;sigma_2"), "a parameter is wrong: inertia, σ₂");
        assert_eq!(said("effect", "viscous;cogging"), "effects are missing: viscous, cogging");
        assert_eq!(said("nothing_missing", ""), "nothing is missing at this noise");
    }
}
