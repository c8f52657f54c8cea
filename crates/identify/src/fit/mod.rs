//! A rig's free parameters, fitted to a record by simulated motions.
//!
//! The record is simulated in one run, or in windows where that drifts, and in closed loop where the rig
//! declares its controller. The state at the start of each window is estimated with the parameters. What the
//! fit minimises is the sum of the squared residuals of every channel, each divided by the channel's noise.

pub mod binding;
mod blocks;
mod bootstrap;
pub mod data;
mod imposed;
mod interval;
mod models;
pub mod newton;
pub mod problem;
pub mod search;
mod starts;
pub mod window;

pub use data::{Data, Seen};
pub use models::{Candidate, candidates};

use crate::Rig;
use binding::Free;
use interval::{Interval, Spread};
use problem::{Problem, Weights};
use search::{End, Found, TO_THE_END};

/// What the fit is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The length of a window [s]; found from the record if not given.
    pub window: Option<f64>,
    /// How many starts beside the nominal one.
    pub starts: usize,
    /// The seed of the starts and of the bootstrap.
    pub seed: u64,
    /// Whether intervals by profile likelihood are asked for.
    pub profiles: bool,
    /// How many times the blocks are drawn for the bootstrap; none if 0.
    pub bootstrap: usize,
    /// Whether the other friction models are fitted, too.
    pub models: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { window: None, starts: 4, seed: 1, profiles: true, bootstrap: 1000, models: true }
    }
}

/// Why nothing could be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// The record is too short.
    #[error(
        "the record has {found} samples: expected at least {expected}, or fewer free parameters"
    )]
    TooShort {
        /// How many samples there are.
        found: usize,
        /// How many are needed.
        expected: usize,
    },
    /// Nothing is free.
    #[error("no parameter is free: name some under [fit] free, as free = [\"f_c\"]")]
    NothingFree,
    /// The nominal model has no motion on this record, nor has any start near it.
    #[error(
        "the model cannot be simulated on this record from its nominal parameters: look at their units"
    )]
    NoMotion,
}

/// How the record is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// The motion is imposed, and the force follows.
    Imposed,
    /// In one run from its first sample to its last.
    OneRun,
    /// In windows, each from its own start.
    Windows,
    /// With the controller that made it, in one run.
    ClosedLoop,
}

/// A fitted parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Its name.
    pub name: String,
    /// Its nominal value [its unit].
    pub given: f64,
    /// Its fitted value.
    pub found: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Whether it lies further from its nominal value than two standard errors and one per cent.
    pub moved: bool,
    /// Whether the record identifies it: the 95 % interval is closed on both sides, or was not asked for.
    pub identified: bool,
    /// The 95 % interval by profile likelihood; a side that is not there was not found.
    pub interval: [Option<f64>; 2],
    /// The 95 % interval from the standard error.
    pub asymptotic: [f64; 2],
    /// The 95 % interval of the bootstrap over blocks.
    pub bootstrap: Option<[f64; 2]>,
    /// Whether it ended as far from its nominal size as it may go.
    pub at_bound: bool,
}

/// The misfit of one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Misfit {
    /// The channel.
    pub channel: String,
    /// Root mean square of the residual with the nominal parameters [the channel's unit].
    pub before: f64,
    /// With the fitted ones.
    pub after: f64,
    /// The noise that the channel itself shows.
    pub noise: f64,
}

/// A fit.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The free parameters.
    pub parameters: Vec<Estimate>,
    /// Their correlations, row by row.
    pub correlation: Vec<Vec<f64>>,
    /// The misfit of every channel.
    pub gap: Vec<Misfit>,
    /// How the record was simulated, and in how many windows.
    pub way: Way,
    /// How many windows there are.
    pub windows: usize,
    /// How the search ended.
    pub end: End,
    /// How many simulations of the whole record the search took, and how many with derivatives.
    pub simulations: [usize; 2],
    /// The variance of the residuals in units of the noise, 1 where model and noise are right.
    pub variance: f64,
    /// The correlation of neighbouring residuals.
    pub neighbours: f64,
    /// The largest change of a parameter, in standard errors, when the steps are ten times more accurate.
    pub step_error: f64,
    /// The other friction models, the best first.
    pub models: Vec<Candidate>,
    /// The rig with the fitted values.
    pub rig: Rig,
}

