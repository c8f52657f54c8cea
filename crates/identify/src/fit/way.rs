//! In which way a record is simulated, and how its channels are weighed.

use super::{
    FitError, Options, Way, blocks,
    gap::{residuals, weights_of},
    newton,
    problem::{Problem, Weights},
    search::{self, End, Found, Patience, TO_THE_END},
    starts,
};

/// A single run must explain the record down to its noise, or windows are preferred: what it leaves, as the noise
/// of the measured input does, adds up from sample to sample, and is not what the intervals are made for [1].
const AS_GOOD: f64 = 2.0;

/// A single run that leaves so much more than the noise after a first look is given up [1].
const HOPELESS: f64 = 1e4;

/// The windows of a first search, of the length of the others.
const SHORT: f64 = 1.0 / 8.0;

/// The first look at a single run.
const A_GLANCE: Patience = Patience { misfit: 1.0, share: 0.0, simulations: 8 };

/// The way in which the record is simulated, and the minimum found so.
pub(super) fn best_way<'a>(
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
        let noise = whole.weights;
        let mut fitted = weighed(whole, options, None)?;
        if way == Way::Imposed {
            for _ in 0..FLOORED {
                fitted = floored(fitted, noise, options.seed);
            }
        }
        return Ok((fitted.0, fitted.1, way));
    }
    let windows = Problem { windows: blocks::blocks(data, options.window), ..whole.clone() };
    if options.window.is_some() {
        let (problem, found) = weighed(windows, options, None)?;
        return Ok((problem, found, Way::Windows));
    }
    // Short windows come to the neighbourhood of the minimum where long ones meet others on the way.
    let length = (data.time[data.time.len() - 1] - data.time[0]) / windows.windows.len() as f64;
    let short = Problem { windows: blocks::blocks(data, Some(SHORT * length)), ..whole.clone() };
    let first = starts::best(&short, options, None);
    let by_windows = weighed(windows.clone(), options, Some(&first.x))?;
    if mean_of(&search::search(&whole, (&by_windows.1.x, None), None, &A_GLANCE)) > HOPELESS {
        return Ok((by_windows.0, by_windows.1, Way::Windows));
    }
    let single = starts::best(&whole, options, Some(&by_windows.1.x));
    if mean_of(&single) <= AS_GOOD {
        let (problem, found) = reweighed(whole, single);
        return Ok((problem, found, Way::OneRun));
    }
    // A single run sees more than windows do, and may have found the better minimum.
    let again = search::search(&by_windows.0, (&single.x, None), None, &TO_THE_END);
    if again.misfit >= by_windows.1.misfit {
        return Ok((by_windows.0, by_windows.1, Way::Windows));
    }
    // The weights were those of the worse minimum.
    let (problem, found) = reweighed(windows, again);
    Ok((problem, found, Way::Windows))
}

/// So often what the noise of an imposed displacement leaves is counted anew, on its way through the model that was found.
const FLOORED: usize = 2;

/// The minimum of an imposed motion's problem beside what the noise of its displacement leaves, the force weighed by its
/// own `noise`.
fn floored(
    (problem, found): (Problem<'_>, Found),
    noise: Weights,
    seed: u64,
) -> (Problem<'_>, Found) {
    let problem = Problem { weights: noise, ..problem }.floored(&found.x, &found.pieces[0], seed);
    let from = (found.x.as_slice(), Some(found.pieces.as_slice()));
    let mut again = search::search(&problem, from, None, &TO_THE_END);
    for (total, before) in again.simulations.iter_mut().zip(found.simulations) {
        *total += before;
    }
    let found = newton::settle(&problem, again, None);
    (problem, found)
}

/// The mean squared weighed residual [1].
fn mean_of(found: &Found) -> f64 {
    found.misfit / found.pieces.iter().map(|p| p.residuals.len()).sum::<usize>().max(1) as f64
}

/// The best of several starts, then once more with each channel weighed by what its residuals are.
fn weighed<'a>(
    problem: Problem<'a>,
    options: &Options,
    other: Option<&[f64]>,
) -> Result<(Problem<'a>, Found), FitError> {
    let found = starts::best(&problem, options, other);
    if found.end == End::NoMotion {
        return Err(FitError::NoMotion);
    }
    Ok(reweighed(problem, found))
}

/// Where a channel's residuals are larger than its noise the model lacks something there, and the channel counts
/// for less; how much less follows from the minimum, and so again until it no longer changes.
fn reweighed(problem: Problem<'_>, found: Found) -> (Problem<'_>, Found) {
    let mut found = newton::settle(&problem, found, None);
    let mut problem = problem;
    let noise = problem.weights;
    for _ in 0..REWEIGHED {
        let rms = residuals(&problem, &found);
        let (mut weights, mut floor, mut old) = (problem.weights, noise, problem.weights);
        let mut change: f64 = 0.0;
        let now = weights_of(&problem, &mut weights).into_iter();
        let least = weights_of(&problem, &mut floor).into_iter();
        let before = weights_of(&problem, &mut old).into_iter();
        for (((now, least), before), (_, rms)) in now.zip(least).zip(before).zip(&rms) {
            *now = if *rms > 1.3 * *least { *rms } else { *least };
            change = change.max((*now / *before).ln().abs());
        }
        if change < 0.2 {
            break;
        }
        problem = Problem { weights, ..problem };
        let from = (found.x.as_slice(), Some(found.pieces.as_slice()));
        let again = search::search(&problem, from, None, &TO_THE_END);
        // Weights follow from a minimum, and from nothing else.
        found = newton::settle(&problem, again, None);
    }
    (problem, found)
}

/// So many times the channels are weighed anew.
const REWEIGHED: usize = 8;
