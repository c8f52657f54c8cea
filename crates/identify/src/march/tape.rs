//! A motion and the steps that led through it.

/// One step as it was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    /// Where in its sample interval it starts, as a share of it.
    pub(super) from: f64,
    /// Its length [s].
    pub(super) h: f64,
    /// The velocity of each stage [m/s].
    pub(super) v: [f64; 3],
    /// The direction in which each stage slides, 0 where Coulomb friction held it.
    pub(super) way: [f64; 3],
    /// By what the derivatives of the velocity are multiplied at the end of the step: 1, but where Coulomb
    /// friction turns or stops the motion there.
    pub(super) turn: f64,
}

/// The steps of a motion, to go over once more.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tape {
    pub(super) steps: Vec<Step>,
    /// How many steps there are up to each sample.
    pub(super) until: Vec<usize>,
}

impl Tape {
    /// How many steps there are.
    pub fn steps(&self) -> usize {
        self.steps.len()
    }

    /// How many samples the motion has; none if it did not get through.
    pub fn samples(&self) -> usize {
        if self.steps.is_empty() { 0 } else { self.until.len() + 1 }
    }
}

/// A motion at the samples of a record.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Motion {
    /// Displacement [m].
    pub q: Vec<f64>,
    /// Velocity [m/s].
    pub v: Vec<f64>,
    /// The input, as recorded or as the controller made it.
    pub u: Vec<f64>,
    /// The steps.
    pub tape: Tape,
}
