//! A rig's free parameters, fitted to a record by simulated motions.
//!
//! The record is simulated in one run, or in windows where that drifts, and in closed loop where the rig
//! declares its controller. The state at the start of each window is estimated with the parameters. What the
//! fit minimises is the sum of the squared residuals of every channel, each divided by the channel's noise.

mod begin;
pub mod binding;
pub mod blocks;
mod bootstrap;
mod colour;
pub mod data;
pub mod descent;
mod displacement;
mod estimate;
pub mod floor;
mod follow;
mod gap;
pub mod hold;
mod imposed;
mod interval;
mod linked;
mod loads;
pub mod models;
pub mod newton;
mod piece;
pub mod problem;
pub mod search;
pub mod shaken;
mod slopes;
pub mod starts;
mod way;
mod weights;
pub mod whitening;
pub mod window;
pub mod work;

pub use data::{Data, Seen};
pub use displacement::{Course, corners};
pub use estimate::Estimate;
pub use gap::{Misfit, Simulated, Trace, moves, simulate};
pub use models::{Candidate, candidates};

use crate::{Rig, known};
use estimate::{correlation, estimates};
use gap::{gap, traces};
use interval::{Interval, Spread};
use problem::{Problem, Weights};
use search::{End, Found, TO_THE_END};
use std::{borrow::Cow, sync::Arc};
use way::best_way;

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
    /// A channel that the model is to follow does not change.
    #[error(
        "channel {channel} is the same from the first sample to the last: expected a record in which it moves; \
         see whether its sensor was connected, or leave it out of the rig file if it may be missing"
    )]
    Still {
        /// The channel.
        channel: String,
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
    /// Every channel over time, as measured, and as simulated before and after the fit.
    pub traces: Vec<Trace>,
    /// The rig with the fitted values.
    pub rig: Rig,
}

/// The steps' tolerance of a fit, of the spans of the channels.
const TOLERANCE: f64 = 1e-5;

/// A step may be wrong by this share of the noise.
const BELOW_NOISE: f64 = 0.01;

/// The change of a parameter by shorter steps that is not worth taking them [standard errors].
const STEPS_MATTER: f64 = 0.1;

/// So many times the steps may be made ten times as accurate.
const FINER: usize = 3;