/// The steps' tolerance of a fit, of the spans of the channels.
const TOLERANCE: f64 = 1e-5;

/// A step may be wrong by this share of the noise.
const BELOW_NOISE: f64 = 0.1;

/// The change of a parameter by shorter steps that is not worth taking them [standard errors].
const STEPS_MATTER: f64 = 0.1;

/// So many times the steps may be made ten times as accurate.
const FINER: usize = 3;

/// A single run must not be worse than windows by more than this to be preferred, for it says more [1].
const AS_GOOD: f64 = 1.2;

/// Fits what is free in `rig` to `data`.
pub fn fit(rig: &Rig, data: &Data, options: &Options) -> Result<Fit, FitError> {
    let problem = problem(rig, data)?;
    let (problem, found, way) = best_way(problem, options)?;
    let before = start_misfit(&problem);
    let Minimum { problem, found, local, spread, step_error } = settled(problem, found);
    let profiles = if options.profiles {
        interval::profiles(&problem, &found, &spread)
    } else {
        vec![[None, None]; found.x.len()]
    };
    let drawn = bootstrap::draw(&problem, &found, &local, options);
    let fitted = fitted(&problem, &found);
    let models = if options.models { models::compare(&fitted, data, options) } else { Vec::new() };
    Ok(Fit {
        parameters: estimates(&problem, &found, &spread, (&profiles, &drawn, options.profiles)),
        correlation: correlation(&spread),
        gap: gap(&problem, &before, &found),
        way,
        windows: problem.windows.len(),
        end: found.end,
        simulations: found.simulations,
        variance: spread.variance,
        neighbours: spread.neighbours,
        step_error,
        models,
        rig: fitted,
    })
}

/// Where a fit ended, with steps short enough for it.
struct Minimum<'a> {
    problem: Problem<'a>,
    found: Found,
    local: newton::Local,
    spread: Spread,
    step_error: f64,
}

/// The minimum near where a search ended; the steps get shorter until they do not matter to it.
fn settled<'a>(mut problem: Problem<'a>, found: Found) -> Minimum<'a> {
    let mut found = newton::settle(&problem, found, None);
    for round in 0.. {
        let local = newton::look(&problem, &found.x, &found.pieces);
        let spread = interval::spread(&problem, &found, &local);
        let step_error = step_error(&problem, &found, &spread);
        if step_error < STEPS_MATTER || round == FINER {
            return Minimum { problem, found, local, spread, step_error };
        }
        problem.tolerance *= 0.1;
        let spent = found.simulations;
        let from = (found.x.as_slice(), Some(found.pieces.as_slice()));
        found = newton::settle(&problem, search::search(&problem, from, None, &TO_THE_END), None);
        for (total, before) in found.simulations.iter_mut().zip(spent) {
            *total += before;
        }
    }
    unreachable!()
}

/// The problem with all samples in one run, its weights the channels' noises.
fn problem<'a>(rig: &'a Rig, data: &'a Data) -> Result<Problem<'a>, FitError> {
    let free = binding::free(rig, data.force(rig), data.speed().max(1e-9));
    if free.is_empty() {
        return Err(FitError::NothingFree);
    }
    let expected = free.len() + 8;
    if data.time.len() < expected {
        return Err(FitError::TooShort { found: data.time.len(), expected });
    }
    let noise = |seen: Option<&Seen>| seen.map_or(1.0, |s| s.noise.max(f64::MIN_POSITIVE));
    let weights = Weights {
        displacement: noise(data.displacement.as_ref()),
        velocity: noise(data.velocity.as_ref()),
        input: data::noise(&data.input).max(1e-9),
        force: noise(data.force.as_ref()),
        loads: [0, 1].map(|i| noise(data.loads.as_ref().map(|l| &l[i]))),
    };
    let closed_loop = rig.controller.is_some() && !data.reference.is_empty();
    let windows = blocks::whole(data);
    let tolerance = tolerance(data);
    Ok(Problem { rig, data, free, windows, closed_loop, weights, tolerance })
}

