//! The deflection over time.

use super::{advance, largest, panel, work};
use crate::{
    FrictionModel, Input, LuGre, Parameters,
    closed_form::{Arcs, Reference, ReferenceError, check},
};

/// More panels than this over a span are refused: about a minute of work.
const MOST_PANELS: f64 = 2e7;

/// The exact deflection of the bristles under an input.
#[derive(Debug, Clone)]
pub struct Trajectory {
    lugre: LuGre,
    arcs: Arcs,
    panels: Vec<Panel>,
    end: f64,
    /// What half as many panels change [m].
    quadrature: f64,
}

/// A piece of an arc.
#[derive(Debug, Clone, Copy)]
struct Panel {
    arc: usize,
    /// Its start [s].
    start: f64,
    /// Deflection there [m].
    x: f64,
}

impl Trajectory {
    /// The trajectory from `x0` [m] over the span [s].
    pub fn new(
        lugre: &LuGre,
        input: &Input,
        x0: f64,
        span: (f64, f64),
    ) -> Result<Self, ReferenceError> {
        check(&[x0], 1, span)?;
        let arcs = Arcs::new(input, span);
        let needed: f64 = (0..arcs.len()).map(|k| count(lugre, &arcs, k)).sum();
        if needed.is_nan() || needed > MOST_PANELS {
            return Err(ReferenceError::TooLong { needed, most: MOST_PANELS });
        }
        let coarse = run(lugre, &arcs, x0, 1);
        let panels = run(lugre, &arcs, x0, 2);
        let pairs = coarse.iter().zip(panels.iter().step_by(2));
        let quadrature = pairs.map(|(a, b)| (a.x - b.x).abs()).fold(0.0, f64::max);
        Ok(Self { lugre: lugre.clone(), arcs, panels, end: span.1, quadrature })
    }

    /// The exact deflection [m] at time `t` [s] of the span.
    pub fn deflection(&self, t: f64) -> f64 {
        let after = self.panels.partition_point(|panel| panel.start <= t);
        let panel = self.panels[after.saturating_sub(1)];
        step(&self.lugre, &self.arcs, panel, t)
    }

    /// The force [N] at time `t` [s], with the velocity of the arc that starts there at a corner.
    pub fn force(&self, t: f64) -> f64 {
        let after = self.panels.partition_point(|panel| panel.start <= t);
        self.force_on(self.panels[after.saturating_sub(1)], t)
    }

    /// ∫F du [J] over the whole span, F with its damping and its viscous part.
    pub fn work(&self) -> f64 {
        let ends = self.panels.iter().skip(1).map(|panel| panel.start).chain([self.end]);
        let pieces = self.panels.iter().zip(ends).map(|(panel, end)| {
            // At constant speed a panel is a whole arc or half of one, far too long for Gauss.
            if let Some(u_dot) = self.arcs.constant_velocity(panel.arc) {
                return work(&self.lugre, panel.x, u_dot * (end - panel.start), u_dot);
            }
            panel::gauss((panel.start, end), |t| {
                self.force_on(*panel, t) * self.arcs.velocity(panel.arc, t)
            })
        });
        pieces.sum()
    }

    /// The largest force [N] over the span: the largest at the panels' ends, and between them by golden
    /// sections about it.
    pub fn largest_force(&self) -> f64 {
        let mut best = (f64::NEG_INFINITY, 0);
        for (i, panel) in self.panels.iter().enumerate() {
            let at = [panel.start, self.end_of(i)].map(|t| self.force_on(*panel, t));
            let force = at[0].max(at[1]);
            if force > best.0 {
                best = (force, i);
            }
        }
        let about = best.1.saturating_sub(1)..=(best.1 + 1).min(self.panels.len() - 1);
        let finer = about.map(|i| {
            let panel = self.panels[i];
            largest((panel.start, self.end_of(i)), |t| self.force_on(panel, t))
        });
        finer.fold(best.0, f64::max)
    }

    /// The time [s] at which panel `i` ends.
    fn end_of(&self, i: usize) -> f64 {
        self.panels.get(i + 1).map_or(self.end, |next| next.start)
    }

