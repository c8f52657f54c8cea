//! The LuGre model a second time, with no formula of the first: equation 18 and the work by Runge-Kutta
//! steps in time, the steady force by its own minimum, the speeds of its extrema by Lambert's W.

use super::largest;
use crate::{FrictionModel, Input, LuGre, closed_form::Arcs};

/// Steps over a travel of the shortest r: their fourth-order error is 1e-10 of the force, and the loops agree to 1e-13.
const PER_R: f64 = 100.0;
/// Steps of an arc, no fewer.
const FEWEST: f64 = 512.0;

/// Deflection and work along an input, step by step.
#[derive(Debug, Clone)]
pub struct Path {
    lugre: LuGre,
    arcs: Arcs,
    steps: Vec<Step>,
    /// Deflection at the end [m].
    pub x: f64,
    /// ∫F du over the span [J].
    pub work: f64,
}

#[derive(Debug, Clone, Copy)]
struct Step {
    arc: usize,
    /// Its start and end [s].
    span: (f64, f64),
    /// Deflection at its start [m].
    x: f64,
}

impl Path {
    /// The path from `x` [m] over the span [s].
    pub fn new(lugre: &LuGre, input: &Input, x: f64, span: (f64, f64)) -> Self {
        let arcs = Arcs::new(input, span);
        let mut path = Self { lugre: lugre.clone(), arcs, steps: Vec::new(), x, work: 0.0 };
        let shortest = lugre.f_c.min(lugre.f_s) / lugre.sigma_0;
        for arc in 0..path.arcs.len() {
            let (from, to) = path.arcs.ends(arc);
            let at = |part: f64| path.arcs.velocity(arc, from + part * (to - from)).abs();
            let fastest = (0..=8).map(|i| at(f64::from(i) / 8.0)).fold(0.0, f64::max);
            let n = (PER_R * fastest * (to - from) / shortest).max(FEWEST).ceil();
            let mut i = 0.0;
            while i < n {
                let end = if i + 1.0 == n { to } else { from + (to - from) * (i + 1.0) / n };
                let step = Step { arc, span: (from + (to - from) * i / n, end), x: path.x };
                let (x, work) = path.advance(step, end);
                path.steps.push(step);
                (path.x, path.work) = (x, path.work + work);
                i += 1.0;
            }
        }
        path
    }

    /// The path of one period from where it repeats itself: the map of a period is affine in x.
    pub fn settled(lugre: &LuGre, input: &Input, period: f64) -> Self {
        let over = |x| Self::new(lugre, input, x, (0.0, period)).x;
        let size = lugre.scale()[0];
        let (c, shifted) = (over(0.0), over(size));
        Self::new(lugre, input, c * size / (size - (shifted - c)), (0.0, period))
    }

    /// The largest force [N]: the largest at the steps, sought between its neighbours by steps of other lengths.
    pub fn largest_force(&self) -> f64 {
        let force = |step: &Step| self.force(step.arc, step.span.0, step.x);
        let best = self.steps.iter().enumerate().max_by(|a, b| force(a.1).total_cmp(&force(b.1)));
        let Some((i, top)) = best else { return f64::NAN };
        let before =
            if i > 0 && self.steps[i - 1].arc == top.arc { &self.steps[i - 1] } else { top };
        let on = |t: f64| self.force(top.arc, t, self.advance(*before, t).0);
        largest((before.span.0, top.span.1), on)
    }

    /// The force [N] where u is largest; at a turn, where the velocity is zero.
    pub fn force_at_right_turn(&self) -> f64 {
        let place = |step: &&Step| self.arcs.u_at(step.span.1);
        let best = self.steps.iter().max_by(|a, b| place(a).total_cmp(&place(b)));
        best.map_or(f64::NAN, |step| {
            self.force(step.arc, step.span.1, self.advance(*step, step.span.1).0)
        })
    }

    fn force(&self, arc: usize, t: f64, x: f64) -> f64 {
        let (u_dot, mut x_dot) = (self.arcs.velocity(arc, t), [0.0]);
        self.lugre.x_dot(&[x], 0.0, u_dot, &mut x_dot);
        self.lugre.force(&[x], &x_dot, 0.0, u_dot)
    }

    /// Deflection [m] and work [J] at `t`, from the start of `step`, by the classical rule.
    fn advance(&self, step: Step, t: f64) -> (f64, f64) {
        let (from, x0) = (step.span.0, step.x);
        let slope = |t: f64, x: f64| {
            let (u_dot, mut x_dot) = (self.arcs.velocity(step.arc, t), [0.0]);
            self.lugre.x_dot(&[x], 0.0, u_dot, &mut x_dot);
            (x_dot[0], self.lugre.force(&[x], &x_dot, 0.0, u_dot) * u_dot)
        };
        let (h, middle) = (t - from, from + 0.5 * (t - from));
        let a = slope(from, x0);
        let b = slope(middle, x0 + 0.5 * h * a.0);
        let c = slope(middle, x0 + 0.5 * h * b.0);
        let d = slope(t, x0 + h * c.0);
        let mean = |a: f64, b: f64, c: f64, d: f64| h / 6.0 * (a + 2.0 * (b + c) + d);
        (x0 + mean(a.0, b.0, c.0, d.0), mean(a.1, b.1, c.1, d.1))
    }
}

/// The force [N] at constant velocity `u_dot` [m/s], from equations 18 and 19 stepped until x rests.
pub fn steady_force(lugre: &LuGre, u_dot: f64) -> f64 {
    let r = lugre.r(u_dot);
    let slope = |x: f64| {
        let mut x_dot = [0.0];
        lugre.x_dot(&[x], 0.0, u_dot, &mut x_dot);
        x_dot[0]
    };
    let (mut x, h) = (0.0, 0.25 * r / u_dot.abs());
    for _ in 0..400 {
        let middle = slope(x + 0.5 * h * slope(x));
        x += h * middle;
    }
    lugre.force(&[x], &[slope(x)], 0.0, u_dot)
}

/// The speeds [m/s] of the largest and the smallest steady force: s² = −W(−ℓ²/2)/2 on the two branches of
/// Lambert's W, ℓ = σ₂v_S/(F_S − F_C), s = u̇/v_S.
pub fn steady_extrema(lugre: &LuGre) -> (f64, f64) {
    let level = lugre.sigma_2 * lugre.v_s / (lugre.f_s - lugre.f_c);
    let y = -0.5 * level * level;
    let speed = |w: f64| lugre.v_s * (-0.5 * w).sqrt();
    // W₋₁ starts from its expansion for small −y.
    let log = (-y).ln();
    (speed(lambert(y, y)), speed(lambert(y, log - (-log).ln())))
}

/// W with W e^W = `y`, by Newton's steps from `w`.
fn lambert(y: f64, mut w: f64) -> f64 {
    for _ in 0..100 {
        let e = w.exp();
        w -= (w * e - y) / (e * (w + 1.0));
    }
    w
}

/// The speed [m/s] above which some |x| ≤ `most` [m] gives energy back: by bisection on the sign of the
/// smallest D over x, which is sought by golden sections.
pub fn returning_speed(lugre: &LuGre, most: f64, fastest: f64) -> Option<f64> {
    let returns = |v: f64| {
        let d = |x: f64| -super::dissipation(lugre, x, v);
        largest((0.0, most), d) > 0.0
    };
    let (mut low, mut high) = (0.0, fastest);
    if !returns(high) {
        return None;
    }
    for _ in 0..200 {
        let v = 0.5 * (low + high);
        if returns(v) { high = v } else { low = v }
    }
    Some(high)
}
