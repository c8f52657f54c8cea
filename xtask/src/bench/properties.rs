//! `cargo xtask bench properties`: the properties of plants, on cases drawn at random.

use crate::{cli::PropertiesArgs, exit::Exit, output};
use serde_json::json;
use simulation::properties::{PROPERTIES, Property, Report};
use std::thread;

/// Tries every property of plants with friction on many cases drawn at random.
pub(crate) fn run(arguments: &PropertiesArgs) -> Exit {
    let processors = || thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.map_or_else(processors, usize::from);
    let mut reports = Vec::new();
    for property in PROPERTIES {
        let report = spread(property, arguments, threads);
        if !arguments.json {
            output::line(&words(property, &report));
        }
        reports.push((property, report));
    }
    let held = reports.iter().all(|(_, report)| report.holds());
    if arguments.json {
        output::line(&format!("{:#}", told(&reports, held, arguments)));
    }
    if held {
        return Exit::Done;
    }
    output::error("a property is violated; its seed alone draws the worst case again");
    Exit::CheckFailed
}

/// The seeds split over threads; the report does not depend on how.
fn spread(property: &'static Property, arguments: &PropertiesArgs, threads: usize) -> Report {
    let share = arguments.cases.div_ceil(threads).max(1);
    let parts: Vec<Report> = thread::scope(|scope| {
        let starts = (0..arguments.cases).step_by(share);
        let spawned: Vec<_> = starts
            .map(|from| {
                let cases = share.min(arguments.cases - from);
                scope.spawn(move || property.check(arguments.seed.wrapping_add(from as u64), cases))
            })
            .collect();
        let joined = spawned.into_iter().map(thread::ScopedJoinHandle::join);
        joined.map(|part| part.unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
    });
    let (property, seed) = (property.name, arguments.seed);
    let mut whole = Report { property, cases: 0, unsolved: 0, violations: 0, worst: 0.0, seed };
    for part in parts {
        whole.cases += part.cases;
        whole.unsolved += part.unsolved;
        whole.violations += part.violations;
        if part.worst > whole.worst || (part.worst.is_nan() && !whole.worst.is_nan()) {
            (whole.worst, whole.seed) = (part.worst, part.seed);
        }
    }
    whole
}

fn words(property: &Property, report: &Report) -> String {
    let mark = if report.holds() { "=" } else { "x" };
    format!(
        "{mark} {:<20} {} cases, {} unsolved, {} violations; worst {:.1e} of {:.0e} allowed, seed {}\n  {}",
        property.name,
        report.cases,
        report.unsolved,
        report.violations,
        report.worst,
        property.tolerance,
        report.seed,
        property.says
    )
}

fn told(
    reports: &[(&Property, Report)],
    held: bool,
    arguments: &PropertiesArgs,
) -> serde_json::Value {
    let rows = reports.iter().map(|(property, report)| {
        json!({
            "property": property.name, "says": property.says, "cases": report.cases,
            "unsolved": report.unsolved, "violations": report.violations, "worst": report.worst,
            "tolerance": property.tolerance, "seed": report.seed, "holds": report.holds(),
        })
    });
    json!({
        "format": record::FORMAT, "first_seed": arguments.seed, "held": held,
        "properties": rows.collect::<Vec<_>>(),
    })
}