/// Fits what is free in `rig` to `data`.
pub fn fit(rig: &Rig, data: &Data, options: &Options) -> Result<Fit, FitError> {
    // The noise of a displacement that is imposed shakes the simulated bristle, which then seems weaker than it is.
    let data = &*known::motion(data);
    let problem = problem(rig, data)?;
    let (problem, found, way) = best_way(problem, options)?;
    let before = start_misfit(&problem);
    let (minimum, profiles) = profiled(settled(problem, found), options);
    let Minimum { problem, found, local, spread, step_error } = minimum;
    let drawn = bootstrap::draw(&problem, &found, &local, options);
    let fitted = fitted(&problem, &found);
    let models = if options.models {
        models::compare(&fitted, data, options, problem.weights)
    } else {
        Vec::new()
    };
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
        traces: traces(&problem, [&before, &found]),
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
fn settled(mut problem: Problem<'_>, found: Found) -> Minimum<'_> {
    let mut found = newton::settle(&problem, found, None);
    let mut round = 0;
    loop {
        let local = newton::look(&problem, &found.x, &found.pieces);
        let spread = interval::spread(&problem, &found, &local);
        let step_error = step_error(&problem, &found, &spread);
        if step_error < STEPS_MATTER || round == FINER {
            return Minimum { problem, found, local, spread, step_error };
        }
        round += 1;
        problem.tolerance *= 0.1;
        let spent = found.simulations;
        let from = (found.x.as_slice(), Some(found.pieces.as_slice()));
        let again = search::search(&problem, from, None, &TO_THE_END);
        if again.end == End::NoMotion {
            // More steps than are allowed: what there is is as good as it gets.
            return Minimum { problem, found, local, spread, step_error };
        }
        found = newton::settle(&problem, again, None);
        for (total, before) in found.simulations.iter_mut().zip(spent) {
            *total += before;
        }
    }
}

/// So many times a profile may come upon a lower minimum.
const LOWER: usize = 3;

/// The intervals at the minimum, from which the fit goes on where one of them comes upon a lower one.
fn profiled<'a>(minimum: Minimum<'a>, options: &Options) -> (Minimum<'a>, Vec<Interval>) {
    let none = vec![[None, None]; minimum.found.x.len()];
    // Around what is no minimum a profile says nothing.
    if !options.profiles || minimum.found.end != End::Converged {
        return (minimum, none);
    }
    let mut minimum = minimum;
    for round in 0.. {
        let (profiles, lower) =
            interval::profiles(&minimum.problem, &minimum.found, &minimum.spread);
        let Some(lower) = lower.filter(|_| round < LOWER) else { return (minimum, profiles) };
        let mut next =
            search::search(&minimum.problem, (&lower.x, Some(&lower.pieces)), None, &TO_THE_END);
        for (total, before) in next.simulations.iter_mut().zip(minimum.found.simulations) {
            *total += before;
        }
        minimum = settled(minimum.problem, next);
    }
    (minimum, none)
}

/// The problem with all samples in one run, its weights the channels' noises.
fn problem<'a>(rig: &'a Rig, data: &'a Data) -> Result<Problem<'a>, FitError> {
    let free = binding::free(rig, data.force(rig), data.speed().max(1e-9));
    if free.is_empty() {
        return Err(FitError::NothingFree);
    }
    let expected = free.len() + 8;
    let problem = unfree(rig, data)?;
    if data.time.len() < expected {
        return Err(FitError::TooShort { found: data.time.len(), expected });
    }
    Ok(Problem { free, ..problem })
}

impl<'a> Problem<'a> {
    /// The problem with all samples in one run, its weights the channels' noises.
    pub fn of(rig: &'a Rig, data: &'a Data) -> Result<Self, FitError> {
        problem(rig, data)
    }

    /// The same with nothing free.
    pub fn unfree(rig: &'a Rig, data: &'a Data) -> Result<Self, FitError> {
        unfree(rig, data)
    }
}

/// The same with nothing free.
fn unfree<'a>(rig: &'a Rig, data: &'a Data) -> Result<Problem<'a>, FitError> {
    if data.time.len() < 8 {
        return Err(FitError::TooShort { found: data.time.len(), expected: 8 });
    }
    // Without any noise or motion in a channel there is nothing to weigh its residuals by.
    let loads = data.loads.iter().flatten();
    let seen = [&data.displacement, &data.velocity, &data.force];
    let mut seen = seen.into_iter().flatten().chain(loads);
    if let Some(still) = seen.find(|seen| seen.span <= 0.0) {
        return Err(FitError::Still { channel: still.name.clone() });
    }
    let imposed = data.force.is_some();
    if imposed && data.input.iter().all(|u| *u == data.input[0]) {
        return Err(FitError::Still { channel: "displacement".to_owned() });
    }
    let noise = |seen: Option<&Seen>| seen.map_or(1.0, |s| s.noise.max(f64::MIN_POSITIVE));
    let weights = Weights {
        displacement: noise(data.displacement.as_ref()),
        velocity: noise(data.velocity.as_ref()),
        input: data.noise_of_input().max(1e-9),
        force: noise(data.force.as_ref()),
        loads: [0, 1].map(|i| noise(data.loads.as_ref().map(|l| &l[i]))),
    }
    .along_angle(rig);
    let closed_loop = rig.controller.is_some() && !data.reference.is_empty();
    let windows = blocks::whole(data);
    let (free, shares) = (Vec::new(), Vec::new());
    let memory = binding::model::<f64>(rig, &|_| None).contact.memory();
    let course = if imposed { Course::of(&data.time, &data.input) } else { Course::default() };
    Ok(Problem {
        rig,
        data,
        speed: data.speed(),
        free,
        windows,
        closed_loop,
        memory,
        shares,
        priors: Vec::new(),
        weights,
        spread: Cow::default(),
        tolerance: tolerance(data),
        course: Arc::new(course),
        slopes: 0.0,
        bends: false,
        work: work::Work::default(),
    })
}

/// The steps' tolerance [1]: below the noise, so that the misfit is smooth on its scale.
fn tolerance(data: &Data) -> f64 {
    let seen = [&data.displacement, &data.velocity].into_iter().flatten();
    let least = seen.map(|seen| seen.noise / seen.span.max(f64::MIN_POSITIVE)).fold(1.0, f64::min);
    (BELOW_NOISE * least).clamp(1e-4 * TOLERANCE, TOLERANCE)
}

/// The nominal parameters' misfit, in the same windows.
fn start_misfit(problem: &Problem<'_>) -> Found {
    let x: Vec<f64> = starts::nominal(problem);
    let pieces = problem.pieces(&x, None);
    Found { x, misfit: f64::NAN, pieces, end: End::OutOfPatience, simulations: [1, 0] }
}

/// The rig with the values at the minimum.
fn fitted(problem: &Problem<'_>, found: &Found) -> Rig {
    let mut rig = problem.rig.clone();
    for (i, free) in problem.free.iter().enumerate() {
        binding::set(&mut rig, &free.name, problem.value(i, &found.x));
    }
    rig
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
    (0..step.len())
        .map(|i| (step[i] / (spread.covariance[(i, i)].sqrt() * spread.inflation[i])).abs())
        .fold(0.0, f64::max)
}
