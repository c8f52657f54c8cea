//! The derivatives of a window's residuals, along its motion.

use super::{
    imposed::forces,
    piece::{Lead, Piece, Slopes, Starts},
    problem::Problem,
    window::{START, Window},
};
use crate::march::{Dual, Tape, replay};
use nalgebra::{DMatrix, DMatrixViewMut};
use rayon::prelude::*;
use std::{borrow::Cow, ops::Range};

/// A motion of so many steps a sample is gone over once more with longer ones for its derivatives: to find these, no fewer
/// than one a sample, takes longer than to carry derivatives along a few steps more.
const MANY: usize = 2;

/// The motion along which derivatives of a window are taken: where it begins, and its steps.
#[derive(Debug)]
struct Way<'p> {
    start: [f64; START],
    tape: Cow<'p, Tape>,
}

/// The motion along which derivatives of a window are taken, and those by its start.
#[derive(Debug)]
pub struct Along<'p> {
    way: Way<'p>,
    starts: Option<Starts>,
}

impl Problem<'_> {
    /// The derivatives of all `pieces`.
    pub fn all_slopes(&self, x: &[f64], pieces: &[Piece]) -> Vec<Slopes> {
        self.windows.par_iter().zip(pieces).map(|(w, piece)| self.slopes(x, w, piece)).collect()
    }

    /// The derivatives of a window's residuals by the variables `x`, its start projected out, and how that follows.
    pub fn slopes(&self, x: &[f64], window: &Window, piece: &Piece) -> Slopes {
        let (free, starts) = (self.free.len(), self.starts());
        let way = self.way(x, window, piece);
        let jacobian = self.jacobian(x, window, &way, 0..free + starts);
        let by_x = jacobian.columns(0, free).into_owned();
        if starts == 0 {
            let lead = Lead::staying(piece.start, free);
            return Slopes { jacobian: by_x, lead };
        }
        let own = Starts::of(jacobian.columns(free, starts).into_owned());
        let along = own.q.tr_mul(&by_x);
        let start = own.better(piece);
        let by = own.moved(&along).resize_vertically(START, 0.0);
        let lead = Lead { was: piece.start, misfit: piece.misfit(), start, by };
        Slopes { jacobian: by_x - own.q * along, lead }
    }

    /// The derivatives of a window's residuals by its start.
    pub(super) fn by_start(&self, x: &[f64], window: &Window, piece: &Piece) -> Starts {
        self.by_start_along(x, window, &self.way(x, window, piece))
    }

    fn by_start_along(&self, x: &[f64], window: &Window, way: &Way<'_>) -> Starts {
        let free = self.free.len();
        Starts::of(self.jacobian(x, window, way, free..free + self.starts()))
    }

    /// The motions of all `pieces` with their derivatives by their starts: derivatives by what is free in other problems, in
    /// which the same model has effects more that change nothing yet, are taken along them.
    pub fn all_along<'p>(&self, x: &[f64], pieces: &'p [Piece]) -> Vec<Along<'p>> {
        let one = |(window, piece): (&Window, &'p Piece)| {
            let way = self.way(x, window, piece);
            let starts = (self.starts() > 0).then(|| self.by_start_along(x, window, &way));
            Along { way, starts }
        };
        self.windows.par_iter().zip(pieces).map(one).collect()
    }

    /// The derivatives of all windows' residuals by the variables `x` along the motions of a problem that is the same but for
    /// effects that change nothing yet, its starts projected out.
    pub fn all_beside(&self, x: &[f64], along: &[Along<'_>]) -> Vec<DMatrix<f64>> {
        let one = |(window, along): (&Window, &Along<'_>)| {
            let by_x = self.jacobian(x, window, &along.way, 0..self.free.len());
            match &along.starts {
                Some(own) => &by_x - &own.q * own.q.tr_mul(&by_x),
                None => by_x,
            }
        };
        self.windows.par_iter().zip(along).map(one).collect()
    }

    /// The motion along which the derivatives of a window are taken: its own or, if that has many steps, one with longer ones.
    fn way<'p>(&self, x: &[f64], window: &Window, piece: &'p Piece) -> Way<'p> {
        let (start, tape) = (piece.start, &piece.motion.tape);
        let own = Way { start, tape: Cow::Borrowed(tape) };
        if self.slopes <= self.tolerance || tape.steps() <= MANY * window.len() {
            return own;
        }
        let model = self.model(x);
        let state = self.state(&model, window, start);
        let longer = self.marched(&model, window, &state, self.slopes);
        longer.map_or(own, |motion| Way { start, tape: Cow::Owned(motion.tape) })
    }

    /// The derivatives of a window's residuals by some of the variables and, after them, of the numbers of its start.
    fn jacobian(
        &self,
        x: &[f64],
        window: &Window,
        way: &Way<'_>,
        some: Range<usize>,
    ) -> DMatrix<f64> {
        let (first, free) = (some.start, self.free.len());
        let mut jacobian = DMatrix::zeros(self.rows(window), some.len());
        match some.len() {
            0..=3 => self.columns::<4>(x, window, way, (first, &mut jacobian)),
            4..=7 => self.columns::<8>(x, window, way, (first, &mut jacobian)),
            8..=11 => self.columns::<12>(x, window, way, (first, &mut jacobian)),
            _ => self.columns::<16>(x, window, way, (first, &mut jacobian)),
        }
        if let Some(whitening) = &window.whitening {
            whitening.apply_all(&mut jacobian);
        }
        let (shares, channels) = (self.shares.get(window.first..window.end), self.channels());
        for (i, share) in shares.unwrap_or_default().iter().enumerate() {
            jacobian.rows_mut(i * channels, channels).scale_mut(*share);
        }
        let (n, starts) = (jacobian.nrows(), self.starts());
        for (i, spread) in window.spread.iter().enumerate().take(starts) {
            if some.contains(&(free + i)) {
                jacobian[(n - starts + i, free + i - first)] = spread.recip();
            }
        }
        jacobian
    }

    /// The columns from `first` on, in passes of as many as fit.
    fn columns<const P: usize>(
        &self,
        x: &[f64],
        window: &Window,
        way: &Way<'_>,
        (first, jacobian): (usize, &mut DMatrix<f64>),
    ) {
        let mut done = 0;
        while done < jacobian.ncols() {
            let many = (jacobian.ncols() - done).min(P - 1);
            let mut part = jacobian.columns_mut(done, many);
            self.some_columns::<P>(x, window, way, (first + done, &mut part));
            done += many;
        }
    }

    /// As many columns from `first` on as there is room for.
    fn some_columns<const P: usize>(
        &self,
        x: &[f64],
        window: &Window,
        way: &Way<'_>,
        (first, jacobian): (usize, &mut DMatrixViewMut<'_, f64>),
    ) {
        let model = self.model_with::<P>(x, first);
        let range = window.first..window.end;
        let many = jacobian.ncols();
        self.work.add_with(way.tape.steps().max(window.len()), many);
        let mut write = |row: usize, value: &Dual<P>, weight: f64| {
            for place in 0..many {
                jacobian[(row, place)] = value.eps[place] / weight;
            }
        };
        if let Some(force) = &self.data.force {
            forces(
                &model,
                (&self.data.time[range.clone()], &self.data.input[range], &self.course(window)),
                force.values[window.first],
                &mut |i, f| write(i, &f, self.first_weight(window.first + i)),
            );
            return;
        }
        let seed = |value: f64, column: usize| match column.checked_sub(first) {
            Some(place) if place < P - 1 => Dual::variable(value, place),
            _ => Dual::from(value),
        };
        let n = self.free.len();
        let start = std::array::from_fn(|i| seed(way.start[i], n + i));
        let state = self.state(&model, window, start);
        let channels = self.channels();
        if way.tape.samples() != window.len() {
            return;
        }
        let drive = (&self.drive(window), &self.data.time[range]);
        replay(&model, drive, &way.tape, &state, &mut |i, q, v, u| {
            let mut row = i * channels;
            write(row, &q, self.first_weight(window.first + i));
            if let Some(seen) = &self.data.velocity {
                row += 1;
                write(row, &v, self.velocity_weight(&seen.values, window.first + i));
            }
            if self.closed_loop {
                write(row + 1, &u, self.weights.input);
            }
        });
    }
}
