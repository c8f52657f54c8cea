//! What residuals are divided by.

use crate::Rig;

/// The standard deviation that a residual of each channel is divided by, in the channel's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// Of the displacement.
    pub displacement: f64,
    /// Of the velocity.
    pub velocity: f64,
    /// Of the input that the controller makes.
    pub input: f64,
    /// Of the force under an imposed motion.
    pub force: f64,
    /// Of the two load cells.
    pub loads: [f64; 2],
}

impl Weights {
    /// The same with the noise of the measured angle in that of the load cells: their springs are followed along it, so
    /// that k r of it lies beside their own.
    #[must_use]
    pub fn along_angle(mut self, rig: &Rig) -> Self {
        for (cell, spring) in self.loads.iter_mut().zip(["k_1", "k_2"]) {
            let by = rig.value(spring).zip(rig.value("radius")).map_or(0.0, |(k, r)| k * r);
            *cell = cell.hypot(by * self.displacement);
        }
        self
    }
}
