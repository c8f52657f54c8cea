//! An ensemble timed: the rig of P6 with its friction's parameters off by up to 30 %, on one thread and on
//! several, beside a loop of plain arithmetic on the same threads.
//!
//! `ensemble [--parameters FILE] [--runs N] [--threads N]`, started by `cargo xtask bench ensemble`, writes
//! JSON, a line for each tolerance.

use cpu_time::ProcessTime;
use integrate::{Limits, Outcome};
use serde_json::{Value, json};
use simulation::{
    Delivered, DrivenPlant, Ensemble, Task,
    anchors::{Anchor, anchors, error, median, rigs, rigs_of},
    best,
    plant_reference::solve_located,
};
use std::{error::Error, fs, hint::black_box, io::Write, process::ExitCode, time::Instant};

/// The tolerances that are tried.
const RTOLS: [f64; 6] = [1e-3, 3e-4, 1e-4, 1e-5, 1e-6, 1e-8];
/// Repeats of each measurement, of which the median is told.
const REPEATS: usize = 5;
/// Every so many runs are checked against the independent method.
const CHECKED: usize = 20;
/// A table that cannot be read.
const INPUT: u8 = 4;
/// Our own mistake.
const BUG: u8 = 70;

fn main() -> ExitCode {
    match all() {
        Ok(()) => ExitCode::SUCCESS,
        Err((code, words)) => {
            let _ = tell(&json!({ "wrong": words }));
            ExitCode::from(code)
        }
    }
}

fn bug(why: impl Error) -> (u8, String) {
    (BUG, why.to_string())
}

fn all() -> Result<(), (u8, String)> {
    let mut file = None;
    let (mut runs, mut threads) = (1000, 2);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || arguments.next().and_then(|text| text.parse().ok());
        match argument.as_str() {
            "--parameters" => file = arguments.next(),
            "--runs" => runs = number().unwrap_or(runs),
            "--threads" => threads = number().unwrap_or(threads),
            _ => {}
        }
    }
    let tasks = match &file {
        None => rigs(runs).map_err(bug)?,
        Some(file) => {
            let refuse = |why: String| (INPUT, format!("{file}: {why}"));
            let text = fs::read_to_string(file).map_err(|why| refuse(why.to_string()))?;
            let mut tasks = rigs_of(&text).map_err(refuse)?;
            tasks.truncate(runs);
            tasks
        }
    };
    let rig = anchors().map_err(bug)?.into_iter().find(|anchor| anchor.problem == "P6");
    let rig = rig.ok_or((BUG, "P6 is no anchor".to_owned()))?;
    let answers = answers(&tasks, &rig.grid)?;
    tell(&json!({ "checked": checked(&tasks, &rig, &answers)? }))?;
    let plain = speed_up(threads, &|threads| {
        let work = |(): &mut (), i: usize| black_box(plain(i));
        integrate::ensemble(threads, tasks.len(), || (), work).map(drop)
    })?;
    for rtol in RTOLS {
        let row = row((&tasks, &rig.grid), rtol, &answers, (threads, plain))?;
        tell(&json!({ "ensemble": row }))?;
    }
    Ok(())
}

/// q of every run on the grid at the tightest tolerance there is use for.
fn answers(tasks: &[Task], grid: &[f64]) -> Result<Vec<Vec<f64>>, (u8, String)> {
    let asked = Ensemble { rtol: 1e-11, limits: Limits::default(), grid, threads: 2 };
    let ran = asked.run(tasks, |_, states| displacements(states));
    let ran = ran.map_err(|why| (BUG, why))?;
    ran.into_iter().map(|one| one.map(|(_, q)| q).map_err(bug)).collect()
}

fn displacements(states: &[f64]) -> Vec<f64> {
    states.iter().step_by(3).copied().collect()
}

