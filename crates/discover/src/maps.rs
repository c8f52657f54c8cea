//! Where a force acts that has no name: maps over time, displacement, velocity and drive.

use crate::{
    board::{Board, Fitted},
    gram::{self, Gram},
    screen,
};
use identify::{
    Effect, Rig,
    effects::{Context, Kind},
    fit::FitError,
};

/// The axes of the maps.
const AXES: [&str; 4] = ["time", "displacement", "velocity", "drive"];

/// How many hats a map has.
const HATS: usize = 12;

/// A map of what is left.
#[derive(Debug, Clone)]
pub(crate) struct Map {
    /// Over what.
    pub(crate) axis: &'static str,
    /// The places of its hats [the axis' unit].
    pub(crate) at: Vec<f64>,
    /// The force at each [N].
    pub(crate) force: Vec<f64>,
    /// The sum of squares left in every block.
    pub(crate) left: Vec<f64>,
    /// By how much the sum of squares falls on the training blocks.
    pub(crate) gain: f64,
}

/// The maps of a fitted model, the one that explains most first.
pub(crate) fn maps(
    board: &Board<'_>,
    fitted: &Fitted,
    context: &Context,
) -> Result<Vec<Map>, FitError> {
    let mut all = Vec::new();
    for (axis, (name, [low, high])) in AXES.iter().zip(ranges(board, context)).enumerate() {
        if high <= low {
            continue;
        }
        let width = (high - low) / (HATS - 1) as f64;
        let at: Vec<f64> = (0..HATS).map(|i| low + width * i as f64).collect();
        let mut rig: Rig = fitted.rig.clone();
        for (i, center) in at.iter().enumerate() {
            add_hat(&mut rig, i, (axis, *center, width));
        }
        let gram = Gram::of_rig(board, fitted, &rig)?;
        let (by, gain, left) = screen::joint(&gram, &board.trains);
        let force = by.iter().zip(&gram.probes[0].sizes).map(|(by, size)| by * size).collect();
        all.push(Map { axis: name, at, force, left, gain });
    }
    all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    Ok(all)
}

/// Adds the `i`-th free force of a map, around one place of an axis, to a rig; it is not there yet.
pub(crate) fn add_hat(rig: &mut Rig, i: usize, (axis, center, width): (usize, f64, f64)) {
    let values = [("amount", 0.0), ("axis", axis as f64), ("center", center), ("width", width)];
    let values = values.iter().map(|(key, v)| ((*key).to_owned(), *v)).collect();
    rig.effects.push(Effect { name: format!("map-{i}"), values });
    rig.free.push(format!("map-{i}.amount"));
}

/// From where to where each axis goes.
fn ranges(board: &Board<'_>, context: &Context) -> [[f64; 2]; 4] {
    let data = board.data;
    let ends = |values: &[f64]| {
        values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(*v), h.max(*v)])
    };
    let moved = data.displacement.as_ref().map_or(&data.input, |seen| &seen.values);
    let drive = if board.imposed() { [0.0, 0.0] } else { [-context.drive, context.drive] };
    [ends(&data.time), ends(moved), [-context.speed, context.speed], drive]
}

/// The probe that stands for all hats together.
pub(crate) fn probe(nominal: usize, sizes: Vec<f64>) -> gram::Probe {
    let columns = (nominal..nominal + sizes.len()).collect();
    gram::Probe { kind: Kind::Map, values: Vec::new(), columns, sizes }
}
