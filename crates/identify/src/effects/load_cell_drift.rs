//! `load_cell_drift`: The load cells drift with time.

use super::{About, Channel, Key, Law, Load, Measure, family::{has_cells}};
use crate::march::Real;

/// The load cells drift with time.
pub(super) struct LoadCellDrift;

impl Law for LoadCellDrift {
    const ABOUT: About = About {
        name: "load_cell_drift",
        physics: "The load cells drift with time.",
        channel: Channel::Loads,
        keys: &[Key::amount("rate", Measure::PullRate, 5.0), Key::amount("rate_2", Measure::PullRate, 5.0)],
        probes: About::no_shape,
        applies: has_cells,
        confused: &[],
        separated_by: "a rest at the end, as long as the record",
        test: 0.1,
    };

    fn load<D: Real>(p: &[D], load: &Load, force: D) -> D {
        force + p[load.cell] * load.t
    }
}
