//! The singly diagonally implicit Runge-Kutta method of order 3 of diffsol, with an explicit first
//! stage.

use super::{Order, Solver};
use crate::libraries::diffsol;

pub(super) const SOLVER: Solver = Solver {
    name: "esdirk34",
    library: "diffsol",
    order: Order::Adaptive(3),
    implicit: true,
    defect: None,
    run: diffsol::esdirk34,
};
