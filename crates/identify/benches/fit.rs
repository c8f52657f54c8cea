//! The fit of six LuGre parameters to the record of P6, timed: 50 s at 100 Hz, angle and velocity with noise of
//! one per cent of their largest value, from one start.
//!
//! `fit [--repeats N]`, started by `cargo xtask bench fit`, writes JSON, a line for each start.

use cpu_time::ProcessTime;
use duhem::Parameters;
use identify::{
    Channel, Friction, Hold, Rig, Shaft,
    fit::{
        Data, Seen, binding, newton,
        problem::{Problem, Weights},
        search::{End, Found, TO_THE_END, search},
        window::Window,
        work::Work,
    },
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde_json::{Value, json};
use simulation::{
    DrivenPlant,
    anchors::{Anchor, anchors, median},
    plant_reference::solve_located,
};
use std::{collections::BTreeMap, error::Error, io::Write, process::ExitCode, sync::Arc};

/// What is fitted.
const FREE: [&str; 6] = ["f_c", "f_s", "v_s", "sigma_0", "sigma_1", "sigma_2"];
/// The starts: what every parameter is multiplied with.
const STARTS: [(&str, [f64; 6]); 2] = [("alt", [0.7, 1.3, 0.7, 1.3, 0.7, 1.3]), ("all", [1.3; 6])];
/// The noise, of the channel's largest value.
const NOISE: f64 = 0.01;
/// The steps' tolerance, that of `identify::fit::fit`.
const TOLERANCE: f64 = 1e-5;
/// Our own mistake.
const BUG: u8 = 70;

/// A record with what it was made from.
struct Record {
    data: Data,
    rig: Rig,
    truth: [Vec<f64>; 2],
    noise: [f64; 2],
}

fn main() -> ExitCode {
    match all() {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            let _ = tell(&json!({ "wrong": why.to_string() }));
            ExitCode::from(BUG)
        }
    }
}

fn all() -> Result<(), Box<dyn Error>> {
    let mut repeats = 5;
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--repeats" {
            repeats = arguments.next().and_then(|text| text.parse().ok()).unwrap_or(repeats);
        }
    }
    let anchor = anchors()?.into_iter().find(|anchor| anchor.problem == "P6");
    let record = record(&anchor.ok_or("P6 is no anchor")?)?;
    // One thread, as the peers have.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    for (name, factors) in STARTS {
        tell(
            &json!({ "fit": pool.install(|| timed(name, factors, &record, repeats).map_err(|why| why.to_string()))? }),
        )?;
    }
    Ok(())
}

/// The fit from one start, as often as asked for.
fn timed(
    name: &str,
    factors: [f64; 6],
    record: &Record,
    repeats: usize,
) -> Result<Value, Box<dyn Error>> {
    let mut rig = record.rig.clone();
    for (key, factor) in FREE.iter().zip(factors) {
        let given = binding::value(&rig, key).ok_or("no such parameter")?;
        binding::set(&mut rig, key, given * factor);
    }
    let (mut times, mut last) = (Vec::new(), None);
    for _ in 0..repeats.max(1) {
        let start = ProcessTime::try_now()?;
        let fitted = fitted(&rig, &record.data);
        times.push(start.elapsed().as_secs_f64());
        last = Some(fitted);
    }
    let (found, values) = last.ok_or("no repeats")?;
    let off: BTreeMap<&str, f64> = FREE
        .iter()
        .zip(&values)
        .map(|(key, value)| {
            (*key, value / binding::value(&record.rig, key).unwrap_or(f64::NAN) - 1.0)
        })
        .collect();
    Ok(json!({
        "start": name, "cpu_s": median(&times), "misfit_of_the_truths": misfit(record, &found),
        "simulations": found.simulations[0], "with_derivatives": found.simulations[1],
        "end": match found.end {
            End::Converged => "converged",
            End::Stalled => "stalled",
            End::OutOfPatience => "out of patience",
            End::NoMotion => "no motion",
        },
        "off": off, "repeats": times.len(),
    }))
}

