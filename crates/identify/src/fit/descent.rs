//! A search that a few windows do not decide.
//!
//! The loss of a residual in a window whose mean square is m is c ln(1 + m/c): a window that is far off, or was lost on
//! the way, is worth its logarithm, one at the floor its sum of squares. Where even the window that fits best is far
//! off, c grows with it, for then all of them are, and say together where to go. The logarithm is concave, so that a step which
//! lowers the sum of squares, each window's times the slope c/(c + m) at hand, lowers the loss by as much at least
//! (Lange, MM Optimization Algorithms, SIAM 2016, chapter 4). Each step is that of Gauss and Newton for this sum, no
//! longer than a radius that grows where its promise holds and shrinks where it does not (Conn, Gould and Toint,
//! Trust-Region Methods, SIAM 2000, chapter 7).

use super::{
    piece::{Lead, Piece},
    problem::Problem,
    search::{End, Found, Patience},
};
use nalgebra::{DMatrix, DVector};

/// The first radius, of the variables' size: see the first step of the other search.
const FIRST_STEP: f64 = 0.03;

/// A step that gains less than the first share of what it promised was too long, one that gains more than the second
/// could have been longer; and what the radius then is of the step.
pub(super) const POOR: f64 = 0.25;
pub(super) const GOOD: f64 = 0.75;
pub(super) const SHORTER: f64 = 0.25;
pub(super) const LONGER: f64 = 2.0;

/// So often in a row a step is tried again shorter.
const TRIED: usize = 4;

/// A window with this mean squared residual is far off [1].
const FAR_OFF: f64 = 4.0;

/// A point of the search.
struct Point {
    x: Vec<f64>,
    pieces: Vec<Piece>,
}

impl Point {
    /// At the variables `x`, where the windows begin as `leads` have it.
    fn at(problem: &Problem<'_>, x: Vec<f64>, leads: Option<(&[f64], &[Lead])>) -> Self {
        let pieces = problem.pieces(&x, leads);
        Self { x, pieces }
    }
}

/// The sum of squares of what the load cells leave [1].
fn loads(problem: &Problem<'_>, x: &[f64]) -> f64 {
    problem.loads(x).0.iter().map(|r| r * r).sum()
}

fn mean(piece: &Piece) -> f64 {
    piece.misfit() / piece.residuals.len().max(1) as f64
}

/// The c of the loss [1], where a search begins with `pieces`: midway, by their logarithms, between what is far off
/// from the floor and from the best of them. An imposed motion is one window, and its sum of squares is the loss.
fn softness(problem: &Problem<'_>, pieces: &[Piece]) -> f64 {
    if problem.data.force.is_some() {
        return f64::INFINITY;
    }
    let best = pieces.iter().map(mean).fold(f64::INFINITY, f64::min);
    FAR_OFF * if best.is_finite() { best.max(1.0).sqrt() } else { 1.0 }
}

/// What a residual in a window with the mean square `m` adds to the loss [1].
fn robust(m: f64, c: f64) -> f64 {
    if c.is_finite() { c * (m / c).ln_1p() } else { m }
}

/// The slope of that by `m` [1].
fn worth(m: f64, c: f64) -> f64 {
    if c.is_finite() { c / (c + m) } else { 1.0 }
}

/// The loss at a point [1].
fn loss(problem: &Problem<'_>, point: &Point, c: f64) -> f64 {
    let one = |piece: &Piece| piece.residuals.len() as f64 * robust(mean(piece), c);
    point.pieces.iter().map(one).sum::<f64>() + loads(problem, &point.x)
}

/// Half the gradient of the loss, Gauss and Newton's matrix, and how the windows' starts follow.
struct Local {
    gradient: DVector<f64>,
    gauss: DMatrix<f64>,
    leads: Vec<Lead>,
}

