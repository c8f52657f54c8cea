//! How far the simulated channels are from the measured ones.

use super::{
    Data, FitError, Way, blocks, models,
    problem::{Piece, Problem, Weights},
    search::{End, Found},
    window::START,
};
use crate::{Rig, march::Motion};

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
    /// Root mean square of what was measured, against which a relative error is meant.
    pub size: f64,
}

/// One channel over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// The channel.
    pub channel: String,
    /// Times of the samples [s].
    pub time: Vec<f64>,
    /// As measured [its unit].
    pub measured: Vec<f64>,
    /// With the nominal parameters.
    pub before: Vec<f64>,
    /// With the fitted ones.
    pub after: Vec<f64>,
}

/// The misfit of every channel of the problem, before and after.
pub(super) fn gap(problem: &Problem<'_>, before: &Found, after: &Found) -> Vec<Misfit> {
    if !problem.spread.is_empty() || problem.windows.iter().any(|w| w.whitening.is_some()) {
        // What was made white is not in the channel's unit.
        let plain = problem.plain();
        let [before, after] = [before, after].map(|found| {
            let all = plain.windows.iter().zip(&found.pieces);
            let pieces = all.map(|(w, piece)| plain.piece(&found.x, w, piece.start)).collect();
            Found { pieces, ..found.clone() }
        });
        return gap(&plain, &before, &after);
    }
    let data = problem.data;
    let seen = [&data.displacement, &data.velocity, &data.force];
    residuals(problem, before)
        .into_iter()
        .zip(residuals(problem, after))
        .map(|((channel, before), (_, after))| {
            let of = seen.iter().find_map(|s| s.as_ref().filter(|s| s.name == channel));
            let values = of.map_or(&data.input, |s| &s.values);
            let noise = of.map_or_else(|| data.noise_of_input(), |s| s.noise);
            let squares: f64 = values.iter().map(|v| v * v).sum();
            let size = (squares / values.len().max(1) as f64).sqrt();
            Misfit { channel, before, after, noise, size }
        })
        .collect()
}

/// A rig's model run on a record's inputs, nothing fitted but the state at the start of each run.
#[derive(Debug, Clone)]
pub struct Simulated {
    /// The misfit of every channel; before and after are the same.
    pub gap: Vec<Misfit>,
    /// Every channel over time; before and after are the same.
    pub traces: Vec<Trace>,
    /// How the record was simulated, and in how many windows.
    pub way: Way,
    /// See `way`.
    pub windows: usize,
    /// Where each window began.
    starts: Vec<[f64; START]>,
    /// What the steps may be wrong by [1].
    tolerance: f64,
}

impl Simulated {
    /// Every channel over time of the same model on another record: in one run, from where this one began and with steps
    /// as short.
    ///
    /// # Errors
    /// As [`simulate`] has them, but for the motion: where there is none the channels are not numbers.
    pub fn once_more(&self, rig: &Rig, data: &Data) -> Result<Vec<Trace>, FitError> {
        let problem = Problem { tolerance: self.tolerance, ..super::unfree(rig, data)? };
        let begun = problem.windows.iter().zip(&self.starts);
        let pieces: Vec<Piece> = begun.map(|(w, start)| problem.piece(&[], w, *start)).collect();
        let found = alone(pieces);
        Ok(traces(&problem, [&found, &found]))
    }
}

/// What nothing was fitted to.
fn alone(pieces: Vec<Piece>) -> Found {
    Found { x: Vec::new(), misfit: f64::NAN, pieces, end: End::Converged, simulations: [1, 0] }
}

/// Whether the model of `rig` has a motion on the inputs of `data`: in one of the windows at least, as [`simulate`] takes
/// them.
///
/// # Errors
/// As `simulate` has them, but for the motion.
pub fn moves(rig: &Rig, data: &Data, window: Option<f64>) -> Result<bool, FitError> {
    let mut problem = super::unfree(rig, data)?;
    if data.force.is_none() && !problem.closed_loop && window.is_some() {
        problem.windows = blocks::blocks(data, window);
    }
    let any = |problem: Problem<'_>| {
        problem.windows.iter().any(|window| follows(&problem.piece(&[], window, window.start)))
    };
    Ok(ever_rougher(&problem).any(any))
}