/// One search from the nominal values to the minimum, all of what `fit` does for it inside.
fn fitted(rig: &Rig, data: &Data) -> (Found, Vec<f64>) {
    let free = binding::free(rig, data.force(rig), data.speed());
    let noise = |seen: &Option<Seen>| seen.as_ref().map_or(1.0, |seen| seen.noise);
    let weights = Weights {
        displacement: noise(&data.displacement),
        velocity: noise(&data.velocity),
        input: 1.0,
        force: 1.0,
        loads: [1.0; 2],
    };
    let windows = vec![Window::new(data, 0, data.time.len())];
    // F_S moves as what it is above F_C; all variables begin at 1.
    let x = vec![1.0; free.len()];
    let problem = Problem {
        rig,
        data,
        speed: data.speed(),
        free,
        windows,
        closed_loop: false,
        memory: 1.0 / 1e3,
        shares: Vec::new(),
        priors: Vec::new(),
        weights,
        spread: std::borrow::Cow::default(),
        tolerance: TOLERANCE,
        course: Arc::default(),
        slopes: 0.0,
        bends: false,
        work: Work::default(),
    };
    let found = newton::settle(&problem, search(&problem, (&x, None), None, &TO_THE_END), None);
    let values = (0..found.x.len()).map(|i| problem.value(i, &found.x)).collect();
    (found, values)
}

/// The sum of the squared residuals, each channel's divided by its true noise, of that of the truth.
fn misfit(record: &Record, found: &Found) -> f64 {
    let seen = [&record.data.displacement, &record.data.velocity];
    let motion = &found.pieces[0].motion;
    let sum = |of: [&[f64]; 2]| -> f64 {
        (0..2)
            .map(|c| {
                let seen = seen[c].as_ref().map_or(&[][..], |seen| &seen.values);
                let square = |(a, b): (&f64, &f64)| ((a - b) / record.noise[c]).powi(2);
                of[c].iter().zip(seen).map(square).sum::<f64>()
            })
            .sum()
    };
    sum([&motion.q, &motion.v]) / sum([&record.truth[0], &record.truth[1]])
}

/// The record of P6, by the method that locates its events.
fn record(anchor: &Anchor) -> Result<Record, Box<dyn Error>> {
    let task = &anchor.task;
    let plant = task.plant.ok_or("P6 is a plant")?;
    let motion = DrivenPlant::new(task.friction()?, plant, task.input.clone(), task.span);
    let path = solve_located(&motion, &task.y0, 1e-11).path;
    let time: Vec<f64> = (0..5001).map(|i| 0.01 * f64::from(i)).collect();
    let truth: [Vec<f64>; 2] =
        [time.iter().map(|t| path.q(*t)).collect(), time.iter().map(|t| path.v(*t)).collect()];
    let rig = rig(&task.parameters);
    let input = time.iter().map(|t| task.input.u(*t)).collect();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let noise = [0, 1].map(|c| NOISE * truth[c].iter().fold(0.0, |m: f64, v| m.max(v.abs())));
    let mut noisy = |name: &str, c: usize| {
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let values = truth[c].iter().map(|v| v + noise[c] * draw()).collect();
        Seen::new(name, values, 0.0)
    };
    let angle = noisy("angle", 0);
    let velocity = Some(noisy("velocity", 1));
    let data = Data { velocity, ..Data::driven(time, input, Hold::Linear, angle) };
    Ok(Record { data, rig, truth, noise })
}

/// The paper's rig with this friction.
fn rig(friction: &Parameters) -> Rig {
    let plant = [
        ("inertia", 3e-4),
        ("radius", 0.0254),
        ("k_1", 2.0),
        ("k_2", 2.0),
        ("f_10", 0.01),
        ("f_20", 0.01),
        ("motor_constant", 16.5),
        ("gear_ratio", 68.8),
    ];
    let current = Channel {
        column: "current_a".to_owned(),
        unit: None,
        quantum: None,
        at: Shaft::Drum,
        hold: None,
    };
    Rig {
        title: "the rig of P6".to_owned(),
        kind: "drum",
        plant: plant.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect(),
        friction: Friction { name: "lugre".to_owned(), parameters: friction.clone(), sigma_2: 0.0 },
        free: FREE.map(str::to_owned).to_vec(),
        channels: BTreeMap::from([("current".to_owned(), current)]),
        controller: None,
        effects: Vec::new(),
    }
}

fn tell(what: &Value) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{what}").and_then(|()| out.flush())
}
