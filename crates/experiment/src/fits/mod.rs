//! Fits to records: made or found in the store, as rows and as curves.

mod drawn;
mod motions;

pub(crate) use drawn::{ends, middle, series};
pub(crate) use motions::{Motions, Runs, Which};

use crate::{
    ExperimentError, Options, Plan, Why,
    plan::{Fit, Fitted},
};
use identify::{
    fit::{Fit as Found, Way, fit, search::End},
    rig::Kind,
};
use record::{FitRecord, FitRow, Key, MisfitRow, ModelRow, ParameterRow};
use std::sync::atomic::Ordering;

/// Makes every fit of the plan, or finds it in the store, one after the other: each uses all threads.
pub(crate) fn run(plan: &Plan, options: &Options) -> Result<(), ExperimentError> {
    for fit in plan.fits.iter().filter(|fit| fit.done.get().is_none()) {
        if options.stop.load(Ordering::Relaxed) {
            return Err(ExperimentError::Interrupted { done: 0, total: plan.cases.len() });
        }
        let fitted = finish(plan, fit, options)?;
        // It was empty a moment ago, and nobody else fills it.
        let _ = fit.done.set(fitted);
    }
    Ok(())
}

fn finish(plan: &Plan, fit: &Fit, options: &Options) -> Result<Fitted, ExperimentError> {
    let key = key(fit);
    let why = if options.fresh {
        Why::Fresh
    } else {
        match options.store.read::<FitRecord>(&key)? {
            record::Found::Record(record) => {
                return Ok(Fitted { record: named(fit, *record), key, why: Why::Reused });
            }
            record::Found::Nothing => Why::New,
            record::Found::Damaged(how) => Why::Damaged(how),
        }
    };
    let record = make(fit).map_err(|found| ExperimentError::Unanswered {
        experiment: plan.name.clone(),
        what: format!("fit `{}`", fit.name),
        found,
    })?;
    options.store.write(&key, &record)?;
    Ok(Fitted { record: named(fit, record), key, why })
}

/// The hash of all that determines the fit; neither its names nor the truth it is compared with are among it.
fn key(fit: &Fit) -> Key {
    Key::of(&[env!("DUHEM_FIT_SOURCES"), &fit.content, &format!("{:?}", fit.options)])
}

fn make(study: &Fit) -> Result<FitRecord, String> {
    let found = fit(&study.rig, &study.data, &study.options).map_err(|e| e.to_string())?;
    let finite = |value: f64| if value.is_finite() { value } else { 0.0 };
    let row = FitRow {
        samples: study.recording.time.len() as u64,
        way: way(found.way).to_owned(),
        windows: found.windows as u64,
        end: end(found.end).to_owned(),
        simulations: found.simulations.iter().sum::<usize>() as u64,
        variance: finite(found.variance),
        neighbours: finite(found.neighbours),
        step_error: finite(found.step_error),
        ..FitRow::default()
    };
    let model = |c: &identify::fit::Candidate| ModelRow {
        model: c.name.clone(),
        free: c.free as u64,
        trained: c.trained_error,
        held_out: c.held_out_error,
        ..ModelRow::default()
    };
    Ok(FitRecord {
        row,
        parameters: parameters(study, &found),
        models: found.models.iter().map(model).collect(),
        misfits: misfits(study, &found),
    })
}

fn parameters(study: &Fit, found: &Found) -> Vec<ParameterRow> {
    let row = |p: &identify::fit::Estimate| {
        let [low, high] = p.interval;
        ParameterRow {
            parameter: p.name.clone(),
            unit: one(study.rig.unit(&p.name)),
            given: p.given,
            found: p.found,
            standard_error: p.standard_error,
            low,
            high,
            identified: p.identified,
            ..ParameterRow::default()
        }
    };
    found.parameters.iter().map(row).collect()
}

fn misfits(study: &Fit, found: &Found) -> Vec<MisfitRow> {
    let unit = |channel: &str| {
        let quantity = Kind::of(study.rig.kind)?.channel(channel)?;
        quantity.dimensions.first().map(|dimension| dimension.si())
    };
    let row = |m: &identify::fit::Misfit| MisfitRow {
        channel: m.channel.clone(),
        unit: one(unit(&m.channel).unwrap_or_default()),
        before: m.before,
        after: m.after,
        noise: m.noise,
        ..MisfitRow::default()
    };
    found.gap.iter().map(row).collect()
}

/// A unit, and `1` for none.
pub(crate) fn one(unit: &str) -> String {
    if unit.is_empty() { "1" } else { unit }.to_owned()
}

/// The record with its names in this experiment, and the truth beside what was found.
fn named(fit: &Fit, mut record: FitRecord) -> FitRecord {
    let row = &mut record.row;
    row.fit.clone_from(&fit.name);
    row.title.clone_from(&fit.title);
    row.text.clone_from(&fit.text);
    row.record.clone_from(&fit.file);
    row.rig.clone_from(&fit.rig.title);
    for row in &mut record.parameters {
        row.fit.clone_from(&fit.name);
        row.truth = fit.truth.get(&row.parameter).copied();
    }
    record.models.iter_mut().for_each(|row| row.fit.clone_from(&fit.name));
    record.misfits.iter_mut().for_each(|row| row.fit.clone_from(&fit.name));
    record
}

fn way(way: Way) -> &'static str {
    match way {
        Way::Imposed => "the motion imposed, the force computed",
        Way::OneRun => "in one run from the first sample to the last",
        Way::Windows => "in windows, each from its own start",
        Way::ClosedLoop => "with the controller that made it, in one run",
    }
}

fn end(end: End) -> &'static str {
    match end {
        End::Converged => "converged",
        End::Stalled => "stalled: the misfit still falls in some direction",
        End::OutOfPatience => "out of patience",
        End::NoMotion => "no motion",
    }
}
