//! Where a force acts that has no name: maps over time, displacement, velocity and drive, of a force beside the friction or
//! of more friction.

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

/// What a map is of: a force beside the friction, or more friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// A force whichever way it moves.
    Force,
    /// What holds it back.
    Friction,
}

impl Of {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Friction => "friction",
        }
    }
}

/// A map of what is left.
#[derive(Debug, Clone)]
pub(crate) struct Map {
    /// What it is of.
    pub(crate) of: Of,
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

/// The maps of this of a fitted model, the one that explains most first.
pub(crate) fn maps(
    board: &Board<'_>,
    fitted: &Fitted,
    (context, of): (&Context, Of),
) -> Result<Vec<Map>, FitError> {
    // More friction is told as a share of itself.
    let unit = match of {
        Of::Force => 1.0,
        Of::Friction => board.problem(&fitted.held(), |_| false)?.model(&[]).contact.level(),
    };
    if unit == 0.0 {
        return Ok(Vec::new());
    }
    let ranges =
        ranges(board, context).into_iter().enumerate().filter(|(_, [low, high])| high > low);
    let axes: Vec<(usize, Vec<f64>)> = ranges
        .map(|(axis, [low, high])| {
            let width = (high - low) / (HATS - 1) as f64;
            (axis, (0..HATS).map(|i| low + width * i as f64).collect())
        })
        .collect();
    let with = |(axis, at): &(usize, Vec<f64>)| {
        let mut rig = fitted.held();
        for (i, center) in at.iter().enumerate() {
            add_hat(&mut rig, i, (*axis, *center, at[1] - at[0]), of);
        }
        rig
    };
    let rigs: Vec<Rig> = axes.iter().map(with).collect();
    let grams = Gram::beside(board, fitted, &rigs)?;
    let one = |((axis, at), gram): ((usize, Vec<f64>), Gram)| {
        let (by, gain, left) = screen::joint(&gram, &board.trains);
        let force =
            by.iter().zip(&gram.probes[0].sizes).map(|(by, size)| unit * by * size).collect();
        Map { of, axis: AXES[axis], at, force, left, gain }
    };
    let mut all: Vec<Map> = axes.into_iter().zip(grams).map(one).collect();
    all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    Ok(all)
}

/// Adds the `i`-th free force of a map, around one place of an axis, to a rig; it is not there yet.
fn add_hat(rig: &mut Rig, i: usize, (axis, center, width): (usize, f64, f64), of: Of) {
    let of = if of == Of::Force { 0.0 } else { 1.0 };
    let place = [("axis", axis as f64), ("center", center), ("width", width), ("of", of)];
    let values = [("amount", 0.0)].into_iter().chain(place);
    let values = values.map(|(key, v)| (key.to_owned(), v)).collect();
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

#[cfg(test)]
mod tests {
    use super::{HATS, Of, maps};
    use crate::{board::Board, walk::made};
    use identify::{
        Hold, Rig,
        fit::{Data, Seen},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    const DRY: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n[friction]\n\
        name = \"coulomb\"\nf_c = 0.5\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n";

    #[test]
    fn friction_that_grows_with_time_is_no_force_that_does() {
        // x = sin 2t of 2 kg on 3 N/m and dry friction of 0.5 N, which is 0.1 N more after ten seconds; noise of 1 mm.
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let input = time.iter().map(|t| {
            let (s, c) = f64::sin_cos(2.0 * t);
            (3.0 - 2.0 * 4.0) * s + (0.5 + if *t > 10.0 { 0.1 } else { 0.0 }) * c.signum()
        });
        let input = input.collect();
        let seen = time.iter().map(|t| (2.0 * t).sin() + 1e-3 * noise()).collect();
        let data = Data::driven(time, input, Hold::Linear, Seen::new("position", seen, 0.0));
        let rig = Rig::parse(DRY).unwrap();
        let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let fitted = board.judged(&rig, None).unwrap();
        let context = crate::model::context(&board, &fitted);
        let first = |of: Of| maps(&board, &fitted, (&context, of)).unwrap().remove(0);
        let (rubs, pushes) = (first(Of::Friction), first(Of::Force));
        assert_eq!((rubs.of, rubs.axis, rubs.force.len()), (Of::Friction, "time", HATS));
        assert!(rubs.gain > pushes.gain, "{} and {}", rubs.gain, pushes.gain);
        let mean = |force: &[f64]| force.iter().sum::<f64>() / force.len() as f64;
        let (before, after) = (mean(&rubs.force[1..5]), mean(&rubs.force[7..11]));
        assert!(before.abs() < 0.02 && (after - 0.1).abs() < 0.02, "{before} N, then {after} N");
        // Without friction there is none to grow.
        let bare = made::rig(2.0);
        let none = maps(&board, &board.judged(&bare, None).unwrap(), (&context, Of::Friction));
        assert!(none.unwrap().is_empty());
    }
}
