//! What a solver is run on and judged in.

use duhem::Input;
use integrate::{Dynamics, InitialValueProblem};

/// A friction model in motion, as an initial-value problem with a force to look at.
pub trait Motion: Dynamics {
    /// The problem with its breakpoints, from the state `y0`.
    fn problem(&self, y0: Vec<f64>) -> InitialValueProblem<'_>;

    /// The times inside the span where the right-hand side is not smooth in t [s].
    fn corners(&self) -> &[f64];

    /// The friction force F [N] in state `y` at time `t` [s]; at a corner, just after it.
    fn force(&self, t: f64, y: &[f64]) -> f64;

    /// What a run is looked at by: F [N] under an imposed motion, the displacement q [m] of a plant.
    fn response(&self, t: f64, y: &[f64]) -> f64;
}

/// Start, corners and end of a span [s]; piece k lies between `times[k]` and `times[k + 1]`.
#[derive(Debug, Clone)]
pub(crate) struct Pieces {
    pub(crate) times: Vec<f64>,
}

impl Pieces {
    pub(crate) fn new((start, end): (f64, f64), corners: impl IntoIterator<Item = f64>) -> Self {
        let mut times = vec![start];
        times.extend(corners);
        times.push(end);
        Self { times }
    }

    pub(crate) fn corners(&self) -> &[f64] {
        &self.times[1..self.times.len() - 1]
    }

    pub(crate) fn problem<'a>(
        &self,
        dynamics: &'a dyn Dynamics,
        y0: Vec<f64>,
    ) -> InitialValueProblem<'a> {
        let last = self.times.len() - 1;
        InitialValueProblem {
            dynamics,
            start: self.times[0],
            end: self.times[last],
            y0,
            breakpoints: self.corners().to_vec(),
        }
    }
}

/// The corners of an input at which u̇ jumps; at its other corners it only turns, smoothly.
pub(crate) fn jumps(input: &Input, (start, end): (f64, f64)) -> Vec<f64> {
    let corners = input.corners(start, end);
    let times = Pieces::new((start, end), corners).times;
    let at_middle = |w: &[f64]| input.u_dot_on(w[0], w[1], w[0] + 0.5 * (w[1] - w[0])).abs();
    let size = times.windows(2).map(at_middle).fold(0.0, f64::max);
    let jump = |w: &&[f64]| {
        let (before, after) = (input.u_dot_on(w[0], w[1], w[1]), input.u_dot_on(w[1], w[2], w[1]));
        // A smooth turn differs from zero by the rounding of its phase only.
        (after - before).abs() > 1e-9 * size
    };
    times.windows(3).filter(jump).map(|w| w[1]).collect()
}
