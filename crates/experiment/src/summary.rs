//! The tables of an experiment, from its plan and its finished cases.

use crate::{
    ExperimentError, Finished, Plan,
    compare::largest_response,
    curves, judge, orders,
    plan::{Answers, Discovery, Fit, Study, solver_names},
    spec::FigureSpec,
};
use record::{
    AboutRow, CaseRow, DiscoveryRecord, DiscoveryRow, FigureRow, FitRecord, FitRow, MeasureRow,
    StudyRow, Summary,
};

/// All tables of the experiment.
pub fn summary(plan: &Plan, finished: &[Finished]) -> Result<Summary, ExperimentError> {
    let mut cases: Vec<CaseRow> = finished.iter().map(|f| f.record.row.clone()).collect();
    orders::local(plan, &mut cases);
    // What has no answer was refused before anything ran, but for what had to be solved for first.
    let unanswered = |why: String| {
        let (what, found) = why.split_once(": ").unwrap_or(("what it asks for", &why));
        let (what, found) = (what.to_owned(), found.to_owned());
        ExperimentError::Unanswered { experiment: plan.name.clone(), what, found }
    };
    let measures = judge::measures(plan).map_err(unanswered)?;
    let claims = judge::claims(plan, &measures).map_err(unanswered)?;
    let (panels, curves) = curves::curves(plan, finished)
        .map_err(|why| unanswered(format!("a figure's panel: {why}")))?;
    let studies = plan.studies.iter().map(study_row).collect::<Result<_, _>>();
    let fits = plan.fits.iter().map(Fit::found).collect::<Result<Vec<_>, _>>();
    let fits: Vec<FitRecord> = fits.map_err(ExperimentError::Bug)?.into_iter().cloned().collect();
    let found = plan.discoveries.iter().map(Discovery::found).collect::<Result<Vec<_>, _>>();
    let found = found.map_err(ExperimentError::Bug)?;
    let mut summary = Summary {
        name: plan.name.clone(),
        about: about(plan),
        studies: studies.map_err(ExperimentError::Bug)?,
        orders: orders::orders(plan, &cases),
        cases,
        figures: plan.figures.iter().map(|f| figure_row(plan, f, &measures)).collect(),
        measures,
        claims,
        panels,
        curves,
        fits: fits.iter().map(|f| told(&f.row)).collect(),
        parameters: fits.iter().flat_map(|f| f.parameters.clone()).collect(),
        models: fits.iter().flat_map(|f| f.models.clone()).collect(),
        misfits: fits.iter().flat_map(|f| f.misfits.clone()).collect(),
        ..Summary::default()
    };
    for record in found {
        add(&mut summary, record);
    }
    Ok(summary)
}

/// Adds the rows of a search.
fn add(summary: &mut Summary, record: &DiscoveryRecord) {
    let row = &record.row;
    summary.discoveries.push(DiscoveryRow { text: folded(&row.text), ..row.clone() });
    summary.effects.extend(record.effects.iter().cloned());
    summary.gaps.extend(record.gaps.iter().cloned());
    summary.ranking.extend(record.ranking.iter().cloned());
    summary.shares.extend(record.shares.iter().cloned());
    summary.parameters.extend(record.parameters.iter().cloned());
}

/// The fit's row, its text as the others' are.
fn told(row: &FitRow) -> FitRow {
    FitRow { text: folded(&row.text), ..row.clone() }
}

fn about(plan: &Plan) -> Vec<AboutRow> {
    let row = |key: &str, value: &str| AboutRow { key: key.to_owned(), value: value.to_owned() };
    let mut rows = vec![
        row("title", &plan.title),
        row("paper", &plan.paper),
        row("text", &folded(&plan.text)),
        row("command", &format!("cargo xtask reproduce {}", plan.name)),
        row("spec sha256", &plan.spec_hash),
        row("format", &record::FORMAT.to_string()),
    ];
    for (name, version) in integrate::versions() {
        rows.push(row(&format!("version {name}"), version));
    }
    for rule in &plan.irreproducible {
        rows.push(row(&format!("irreproducible {}", rule.name), &folded(&rule.why)));
    }
    rows
}

/// A text with single line breaks folded and paragraphs kept.
fn folded(text: &str) -> String {
    let words = |p: &str| p.split_whitespace().collect::<Vec<_>>().join(" ");
    text.trim().split("\n\n").map(words).collect::<Vec<_>>().join("\n\n")
}

fn study_row(study: &Study) -> Result<StudyRow, String> {
    let mut worst: Option<f64> = None;
    for point in 0..study.points.len() {
        if let Some(error) = reference_error(study, point)? {
            worst = Some(worst.unwrap_or(0.0).max(error));
        }
    }
    Ok(StudyRow {
        study: study.name.clone(),
        title: study.title.clone(),
        model: study.model_text.clone(),
        input: study.input_text.clone(),
        text: folded(&study.text),
        reference: study.reference.as_ref().map_or_else(String::new, Answers::words),
        response: study.response().to_owned(),
        period: study.period,
        span: study.span,
        budget: study.budget,
        reference_error: worst,
    })
}

/// The reference's own bound, relative to its largest response.
fn reference_error(study: &Study, point: usize) -> Result<Option<f64>, String> {
    if study.reference.is_none() {
        return Ok(None);
    }
    let reference = study.exact(point)?.reference();
    let motion = study.motion(point)?;
    let scale = largest_response(motion.as_ref(), reference, (study.span, study.initial.len()));
    Ok(Some(reference.error_bound() / scale))
}

fn figure_row(plan: &Plan, figure: &FigureSpec, measures: &[MeasureRow]) -> FigureRow {
    let study = plan.studies.iter().find(|s| Some(&s.name) == figure.study.as_ref());
    let points = study.filter(|_| !figure.select.is_empty()).map_or(String::new(), |study| {
        let chosen = study.selected(&figure.select).unwrap_or_default();
        chosen.iter().map(|p| p.label.as_str()).collect::<Vec<_>>().join(";")
    });
    FigureRow {
        figure: figure.name.clone(),
        kind: figure.kind.clone(),
        study: figure.study.clone().unwrap_or_default(),
        title: figure.title.clone(),
        description: folded(&figure.description),
        caption: judge::fill(&figure.caption, measures),
        points,
        solvers: solver_names(&figure.solvers).join(";"),
        value: figure.value,
        aside: figure.aside,
    }
}
