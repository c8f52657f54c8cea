//! What residuals are divided by.

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
