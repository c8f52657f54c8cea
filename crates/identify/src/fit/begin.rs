//! The state in which a window begins.

use super::{
    problem::Problem,
    window::{START, Window},
};
use crate::march::{Model, Real, Start};

/// So many times its memory a contact must have slid for its state to be that of steady sliding.
const FORGOTTEN: f64 = 6.0;

impl Problem<'_> {
    /// The input with which a window begins.
    fn begins<D: Real>(&self, model: &Model<D>, window: &Window) -> D {
        let time = &self.data.time[window.first..window.end];
        let late = self.drive(window).begins(model.delay().map(|delay| (delay, time)));
        late.unwrap_or_else(|| D::from(self.data.input[window.first]))
    }

    /// The state of the contact at a window's start follows from how it came there.
    pub(super) fn state<D: Real>(
        &self,
        model: &Model<D>,
        window: &Window,
        start: [D; START],
    ) -> Start<D> {
        let [q, v, shift, off, faster] = start;
        let way = if window.run_up == 0.0 { 0.0 } else { window.run_up.signum() };
        let others = model.effects_from(way, window.past());
        // By the nominal memory: the answer must not jump where a parameter passes a limit.
        let z = if let Some(z) = model.contact.slipped(&window.path) {
            z
        } else if window.run_up.abs() > FORGOTTEN * self.memory {
            model.contact.sliding(window.run_up.signum() * v.re().abs())
        } else {
            model.holding(
                (self.data.time[window.first], self.begins(model, window)),
                [q, v],
                &others,
            )
        };
        let mut z = model.contact.shifted(z, shift);
        z.extend(others);
        if !self.rig.two_masses() {
            return Start { q, v, z, shown: window.shown };
        }
        // A measured velocity is the motor's, one from the displacement the load's that is not hidden.
        let motors = self.data.velocity.is_some() || model.hides_load();
        let [v, load] = if motors { [v, v - faster] } else { [v + faster, v] };
        let q = model.motor(self.begins(model, window), [q, load], (way, off), &mut z);
        Start { q, v, z, shown: window.shown }
    }
}