/// The steps' tolerance [1]: below the noise, so that the misfit is smooth on its scale.
fn tolerance(data: &Data) -> f64 {
    let seen = [&data.displacement, &data.velocity].into_iter().flatten();
    let least = seen.map(|seen| seen.noise / seen.span.max(f64::MIN_POSITIVE)).fold(1.0, f64::min);
    (BELOW_NOISE * least).clamp(1e-4 * TOLERANCE, TOLERANCE)
}

/// The way in which the record is simulated, and the minimum found so.
fn best_way<'a>(
    whole: Problem<'a>,
    options: &Options,
) -> Result<(Problem<'a>, Found, Way), FitError> {
    let data = whole.data;
    let one = if whole.data.force.is_some() {
        Some(Way::Imposed)
    } else if whole.closed_loop {
        Some(Way::ClosedLoop)
    } else {
        None
    };
    if let Some(way) = one {
        let (problem, found) = weighed(whole, options)?;
        return Ok((problem, found, way));
    }
    let windows = Problem { windows: blocks::blocks(data, options.window), ..whole.clone() };
    if options.window.is_some() {
        let (problem, found) = weighed(windows, options)?;
        return Ok((problem, found, Way::Windows));
    }
    let by_windows = weighed(windows, options)?;
    let single = starts::best(&whole, options, Some(&by_windows.1.x));
    let mean = |found: &Found| {
        found.misfit / found.pieces.iter().map(|p| p.residuals.len()).sum::<usize>().max(1) as f64
    };
    let unweighed = search::search(
        &Problem { windows: by_windows.0.windows.clone(), ..whole.clone() },
        (&by_windows.1.x, Some(&by_windows.1.pieces)),
        None,
        &TO_THE_END,
    );
    if mean(&single) <= AS_GOOD * mean(&unweighed) {
        let (problem, found) = reweighed(whole, single);
        return Ok((problem, found, Way::OneRun));
    }
    Ok((by_windows.0, by_windows.1, Way::Windows))
}

/// The best of several starts, then once more with each channel weighed by what its residuals are.
fn weighed<'a>(problem: Problem<'a>, options: &Options) -> Result<(Problem<'a>, Found), FitError> {
    let found = starts::best(&problem, options, None);
    if found.end == End::NoMotion {
        return Err(FitError::NoMotion);
    }
    Ok(reweighed(problem, found))
}

/// Where a channel's residuals are larger than its noise the model lacks something there, and the channel
/// counts for less.
fn reweighed<'a>(problem: Problem<'a>, found: Found) -> (Problem<'a>, Found) {
    let rms = residuals(&problem, &found);
    let mut weights = problem.weights;
    let mut worse = false;
    for (weight, (_, rms)) in weights_of(&problem, &mut weights).into_iter().zip(&rms) {
        if *rms > 1.3 * *weight {
            *weight = *rms;
            worse = true;
        }
    }
    let problem = Problem { weights, ..problem };
    if !worse {
        return (problem, found);
    }
    let from = (found.x.as_slice(), Some(found.pieces.as_slice()));
    let again = search::search(&problem, from, None, &TO_THE_END);
    (problem, again)
}

/// The weights of the channels there are, in the order of [`residuals`].
fn weights_of<'w>(problem: &Problem<'_>, weights: &'w mut Weights) -> Vec<&'w mut f64> {
    if problem.data.force.is_some() {
        return vec![&mut weights.force];
    }
    let mut all = vec![&mut weights.displacement];
    if problem.data.velocity.is_some() {
        all.push(&mut weights.velocity);
    }
    if problem.closed_loop {
        all.push(&mut weights.input);
    }
    all
}

/// The root mean square of every channel's residual [its unit], by the channel's name.
fn residuals(problem: &Problem<'_>, found: &Found) -> Vec<(String, f64)> {
    let channels = problem.channels();
    let mut weights = problem.weights;
    let sizes: Vec<f64> = weights_of(problem, &mut weights).into_iter().map(|w| *w).collect();
    let names: Vec<&str> = if problem.data.force.is_some() {
        vec!["force"]
    } else {
        [
            ("displacement", true),
            ("velocity", problem.data.velocity.is_some()),
            ("input", problem.closed_loop),
        ]
        .into_iter()
        .filter_map(|(name, there)| there.then_some(name))
        .collect()
    };
    (0..channels)
        .map(|c| {
            let (mut sum, mut count) = (0.0, 0);
            for (window, piece) in problem.windows.iter().zip(&found.pieces) {
                for i in 0..window.len() {
                    sum += piece.residuals[i * channels + c].powi(2);
                    count += 1;
                }
            }
            (names[c].to_owned(), sizes[c] * (sum / f64::from(count.max(1))).sqrt())
        })
        .collect()
}

