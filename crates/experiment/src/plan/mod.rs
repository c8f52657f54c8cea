//! An experiment as checked: every name resolved, every number in its range, every case listed.

mod answer;
mod discovery;
mod figures;
mod fit;
mod input;
mod judged;
mod judged_record;
mod methods;
mod panel;
mod source;
mod study;
mod sweep;

pub use answer::{Answers, Exact};
pub use discovery::{Discovered, Discovery, Hidden};
pub(crate) use figures::{BY_BLOCKS, RESIDUAL};
pub use fit::{Fit, Fitted};
pub use judged::{Claim, Decision, Irreproducible, Measure, Subject, Whose};
pub use methods::control_name;
pub use source::Source;
pub use study::Study;
pub use sweep::Point;
pub(crate) use sweep::angular;

use crate::{
    ExperimentError,
    error::Complaint,
    spec::{FigureSpec, Spec},
    written::Written,
};
use integrate::{Control, Corners, Solver};
use record::RecordError;
use simulation::Method;
use std::{collections::BTreeSet, fs, path::Path};

/// The most evaluations a case may use if the experiment does not say otherwise.
const BUDGET: f64 = 5e6;
/// The most cases an experiment may have: more is a slip of the pen.
const MOST_CASES: usize = 100_000;

/// An experiment as checked.
#[derive(Debug)]
pub struct Plan {
    /// Its name: that of its file.
    pub name: String,
    /// The SHA-256 of its TOML.
    pub spec_hash: String,
    /// The title.
    pub title: String,
    /// Which figures and equations of the paper it covers.
    pub paper: String,
    /// What it is about.
    pub text: String,
    /// The studies.
    pub studies: Vec<Study>,
    /// The fits to records.
    pub fits: Vec<Fit>,
    /// The searches for what a model lacks.
    pub discoveries: Vec<Discovery>,
    /// Every case, in the order of the tables.
    pub cases: Vec<Case>,
    /// The figures, their studies and solvers resolved.
    pub figures: Vec<FigureSpec>,
    /// The measures.
    pub measures: Vec<Measure>,
    /// The claims.
    pub claims: Vec<Claim>,
    /// The rows whose numbers are not reproducible by nature.
    pub irreproducible: Vec<Irreproducible>,
}

/// One cell of model × input × solver × control × corners.
#[derive(Debug, Clone)]
pub struct Case {
    /// The study's index.
    pub study: usize,
    /// The point's index in its sweep.
    pub point: usize,
    /// The solver, or the method of our own.
    pub solver: Method,
    /// Steps per period, or the relative tolerance; 0 for an exact method.
    pub value: f64,
    /// Whether the solver restarts at corners, as a method of our own does.
    pub corners: Corners,
    /// Whether its steps are kept for a figure.
    pub history: bool,
}

/// The steps of a solver in a study: so many a period, or at that relative tolerance.
pub(crate) fn control(study: &Study, solver: &'static Solver, value: f64) -> Control {
    match control_name(Method::Solver(solver)) {
        "step" => Control::Step(study.period / value),
        _ => Control::Tolerance { rtol: value },
    }
}

/// `restart` or `ignore`.
pub fn corners_name(corners: Corners) -> &'static str {
    match corners {
        Corners::Restart => "restart",
        Corners::Ignore => "ignore",
    }
}

impl Plan {
    /// Reads and checks the experiment at `path`; `kinds` are the kinds of figure that can be drawn.
    pub fn read(path: &Path, kinds: &[&str]) -> Result<Self, ExperimentError> {
        let disk = |source| RecordError::Disk { path: path.into(), what: "cannot read", source };
        let bytes = fs::read(path).map_err(disk)?;
        let text = String::from_utf8(bytes).map_err(|e| ExperimentError::Spec {
            path: path.to_path_buf(),
            line: 1,
            key: "the file".to_owned(),
            found: format!("a byte that is no text, at {}", e.utf8_error().valid_up_to()),
            expected: "UTF-8".to_owned(),
        })?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Self::from_text(&name, path, &text, kinds)
    }