impl Local {
    fn of(problem: &Problem<'_>, point: &Point, c: f64) -> Self {
        let (loads, loads_by) = problem.loads(&point.x);
        let n = point.x.len();
        let (mut gradient, mut gauss) = (DVector::zeros(n), DMatrix::zeros(n, n));
        if loads_by.nrows() > 0 {
            gradient = loads_by.tr_mul(&DVector::from_vec(loads));
            // Faster than `tr_mul`, which goes column by column.
            gauss = loads_by.transpose() * &loads_by;
        }
        let slopes = problem.all_slopes(&point.x, &point.pieces);
        for (piece, slopes) in point.pieces.iter().zip(&slopes) {
            let worth = worth(mean(piece), c);
            let residuals = DVector::from_column_slice(&piece.residuals);
            gradient += worth * slopes.jacobian.tr_mul(&residuals);
            gauss += worth * (slopes.jacobian.transpose() * &slopes.jacobian);
        }
        Self { gradient, gauss, leads: slopes.into_iter().map(|slopes| slopes.lead).collect() }
    }
}

/// The step to the smallest sum of squares within a `radius`, by how much that falls, and whether the radius bounds it.
pub(super) fn within(
    gauss: &DMatrix<f64>,
    gradient: &DVector<f64>,
    radius: f64,
) -> (DVector<f64>, f64, bool) {
    if !gauss.iter().chain(gradient.iter()).all(|value| value.is_finite()) {
        return (DVector::zeros(gradient.len()), 0.0, false);
    }
    let eigen = gauss.clone().symmetric_eigen();
    let along = -eigen.eigenvectors.tr_mul(gradient);
    // A direction in which nothing changes is left alone.
    let least = 1e-12 * eigen.eigenvalues.amax().max(f64::MIN_POSITIVE);
    let moved = |damping: f64| {
        DVector::from_fn(along.len(), |i, _| along[i] / (eigen.eigenvalues[i].max(least) + damping))
    };
    let mut by = moved(0.0);
    let bounded = by.norm() > radius;
    if bounded {
        // Between these the length falls through the radius.
        let (mut low, mut high) = (0.0, along.norm() / radius);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if moved(middle).norm() > radius { low = middle } else { high = middle }
        }
        by = moved(high);
    }
    let fall = |i: usize| by[i] * (2.0 * along[i] - eigen.eigenvalues[i] * by[i]);
    let gained = (0..by.len()).map(fall).sum();
    (&eigen.eigenvectors * by, gained, bounded)
}

/// A search on its way, which may be left and taken up again.
pub struct Descent<'p, 'd> {
    problem: &'p Problem<'d>,
    here: Point,
    /// The c of the loss [1].
    c: f64,
    /// The loss at the point where it is [1].
    now: f64,
    radius: f64,
    simulations: [usize; 2],
    ended: bool,
}

impl std::fmt::Debug for Descent<'_, '_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Descent")
            .field("x", &self.here.x)
            .field("loss", &self.now)
            .finish_non_exhaustive()
    }
}

impl<'p, 'd> Descent<'p, 'd> {
    /// At its beginning, the variables `x`, its windows begun where they did in `pieces` of a search nearby, or, if
    /// there are none, as they were seen.
    pub fn of(problem: &'p Problem<'d>, x: &[f64], pieces: Option<&[Piece]>) -> Self {
        let stays = |piece: &Piece| Lead::staying(piece.start, x.len());
        let leads: Option<Vec<Lead>> = pieces.map(|pieces| pieces.iter().map(stays).collect());
        let lead = leads.as_ref().map(|leads| (x, leads.as_slice()));
        let here = Point::at(problem, x.to_vec(), lead);
        let c = softness(problem, &here.pieces);
        let now = loss(problem, &here, c);
        Self { problem, here, c, now, radius: FIRST_STEP, simulations: [1, 0], ended: false }
    }

    /// Searches for a smaller loss until it has simulated so often in all. It does not ask whether the end is a
    /// minimum.
    pub fn go(&mut self, patience: &Patience) {
        while !self.ended && self.simulations[0] < patience.simulations {
            self.step(patience);
        }
    }

