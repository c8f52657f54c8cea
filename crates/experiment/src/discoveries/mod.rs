//! Searches for what a model lacks: made or found in the store, as rows and as curves.

use crate::{
    ExperimentError, Options, Plan, Why,
    curves::Series,
    fits::{self, Motions, Runs, Which, one},
    plan::{BY_BLOCKS, Discovered, Discovery, RESIDUAL},
    spec::PanelSpec,
};
use discover::Discovery as Found;
use identify::fit::{blocks::blocks, simulate};
use record::{
    DiscoveryRecord, DiscoveryRow, EffectRow, GapRow, Key, ParameterRow, RankedRow, ShareRow,
};
use std::sync::atomic::Ordering;

/// The largest number of samples that is drawn of a residual or a loop.
const MOST: usize = 1000;

/// The length of a block that a loop is drawn in, as the search cuts the record [s].
const BLOCK: f64 = 3.0;

/// Makes every search of the plan, or finds it in the store, one after the other: each uses all threads.
pub(crate) fn run(plan: &Plan, options: &Options) -> Result<(), ExperimentError> {
    for search in plan.discoveries.iter().filter(|search| search.done.get().is_none()) {
        if options.stop.load(Ordering::Relaxed) {
            return Err(ExperimentError::Interrupted { done: 0, total: plan.cases.len() });
        }
        let found = finish(plan, search, options)?;
        // It was empty a moment ago, and nobody else fills it.
        let _ = search.done.set(found);
    }
    Ok(())
}

fn finish(
    plan: &Plan,
    search: &Discovery,
    options: &Options,
) -> Result<Discovered, ExperimentError> {
    let key = key(search);
    let why = if options.fresh {
        Why::Fresh
    } else {
        match options.store.read::<DiscoveryRecord>(&key)? {
            record::Found::Record(record) => {
                return Ok(Discovered { record: named(search, *record), key, why: Why::Reused });
            }
            record::Found::Nothing => Why::New,
            record::Found::Damaged(how) => Why::Damaged(how),
        }
    };
    let source = &search.source;
    let found = discover::discover(&source.rig, &source.data, &search.options);
    let found = found.map_err(|e| ExperimentError::Unanswered {
        experiment: plan.name.clone(),
        what: format!("search `{}`", search.name),
        found: e.to_string(),
    })?;
    let record = kept(search, &found);
    options.store.write(&key, &record)?;
    Ok(Discovered { record: named(search, record), key, why })
}

/// The hash of all code that decides what a search answers: our sources, the locked dependencies, the compiler.
pub const SEARCH_SOURCES: &str = env!("DUHEM_SEARCH_SOURCES");

