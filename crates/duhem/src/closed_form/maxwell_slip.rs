//! The Maxwell-slip model solved exactly: between two turns each element first sticks, then slips.

use super::{Arcs, Reference, ReferenceError, check};
use crate::{Input, MaxwellSlip, Parameters};

/// The deflection z = u − x [m] of one element after a monotone displacement `delta_u` [m]: the stop
/// operator. A deflection beyond the deadband stays, as equation 24 has it, until the motion turns.
pub fn stop(z: f64, delta_u: f64, delta: f64) -> f64 {
    if delta_u > 0.0 { z.max((z + delta_u).min(delta)) } else { z.min((z + delta_u).max(-delta)) }
}

fn stop_all(model: &MaxwellSlip, z: &[f64], delta_u: f64) -> Vec<f64> {
    z.iter().zip(&model.delta).map(|(z, delta)| stop(*z, delta_u, *delta)).collect()
}

fn force(model: &MaxwellSlip, z: &[f64]) -> f64 {
    model.k.iter().zip(z).map(|(k, z)| k * z).sum()
}

/// ∫F du [J] over a monotone displacement `delta_u` [m] from the deflections `z` [m].
pub fn work(model: &MaxwellSlip, z: &[f64], delta_u: f64) -> f64 {
    let element = |(k, (z0, delta)): (&f64, (&f64, &f64))| {
        let z1 = stop(*z0, delta_u, *delta);
        k * (0.5 * (z1 + z0) * (z1 - z0) + z1 * (delta_u - (z1 - z0)))
    };
    model.k.iter().zip(z.iter().zip(&model.delta)).map(element).sum()
}

/// Σ kᵢΔᵢ² [J], what the paper gives as the loop's area (p. 97). It is not: see [`Loop::area`].
pub fn dissipation_as_printed(model: &MaxwellSlip) -> f64 {
    model.k.iter().zip(&model.delta).map(|(k, delta)| k * delta * delta).sum()
}

/// Σ kᵢΔᵢ [N], the force when all elements slip.
pub fn saturation_force(model: &MaxwellSlip) -> f64 {
    force(model, &model.delta)
}

/// The positions [m] over one monotone piece after another, at many displacements at once: the play
/// operator, which is [`stop`] seen from x. An element moves where it is pushed, x = u ∓ Δ, and else stays.
#[derive(Debug, Clone, PartialEq)]
pub struct Play {
    delta: Vec<f64>,
    /// Whether u rises.
    rising: bool,
    /// Positions at the start of the piece [m].
    x: Vec<f64>,
    /// The deflection at which each slips [m]: Δ, or what it is beyond it.
    limit: Vec<f64>,
}

impl Play {
    /// The elements in the positions `x0` [m], before the first piece.
    pub fn new(model: &MaxwellSlip, x0: &[f64]) -> Self {
        let delta = model.delta.clone();
        Self { limit: delta.clone(), delta, rising: true, x: x0.to_vec() }
    }

    /// Begins a piece at the displacement `u` [m], where the positions are those at its start.
    pub fn turn(&mut self, u: f64, rising: bool) {
        self.rising = rising;
        let elements = self.x.iter().zip(&self.delta);
        for (limit, (x, delta)) in self.limit.iter_mut().zip(elements) {
            *limit = delta.max(if rising { u - x } else { x - u });
        }
    }

    /// Ends the piece at the displacement `u` [m].
    pub fn stop_at(&mut self, u: f64) {
        for (x, limit) in self.x.iter_mut().zip(&self.limit) {
            *x = if self.rising { pushed_up(*x, u - limit) } else { pushed_down(*x, u + limit) };
        }
    }

    /// Writes the positions at each of the displacements `u` [m] of the piece, row by row.
    pub fn positions(&self, u: &[f64], x: &mut [f64]) {
        let n = self.x.len();
        for (row, u) in x.chunks_exact_mut(n).zip(u) {
            let elements = row.iter_mut().zip(self.x.iter().zip(&self.limit));
            if self.rising {
                elements.for_each(|(x, (x0, limit))| *x = pushed_up(*x0, u - limit));
            } else {
                elements.for_each(|(x, (x0, limit))| *x = pushed_down(*x0, u + limit));
            }
        }
    }
}

