//! `Dop853` of ode_solvers with the time as one more state, τ' = 1: the remedy for its wrong
//! nodes. The time weighs nothing in the error, but counts in its mean over the states, which
//! loosens the tolerance by √((n + 1)/n).

use super::{Order, Solver};
use crate::libraries::ode_solvers;

pub(super) const SOLVER: Solver = Solver {
    name: "dop853-autonomous",
    library: "ode_solvers",
    order: Order::Adaptive(8),
    implicit: false,
    defect: None,
    run: |segment, control, recorder| ode_solvers::dop853(segment, control, recorder, true),
};
