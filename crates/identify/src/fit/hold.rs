//! What the recorded input does between its samples, where the rig file does not say.
//!
//! An input that is held until the next sample comes half a sample later, in the mean, than one that goes on to it, and that can be more than any effect of friction. It is told by the record: of two models that differ in
//! nothing else the nearer one.

use super::{
    Data, FitError, binding, blocks,
    descent::descend,
    problem::{Piece, Problem},
    starts,
};
use super::{search::Patience, window::Window};
use crate::{Hold, Rig, doctor::noise};
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
    /// Whether the record shows it beyond chance.
    pub sure: bool,
}

/// What the input of `rig` does between the samples of the record `data`: what is free is fitted with either, from the
/// values of `rig`, and the nearer one is told. None where the rig file says it, or there is nothing to be said. Fails
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
    // What is measured of an input that nobody holds is smooth; straight it is only on paper.
    let [smooth, held] = [Hold::Smooth, Hold::ZeroOrder];
    let both = rayon::join(|| misfit(&rig, data, smooth), || misfit(&rig, data, held));
    let nearer: Vec<f64> = both.0?.iter().zip(both.1?).map(|(line, step)| line - step).collect();
    let mean = nearer.iter().sum::<f64>() / nearer.len().max(1) as f64;
    let hold = if mean > 0.0 { held } else { smooth };
    Ok(Some(Told { hold, sure: sure(&nearer, mean) }))
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
    let problem = Problem { windows, closed_loop: false, ..Problem::unfree(rig, &data)? };
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
    Ok(pieces.iter().map(|piece| piece.misfit().max(f64::MIN_POSITIVE).ln()).collect())
}
