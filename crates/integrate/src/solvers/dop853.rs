//! The method of Dormand and Prince of order 8(5,3) of ode_solvers, `Dop853`, as shipped.

use super::{Order, Solver};
use crate::libraries::ode_solvers;

pub(super) const SOLVER: Solver = Solver {
    name: "dop853",
    library: "ode_solvers",
    order: Order::Adaptive(8),
    implicit: false,
    defect: Some(
        "order 1 where the right-hand side uses t: the tableau has c12 = c13 = 0 instead of 1, so \
         the last stage is taken at the start of the step",
    ),
    run: |segment, control, recorder| ode_solvers::dop853(segment, control, recorder, false),
};
