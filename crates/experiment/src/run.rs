//! Every case run or found in the store, in parallel, none able to stop the others.

use crate::{
    ExperimentError, compare, discoveries, fits, own,
    plan::{Case, Plan, Study, control, corners_name},
};
use integrate::Limits;
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
use record::{CaseRecord, CaseRow, Found, Key, Store};
use simulation::Method;
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicUsize, Ordering},
        mpsc::{self, RecvTimeoutError},
    },
    thread,
    time::Duration,
};

/// How to run.
#[derive(Debug)]
pub struct Options<'a> {
    /// Where finished cases are kept.
    pub store: Store,
    /// Whether to ignore what is kept.
    pub fresh: bool,
    /// How many cases at once.
    pub threads: usize,
    /// How long a case may go without an answer. Its limit is the budget of evaluations; this is for code
    /// that never calls back.
    pub watchdog: Duration,
    /// Set from outside to stop after the cases in flight.
    pub stop: &'a AtomicBool,
}

/// Why a case ran or did not.
#[derive(Debug, Clone, PartialEq)]
pub enum Why {
    /// Its record was in the store.
    Reused,
    /// There was no record under its key.
    New,
    /// There was one, and it was damaged: how.
    Damaged(String),
    /// Records were to be ignored.
    Fresh,
}

/// One finished case.
#[derive(Debug)]
pub struct Finished {
    /// Its record.
    pub record: CaseRecord,
    /// Its key in the store.
    pub key: Key,
    /// Why it ran or did not.
    pub why: Why,
}

/// How far the run is.
#[derive(Debug, Clone, Copy)]
pub struct Progress {
    /// Cases finished.
    pub done: usize,
    /// How many of these were reused.
    pub reused: usize,
    /// Cases planned.
    pub total: usize,
}

/// The status of a case that the watchdog gave up: never stored.
pub const WATCHDOG: &str = "watchdog";

/// Runs the plan's cases, in the order of the plan; `tell` hears of each that is finished.
pub fn run(
    plan: &Arc<Plan>,
    options: &Options,
    tell: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Finished>, ExperimentError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|e| ExperimentError::Environment(e.to_string()))?;
    pool.install(|| solve_plants(plan))?;
    pool.install(|| fits::run(plan, options))?;
    pool.install(|| discoveries::run(plan, options))?;
    let total = plan.cases.len();
    let (done, reused) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let one = |index: usize| {
        if options.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let finished = finish(plan, index, options)?;
        reused.fetch_add(usize::from(finished.why == Why::Reused), Ordering::Relaxed);
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        tell(Progress { done, reused: reused.load(Ordering::Relaxed), total });
        Ok::<_, ExperimentError>(Some(finished))
    };
    // With many short cases and a few long ones, small pieces keep all threads busy to the end.
    let finished: Vec<Option<Finished>> = pool.install(|| {
        (0..total).into_par_iter().with_max_len(1).map(one).collect::<Result<_, _>>()
    })?;
    let finished: Vec<Finished> = finished.into_iter().flatten().collect();
    if finished.len() < total {
        return Err(ExperimentError::Interrupted { done: finished.len(), total });
    }
    Ok(finished)
}

/// Solves every plant before the first case: all at once, and a mistake of the TOML is told as one.
fn solve_plants(plan: &Plan) -> Result<(), ExperimentError> {
    let of = |study: &'_ Study| (0..study.points.len()).collect::<Vec<_>>();
    let plants = plan.studies.iter().filter(|s| s.plant.is_some() && s.reference.is_some());
    let all: Vec<(&Study, usize)> =
        plants.flat_map(|study| of(study).into_iter().map(move |point| (study, point))).collect();
    all.into_par_iter().with_max_len(1).try_for_each(|(study, point)| {
        let unanswered = |found| ExperimentError::Unanswered {
            experiment: plan.name.clone(),
            what: format!("study `{}` {}", study.name, study.points[point].label)
                .trim_end()
                .to_owned(),
            found,
        };
        study.exact(point).map(|_| ()).map_err(unanswered)
    })
}

fn finish(plan: &Arc<Plan>, index: usize, options: &Options) -> Result<Finished, ExperimentError> {
    let case = &plan.cases[index];
    let key = key(plan, case);
    let why = if options.fresh {
        Why::Fresh
    } else {
        match options.store.read(&key)? {
            Found::Record(record) => {
                return Ok(Finished { record: named(plan, case, *record), key, why: Why::Reused });
            }
            Found::Nothing => Why::New,
            Found::Damaged(how) => Why::Damaged(how),
        }
    };
    let record = watched(plan, index, options.watchdog)?;
    if record.row.status != WATCHDOG {
        options.store.write(&key, &record)?;
    }
    Ok(Finished { record: named(plan, case, record), key, why })
}

