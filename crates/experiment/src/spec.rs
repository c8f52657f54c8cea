//! An experiment as written: the TOML's keys and nothing more. What is checked is a [`crate::Plan`].

use serde::Deserialize;
use std::collections::BTreeMap;

/// An experiment as written.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spec {
    /// The title.
    pub title: String,
    /// Which figures and equations of the paper it covers.
    pub paper: String,
    /// What the experiment is about, for the report.
    pub text: String,
    /// The most evaluations a case may use; 5e6 if not given.
    pub budget: Option<f64>,
    /// The studies.
    #[serde(default)]
    pub study: Vec<StudySpec>,
    /// The fits to records.
    #[serde(default)]
    pub fit: Vec<FitSpec>,
    /// The searches for what a model lacks.
    #[serde(default)]
    pub discover: Vec<DiscoverSpec>,
    /// The figures.
    #[serde(default)]
    pub figure: Vec<FigureSpec>,
    /// The quantities to measure.
    #[serde(default)]
    pub measure: Vec<MeasureSpec>,
    /// The claims to judge.
    #[serde(default)]
    pub claim: Vec<ClaimSpec>,
    /// The rows whose numbers are not reproducible by nature.
    #[serde(default)]
    pub irreproducible: Vec<IrreproducibleSpec>,
}

/// One study: model × input × solvers × controls.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudySpec {
    /// Its name.
    pub name: String,
    /// Its title, for the report.
    pub title: String,
    /// The label of its curve, where several studies share a panel; the model's name if not given.
    #[serde(default)]
    pub label: String,
    /// The physics, for the report.
    #[serde(default)]
    pub text: String,
    /// The model's name and parameters.
    pub model: toml::Table,
    /// The plant's kind and parameters, if the input is a force (or a current) on one; without it the
    /// input is the displacement itself.
    pub plant: Option<toml::Table>,
    /// The input's shape and parameters.
    pub input: toml::Table,
    /// Parameters of the model or the plant that take several values.
    #[serde(default)]
    pub sweep: BTreeMap<String, Vec<f64>>,
    /// The time span, in periods of the input.
    pub periods: Option<f64>,
    /// The time span [s], where it is no matter of periods.
    pub span: Option<f64>,
    /// The state at t = 0: the model's, after displacement and velocity if there is a plant; zero if
    /// not given.
    pub initial: Option<Vec<f64>>,
    /// Solvers and named sets of them.
    #[serde(default)]
    pub solvers: Vec<String>,
    /// Steps per period (over the span if that is given), for the methods of fixed step.
    #[serde(default)]
    pub steps: Vec<f64>,
    /// Relative tolerances, for the adaptive methods.
    #[serde(default)]
    pub rtol: Vec<f64>,
    /// `restart`, `ignore` or both.
    #[serde(default)]
    pub corners: Vec<String>,
    /// The exact answer errors are judged by.
    pub reference: Option<String>,
    /// Cases whose steps are kept for a figure.
    #[serde(default)]
    pub history: Vec<HistorySpec>,
}

/// One fit: a rig's free parameters from a record. Files are named as seen from the experiment's folder.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitSpec {
    /// Its name; panels, measures and checks call it their `study`.
    pub name: String,
    /// Its title, for the report.
    pub title: String,
    /// What is to be known of it, for the report.
    #[serde(default)]
    pub text: String,
    /// The record.
    pub record: String,
    /// The rig file.
    pub rig: String,
    /// The truth file of a synthetic record; it is compared with, and never seen by the fit.
    pub truth: Option<String>,
    /// The length of a window [s]; found from the record if not given.
    pub window: Option<f64>,
    /// The starts beside the nominal one.
    pub starts: Option<u32>,
    /// The seed of the starts.
    pub seed: Option<u32>,
    /// Whether the other friction models are fitted, too; so if not said.
    pub models: Option<bool>,
}

/// One search for what the model of a rig lacks. Files are named as seen from the experiment's folder.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiscoverSpec {
    /// Its name; panels, measures and checks call it their `study`.
    pub name: String,
    /// Its title, for the report.
    pub title: String,
    /// What is to be known of it, for the report.
    #[serde(default)]
    pub text: String,
    /// The record.
    pub record: String,
    /// The rig file.
    pub rig: String,
    /// The file that says what was hidden in a synthetic record; it is compared with, and never seen by the search.
    pub truth: Option<String>,
    /// The seed of the perturbations by which the floor is found.
    pub seed: Option<u32>,
}

/// A case whose steps are kept for a figure, at every point of the sweep.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HistorySpec {
    /// The solver.
    pub solver: String,
    /// Its relative tolerance, one of the study's.
    pub rtol: f64,
    /// `restart` or `ignore`.
    pub corners: String,
}

