//! The rows of all residuals and of their derivatives, window by window.

use crate::board::Board;
use identify::fit::{
    problem::{Along, Piece, Problem},
    window::Window,
};
use nalgebra::{DMatrix, DVector};

/// The derivatives of every block's residuals, those of the load cells last.
pub(crate) fn jacobians(
    board: &Board<'_>,
    problem: &Problem<'_>,
    x: &[f64],
    pieces: &[Piece],
) -> Vec<DMatrix<f64>> {
    beside(board, problem, x, &problem.all_along(x, pieces))
}

/// The same along the motions of a problem that is the same but for effects that change nothing yet.
pub(crate) fn beside(
    board: &Board<'_>,
    problem: &Problem<'_>,
    x: &[f64],
    along: &[Along<'_>],
) -> Vec<DMatrix<f64>> {
    let slopes = problem.all_beside(x, along);
    let loads = problem.cells(x).1;
    let channels = problem.channels();
    let windows = windows(board, problem);
    let one = |k: usize| {
        let window = &windows[k];
        let n = window.len();
        let own = if board.imposed() {
            slopes[0].rows(window.first, n).into_owned()
        } else {
            slopes[k].rows(0, n * channels).into_owned()
        };
        if loads.nrows() == 0 {
            return own;
        }
        let rows = own.nrows();
        let mut all = DMatrix::zeros(rows + 2 * n, own.ncols());
        all.rows_mut(0, rows).copy_from(&own);
        for cell in 0..2 {
            let from = cell_row(windows, k, cell);
            all.rows_mut(rows + cell * n, n).copy_from(&loads.rows(from, n));
        }
        all
    };
    (0..windows.len()).map(one).collect()
}

/// Every block's residuals in the same order.
pub(crate) fn residuals(
    board: &Board<'_>,
    problem: &Problem<'_>,
    x: &[f64],
    pieces: &[Piece],
) -> Vec<DVector<f64>> {
    let loads = problem.cells(x).0;
    let channels = problem.channels();
    let windows = windows(board, problem);
    let one = |k: usize| {
        let window = &windows[k];
        let n = window.len();
        let mut all: Vec<f64> = if board.imposed() {
            pieces[0].residuals[window.first..window.end].to_vec()
        } else {
            pieces[k].residuals[..n * channels].to_vec()
        };
        if !loads.is_empty() {
            for cell in 0..2 {
                let from = cell_row(windows, k, cell);
                all.extend_from_slice(&loads[from..from + n]);
            }
        }
        DVector::from_vec(all)
    };
    (0..windows.len()).map(one).collect()
}

/// The row with which a load cell begins in a window, the cells after one another.
fn cell_row(windows: &[Window], window: usize, cell: usize) -> usize {
    let before = |windows: &[Window]| windows.iter().map(Window::len).sum::<usize>();
    cell * before(windows) + before(&windows[..window])
}

/// The windows of a problem; those of the board where the motion is imposed, which is one run.
fn windows<'a>(board: &'a Board<'_>, problem: &'a Problem<'_>) -> &'a [Window] {
    if board.imposed() { &board.windows } else { &problem.windows }
}

#[cfg(test)]
mod tests {
    use super::{Window, cell_row};
    use crate::{board::Board, walk::made};

    #[test]
    fn the_cells_rows_of_some_windows_follow_one_another() {
        let (rig, data) = (made::rig(2.0), made::data());
        let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let some: Vec<Window> = [1, 4, 6].map(|w| board.windows[w].clone()).into();
        let [a, b, c] = [0, 1, 2].map(|w| some[w].len());
        let rows = [0, 1].map(|cell| [0, 1, 2].map(|w| cell_row(&some, w, cell)));
        assert_eq!(rows, [[0, a, a + b], [a + b + c, 2 * a + b + c, 2 * a + 2 * b + c]]);
    }
}
