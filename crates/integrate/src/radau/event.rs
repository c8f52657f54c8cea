//! Where the event function changes sign: the step is taken again until it ends there.

use super::{
    System,
    step::{Base, Method, NoStages, Step, plus},
};

/// Steps tried for one event; bisection alone would need about fifty.
const TRIES: u32 = 60;

/// How much closer than usual the stages are solved for: the event is a root of the computed end.
const CLOSE: f64 = 1e-3;

/// What a step did to the event function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Crossing {
    /// Nothing; it was last seen on this side (1, −1, or 0 if it is in the dead band).
    None(f64),
    /// It changed sign before this stage, at the part of the step, and maybe back again.
    Inside(f64),
    /// It has changed sign at the end, and was on the other side at the part `after` with the value `g`.
    AtEnd {
        /// Part of the step after which it happened.
        after: f64,
        /// The event function there.
        g: f64,
    },
}

impl<S: System<N>, const N: usize> Method<'_, S, N> {
    fn event_at(&self, base: &Base<N>, step: &Step<N>, stage: usize) -> f64 {
        let t = base.t + self.tableau.c[stage] * step.h;
        self.system.event(t, &plus(&base.y, &step.z[stage]))
    }

    /// Looks at the event function at the start and at the stages, `side` being where it came from.
    pub(super) fn crossing(
        &self,
        base: &Base<N>,
        step: &Step<N>,
        side: f64,
        dead_band: f64,
    ) -> Crossing {
        let sign = |g: f64| if g.abs() <= dead_band { 0.0 } else { g.signum() };
        let start = self.system.event(base.t, &base.y);
        let (mut side, mut last) = (side, (0.0, start));
        for (stage, c) in self.tableau.c.into_iter().enumerate() {
            let g = self.event_at(base, step, stage);
            let now = sign(g);
            if now * side < 0.0 {
                let (after, g) = last;
                return if c == 1.0 { Crossing::AtEnd { after, g } } else { Crossing::Inside(c) };
            }
            if now != 0.0 {
                (side, last) = (now, (c, g));
            }
        }
        Crossing::None(side)
    }

    /// The step that ends where the event function is zero, between the part `after` of `step`, where
    /// it was `g`, and its end. Secants on the end states of steps, kept inside the bracket; the side
    /// that stays has its value halved, so that neither does for long.
    pub(super) fn locate(
        &mut self,
        base: &Base<N>,
        step: &Step<N>,
        (after, g): (f64, f64),
    ) -> Result<Step<N>, NoStages> {
        let end = self.event_at(base, step, 2);
        let (mut low, mut g_low) = (after * step.h, g);
        let (mut high, mut g_high) = (step.h, end);
        let mut best = (end.abs(), step.clone());
        let mut previous = 0.0;
        for k in 0..TRIES {
            let secant = low + (high - low) * g_low / (g_low - g_high);
            let middle = low + 0.5 * (high - low);
            let guess = if secant > low && secant < high && k % 4 != 3 { secant } else { middle };
            let h = (base.t + guess) - base.t;
            if h <= low || h >= high {
                break;
            }
            let z = self.tableau.c.map(|c| self.along(step, c * h / step.h));
            let tried = self.stages(base, h, z, CLOSE)?;
            let g_tried = self.event_at(base, &tried, 2);
            if g_tried.abs() < best.0 {
                best = (g_tried.abs(), tried);
            }
            if g_tried == 0.0 {
                break;
            }
            if g_tried.signum() == end.signum() {
                (high, g_high) = (h, g_tried);
                g_low *= if previous > 0.0 { 0.5 } else { 1.0 };
                previous = 1.0;
            } else {
                (low, g_low) = (h, g_tried);
                g_high *= if previous < 0.0 { 0.5 } else { 1.0 };
                previous = -1.0;
            }
        }
        Ok(best.1)
    }
}