/// The hash of all that determines the case's numbers; its names in the experiment are not among it.
fn key(plan: &Plan, case: &Case) -> Key {
    let study = &plan.studies[case.study];
    let point = &study.points[case.point];
    let versions = format!("{:?}", integrate::versions());
    let reference = study.reference.as_ref().map_or("", |r| r.name);
    let plant = study.plant.map_or("", |p| p.name);
    Key::of(&[
        env!("DUHEM_SOURCES"),
        &versions,
        study.model.name,
        &format!("{:?}", point.parameters),
        &format!("{plant} {:?}", point.plant_parameters),
        &format!("{:?}", study.input),
        &format!("{:?} {:?} {:?}", study.initial, study.span, study.period),
        reference,
        case.solver.name(),
        &format!("{:?} {} {}", case.value, corners_name(case.corners), case.history),
        &study.budget.to_string(),
    ])
}

/// The record with its names in this experiment.
fn named(plan: &Plan, case: &Case, mut record: CaseRecord) -> CaseRecord {
    let study = &plan.studies[case.study];
    let point = &study.points[case.point];
    let rule =
        |r: &&crate::plan::Irreproducible| r.covers((case.study, point), case.solver, case.corners);
    record.row.study.clone_from(&study.name);
    record.row.point.clone_from(&point.label);
    let rule = plan.irreproducible.iter().find(rule);
    record.row.irreproducible = rule.map_or(String::new(), |r| r.name.clone());
    record.row.any_status = rule.is_some_and(|r| r.any_status);
    record
}

/// Runs the case on a thread of its own and waits for it no longer than `watchdog`.
/// A thread cannot be killed: one that gives no answer is left behind and ends with the program.
fn watched(
    plan: &Arc<Plan>,
    index: usize,
    watchdog: Duration,
) -> Result<CaseRecord, ExperimentError> {
    let (send, receive) = mpsc::channel();
    let theirs = Arc::clone(plan);
    let handle = thread::Builder::new()
        .spawn(move || {
            // Nobody listens any more if the watchdog was faster.
            let _ = send.send(compute(&theirs, &theirs.cases[index]));
        })
        .map_err(|e| ExperimentError::Environment(e.to_string()))?;
    match receive.recv_timeout(watchdog) {
        Ok(record) => record.map_err(ExperimentError::Bug),
        Err(RecvTimeoutError::Timeout) => Ok(given_up(&plan.cases[index], watchdog)),
        Err(RecvTimeoutError::Disconnected) => {
            let panic = handle.join().err();
            let words = panic.as_ref().and_then(|p| {
                let text = p.downcast_ref::<&str>().map(ToString::to_string);
                p.downcast_ref::<String>().cloned().or(text)
            });
            let case = &plan.cases[index];
            let words = words.unwrap_or_else(|| "no words".to_owned());
            Err(ExperimentError::Bug(format!(
                "case {index} ({}) panicked: {words}",
                case.solver.name()
            )))
        }
    }
}

fn given_up(case: &Case, watchdog: Duration) -> CaseRecord {
    let row = CaseRow {
        status: WATCHDOG.to_owned(),
        detail: format!("no answer within {} s", watchdog.as_secs_f64()),
        ..compare::named(case)
    };
    CaseRecord { row, history: None }
}

fn compute(plan: &Plan, case: &Case) -> Result<CaseRecord, String> {
    let study = &plan.studies[case.study];
    let exact = study.exact(case.point)?;
    let motion = study.motion(case.point)?;
    let run = match case.solver {
        Method::Solver(solver) => {
            let problem = motion.problem(study.initial.clone());
            let limits = Limits { evaluations: study.budget };
            let control = control(study, solver, case.value);
            integrate::solve(solver, &problem, &control, case.corners, &limits)
        }
        Method::Exact(method) | Method::Adaptive(method) => {
            let kinks = compare::kinks(motion.as_ref(), exact.reference());
            own::run(study, case, method, &kinks)?
        }
    };
    Ok(compare::record(plan, case, &run, motion.as_ref(), exact.reference()))
}

#[cfg(test)]
mod tests {
    use super::key;
    use crate::Plan;
    use std::{collections::BTreeSet, path::Path};

    const BASE: &str = r#"
title = "t"
paper = "p"
text = "x"
budget = 1000
[[study]]
name = "s"
title = "t"
model = { name = "dahl", f_c = 0.75, sigma = 1.5, gamma = 1.0 }
input = { shape = "sine", amplitude = 1.0, omega = 0.1 }
periods = 1
initial = [0.0]
solvers = ["dopri5"]
rtol = [1e-3]
corners = ["restart"]
reference = "dahl"
"#;

