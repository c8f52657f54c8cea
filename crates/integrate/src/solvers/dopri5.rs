//! The method of Dormand and Prince of order 5(4) of ode_solvers, `Dopri5`.

use super::{Order, Solver};
use crate::libraries::ode_solvers;

pub(super) const SOLVER: Solver = Solver {
    name: "dopri5",
    library: "ode_solvers",
    order: Order::Adaptive(5),
    implicit: false,
    defect: None,
    run: ode_solvers::dopri5,
};