/// One figure.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FigureSpec {
    /// Its name, and its file's.
    pub name: String,
    /// The kind.
    pub kind: String,
    /// The study whose cases it shows.
    pub study: Option<String>,
    /// The title.
    pub title: String,
    /// For a reader who cannot see it.
    pub description: String,
    /// What to see in it.
    pub caption: String,
    /// Values of the sweep to show; all if not given.
    #[serde(default)]
    pub select: BTreeMap<String, Vec<f64>>,
    /// Solvers to show; all if not given.
    #[serde(default)]
    pub solvers: Vec<String>,
    /// The one control value to show, for kinds that need one.
    pub value: Option<f64>,
    /// Whether it stands aside, for a reader who wants more than the paper's own figures.
    #[serde(default)]
    pub aside: bool,
    /// The panels, for figures of curves.
    #[serde(default)]
    pub panel: Vec<PanelSpec>,
}

/// One panel of a figure of curves.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PanelSpec {
    /// Its title.
    pub title: String,
    /// The study whose curves it shows; the figure's if not given.
    pub study: Option<String>,
    /// Further studies drawn in the same way.
    #[serde(default)]
    pub also: Vec<String>,
    /// What is drawn, as listed in `plan`: `force-displacement`, `displacement-time`, `step-time`, ….
    pub show: String,
    /// `settled` (the limit cycle) or `from-start`; only for the exact answer under an imposed motion.
    #[serde(default)]
    pub from: String,
    /// The stretch of time to show [s]; the whole span if not given. Only for plants.
    pub between: Option<[f64; 2]>,
    /// Solvers whose own path is drawn besides, or alone where the study has no exact answer.
    #[serde(default)]
    pub runs: Vec<RunSpec>,
    /// What is drawn of a fit: `record`, `given` (the nominal parameters, simulated), `fitted`; the record alone
    /// if not given.
    #[serde(default)]
    pub of: Vec<String>,
    /// Whether a fit's torque is drawn without bias and asymmetry, and its angles about their middle.
    #[serde(default)]
    pub centred: bool,
    /// Label of the horizontal axis.
    pub x: String,
    /// Label of the vertical axis.
    pub y: String,
    /// The ends of the horizontal axis.
    pub x_range: [f64; 2],
    /// The ends of the vertical axis.
    pub y_range: [f64; 2],
    /// Whether the horizontal axis is logarithmic.
    #[serde(default)]
    pub x_log: bool,
    /// Whether the vertical axis is logarithmic.
    #[serde(default)]
    pub y_log: bool,
}

/// One run of a solver, to be drawn.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSpec {
    /// The solver.
    pub solver: String,
    /// Steps per period, or the relative tolerance.
    pub value: f64,
    /// `restart` or `ignore`.
    pub corners: String,
}

/// One quantity to measure.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasureSpec {
    /// Its id.
    pub id: String,
    /// Its unit.
    pub unit: String,
    /// The study it is taken in.
    pub study: String,
    /// `quantity`, what the quantity takes, and values for swept parameters.
    pub what: toml::Table,
}

/// One sentence of the paper.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClaimSpec {
    /// Its id.
    pub id: String,
    /// Where the paper says it.
    pub place: String,
    /// What it says.
    pub says: String,
    /// The printed number, if there is one.
    pub printed: Option<PrintedSpec>,
    /// The measure that decides a number.
    pub measure: Option<String>,
    /// The check that decides a sentence: `name`, `study`, and its parameters.
    pub check: Option<toml::Table>,
    /// Why the outcome depends on something the paper does not print.
    pub under_specified: Option<String>,
    /// Both numbers are the paper's: the measure computes from one place what it prints in another. Where
    /// they differ, two printed things exclude each other, and neither is ours to choose.
    #[serde(default)]
    pub between_prints: bool,
    /// Only a shape or an impression is claimed.
    #[serde(default)]
    pub qualitative: bool,
    /// What was found and what probably happened; `{id}` stands for a measure's value.
    pub why: String,
    /// The figure that shows it.
    #[serde(default)]
    pub figure: String,
}

/// A number as printed.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrintedSpec {
    /// The number.
    pub value: f64,
    /// How many significant digits are printed.
    pub digits: u64,
    /// Its unit.
    pub unit: String,
}

/// Rows whose numbers are not reproducible by nature: those that fit every key given.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IrreproducibleSpec {
    /// A short name, for the rows.
    pub name: String,
    /// The studies.
    pub studies: Vec<String>,
    /// Values of the sweep; all if not given.
    #[serde(default)]
    pub select: BTreeMap<String, Vec<f64>>,
    /// Solvers and sets; all if not given.
    #[serde(default)]
    pub solvers: Vec<String>,
    /// `restart`, `ignore`; both if not given.
    #[serde(default)]
    pub corners: Vec<String>,
    /// Whether not even the status is reproducible: runs that meet their budget on the edge.
    #[serde(default)]
    pub any_status: bool,
    /// The reason, for the report.
    pub why: String,
}
