//! The backward differentiation formulas of order 1 to 5 of diffsol.

use super::{Order, Solver};
use crate::libraries::diffsol;

pub(super) const SOLVER: Solver = Solver {
    name: "bdf",
    library: "diffsol",
    order: Order::Variable,
    implicit: true,
    defect: None,
    run: diffsol::bdf,
};