    /// A step down, or the end.
    fn step(&mut self, patience: &Patience) {
        let enough = patience.misfit.max(patience.share * self.now);
        let local = Local::of(self.problem, &self.here, self.c);
        self.simulations[1] += 1;
        for tried in 0.. {
            let (step, promised, bounded) = within(&local.gauss, &local.gradient, self.radius);
            let hopeless = promised <= enough && !bounded;
            if hopeless || tried > TRIED {
                self.ended = true;
                return;
            }
            if self.simulations[0] >= patience.simulations {
                return;
            }
            let next = self.here.x.iter().zip(step.iter()).map(|(x, s)| x + s).collect();
            let there = Point::at(self.problem, next, Some((&self.here.x, &local.leads)));
            self.simulations[0] += 1;
            let then = loss(self.problem, &there, self.c);
            let gained = self.now - then;
            if gained > GOOD * promised {
                self.radius = self.radius.max(LONGER * step.norm());
            } else if gained.is_nan() || gained < POOR * promised {
                self.radius = SHORTER * step.norm();
            }
            if gained > 0.0 {
                (self.here, self.now) = (there, then);
                // A step that its radius bounds is no sign of the end.
                let small = !bounded || self.radius < FIRST_STEP;
                self.ended = gained.max(promised) < enough && small;
                return;
            }
        }
    }

    /// The windows where it is.
    pub fn pieces(&self) -> &[Piece] {
        &self.here.pieces
    }

    /// Where it is.
    pub fn found(self) -> Found {
        let windows: f64 = self.here.pieces.iter().map(Piece::misfit).sum();
        let misfit = windows + loads(self.problem, &self.here.x);
        let Point { x, pieces } = self.here;
        Found { x, misfit, pieces, end: End::OutOfPatience, simulations: self.simulations }
    }
}

/// Searches from `x` for a smaller loss, as [`Descent`] does.
pub fn descend(
    problem: &Problem<'_>,
    (x, pieces): (&[f64], Option<&[Piece]>),
    patience: &Patience,
) -> Found {
    let mut descent = Descent::of(problem, x, pieces);
    descent.go(patience);
    descent.found()
}

#[cfg(test)]
mod tests {
    use super::{robust, within, worth};
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn a_step_is_the_smallest_sum_of_squares_within_its_radius() {
        // x² + 100 y² about (3, 1): the gradient at 0 is half of (−6, −200).
        let gauss = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 100.0]));
        let gradient = DVector::from_vec(vec![-3.0, -100.0]);
        let (whole, promised, bounded) = within(&gauss, &gradient, 10.0);
        assert!((whole - DVector::from_vec(vec![3.0, 1.0])).norm() < 1e-12 && !bounded);
        assert!((promised - 109.0).abs() < 1e-9, "{promised}");
        let (step, promised, bounded) = within(&gauss, &gradient, 0.5);
        let sum = |x: f64, y: f64| (x - 3.0).powi(2) + 100.0 * (y - 1.0).powi(2);
        assert!(bounded && (step.norm() - 0.5).abs() < 1e-9);
        assert!((sum(0.0, 0.0) - sum(step[0], step[1]) - promised).abs() < 1e-9);
        // No other point of the circle is lower.
        for i in 0..1000 {
            let (s, c) = (0.002 * std::f64::consts::PI * f64::from(i)).sin_cos();
            assert!(sum(0.5 * c, 0.5 * s) >= sum(step[0], step[1]) - 1e-9);
        }
    }

    #[test]
    fn a_direction_in_which_nothing_changes_is_left_alone() {
        let gauss = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 0.0]));
        let (step, ..) = within(&gauss, &DVector::from_vec(vec![-1.0, 0.0]), 10.0);
        assert_eq!((step[0], step[1]), (1.0, 0.0));
        let unknown = DMatrix::from_element(2, 2, f64::NAN);
        assert_eq!(within(&unknown, &DVector::zeros(2), 1.0).1, 0.0);
    }

    #[test]
    fn the_tangent_of_the_loss_lies_above_it() {
        for c in [4.0, 400.0, f64::INFINITY] {
            for m in [0.1, 1.0, 40.0, 1e6] {
                for other in [0.0, 0.5 * m, 3.0 * m, 1e4 * m] {
                    let tangent = robust(m, c) + worth(m, c) * (other - m);
                    assert!(tangent >= robust(other, c) - 1e-9 * tangent.abs(), "{c} {m} {other}");
                }
            }
        }
    }

    #[test]
    fn what_is_far_off_is_worth_its_logarithm_and_what_is_near_its_square() {
        assert!((robust(1e-3, 4.0) - 1e-3).abs() < 1e-6);
        let ten_times = robust(1e7, 4.0) - robust(1e6, 4.0);
        assert!((ten_times - 4.0 * 10.0_f64.ln()).abs() < 1e-4);
        assert_eq!(robust(3.0, f64::INFINITY), 3.0);
    }
}
