//! The nominal model alone, refitted to the record.

use super::{FIRST, GROSS, REFIT, SHORT};
use crate::{
    board::{self, Board, FINE, Fitted},
    model,
};
use identify::{
    Rig,
    fit::{Data, FitError},
};

/// A model is refitted so often at most, as long as the mean squared residual falls below so much of what it was.
const SETTLED: usize = 5;
const AS_BEFORE: f64 = 0.8;

/// What a walk begins with.
pub(super) struct Begin<'a> {
    /// The model with all that is fitted free.
    pub(super) rig: Rig,
    /// What of that is held near its given value: its names and given values.
    pub(super) loose: Vec<(String, f64)>,
    /// The blocks with their floor.
    pub(super) board: Board<'a>,
    /// The model refitted.
    pub(super) refit: Fitted,
    /// And as it was before.
    pub(super) origin: Fitted,
    /// What is given and not free, and went far all the same: its names and given values.
    pub(super) strayed: Vec<(String, f64)>,
}

/// The model `given`, with some of it a little `loose`, refitted to the record.
pub(super) fn begin<'a>(
    (given, mut loose): (&Rig, Vec<(String, f64)>),
    data: &'a Data,
    seed: u64,
) -> Result<Begin<'a>, FitError> {
    let mut own = given.clone();
    let mut rig = board::loosened(&own, &loose);
    let (mut board, mut refit) = nominal(&rig, data, &loose, seed)?;
    if !moves(&board, &refit) {
        return Err(FitError::NoMotion);
    }
    if let Some(scale) = board.untold(&own, &refit)? {
        own.free.retain(|name| *name != scale.0);
        loose.push(scale);
        rig = board::loosened(&own, &loose);
        (board, refit) = nominal(&rig, data, &loose, seed)?;
    }
    // What is given and not free may be a little off; what is far off is not the refit's to mend.
    let (mut strayed, mut start) = (Vec::new(), rig.clone());
    let mut names = board.strayed_alone(&refit);
    while !names.is_empty() {
        strayed.extend(loose.extract_if(.., |(name, _)| names.contains(name)));
        rig = board::loosened(&own, &loose);
        start = board.all_but(&refit, &rig);
        (board, refit) = nominal(&rig, data, &loose, seed)?;
        names = board.lone_pull(&refit).into_iter().collect();
    }
    let mut origin = board.judged(&start, None)?;
    if board.trained(&origin) < board.trained(&refit) || astray(&board, &refit, &origin) {
        refit = from_given(&mut board, &origin, seed)?;
        origin = board.again(&origin)?;
    }
    Ok(Begin { rig, loose, board, refit, origin, strayed })
}

/// Whether a model can be simulated on any window at all.
fn moves(board: &Board<'_>, fitted: &Fitted) -> bool {
    board.imposed() || fitted.pieces.iter().any(|piece| !piece.motion.q.is_empty())
}

/// The blocks of `data` with their floor, and the nominal model refitted on them.
fn nominal<'a>(
    rig: &Rig,
    data: &'a Data,
    loose: &[(String, f64)],
    seed: u64,
) -> Result<(Board<'a>, Fitted), FitError> {
    let mut board = Board::of(rig, data, 1, loose.to_vec())?;
    let short = Board::of(rig, data, SHORT, loose.to_vec())?;
    let first = board.refit(rig, Some(&short).filter(|s| !s.imposed()), &FIRST)?;
    let first = board.refined(&first, FINE)?;
    board.refloor(&first, seed)?;
    let refit = board.again(&first)?;
    let refit = settled(&mut board, refit, seed)?;
    Ok((board, refit))
}

/// A model refitted for as long as it comes much nearer. The nearer it is the less its steps may be wrong by, and what
/// noise leaves is known the better.
pub(super) fn settled(
    board: &mut Board<'_>,
    mut fitted: Fitted,
    seed: u64,
) -> Result<Fitted, FitError> {
    for _ in 0..SETTLED {
        let before = board.trained_level(&fitted);
        fitted = board.fit(&fitted.rig, Some((&fitted.x, &fitted.pieces)), &REFIT)?;
        fitted = board.refined(&fitted, FINE)?;
        board.refloor(&fitted, seed)?;
        fitted = board.again(&fitted)?;
        if board.trained_level(&fitted) > AS_BEFORE * before {
            break;
        }
    }
    Ok(fitted)
}

/// The model refitted from the given values alone: where they are right already, a search by way of short windows
/// may lead away from them.
fn from_given(board: &mut Board<'_>, given: &Fitted, seed: u64) -> Result<Fitted, FitError> {
    let given = board.refined(given, FINE)?;
    board.refloor(&given, seed)?;
    let given = board.again(&given)?;
    let refit = board.fit(&given.rig, Some((&given.x, &given.pieces)), &REFIT)?;
    let better = board.trained(&refit) < board.trained(&given);
    Ok(if better && !astray(board, &refit, &given) { refit } else { given })
}

/// Whether a refit says nothing: the model is far off with it, and a parameter went to what is absurd. A mass without
/// friction that is to come to rest is best as heavy as can be.
pub(super) fn astray(board: &Board<'_>, refit: &Fitted, given: &Fitted) -> bool {
    board.trained_level(refit) > GROSS && !model::reasonable(&refit.rig, &given.rig)
}

#[cfg(test)]
mod tests {
    use super::{begin, moves};
    use crate::walk::made::{DRY, data, rig};
    use identify::{Rig, fit::FitError, march::Motion};

    #[test]
    fn a_model_that_cannot_be_simulated_is_searched_no_further() {
        let data = data();
        let began = begin((&rig(2.0), Vec::new()), &data, 1).unwrap();
        assert!(moves(&began.board, &began.refit));
        let mut still = began.refit.clone();
        still.pieces.iter_mut().for_each(|piece| piece.motion = Motion::default());
        assert!(!moves(&began.board, &still));
        // Beyond its dry friction nothing holds a force of newtons back.
        let text =
            DRY.replace("mass = 2.0", "mass = 1e-59").replace("sigma_2 = 0.5", "sigma_2 = 0");
        let massless = Rig::parse(&text.replace("stiffness = 3.0", "stiffness = 1e-59")).unwrap();
        let refused = begin((&massless, Vec::new()), &data, 1).map(|_| ());
        assert!(matches!(refused, Err(FitError::NoMotion)), "{refused:?}");
    }
}
