//! Why a plant has no solution here.

use duhem::MaxwellSlip;

/// Why a plant has no solution here.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The plant cannot be.
    #[error("{key} = {found}: expected {expected}")]
    Plant {
        /// Which value.
        key: &'static str,
        /// What it is.
        found: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// The drive is not one sine.
    #[error("a drive that is no sine: expected a sine, an offset cosine or a constant")]
    Drive,
    /// The initial state is not one of this plant.
    #[error("y0 = {found:?}: expected {expected}")]
    InitialState {
        /// The state found.
        found: Vec<f64>,
        /// What it may be.
        expected: String,
    },
    /// The time span is empty or not finite.
    #[error("span = [{start}, {end}] s: expected a finite start before a finite end")]
    Span {
        /// Its start [s].
        start: f64,
        /// Its end [s].
        end: f64,
    },
    /// The span holds too many steps.
    #[error(
        "{needed:e} steps of a sixteenth period: expected at most {most:e}, take a shorter span or longer steps"
    )]
    TooLong {
        /// How many it needs.
        needed: f64,
        /// How many it may have.
        most: f64,
    },
}

impl SimulationError {
    /// The initial state of a plant with Maxwell-slip of `elements`.
    pub(crate) fn maxwell_slip_state(y0: &[f64], elements: usize) -> Self {
        let expected =
            format!("q, v and {elements} positions x_i, all finite, with |q - x_i| ≤ Δ_i");
        Self::InitialState { found: y0.to_vec(), expected }
    }
}

/// Refuses a span that is empty or not finite.
pub(crate) fn check_span((start, end): (f64, f64)) -> Result<(), SimulationError> {
    if start.is_finite() && end.is_finite() && start < end {
        Ok(())
    } else {
        Err(SimulationError::Span { start, end })
    }
}

/// The deflections of the elements of a plant with Maxwell-slip in the state `y0`, cut to the deadbands:
/// one may be exceeded by the rounding of q − x.
pub(crate) fn deflections(model: &MaxwellSlip, y0: &[f64]) -> Result<Vec<f64>, SimulationError> {
    let refuse = || SimulationError::maxwell_slip_state(y0, model.k.len());
    if y0.len() != model.k.len() + 2 || !y0.iter().all(|y| y.is_finite()) {
        return Err(refuse());
    }
    let slack = 1e-12 * y0[0].abs();
    let cut = |(x, delta): (&f64, &f64)| {
        let z = y0[0] - x;
        (z.abs() <= delta * (1.0 + 1e-12) + slack).then(|| z.clamp(-delta, *delta))
    };
    y0[2..].iter().zip(&model.delta).map(cut).collect::<Option<_>>().ok_or_else(refuse)
}
