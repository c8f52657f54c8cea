//! What the recorded input does between its samples, where the rig file does not say.
//!
//! An input that is held until the next sample comes half a sample later, in the mean, than one that goes on to it, and
//! one that goes straight lacks (ωh)²/12 of a smooth one: either can be more than any effect of friction. It is told by
//! the record: of three models that differ in nothing else the nearest one.

use super::{
    Data, FitError, binding, blocks,
    descent::descend,
    problem::{Piece, Problem},
    starts,
};
use super::{search::Patience, window::Window};
use crate::{Hold, Rig, doctor::noise};
use rayon::prelude::*;
use std::sync::Arc;

/// Windows so long [s]: too short for what the model lacks to add up.
const WINDOW: f64 = 0.4;

/// So many of them at most, spread over the record.
const MOST: usize = 40;

/// What comes late by a time of its own.
const DELAY: &str = "input_delay";

/// The constant force on the side of the friction.
const OFFSET: &str = "offset";

/// Enough to see which of two models is nearer.
const PATIENCE: Patience = Patience { misfit: 1.0, share: 1e-5, simulations: 8 };

/// The steps' tolerance [1].
const TOLERANCE: f64 = 1e-5;

/// Standard errors from which on the nearer of two models is surely so.
const SURE: f64 = 3.0;

/// What a record tells of its input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Told {
    /// What the input does between samples.
    pub hold: Hold,
    /// The other ways, the nearer first.
    pub others: [Hold; 2],
    /// Whether the record shows it beyond chance.
    pub sure: bool,
}

/// What the input of `rig` does between the samples of the record `data`: what is free is fitted with each, from the
/// values of `rig`, and the nearest is told. None where the rig file says it, or there is nothing to be said. Fails
/// where the record cannot be fitted at all.
pub fn told(rig: &Rig, data: &Data) -> Result<Option<Told>, FitError> {
    if rig.unsaid().is_none() {
        return Ok(None);
    }
    // A delay, whatever it is in truth, is made up of the two; and a constant force that is missing is no question of
    // time.
    let mut rig = rig.clone();
    rig.effects.retain(|effect| effect.name != DELAY);
    rig.free.retain(|free| !free.starts_with(DELAY));
    if !rig.free.iter().any(|free| free == OFFSET) {
        rig.free.push(OFFSET.to_owned());
    }
    let ways = [Hold::Smooth, Hold::ZeroOrder, Hold::Linear];
    let far = ways.par_iter().map(|hold| Ok((*hold, misfit(&rig, data, *hold)?)));
    let mut far: Vec<(Hold, Vec<f64>)> = far.collect::<Result<_, FitError>>()?;
    let sum = |windows: &Vec<f64>| windows.iter().sum::<f64>();
    far.sort_by(|a, b| sum(&a.1).total_cmp(&sum(&b.1)));
    let [nearest, next, last] = far.as_slice() else { return Ok(None) };
    let nearer: Vec<f64> = next.1.iter().zip(&nearest.1).map(|(next, near)| next - near).collect();
    let mean = sum(&nearer) / nearer.len().max(1) as f64;
    Ok(Some(Told { hold: nearest.0, others: [next.0, last.0], sure: sure(&nearer, mean) }))
}

/// Whether the `mean` of the windows is so far from 0 that it is no chance.
fn sure(windows: &[f64], mean: f64) -> bool {
    let n = windows.len() as f64;
    let variance = windows.iter().map(|w| (w - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    mean.abs() > SURE * (variance / n).sqrt()
}

/// What a model leaves of every window, by its logarithm.
fn misfit(rig: &Rig, data: &Data, hold: Hold) -> Result<Vec<f64>, FitError> {
    let data = Data { hold, ..data.clone() };
    let all = blocks::blocks(&data, Some(WINDOW));
    let stride = all.len().div_ceil(MOST);
    let some = all.iter().step_by(stride);
    let windows: Vec<Window> = some.map(|w| w.clone().remembering(&data)).collect();
    let problem =
        Problem { windows, closed_loop: false, bends: true, ..Problem::unfree(rig, &data)? };
    let free = binding::free(rig, data.force(rig), data.speed().max(1e-9));
    let problem = Problem { free, tolerance: problem.tolerance.max(TOLERANCE), ..problem };
    let near = descend(&problem, (&starts::nominal(&problem), None), &PATIENCE);
    // What the noise of the input does would hide which of the two is nearer.
    let noise = noise(&data.input);
    let whitened = |(window, piece): (&Window, &Piece)| Window {
        whitening: problem.whitening(&near.x, (window, piece), noise).map(Arc::new),
        ..window.clone()
    };
    let windows = problem.windows.iter().zip(&near.pieces).map(whitened).collect();
    let problem = Problem { windows, ..problem.clone() };
    let pieces = descend(&problem, (&near.x, Some(&near.pieces)), &PATIENCE).pieces;
    Ok(pieces.iter().map(super::piece::Piece::logarithm).collect())
}