    fn of(text: &str) -> String {
        let plan = Plan::from_text("t", Path::new("t.toml"), text, &[]).unwrap();
        key(&plan, &plan.cases[0]).as_str().to_owned()
    }

    #[test]
    fn everything_that_determines_a_case_is_in_its_key() {
        let changes = [
            ("f_c = 0.75", "f_c = 0.76"),
            ("sigma = 1.5", "sigma = 1.6"),
            ("gamma = 1.0", "gamma = 1.1"),
            ("\"sine\"", "\"triangle\""),
            ("amplitude = 1.0", "amplitude = 1.1"),
            ("omega = 0.1", "omega = 0.2"),
            ("periods = 1", "periods = 2"),
            ("initial = [0.0]", "initial = [0.1]"),
            ("dopri5", "tsit45"),
            ("1e-3", "1e-4"),
            ("restart", "ignore"),
            ("budget = 1000", "budget = 2000"),
            (
                "corners =",
                "history = [{ solver = \"dopri5\", rtol = 1e-3, corners = \"restart\" }]\ncorners =",
            ),
        ];
        let mut keys = BTreeSet::from([of(BASE)]);
        for (from, to) in changes {
            let text = BASE.replacen(from, to, 1);
            assert_ne!(text, BASE, "no `{from}` to change");
            assert!(keys.insert(of(&text)), "`{to}` has the key of another case");
        }
    }

    const PLANT: &str = r#"
title = "t"
paper = "p"
text = "x"
[[study]]
name = "s"
title = "t"
model = { name = "dahl", f_c = 0.75, sigma = 1.5, gamma = 1.0 }
plant = { kind = "mass-spring", mass = 1.0, stiffness = 1.5 }
input = { shape = "sine", amplitude = 1.0, omega = 0.1 }
span = 10.0
solvers = ["dopri5"]
rtol = [1e-3]
corners = ["ignore"]
reference = "dahl"
"#;

    #[test]
    fn the_plant_and_the_span_of_a_case_are_in_its_key() {
        let mut keys = BTreeSet::from([of(PLANT)]);
        for (from, to) in [
            ("mass = 1.0", "mass = 2.0"),
            ("stiffness = 1.5", "stiffness = 1.6"),
            ("span = 10.0", "span = 11.0"),
            ("span = 10.0", "periods = 1"),
            ("reference", "initial = [0.1, 0.0, 0.0]\nreference"),
        ] {
            let text = PLANT.replacen(from, to, 1);
            assert_ne!(text, PLANT, "no `{from}` to change");
            assert!(keys.insert(of(&text)), "`{to}` has the key of another case");
        }
    }

    #[test]
    fn what_a_plant_cannot_be_is_said_with_its_key() {
        for (from, to, key) in [
            ("\"mass-spring\"", "\"mas-spring\"", "study[0].plant.kind"),
            ("mass = 1.0", "mass = -1.0", "study[0].plant.mass"),
            ("mass = 1.0", "mas = 1.0", "study[0].plant.mas"),
            (", stiffness = 1.5", "", "study[0].plant.stiffness"),
            ("span = 10.0", "span = -1.0", "study[0].span"),
            ("span = 10.0", "span = 10.0\nperiods = 1", "study[0].span"),
            ("span = 10.0", "", "study[0].periods"),
            ("span = 10.0", "span = 10.0\nsweep = { mas = [1.0] }", "study[0].sweep.mas"),
            ("span = 10.0", "span = 10.0\nsweep = { mass = [1.0] }", "study[0].sweep.mass"),
            ("span = 10.0", "span = 10.0\ninitial = [0.0]", "study[0].initial"),
            ("reference = \"dahl\"", "reference = \"dal\"", "study[0].reference"),
        ] {
            let text = PLANT.replacen(from, to, 1);
            assert_ne!(text, PLANT, "no `{from}` to change");
            let refused = Plan::from_text("t", Path::new("t.toml"), &text, &[]);
            let message = refused.map(|_| ()).expect_err(to).to_string();
            assert!(message.contains(&format!("{key}: ")), "`{to}`: {message}");
        }
    }

    #[test]
    fn names_and_texts_are_not_in_the_key() {
        for (from, to) in [
            ("name = \"s\"", "name = \"r\""),
            ("title = \"t\"", "title = \"u\""),
            ("text = \"x\"", "text = \"y\""),
        ] {
            assert_eq!(of(&BASE.replacen(from, to, 1)), of(BASE), "{to}");
        }
    }
}
