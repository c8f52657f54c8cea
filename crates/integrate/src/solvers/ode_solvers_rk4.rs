//! The classical Runge-Kutta method of ode_solvers, `Rk4`.

use super::{Order, Solver};
use crate::libraries::ode_solvers;

pub(super) const SOLVER: Solver = Solver {
    name: "ode_solvers-rk4",
    library: "ode_solvers",
    order: Order::Fixed(4),
    implicit: false,
    defect: None,
    run: ode_solvers::rk4,
};