    fn force_on(&self, panel: Panel, t: f64) -> f64 {
        let (x, mut x_dot) = ([step(&self.lugre, &self.arcs, panel, t)], [0.0]);
        let u_dot = self.arcs.velocity(panel.arc, t);
        self.lugre.x_dot(&x, 0.0, u_dot, &mut x_dot);
        self.lugre.force(&x, &x_dot, 0.0, u_dot)
    }

    pub(crate) fn build(
        parameters: &Parameters,
        input: &Input,
        x0: &[f64],
        span: (f64, f64),
    ) -> Result<Box<dyn Reference>, ReferenceError> {
        let lugre = LuGre::new(parameters)?;
        check(x0, 1, span)?;
        Ok(Box::new(Self::new(&lugre, input, x0[0], span)?))
    }
}

impl Reference for Trajectory {
    fn state(&self, t: f64, x: &mut [f64]) {
        x[0] = self.deflection(t);
    }

    /// The flow contracts, so the roundings of the panels fade over a travel of r: a few units of the
    /// largest deflection, that of u with |dx/du| ≤ 1 + |x|/r in each arc, and what refinement showed.
    fn error_bound(&self) -> f64 {
        let slowest = self.lugre.f_s.min(self.lugre.f_c) / self.lugre.sigma_0;
        let fastest = self.lugre.f_s.max(self.lugre.f_c) / self.lugre.sigma_0;
        let largest = self.panels.iter().fold(fastest, |largest, panel| largest.max(panel.x.abs()));
        let slope = 1.0 + largest / slowest;
        let rounding = 64.0 * f64::EPSILON * largest + 2.0 * slope * self.arcs.rounding();
        2.0 * self.quadrature + self.arcs.len() as f64 * rounding
    }
}

/// The deflection [m] at t = 0 with which a periodic input repeats itself: over one period x goes to
/// c + qx, from two runs, so x = c/(1 − q).
pub fn settled_start(lugre: &LuGre, input: &Input) -> Result<f64, ReferenceError> {
    let period = input.period().ok_or(ReferenceError::NoPeriod)?;
    let size = lugre.scale()[0];
    let run = |x0| Trajectory::new(lugre, input, x0, (0.0, period));
    let (c, shifted) = (run(0.0)?.deflection(period), run(size)?.deflection(period));
    Ok(c / (1.0 - (shifted - c) / size))
}

/// One settled period of a periodic input.
pub fn settled(lugre: &LuGre, input: &Input) -> Result<Trajectory, ReferenceError> {
    let period = input.period().ok_or(ReferenceError::NoPeriod)?;
    Trajectory::new(lugre, input, settled_start(lugre, input)?, (0.0, period))
}

/// How many panels arc `k` needs; one where the velocity is constant.
fn count(lugre: &LuGre, arcs: &Arcs, k: usize) -> f64 {
    if arcs.constant_velocity(k).is_some() { 1.0 } else { panel::count(lugre, arcs, k) }
}

/// All panels, `refinement` times as many as needed.
fn run(lugre: &LuGre, arcs: &Arcs, x0: f64, refinement: u8) -> Vec<Panel> {
    let (mut panels, mut x) = (Vec::new(), x0);
    for arc in 0..arcs.len() {
        let (from, to) = arcs.ends(arc);
        let n = count(lugre, arcs, arc) * f64::from(refinement);
        let at = |i: f64| if i == n { to } else { from + (to - from) * i / n };
        let mut i = 0.0;
        while i < n {
            let panel = Panel { arc, start: at(i), x };
            panels.push(panel);
            i += 1.0;
            x = step(lugre, arcs, panel, at(i));
        }
    }
    panels
}

/// The deflection at `t` from the start of `panel`.
fn step(lugre: &LuGre, arcs: &Arcs, panel: Panel, t: f64) -> f64 {
    match arcs.constant_velocity(panel.arc) {
        Some(u_dot) => advance(lugre, panel.x, u_dot * (t - panel.start), u_dot),
        None => panel::advance(lugre, (arcs, panel.arc), panel.x, (panel.start, t)),
    }
}
