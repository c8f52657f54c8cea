//! `load_cell_drift`: The load cells drift with time.

use super::{About, Channel, Key, Law, Load, Measure, family::{has_cells}};
use crate::march::Real;

/// The load cells drift with time.
pub(super) struct LoadCellDrift;

/// A time constant beside which every record is short [s].
const STEADY: f64 = 1e7;

impl Law for LoadCellDrift {
    const ABOUT: About = About {
        name: "load_cell_drift",
        physics: "The load cells drift with time, and less and less.",
        equation: "F_i + rate_i tau (1 − exp(−t/tau))",
        channel: Channel::Loads,
        keys: &[
            Key::amount("rate", Measure::PullRate, 50.0),
            Key::amount("rate_2", Measure::PullRate, 50.0),
            Key::fitted("tau", Measure::Time).usually(STEADY),
        ],
        probes: |c| [3.0, 0.3].map(|share| vec![share * c.duration]).to_vec(),
        applies: has_cells,
        confused: &[],
        separated_by: "a rest at the end, as long as the record",
        test: 0.1,
    };

    fn load<D: Real>(p: &[D], load: &Load, force: D) -> D {
        force + p[load.cell] * p[2] * (D::from(1.0) - (-(p[2].recip() * load.t)).exp())
    }
}