/// The hash of all that determines the answer; neither its names nor what was hidden are among it.
fn key(search: &Discovery) -> Key {
    let options = format!("{:?}", search.options);
    Key::of(&[SEARCH_SOURCES, &search.source.content, &options])
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// What is kept of an answer, without the names of the experiment and without the truth.
fn kept(search: &Discovery, found: &Found) -> DiscoveryRecord {
    let moved = found.parameters.iter().filter(|p| p.moved).map(|p| p.found.name.clone());
    let moved: Vec<String> = moved.collect();
    let effects: Vec<&str> = found.effects.iter().map(|e| e.name).collect();
    let names = if effects.is_empty() { moved.join(";") } else { effects.join(";") };
    let [before, refit, after] = found.chi_squared.map(finite);
    let row = DiscoveryRow {
        samples: search.source.recording.time.len() as u64,
        verdict: found.verdict.name().to_owned(),
        names,
        before,
        refit,
        after,
        ..DiscoveryRow::default()
    };
    let mut model = found.rig.clone();
    let given = |name: &str| search.source.rig.effects.iter().any(|e| e.name == name);
    model.effects.retain(|e| effects.contains(&e.name.as_str()) || given(&e.name));
    let there = |free: &String| model.value(free).is_some();
    let free = model.free.iter().filter(|free| there(free)).cloned().collect();
    model.free = free;
    DiscoveryRecord {
        row,
        effects: found.effects.iter().flat_map(values).collect(),
        gaps: found.gap.iter().map(gap).collect(),
        ranking: found.ranking.iter().map(ranked).collect(),
        shares: found
            .shares
            .iter()
            .map(|s| ShareRow {
                part: s.part.to_owned(),
                share: finite(s.share),
                ..ShareRow::default()
            })
            .collect(),
        parameters: found.parameters.iter().filter_map(parameter).collect(),
        moved,
        model: model.write(),
    }
}

fn values(effect: &discover::Found) -> Vec<EffectRow> {
    let row = |v: &discover::Value| EffectRow {
        effect: effect.name.to_owned(),
        set: effect.set.join(";"),
        separated_by: effect.separated_by.clone(),
        shrink: effect.shrink,
        t: finite(effect.t),
        key: v.name.clone(),
        unit: one(v.unit),
        value: v.value,
        standard_error: finite(v.standard_error),
        ..EffectRow::default()
    };
    effect.values.iter().map(row).collect()
}

fn gap(gap: &discover::Gap) -> GapRow {
    GapRow {
        channel: gap.channel.clone(),
        unit: one(gap.unit),
        before: finite(gap.before),
        refit: finite(gap.refit),
        after: finite(gap.after),
        floor: gap.floor,
        ..GapRow::default()
    }
}

fn ranked(ranked: &discover::Ranked) -> RankedRow {
    RankedRow {
        round: ranked.round as u64 + 1,
        effect: ranked.name.to_owned(),
        shrink: ranked.shrink,
        t: finite(ranked.t),
        plausible: ranked.plausible,
        ..RankedRow::default()
    }
}

/// A nominal parameter; of its error nothing is told where it could not be had.
fn parameter(p: &discover::Moved) -> Option<ParameterRow> {
    let error = finite(p.found.standard_error)?;
    let reach = crate::quantities::NORMAL * error;
    // What is less sure than its own half is not told by the record.
    let told = error < 0.5 * p.found.value.abs().max(p.given.abs()) || p.given == 0.0;
    Some(ParameterRow {
        parameter: p.found.name.clone(),
        unit: one(p.found.unit),
        given: p.given,
        found: p.found.value,
        standard_error: error,
        low: told.then_some(p.found.value - reach),
        high: told.then_some(p.found.value + reach),
        identified: told,
        ..ParameterRow::default()
    })
}

/// The record with its names in this experiment, and what was hidden beside what was found.
fn named(search: &Discovery, mut record: DiscoveryRecord) -> DiscoveryRecord {
    let own = || search.name.clone();
    let row = &mut record.row;
    row.discovery = own();
    row.title.clone_from(&search.title);
    row.text.clone_from(&search.text);
    row.record.clone_from(&search.source.file);
    row.rig.clone_from(&search.source.rig.title);
    record.effects.iter_mut().for_each(|row| row.discovery = own());
    record.gaps.iter_mut().for_each(|row| row.discovery = own());
    record.ranking.iter_mut().for_each(|row| row.discovery = own());
    record.shares.iter_mut().for_each(|row| row.discovery = own());
    record.parameters.iter_mut().for_each(|row| row.fit = own());
    let Some(hidden) = &search.hidden else { return record };
    let names = hidden.effects.keys().chain(hidden.parameters.keys());
    record.row.truth.clone_from(&hidden.verdict);
    record.row.hidden = names.cloned().collect::<Vec<_>>().join(";");
    for row in &mut record.effects {
        row.truth = hidden.effects.get(&row.effect).and_then(|keys| keys.get(&row.key)).copied();
    }
    for row in &mut record.parameters {
        row.truth = hidden.parameters.get(&row.parameter).copied();
    }
    record
}

/// The curves of one panel: motions as of a fit, loops block by block, and the force that the model lacks.
pub(crate) fn series(search: &Discovery, panel: &PanelSpec) -> Result<Series, String> {
    let runs = Runs::of_discovery(search)?;
    let drawn: fn(&Discovery, &Runs<'_>, Which) -> Result<Vec<(f64, f64)>, String> =
        match panel.show.as_str() {
            RESIDUAL => residual,
            BY_BLOCKS => by_blocks,
            _ => return fits::series(&runs, panel),
        };
    let names = if panel.of.is_empty() { &["given".to_owned()][..] } else { &panel.of[..] };
    let one = |name: &String| {
        let which = Which::of(name)?;
        Ok((runs.label(which).to_owned(), drawn(search, &runs, which)?))
    };
    names.iter().map(one).collect()
}

/// The force that the model lacks over time.
fn residual(search: &Discovery, runs: &Runs<'_>, which: Which) -> Result<Vec<(f64, f64)>, String> {
    let residual = discover::residual(runs.rig(which), runs.data, search.options.seed)
        .ok_or_else(|| format!("no motion {}", runs.label(which)))?;
    let stride = residual.time.len().div_ceil(MOST).max(1);
    Ok(residual.time.iter().copied().zip(residual.force).step_by(stride).collect())
}

/// Displacement over drive, block by block, each from its own start as the search has them; a gap in the line parts
/// the blocks.
fn by_blocks(_: &Discovery, runs: &Runs<'_>, which: Which) -> Result<Vec<(f64, f64)>, String> {
    let recorded = Motions::of(runs, Which::Record, 1.0)?;
    let run = simulate(runs.rig(which), runs.data, Some(BLOCK)).map_err(|e| e.to_string())?;
    let trace = run.traces.into_iter().next().ok_or("no displacement")?;
    let values = if which == Which::Record { trace.measured } else { trace.after };
    let stride = values.len().div_ceil(MOST).max(1);
    let mut points = Vec::new();
    for window in blocks(runs.data, Some(BLOCK)) {
        let some = (window.first..window.end).step_by(stride);
        points.extend(some.map(|i| (recorded.drive[i], values[i])));
        if which != Which::Record {
            points.push((recorded.drive[window.end - 1], f64::NAN));
        }
    }
    Ok(points)
}