fn pushed_up(x: f64, by: f64) -> f64 {
    if x > by { x } else { by }
}

fn pushed_down(x: f64, by: f64) -> f64 {
    if x < by { x } else { by }
}

/// The exact deflections of the model under an input.
#[derive(Debug, Clone)]
pub struct Trajectory {
    model: MaxwellSlip,
    arcs: Arcs,
    /// Deflections at the start of each arc [m].
    z: Vec<Vec<f64>>,
}

impl Trajectory {
    /// The trajectory from the positions `x0` [m] over the span [s].
    pub fn new(
        model: &MaxwellSlip,
        input: &Input,
        x0: &[f64],
        span: (f64, f64),
    ) -> Result<Self, ReferenceError> {
        check(x0, model.k.len(), span)?;
        let arcs = Arcs::new(input, span);
        let mut z = vec![x0.iter().map(|x| arcs.u(0) - x).collect::<Vec<f64>>()];
        for k in 1..arcs.len() {
            z.push(stop_all(model, &z[k - 1], arcs.travel(k - 1)));
        }
        Ok(Self { model: model.clone(), arcs, z })
    }

    /// The deflections u − xᵢ [m] at time `t` [s] of the span.
    pub fn deflections(&self, t: f64) -> Vec<f64> {
        let (k, so_far) = self.arcs.locate(t);
        stop_all(&self.model, &self.z[k], so_far)
    }

    /// The force [N] at time `t` [s] of the span.
    pub fn force(&self, t: f64) -> f64 {
        force(&self.model, &self.deflections(t))
    }

    /// The largest force [N] over the span: F is monotone between the turns.
    pub fn largest_force(&self) -> f64 {
        let last = self.arcs.len();
        let end = stop_all(&self.model, &self.z[last - 1], self.arcs.travel(last - 1));
        self.z.iter().chain([&end]).map(|z| force(&self.model, z)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The displacements [m] at the start, at every turn and at the end.
    pub fn turns(&self) -> Vec<f64> {
        let starts = (0..self.arcs.len()).map(|k| self.arcs.u(k));
        let last = self.arcs.len() - 1;
        starts.chain([self.arcs.u(last) + self.arcs.travel(last)]).collect()
    }

    /// ∫F du [J] over the whole span.
    pub fn work(&self) -> f64 {
        (0..self.arcs.len()).map(|k| work(&self.model, &self.z[k], self.arcs.travel(k))).sum()
    }

    pub(crate) fn build(
        parameters: &Parameters,
        input: &Input,
        x0: &[f64],
        span: (f64, f64),
    ) -> Result<Box<dyn Reference>, ReferenceError> {
        Ok(Box::new(Self::new(&MaxwellSlip::new(parameters)?, input, x0, span)?))
    }
}

impl Reference for Trajectory {
    fn state(&self, t: f64, x: &mut [f64]) {
        let u = self.arcs.u_at(t);
        for (x, z) in x.iter_mut().zip(self.deflections(t)) {
            *x = u - z;
        }
    }

    /// Each arc adds the rounding of u at both ends; z never grows an error.
    fn error_bound(&self) -> f64 {
        let delta = self.model.delta.iter().fold(0.0_f64, |most, delta| most.max(*delta));
        let arcs = self.arcs.len() as f64;
        (2.0 * arcs + 1.0) * (self.arcs.rounding() + f64::EPSILON * delta)
    }
}

/// The settled loop of the Maxwell-slip model between two turning points.
///
/// Elements with 2Δᵢ below its width slip both ways and forget; the others keep an offset from the
/// history that led there, which is the model's nonlocal memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Loop {
    model: MaxwellSlip,
    /// Left turning point [m].
    pub u_min: f64,
    /// Right turning point [m].
    pub u_max: f64,
    /// Deflections at the left turning point [m].
    pub z_at_u_min: Vec<f64>,
    /// Deflections at the right turning point [m].
    pub z_at_u_max: Vec<f64>,
}

impl Loop {
    /// The loop between these extremes [m] after the positions `x0` [m] at the displacement `u0` [m].
    pub fn new(model: &MaxwellSlip, (u_min, u_max): (f64, f64), u0: f64, x0: &[f64]) -> Self {
        let start: Vec<f64> = x0.iter().map(|x| u0 - x).collect();
        let first = stop_all(model, &start, u_max - u0);
        let z_at_u_min = stop_all(model, &first, u_min - u_max);
        let z_at_u_max = stop_all(model, &z_at_u_min, u_max - u_min);
        Self { model: model.clone(), u_min, u_max, z_at_u_min, z_at_u_max }
    }

