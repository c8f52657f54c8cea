//! The experiments, and one of them resolved.

use crate::{
    exit::{Exit, Failure},
    output, root,
};
use experiment::{Plan, control_name, corners_name};
use report::FIGURES;
use serde_json::json;
use std::path::Path;

/// The kinds of figure that can be drawn.
pub(crate) fn kinds() -> Vec<&'static str> {
    FIGURES.iter().map(|kind| kind.name).collect()
}

/// Lists the experiments with their titles and the number of their cases.
pub(crate) fn list(root: &Path, as_json: bool) -> Result<Exit, Failure> {
    let mut rows = Vec::new();
    for name in root::experiments(root)? {
        let plan = Plan::read(&root::toml(root, &name), &kinds())?;
        rows.push((name, plan.title, plan.paper, plan.cases.len()));
    }
    if as_json {
        let rows: Vec<_> = rows
            .iter()
            .map(|(name, title, paper, cases)| json!({ "name": name, "title": title, "paper": paper, "cases": cases }))
            .collect();
        output::line(&format!("{:#}", json!({ "format": record::FORMAT, "experiments": rows })));
    } else if rows.is_empty() {
        output::note("no experiments: `cargo xtask new experiment NAME` makes one");
    } else {
        for (name, title, paper, cases) in rows {
            output::line(&format!("{name}  {title} ({paper}), {cases} cases"));
        }
    }
    Ok(Exit::Done)
}

/// Shows one experiment with every name resolved.
pub(crate) fn show(root: &Path, name: &str, as_json: bool) -> Result<Exit, Failure> {
    let names = root::chosen(root, &[name.to_owned()])?;
    let plan = Plan::read(&root::toml(root, &names[0]), &kinds())?;
    let studies = plan.studies.iter().map(|study| {
        let names = |control: &str| {
            let own = study.solvers.iter().filter(|s| control_name(**s) == control);
            own.map(simulation::Method::name).collect::<Vec<_>>()
        };
        json!({
            "name": study.name, "model": study.model_text, "input": study.input_text,
            "points": study.points.iter().map(|p| &p.label).collect::<Vec<_>>(),
            "span_s": study.span, "budget": study.budget, "reference": study.reference.as_ref().map(|r| r.name),
            "exact": names("none"), "fixed_step": names("step"), "steps_per_period": study.steps,
            "adaptive": names("rtol"), "rtol": study.rtol,
            "corners": study.corners.iter().map(|c| corners_name(*c)).collect::<Vec<_>>(),
        })
    });
    let shown = json!({
        "format": record::FORMAT, "name": plan.name, "title": plan.title, "paper": plan.paper,
        "cases": plan.cases.len(),
        "fits": plan.fits.iter().map(|f| json!({ "name": f.name, "record": f.file, "free": f.rig.free_parameters() })).collect::<Vec<_>>(),
        "discover": plan.discoveries.iter().map(|d| json!({ "name": d.name, "record": d.source.file, "free": d.source.rig.free_parameters() })).collect::<Vec<_>>(),
        "studies": studies.collect::<Vec<_>>(),
        "figures": plan.figures.iter().map(|f| &f.name).collect::<Vec<_>>(),
        "measures": plan.measures.iter().map(|m| &m.id).collect::<Vec<_>>(),
        "claims": plan.claims.iter().map(|c| &c.written.id).collect::<Vec<_>>(),
    });
    if as_json {
        output::line(&format!("{shown:#}"));
    } else {
        text(&shown, 0);
    }
    Ok(Exit::Done)
}

/// A JSON value as indented text: names before values, no braces.
fn text(value: &serde_json::Value, depth: usize) {
    let indent = "  ".repeat(depth);
    let plain = |v: &serde_json::Value| match v {
        serde_json::Value::String(s) => s.clone(),
        serde_json::Value::Array(items) if items.iter().all(|i| !i.is_object()) => items
            .iter()
            .map(|i| i.as_str().map_or_else(|| i.to_string(), ToOwned::to_owned))
            .collect::<Vec<_>>()
            .join(", "),
        other => other.to_string(),
    };
    let Some(fields) = value.as_object() else { return };
    for (key, field) in fields {
        match field.as_array().map(Vec::as_slice) {
            Some(items) if items.iter().any(serde_json::Value::is_object) => {
                output::line(&format!("{indent}{key}:"));
                for item in items {
                    text(item, depth + 1);
                    output::line("");
                }
            }
            Some([]) => {}
            _ => output::line(&format!("{indent}{key}: {}", plain(field))),
        }
    }
}
