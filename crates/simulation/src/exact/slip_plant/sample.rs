//! The exact solution as a path.

use super::{ExactSolution, Leg, arc::Point};
use crate::Path;

impl ExactSolution {
    /// The solution as a path on which the cubics between the nodes are within `tolerance` [m] of x, and
    /// the quintics of q far closer.
    ///
    /// Each event stands twice, with the derivative before and after. At least sixteen nodes make a period
    /// of the plant or of the drive; where the motion is large it takes more.
    pub fn path(&self, tolerance: f64) -> Path {
        let states = self.plant.model.k.len() + 2;
        let mut path = Path::new(states);
        let (mut y, mut y_dot) = (vec![0.0; states], vec![0.0; states]);
        for (k, leg) in self.legs.iter().enumerate() {
            let mut tau = 0.0;
            while tau < leg.length {
                leg.node(tau, &mut y, &mut y_dot);
                path.push(leg.start + tau, &y, &y_dot);
                tau += leg.spacing(tau, tolerance);
            }
            leg.node(leg.length, &mut y, &mut y_dot);
            let mut end = leg.start + leg.length;
            if let Some(next) = self.legs.get(k + 1) {
                // The same numbers on both sides of an event: v is exactly 0 where the motion turns.
                end = next.start;
                next.state(0.0, &mut y);
            }
            path.push(end, &y, &y_dot);
        }
        path
    }
}

impl Leg {
    fn node(&self, tau: f64, y: &mut [f64], y_dot: &mut [f64]) {
        self.state(tau, y);
        let Point { v, a, .. } = self.arc.at(tau);
        (y_dot[0], y_dot[1]) = (v, a);
        for (x_dot, slips) in y_dot[2..].iter_mut().zip(&self.slips) {
            *x_dot = if *slips { v } else { 0.0 };
        }
    }

    /// How far the next node may be: Mh⁴/384 bounds the error of a cubic with |q⁗| ≤ M. Half a leg at
    /// most, so that a node stands between two turns and shows which way the motion went.
    fn spacing(&self, tau: f64, tolerance: f64) -> f64 {
        let h = self.arc.step(0.5 * self.length);
        let (_, third) = self.arc.bounds(&self.arc.at(tau), h);
        h.min((384.0 * tolerance / third).powf(0.25))
    }
}