/// The largest difference of those answers from the independent method's, over every twentieth run.
fn checked(tasks: &[Task], rig: &Anchor, answers: &[Vec<f64>]) -> Result<f64, (u8, String)> {
    let mut worst = 0.0_f64;
    for (task, answer) in tasks.iter().zip(answers).step_by(CHECKED) {
        let plant = task.plant.ok_or((BUG, "the rig is a plant".to_owned()))?;
        let friction = task.friction().map_err(bug)?;
        let motion = DrivenPlant::new(friction, plant, task.input.clone(), task.span);
        let located = solve_located(&motion, &task.y0, 1e-11);
        let right: Vec<f64> = rig.grid.iter().map(|t| located.path.q(*t)).collect();
        worst = worst.max(error(answer, &right));
    }
    Ok(worst)
}

type Told = Vec<Result<(Delivered, f64), simulation::NotHere>>;

/// One tolerance: errors and failures of all runs, time per run and core, speed-up by threads.
fn row(
    (tasks, grid): (&[Task], &[f64]),
    rtol: f64,
    answers: &[Vec<f64>],
    (threads, plain): (usize, f64),
) -> Result<Value, (u8, String)> {
    let limits = Limits::default();
    let look = |i: usize, states: &[f64]| error(&displacements(states), &answers[i]);
    let ask = |threads| Ensemble { rtol, limits, grid, threads };
    let told: Told = ask(1).run(tasks, look).map_err(|why| (BUG, why))?;
    let solved = |one: &Result<(Delivered, f64), _>| match one {
        Ok((delivered, error)) if delivered.outcome == Outcome::Solved => Some(*error),
        _ => None,
    };
    let mut errors: Vec<f64> = told.iter().filter_map(solved).collect();
    errors.sort_by(f64::total_cmp);
    let evaluations: u64 = told.iter().flatten().map(|(d, _)| d.work.evaluations).sum();
    let mut times = Vec::new();
    for _ in 0..REPEATS {
        let start = ProcessTime::try_now().map_err(bug)?;
        ask(1).run(tasks, |_, _| ()).map_err(|why| (BUG, why))?;
        times.push(start.elapsed().as_secs_f64() / tasks.len() as f64);
    }
    let faster = speed_up(threads, &|threads| ask(threads).run(tasks, |_, _| ()).map(drop))?;
    let failed = tasks.len() - errors.len();
    let name = tasks.first().and_then(|task| best(task).ok()).map(|(own, _)| own.name);
    Ok(json!({
        "problem": "ensemble", "parameter": null, "solver": name, "ours": true,
        "control": { "rtol": rtol }, "restart": false, "error": errors.get(errors.len() / 2),
        "cpu_s": median(&times), "evaluations": evaluations,
        "status": if failed == 0 { "solved".to_owned() } else { format!("{failed} failed") },
        "worst": errors.last(), "runs": tasks.len(), "failed": failed, "threads": threads,
        "speed_up": faster, "plain_speed_up": plain,
    }))
}

/// How much less time so many threads take than one, by the clock on the wall: the median of repeats in turn.
#[expect(clippy::disallowed_methods, reason = "the clock is what this program is for")]
fn speed_up(
    threads: usize,
    run: &dyn Fn(usize) -> Result<(), String>,
) -> Result<f64, (u8, String)> {
    let timed = |threads| {
        let start = Instant::now();
        run(threads).map_err(|why| (BUG, why))?;
        Ok::<f64, (u8, String)>(start.elapsed().as_secs_f64())
    };
    let mut ratios = Vec::new();
    for _ in 0..REPEATS {
        let one = timed(1)?;
        ratios.push(one / timed(threads)?);
    }
    median(&ratios).ok_or((BUG, "no repeats".to_owned()))
}

/// A few hundred microseconds of arithmetic that waits for no memory.
fn plain(seed: usize) -> f64 {
    let mut x = 0.1 + 1e-6 * seed as f64;
    for _ in 0..100_000 {
        x = 3.9 * x * (1.0 - x);
    }
    x
}

fn tell(what: &Value) -> Result<(), (u8, String)> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{what}").and_then(|()| out.flush()).map_err(bug)
}