    pub(crate) fn from_text(
        name: &str,
        path: &Path,
        text: &str,
        kinds: &[&str],
    ) -> Result<Self, ExperimentError> {
        let written = Written::parse(path, text)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        check((name, folder), text, &written.spec, kinds)
            .map_err(|complaint| written.error(complaint))
    }

    /// The same plan with two steps and tolerances in every study: the first, and the one that a figure
    /// shows or else the second; and with the fits' standard errors alone, no profiles.
    #[must_use]
    pub fn quick(mut self) -> Self {
        for study in &mut self.studies {
            let shown = self.figures.iter().filter(|f| f.study.as_ref() == Some(&study.name));
            let shown: Vec<f64> = shown.filter_map(|f| f.value).collect();
            for values in [&mut study.steps, &mut study.rtol] {
                if let Some(wanted) = values.iter().skip(1).position(|v| shown.contains(v)) {
                    values.swap(1, wanted + 1);
                }
                values.truncate(2);
            }
        }
        for fit in &mut self.fits {
            fit.options.profiles = false;
        }
        self.cases = cases(&self.studies);
        self
    }
}

fn check(
    (name, folder): (&str, &Path),
    text: &str,
    spec: &Spec,
    kinds: &[&str],
) -> Result<Plan, Complaint> {
    unique("study", spec.study.iter().map(|s| &s.name))?;
    unique("fit", spec.fit.iter().map(|s| &s.name))?;
    unique("discover", spec.discover.iter().map(|s| &s.name))?;
    unique("figure", spec.figure.iter().map(|s| &s.name))?;
    for (key, text) in [("title", &spec.title), ("paper", &spec.paper), ("text", &spec.text)] {
        readable(text).map_err(|c| c.under(key))?;
    }
    if spec.study.is_empty() && spec.fit.is_empty() && spec.discover.is_empty() {
        let expected = "at least one [[study]], [[fit]] or [[discover]]";
        return Err(Complaint::new("study", "none", expected));
    }
    let budget = spec.budget.unwrap_or(BUDGET);
    if !(1.0..=1e12).contains(&budget) {
        return Err(Complaint::new("budget", budget.to_string(), "from 1 to 1e12 evaluations"));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked above")]
    let budget = budget as u64;
    let mut studies = Vec::new();
    for (i, written) in spec.study.iter().enumerate() {
        let study = Study::check(written, budget).map_err(|c| c.under(&format!("study[{i}]")))?;
        studies.push(study);
    }
    let cases = cases(&studies);
    if cases.len() > MOST_CASES {
        let found = format!("{} cases", cases.len());
        return Err(Complaint::new("study", found, format!("at most {MOST_CASES}")));
    }
    let (fits, discoveries) = (fits(spec, folder)?, discoveries(spec, folder)?);
    let known = Known { studies: &studies, fits: &fits, discoveries: &discoveries };
    let judged = judged::check(spec, known)?;
    let plan = Plan {
        name: name.to_owned(),
        spec_hash: record::sha256(text.as_bytes()),
        title: spec.title.clone(),
        paper: spec.paper.clone(),
        text: spec.text.clone(),
        figures: figures::check(spec, known, kinds)?,
        studies,
        fits,
        discoveries,
        cases,
        measures: judged.measures,
        claims: judged.claims,
        irreproducible: judged.irreproducible,
    };
    answerable(&plan)?;
    Ok(plan)
}

/// The fits, each of a name that no study has: figures, measures and checks name one or the other.
fn fits(spec: &Spec, folder: &Path) -> Result<Vec<Fit>, Complaint> {
    let mut fits = Vec::new();
    for (i, written) in spec.fit.iter().enumerate() {
        let key = format!("fit[{i}]");
        if spec.study.iter().any(|s| s.name == written.name) {
            let found = format!("`{}`, the name of a study", written.name);
            return Err(Complaint::new(format!("{key}.name"), found, "a name of its own"));
        }
        fits.push(Fit::check(written, folder).map_err(|c| c.under(&key))?);
    }
    Ok(fits)
}

/// The searches, each of a name that no study and no fit has.
fn discoveries(spec: &Spec, folder: &Path) -> Result<Vec<Discovery>, Complaint> {
    let mut all = Vec::new();
    for (i, written) in spec.discover.iter().enumerate() {
        let key = format!("discover[{i}]");
        let mut others = spec.study.iter().map(|s| &s.name).chain(spec.fit.iter().map(|f| &f.name));
        if others.any(|name| *name == written.name) {
            let found = format!("`{}`, the name of a study or a fit", written.name);
            return Err(Complaint::new(format!("{key}.name"), found, "a name of its own"));
        }
        all.push(Discovery::check(written, folder).map_err(|c| c.under(&key))?);
    }
    Ok(all)
}

/// What figures, measures and checks can be of.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a> {
    studies: &'a [Study],
    fits: &'a [Fit],
    discoveries: &'a [Discovery],
}