/// The nominal parameters' misfit, in the same windows.
fn start_misfit(problem: &Problem<'_>) -> Found {
    let x: Vec<f64> = starts::nominal(problem);
    let pieces = problem.pieces(&x, None);
    Found { x, misfit: f64::NAN, pieces, end: End::OutOfPatience, simulations: [1, 0] }
}

fn gap(problem: &Problem<'_>, before: &Found, after: &Found) -> Vec<Misfit> {
    let noises = [&problem.data.displacement, &problem.data.velocity, &problem.data.force];
    residuals(problem, before)
        .into_iter()
        .zip(residuals(problem, after))
        .map(|((channel, before), (_, after))| {
            let noise = match channel.as_str() {
                "displacement" => noises[0].as_ref().map_or(0.0, |s| s.noise),
                "velocity" => noises[1].as_ref().map_or(0.0, |s| s.noise),
                "force" => noises[2].as_ref().map_or(0.0, |s| s.noise),
                _ => data::noise(&problem.data.input),
            };
            Misfit { channel, before, after, noise }
        })
        .collect()
}

/// The rig with the values at the minimum.
fn fitted(problem: &Problem<'_>, found: &Found) -> Rig {
    let mut rig = problem.rig.clone();
    for (i, free) in problem.free.iter().enumerate() {
        binding::set(&mut rig, &free.name, problem.value(i, &found.x));
    }
    rig
}

fn correlation(spread: &Spread) -> Vec<Vec<f64>> {
    let c = &spread.covariance;
    (0..c.nrows())
        .map(|i| (0..c.nrows()).map(|j| c[(i, j)] / (c[(i, i)] * c[(j, j)]).sqrt()).collect())
        .collect()
}

fn estimates(
    problem: &Problem<'_>,
    found: &Found,
    spread: &Spread,
    (profiles, drawn, asked): (&[Interval], &[Option<[f64; 2]>], bool),
) -> Vec<Estimate> {
    let one = |(i, free): (usize, &Free)| {
        let at = |x: f64| {
            let mut there = found.x.clone();
            there[i] = x;
            problem.value(i, &there)
        };
        let value = at(found.x[i]);
        let error = spread.covariance[(i, i)].sqrt() * spread.inflation[i];
        let slope = free.slope(free.value(found.x[i])).abs();
        let standard_error = slope * error;
        let mut interval = profiles[i].map(|x| x.map(at));
        if matches!(free.scale, binding::Scale::InverseSquare(_)) {
            interval.reverse();
        }
        Estimate {
            name: free.name.clone(),
            given: free.given,
            found: value,
            standard_error,
            moved: (value - free.given).abs() > (2.0 * standard_error).max(0.01 * free.given.abs()),
            identified: !asked || interval.iter().all(Option::is_some),
            interval,
            asymptotic: [-1.0, 1.0].map(|s| value + s * interval::NORMAL * standard_error),
            bootstrap: drawn[i],
            at_bound: free.at_bound(free.value(found.x[i])),
        }
    };
    problem.free.iter().enumerate().map(one).collect()
}

/// The Gauss–Newton step that ten times more accurate steps ask for, in standard errors.
fn step_error(problem: &Problem<'_>, found: &Found, spread: &Spread) -> f64 {
    let finer = Problem { tolerance: 0.1 * problem.tolerance, ..problem.clone() };
    let starts: Vec<_> = found.pieces.iter().map(|p| p.start).collect();
    let pieces: Vec<_> =
        finer.windows.iter().zip(&starts).map(|(w, s)| finer.piece(&found.x, w, *s)).collect();
    let gradient = |problem: &Problem<'_>, pieces: &[problem::Piece]| {
        newton::look(problem, &found.x, pieces).gradient
    };
    let change = gradient(&finer, &pieces) - gradient(problem, &found.pieces);
    let step = &spread.covariance * change / spread.variance;
    (0..step.len()).map(|i| (step[i] / spread.covariance[(i, i)].sqrt()).abs()).fold(0.0, f64::max)
}