/// Where a model has no motion with steps as short as a fit takes them they may be so many times as rough, and so many
/// times again, up to this share of the spans: a small load on a hard joint may ask for more steps than a window may take.
const ROUGHER: f64 = 10.0;
const ROUGHEST: f64 = 1e-2;

/// The problem with ever rougher steps.
fn ever_rougher<'p>(problem: &Problem<'p>) -> impl Iterator<Item = Problem<'p>> {
    std::iter::successors(Some(problem.tolerance), |tolerance| Some(ROUGHER * tolerance))
        .take_while(|tolerance| *tolerance <= ROUGHEST)
        .map(|tolerance| Problem { tolerance, ..problem.clone() })
}

/// Whether a window has a motion. One that is lost says nothing of the others.
fn follows(piece: &Piece) -> bool {
    !piece.motion.q.is_empty()
}

/// Runs the model of `rig` on the inputs of `data`: in closed loop where the controller is declared, in windows
/// of a `window` [s] if one is given, in one run otherwise; an imposed motion without what is known to be its sensor's noise.
pub fn simulate(rig: &Rig, data: &Data, window: Option<f64>) -> Result<Simulated, FitError> {
    let data = &*crate::known::motion(data);
    let mut problem = super::unfree(rig, data)?;
    let way = match window {
        _ if data.force.is_some() => Way::Imposed,
        _ if problem.closed_loop => Way::ClosedLoop,
        Some(_) => {
            problem.windows = blocks::blocks(data, window);
            Way::Windows
        }
        None => Way::OneRun,
    };
    let moving = |problem: Problem<'_>| {
        let pieces = problem.pieces(&[], None);
        pieces.iter().any(follows).then(|| {
            let pieces = models::followed(&problem, &[], pieces, 2);
            let found = alone(pieces);
            Simulated {
                gap: gap(&problem, &found, &found),
                traces: traces(&problem, [&found, &found]),
                way,
                windows: problem.windows.len(),
                starts: found.pieces.iter().map(|piece| piece.start).collect(),
                tolerance: problem.tolerance,
            }
        })
    };
    ever_rougher(&problem).find_map(moving).ok_or(FitError::NoMotion)
}

/// Every channel of the windows; a window that could not be simulated shows what is not a number.
pub(super) fn traces(problem: &Problem<'_>, [before, after]: [&Found; 2]) -> Vec<Trace> {
    let data = problem.data;
    let samples: Vec<usize> = problem.windows.iter().flat_map(|w| w.first..w.end).collect();
    let simulated = |found: &Found, of: fn(&Motion) -> &Vec<f64>| {
        let windows = problem.windows.iter().zip(&found.pieces);
        windows
            .flat_map(|(window, piece)| {
                let values = of(&piece.motion);
                (0..window.len()).map(|i| values.get(i).copied().unwrap_or(f64::NAN))
            })
            .collect::<Vec<f64>>()
    };
    let one = |channel: &str, measured: &[f64], of: fn(&Motion) -> &Vec<f64>| Trace {
        channel: channel.to_owned(),
        time: samples.iter().map(|i| data.time[*i]).collect(),
        measured: samples.iter().map(|i| measured[*i]).collect(),
        before: simulated(before, of),
        after: simulated(after, of),
    };
    let mut all = Vec::new();
    if let Some(seen) = data.force.as_ref().or(data.displacement.as_ref()) {
        all.push(one(&seen.name, &seen.values, |m| &m.q));
    }
    if let Some(seen) = &data.velocity {
        all.push(one(&seen.name, &seen.values, |m| &m.v));
    }
    if problem.closed_loop {
        all.push(one("input", &data.input, |m| &m.u));
    }
    all
}

/// The weights of the channels there are, in the order of [`residuals`].
pub(super) fn weights_of<'w>(problem: &Problem<'_>, weights: &'w mut Weights) -> Vec<&'w mut f64> {
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
pub(super) fn residuals(problem: &Problem<'_>, found: &Found) -> Vec<(String, f64)> {
    let channels = problem.channels();
    let mut weights = problem.weights;
    let sizes: Vec<f64> = weights_of(problem, &mut weights).into_iter().map(|w| *w).collect();
    let seen = [&problem.data.force, &problem.data.displacement, &problem.data.velocity];
    let mut names: Vec<&str> =
        seen.iter().filter_map(|s| s.as_ref().map(|s| s.name.as_str())).collect();
    names.extend(problem.closed_loop.then_some("input"));
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