/// What has no answer, as the travel to a force that is never reached, is found before anything runs.
fn answerable(plan: &Plan) -> Result<(), Complaint> {
    // What has to be solved for is not: that takes its time, and a run tells.
    let quick = |s: &Subject| s.of == Whose::Study && plan.studies[s.study].plant.is_none();
    for (i, measure) in plan.measures.iter().enumerate().filter(|(_, m)| quick(&m.subject)) {
        (measure.quantity.measure)(plan, &measure.subject).map_err(|e| {
            Complaint::new(format!("measure[{i}].what"), e, "a quantity this model has")
        })?;
    }
    for (i, claim) in plan.claims.iter().enumerate() {
        if let Decision::Check(check, subject) = &claim.decision
            && quick(subject)
        {
            (check.run)(plan, subject).map_err(|e| {
                Complaint::new(format!("claim[{i}].check"), e, "what can be checked")
            })?;
        }
    }
    Ok(())
}

/// A text that would move a terminal's cursor or turn the line round is refused.
fn readable(text: &str) -> Result<(), Complaint> {
    let turns = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    match text.chars().find(|c| turns(*c) || (c.is_control() && !"\n\t\r".contains(*c))) {
        None => Ok(()),
        Some(c) => {
            let found = format!("the control character U+{:04X}", u32::from(c));
            Err(Complaint::new("", found, "text that can be shown"))
        }
    }
}

fn unique<'a>(table: &str, names: impl Iterator<Item = &'a String>) -> Result<(), Complaint> {
    let mut seen = BTreeSet::new();
    for (i, name) in names.enumerate() {
        if !plain(name) {
            let expected = "at most 64 letters, digits, `-`, `_`, `.`, `=`, `*`";
            return Err(Complaint::new(
                format!("{table}[{i}].name"),
                format!("`{name}`"),
                expected,
            ));
        }
        // A figure's data stand beside the tables, under its own name.
        if table == "figure" && record::Summary::FILES.contains(&format!("{name}.csv").as_str()) {
            let found = format!("`{name}`, the name of a table");
            return Err(Complaint::new(format!("figure[{i}].name"), found, "another name"));
        }
        if !seen.insert(name) {
            let found = format!("`{name}` a second time");
            return Err(Complaint::new(format!("{table}[{i}].name"), found, "a name of its own"));
        }
    }
    Ok(())
}

/// Names become file names and anchors.
fn plain(name: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || "-_.=*".contains(c);
    !name.is_empty() && name.len() <= 64 && name.chars().all(allowed) && !name.starts_with('.')
}

/// The cases of all studies, in the order of the tables.
fn cases(studies: &[Study]) -> Vec<Case> {
    let mut cases = Vec::new();
    for (s, study) in studies.iter().enumerate() {
        for point in 0..study.points.len() {
            let takes = |solver: &Method| study.holds(point, *solver).is_ok();
            for solver in study.solvers.iter().copied().filter(takes) {
                for value in study.values(solver) {
                    for corners in study.corners_of(solver) {
                        let history = study.keeps(solver, *value, *corners);
                        let (value, corners) = (*value, *corners);
                        cases.push(Case { study: s, point, solver, value, corners, history });
                    }
                }
            }
        }
    }
    cases
}

/// The names that these names and sets mean; none for those that a plan has already refused.
pub(crate) fn solver_names(names: &[String]) -> Vec<&'static str> {
    methods::named(names).unwrap_or_default().iter().map(Method::name).collect()
}
