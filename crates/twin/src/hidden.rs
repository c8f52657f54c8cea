//! The place for what a model does not know.

/// An effect hidden in a driven plant: it acts beside everything the scenario says.
/// Each method's own text is what it does where nothing is hidden.
pub trait Hidden {
    /// A force or torque [N or N·m] added to what drives the plant, at time t, displacement q and speed v.
    fn drive(&self, _t: f64, _q: f64, _v: f64) -> f64 {
        0.0
    }
}

/// Nothing is hidden.
#[derive(Debug)]
pub(crate) struct Nothing;

impl Hidden for Nothing {}