    /// The loop that a trajectory of this input is on in the `period` [s] that ends at `end` [s].
    pub fn of(run: &Trajectory, input: &Input, (period, end): (f64, f64)) -> Self {
        let (start, mut x) = (end - period, vec![0.0; run.model.k.len()]);
        run.state(start, &mut x);
        Self::new(&run.model, input.range_on(start, end), input.u(start), &x)
    }

    /// The energy [J] that the springs give back in one cycle, while they relax from either deflection
    /// to none: of elements that slip both ways, Σ ½kᵢΔᵢ² twice.
    pub fn returned(&self) -> f64 {
        let of = |z: f64, goal: f64| if z * goal < 0.0 { 0.5 * z * z } else { 0.0 };
        let ends = self.z_at_u_max.iter().zip(&self.z_at_u_min);
        self.model.k.iter().zip(ends).map(|(k, (a, b))| k * (of(*a, *b) + of(*b, *a))).sum()
    }

    /// The force [N] at `u` [m] within the range, going up or down.
    pub fn force(&self, u: f64, rising: bool) -> f64 {
        let (z, delta_u) = if rising {
            (&self.z_at_u_min, (u - self.u_min).max(0.0))
        } else {
            (&self.z_at_u_max, (u - self.u_max).min(0.0))
        };
        force(&self.model, &stop_all(&self.model, z, delta_u))
    }

    /// Force at the right turning point [N].
    pub fn force_at_u_max(&self) -> f64 {
        force(&self.model, &self.z_at_u_max)
    }

    /// ∮F du [J]: each element's loop is a parallelogram, its height in z times the slip of one way.
    ///
    /// For u_max = −u_min > Δᵢ for all i it is Σ 4kᵢΔᵢ(u_max − Δᵢ). *Printed* Σ kᵢΔᵢ² (p. 97), *read
    /// as* this, *because* the print does not depend on u_max, which the length of the slip does.
    pub fn area(&self) -> f64 {
        let height = self.z_at_u_max.iter().zip(&self.z_at_u_min).map(|(max, min)| max - min);
        let beta = self.u_max - self.u_min;
        self.model.k.iter().zip(height).map(|(k, height)| k * height * (beta - height)).sum()
    }

    /// The corners (u [m], F [N]) of the branch in the order of travel: its ends, and where elements
    /// begin to slip. The branch is the polygon through them.
    pub fn corners(&self, rising: bool) -> Vec<(f64, f64)> {
        let (from, to) = if rising { (self.u_min, self.u_max) } else { (self.u_max, self.u_min) };
        let z = if rising { &self.z_at_u_min } else { &self.z_at_u_max };
        let s = (to - from).signum();
        let ways = z.iter().zip(&self.model.delta).map(|(z, delta)| delta - s * z);
        let mut ways: Vec<f64> = ways.filter(|way| *way > 0.0 && *way < s * (to - from)).collect();
        ways.sort_by(f64::total_cmp);
        ways.dedup();
        let inner = ways.into_iter().map(|way| from + s * way);
        [from].into_iter().chain(inner).chain([to]).map(|u| (u, self.force(u, rising))).collect()
    }

    /// Where the branch crosses F = 0 [m], if it does.
    pub fn zero_force(&self, rising: bool) -> Option<f64> {
        let corners = self.corners(rising);
        let mut sides = corners.windows(2).map(|side| (side[0], side[1]));
        let ((u0, f0), (u1, f1)) = sides.find(|((_, f0), (_, f1))| f0 * f1 <= 0.0 && f0 != f1)?;
        Some(u0 + (u1 - u0) * f0 / (f0 - f1))
    }

    /// The displacement [m] from the right turning point to F = 0, a magnitude.
    pub fn lag(&self) -> Option<f64> {
        self.zero_force(false).map(|u| self.u_max - u)
    }

    /// The width [m] of the loop at F = 0.
    pub fn width(&self) -> Option<f64> {
        Some((self.zero_force(false)? - self.zero_force(true)?).abs())
    }
}
